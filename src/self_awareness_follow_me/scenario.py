"""The scenario of the simulated follow-me robot: its data, read from YAML and checked.

The paper evaluates its model on a robot of 15 components that follows a person (section V-A) and
on four errors induced in it (section V-B). `config/follow_me.yaml` describes both and explains
every key; this module turns the file into immutable data and rejects what makes no sense. How a
component behaves is in `component`, which faults can hit it in `faults`. Times are seconds, as in
the file.
"""
from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Dict, Mapping, Optional, Tuple, Union

import rospkg

from self_awareness import yaml_file
from self_awareness.yaml_section import Section, SectionError
from self_awareness_follow_me.component_spec import (ComponentSpec, Duration, Hypothesis, InView,
                                                     Need, Output, Task)
from self_awareness_follow_me.effects import (Change, ClockDrift, Crash, Faults, Intruder,
                                              Starvation, disordered)


@dataclass(frozen=True)
class Scenario:
    """Everything that the YAML file says; `datatypes` maps each topic to its message type."""

    components: Tuple[ComponentSpec, ...]
    faults: Faults
    transport: Duration
    lateness: Duration
    cpu_share: float
    type_fields: Mapping[str, str]
    datatypes: Mapping[str, str]

    def component(self, name: str) -> ComponentSpec:
        """Return the component of that name.

        Raises:
            SectionError: there is none; the message lists those that exist.
        """
        for spec in self.components:
            if spec.name == name:
                return spec
        names = ', '.join(spec.name for spec in self.components)
        raise SectionError(f'no component {name!r} in the scenario; there are: {names}')


def default_path() -> Path:
    """Return the scenario that comes with the package.

    Raises:
        SectionError: the package is not on ROS_PACKAGE_PATH.
    """
    try:
        package = rospkg.RosPack().get_path('self_awareness')
    except rospkg.ResourceNotFound as error:
        raise SectionError('package self_awareness not found: source the setup.bash of its '
                           'workspace, or name the scenario file') from error
    return Path(package) / 'config' / 'follow_me.yaml'


def load_scenario(path: Union[str, Path, None] = None) -> Scenario:
    """Read and check a scenario file, by default the one that comes with the package.

    Raises:
        SectionError: the file cannot be read, is not YAML, or a value in it is missing, unknown,
            of the wrong kind or out of range; the message names the file and the key.
    """
    path = default_path() if path is None else Path(path)
    try:
        data = yaml_file.load(str(path))
    except OSError as error:
        raise SectionError(f'{path}: cannot be read: {error}') from error
    except ValueError as error:
        raise SectionError(str(error)) from error
    with Section(data, str(path)) as top:
        components = tuple(_component(section) for section in top.sections('components'))
        datatypes = _datatypes(top, components)
        faults = _faults(top.section('faults'), components, datatypes)
        with top.section('simulation') as simulation:
            transport = _duration(simulation, 'transport')
            lateness = _duration(simulation, 'lateness')
        with top.section('live') as live:
            cpu_share = live.number('cpu_share', low=1e-3, high=1.0)
        with top.section('encoding') as encoding:
            type_fields = encoding.texts_by_key('type_fields')
    return Scenario(components, faults, transport, lateness, cpu_share, type_fields, datatypes)


def _duration(section: Section, key: str, default: Optional[Duration] = None,
              low: float = 0.0) -> Duration:
    if key not in section and default is not None:
        return default
    if section.is_number(key):
        return Duration(section.number(key, low=low))
    with section.section(key) as parts:
        return Duration(parts.number('median', low=max(low, 1e-6)),
                        parts.number('sigma', low=0.0, high=3.0),
                        parts.number('rare', low=0.0, high=1.0, default=0.0),
                        parts.number('factor', low=1.0, default=1.0))


def _component(section: Section) -> ComponentSpec:
    with section:
        return ComponentSpec(section.text('name', r'[a-z][a-z0-9_]*'),
                             section.text('host', r'[ab]'),
                             tuple(_task(task) for task in section.sections('tasks')),
                             section.texts('hears', default=()))


def _task(section: Section) -> Task:
    with section:
        if 'upon' not in section and 'every' not in section:
            section.fail('upon', 'missing; a task needs `upon: TOPIC`, `every: SECONDS` or both')
        hypothesis = None
        if 'hypothesis' in section:
            hypothesis = _hypothesis(section.section('hypothesis'))
        every = _duration(section, 'every', low=1e-3) if 'every' in section else None
        return Task(
            publish=tuple(_output(output) for output in section.sections('publish')),
            otherwise=tuple(_output(output)
                            for output in section.sections('otherwise', default=())),
            upon=section.text('upon', default=None),
            each=section.integer('each', low=1, default=1),
            every=every,
            jitter=section.number('jitter', low=0.0, high=every.median / 4 if every else 0.0,
                                  default=0.0),
            needs=tuple(_need(need) for need in section.sections('needs', default=())),
            probability=section.number('probability', low=0.0, high=1.0, default=1.0),
            in_view=_in_view(section.section('in_view')) if 'in_view' in section else None,
            hypothesis=hypothesis)


def _output(section: Section) -> Output:
    with section:
        if 'value' in section and 'value_of' in section:
            section.fail('value', 'cannot be given together with `value_of`')
        return Output(section.text('topic', r'[a-z][a-z0-9_/]*'),
                      section.text('type', r'[A-Za-z]\w*/[A-Za-z]\w*'),
                      _duration(section, 'takes'),
                      _duration(section, 'waits', default=Duration(0.0)),
                      section.boolean('latch', default=False),
                      section.values('value', default=()),
                      section.text('value_of', default=None))


