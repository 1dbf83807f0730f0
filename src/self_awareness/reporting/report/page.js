// Draws the figures of the page, and lets alarms be clicked. All that it draws is in the data.
(function () {
  'use strict';

  const data = JSON.parse(document.getElementById('data').textContent);
  const dark = window.matchMedia('(prefers-color-scheme: dark)');
  const narrow = window.matchMedia('(max-width: 600px)');
  const drawn = new Map(); // figure by its element
  let printing = false;

  // Below the limit, evidence is normal and quiet; at the limit, the colour changes at once.
  function evidenceColours(isDark) {
    const ground = isDark ? '#1d2128' : '#f6f7f9';
    const half = isDark ? '#263a52' : '#dbe8f7';
    return [[0, ground], [0.25, half], [0.4999, '#4a8fdd'], [0.5, '#e08a00'], [0.75, '#e5484d'],
      [1, '#8c1016']];
  }

  function themed(figure) {
    const isDark = dark.matches && !printing;
    const ink = isDark ? '#c3cad5' : '#3a424d';
    const grid = isDark ? '#2c333d' : '#e6e9ed';
    const layout = Object.assign({}, figure.layout, {
      paper_bgcolor: 'rgba(0,0,0,0)', plot_bgcolor: 'rgba(0,0,0,0)',
      font: {color: ink, size: narrow.matches ? 10 : 12}, autosize: true,
    });
    if (narrow.matches) {
      layout.dragmode = false; // a finger on a plot moves the page
    }
    for (const name of Object.keys(layout)) {
      if (/^[xy]axis/.test(name)) {
        layout[name] = Object.assign({gridcolor: grid}, layout[name]);
      }
    }
    const traces = figure.data.map(function (trace) {
      return trace.meta === 'evidence'
        ? Object.assign({}, trace, {colorscale: evidenceColours(isDark)}) : trace;
    });
    return {data: traces, layout: layout};
  }

  function draw(element, figure) {
    const shown = themed(figure);
    const before = drawn.has(element) && element.layout && element.layout.xaxis;
    if (before && before.range) { // the zoom stays
      shown.layout.xaxis = Object.assign({}, shown.layout.xaxis, {range: before.range.slice()});
    }
    drawn.set(element, figure);
    return Plotly.react(element, shown.data, shown.layout,
      {displaylogo: false, responsive: true, displayModeBar: false});
  }

  function drawDetails(incident) {
    for (const [id, figure] of Object.entries(incident.figures)) {
      const element = document.getElementById(id);
      if (element && !drawn.has(element)) {
        draw(element, figure);
      }
    }
  }

  function redraw() {
    for (const [element, figure] of drawn) {
      draw(element, figure);
    }
  }

  // Shows an alarm with what comes before and after it.
  function zoom(section, [start, end]) {
    const [first, last] = section.overTime.layout.xaxis.range;
    const around = Math.max(5, 0.25 * (end - start));
    Plotly.relayout(section.element,
      {'xaxis.range': [Math.max(first, start - around), Math.min(last, end + around)]});
  }

  function show(key) {
    const section = data.sections.find(function (each) { return key in each.incidents; });
    drawDetails(section.incidents[key]);
    zoom(section, section.incidents[key].range);
  }

  function open(key) {
    const details = document.getElementById(key);
    details.open = true;
    show(key);
    details.scrollIntoView({block: 'nearest'});
  }

  // Needs plotly.js; what it is for is in the page already.
  function start() {
    document.querySelectorAll('.over-time').forEach(function (element) {
      const section = data.sections[Number(element.dataset.section)];
      section.element = element;
      draw(element, section.overTime).then(function () {
        element.on('plotly_click', function (event) {
          const key = event.points[0] && event.points[0].customdata;
          if (key in section.incidents) {
            open(key);
          }
        });
      });
      for (const [key, incident] of Object.entries(section.incidents)) {
        const details = document.getElementById(key);
        if (details.open) {
          drawDetails(incident);
        }
        details.querySelectorAll('[data-zoom]').forEach(function (button) {
          button.addEventListener('click', function () {
            zoom(section, button.dataset.zoom.split(' ').map(Number));
            element.scrollIntoView({block: 'nearest'});
          });
        });
        details.querySelector('summary').addEventListener('click', function () {
          if (!details.open) { // it opens after this event
            setTimeout(show, 0, key);
          }
        });
      }
    });
    (data.figures || []).forEach(function (figure) {
      draw(document.getElementById(figure.id), figure);
    });

    document.querySelectorAll('[data-open]').forEach(function (button) {
      button.addEventListener('click', function () { open(button.dataset.open); });
    });
    document.querySelectorAll('[data-whole]').forEach(function (button) {
      const section = data.sections[Number(button.dataset.whole)];
      button.addEventListener('click', function () {
        Plotly.relayout(section.element,
          {'xaxis.range': section.overTime.layout.xaxis.range.slice()});
      });
    });

    // On paper nothing can be opened: the alarm that the summary is about is printed with details.
    window.addEventListener('beforeprint', function () {
      printing = true;
      document.querySelectorAll('[data-open]').forEach(function (button) {
        document.getElementById(button.dataset.open).open = true;
      });
      data.sections.forEach(function (section) {
        for (const [key, incident] of Object.entries(section.incidents)) {
          if (document.getElementById(key).open) {
            drawDetails(incident);
          }
        }
      });
      redraw();
    });
    window.addEventListener('afterprint', function () {
      printing = false;
      redraw();
    });
    for (const media of [dark, narrow]) {
      media.addEventListener('change', redraw);
    }
  }

  // plotly.js is packed: it would be nearly all of the page.
  async function loadPlotly() {
    const packed = atob(document.getElementById('plotly').textContent);
    const bytes = Uint8Array.from(packed, function (each) { return each.charCodeAt(0); });
    const unpacked = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
    const script = document.createElement('script');
    script.textContent = await new Response(unpacked).text();
    document.head.append(script);
  }

  if ('DecompressionStream' in window) {
    loadPlotly().then(start);
  } else {
    document.querySelectorAll('.figure').forEach(function (element) {
      element.textContent = 'This browser is too old to draw this.';
    });
  }
}());