def _need(section: Section) -> Need:
    kinds = [kind for kind in ('within', 'stamps_within', 'one_of') if kind in section]
    if len(kinds) != 1:
        section.fail('within', 'give exactly one of `within`, `stamps_within` and `one_of`')
    with section:
        return Need(section.text('topic'),
                    section.number('within', low=1e-6, default=None),
                    section.number('stamps_within', low=1e-6, default=None),
                    section.values('one_of', default=None))


def _in_view(section: Section) -> InView:
    with section:
        return InView(_duration(section, 'stays', low=1e-3),
                      _duration(section, 'leaves', low=1e-3))


def _hypothesis(section: Section) -> Hypothesis:
    with section:
        values = [section.integer(action, low=0) for action in ('insert', 'update', 'delete')]
        if len(set(values)) != 3:
            section.fail('insert', '`insert`, `update` and `delete` need three different values')
        return Hypothesis(section.integer('confirm', low=1),
                          section.number('discard_after', low=1e-3), *values)


def _faults(section: Section, components: Tuple[ComponentSpec, ...],
            datatypes: Mapping[str, str]) -> Faults:
    with section:
        with section.section('cc1') as cc1, section.section('cc2') as cc2:
            crashes = [Crash(_known(crash, 'crash', crash.text('crash'), components).name)
                       for crash in (cc1, cc2)]
        with section.section('rs') as rs:
            starvation = Starvation(rs.number('ramp', low=1e-3), rs.number('slowdown', low=1.0),
                                    rs.integer('workers_per_core', low=1))
        with section.section('ac') as ac:
            drift = ClockDrift(ac.text('host', r'[ab]'), ac.number('drift'),
                               ac.number('settle', low=1e-3), ac.number('wobble', low=0.0),
                               ac.numbers('periods', low=1e-3))
        with section.section('lat') as lat:
            late = tuple(_known(lat, 'components', name, components).name
                         for name in lat.texts('components'))
            latency = Change(late, {'delay': lat.number('delay', low=1e-3)})
        extra = section.section('extra')
        intruder = _component(extra)
        if intruder.name in [spec.name for spec in components]:
            extra.fail('name', f'{intruder.name!r} is a component; a foreign node has another')
        _check_topics(extra, intruder, datatypes)
        with section.section('order') as order:
            mixed_up = _known(order, 'component', order.text('component'), components)
            if all(len(task.publish) < 2 for task in mixed_up.tasks):
                order.fail('component', f'{mixed_up.name!r} never publishes two messages in a '
                                        'row; choose a component that does')
        with section.section('unknown') as unknown:
            changed = _known(unknown, 'component', unknown.text('component'), components)
            task = _task(unknown.section('task'))
            _check_topics(unknown, replace(changed, tasks=(task,)), datatypes)
            for topic in [o.topic for o in task.publish if o.topic not in changed.outputs()]:
                unknown.fail('task', f'{changed.name!r} does not publish {topic!r} otherwise')
        with section.section('lossy') as lossy:
            loss = Change((), {'lost': lossy.number('share', low=1e-6, high=1.0)})
    return Faults(crashes[0], crashes[1], starvation, drift, latency, Intruder(intruder),
                  Change((mixed_up.name,), other=disordered),
                  Change((changed.name,), more=(task,)), loss)


def _known(section: Section, key: str, name: str,
           components: Tuple[ComponentSpec, ...]) -> ComponentSpec:
    for spec in components:
        if spec.name == name:
            return spec
    names = ', '.join(spec.name for spec in components)
    section.fail(key, f'no component {name!r}; there are: {names}')


def _check_topics(section: Section, spec: ComponentSpec, datatypes: Mapping[str, str]) -> None:
    """Check that what a fault adds stays within the topics and types of the components."""
    for topic in spec.inputs():
        if topic not in datatypes:
            section.fail('upon', f'no component publishes {topic!r}')
    for topic, output in spec.outputs().items():
        if datatypes.get(topic) != output.datatype:
            section.fail('publish', f'no component publishes {topic!r} as {output.datatype}')


def _datatypes(top: Section, components: Tuple[ComponentSpec, ...]) -> Dict[str, str]:
    """Map topics to types; check names, and that somebody publishes what is listened to."""
    datatypes: Dict[str, str] = {}
    publishers: Dict[str, str] = {}
    for spec in components:
        if [other.name for other in components].count(spec.name) > 1:
            top.fail('components', f'the name {spec.name!r} is given twice')
        for output in (o for task in spec.tasks for o in task.publish + task.otherwise):
            if publishers.setdefault(output.topic, spec.name) != spec.name:
                top.fail('components', f'topic {output.topic!r} is published by both '
                                       f'{publishers[output.topic]!r} and {spec.name!r}')
            if datatypes.setdefault(output.topic, output.datatype) != output.datatype:
                top.fail('components', f'topic {output.topic!r} has two types: '
                                       f'{datatypes[output.topic]} and {output.datatype}')
    for spec in components:
        for topic in spec.inputs():
            if topic not in datatypes:
                top.fail('components', f'{spec.name!r} listens to {topic!r}, which no component '
                                       'publishes')
    return datatypes
