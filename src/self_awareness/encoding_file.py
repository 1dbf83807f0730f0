"""Reads an encoding file: how messages become events (config/encoding.yaml is an example)."""
from __future__ import annotations

from typing import Any, Dict, List, Optional, Tuple

from self_awareness import (FEWEST_CLASSES, MOST_CLASSES, EncodingRules, resolved_name,
                            yaml_file)
from self_awareness.yaml_section import Section, shown

Classes = Dict[str, Tuple[int, List[float]]]
"""Number of the classes of a field's values, and their bounds, by datatype."""

_LISTS = ('include_topics', 'exclude_topics', 'include_sources', 'exclude_sources')


def load(path: str) -> EncodingRules:
    """Return the rules of an encoding file; keys left out keep EncodingRules.defaults().

    Raises:
        OSError: the file cannot be read.
        ValueError: it is no YAML, has an unknown key, a value of the wrong kind, or a pattern that
            is no regular expression; the message names the file and the key.
    """
    data = yaml_file.load(path)
    rules = EncodingRules.defaults()
    # A file with nothing but comments is None: no key is there.
    with Section({} if data is None else data, path) as section:
        if 'source' in section:
            rules.source = section.text('source', 'callerid|none')
        if 'rename' in section:
            rules.rename = _renames(section, data['rename'])
            _validate(section, 'rename', rules)
        for key in _LISTS:
            if key in section:
                setattr(rules, key, list(section.texts(key, fewest=0)))
                _validate(section, key, rules)
        if 'type_fields' in section:
            rules.type_fields, rules.classes = _fields(section.section('type_fields'),
                                                       data['type_fields'])
        if 'mode' in section:
            rules.mode = _mode(section, data['mode'])
            _validate(section, 'mode', rules)
    return rules


def values(rules: EncodingRules) -> Dict[str, Any]:
    """Return rules by their keys in an encoding file."""
    return {'source': rules.source, 'rename': [list(rename) for rename in rules.rename],
            **{key: list(getattr(rules, key)) for key in _LISTS},
            'type_fields': {datatype: _field(name, rules.classes.get(datatype))
                            for datatype, name in rules.type_fields.items()},
            'mode': dict(zip(('topic', 'field'), rules.mode or ()))}


def _fields(section: Section, value: Dict[Any, Any]) -> Tuple[Dict[str, str], Classes]:
    """Return the fields by datatype, and the classes of those that have some."""
    names: Dict[str, str] = {}
    classes: Classes = {}
    for datatype, of_type in value.items():
        if not isinstance(datatype, str):
            section.fail(str(datatype), 'expected a datatype')
        if not isinstance(of_type, dict):
            names[datatype] = section.text(datatype)
            continue
        with section.section(datatype) as numeric:
            names[datatype] = numeric.text('field')
            number = numeric.integer('classes', FEWEST_CLASSES, high=MOST_CLASSES)
            classes[datatype] = (number, [])
    return names, classes


def _field(name: str, classes: Optional[Tuple[int, List[float]]]) -> Any:
    if classes is None:
        return name
    return {'field': name, 'classes': classes[0], 'bounds': list(classes[1])}


def _mode(section: Section, value: Any) -> Optional[Tuple[str, str]]:
    if value == {}:
        return None
    with section.section('mode') as mode:
        return resolved_name(mode.text('topic')), mode.text('field')


def _renames(section: Section, value: Any) -> List[Tuple[str, str]]:
    if not isinstance(value, list) or not all(
            isinstance(rule, list) and len(rule) == 2 and
            all(isinstance(text, str) for text in rule) for rule in value):
        section.fail('rename', 'expected a list of pairs, each of a regular expression and the '
                               f'name that takes its place, found {shown(value)}')
    return [(pattern, name) for pattern, name in value]


def _validate(section: Section, key: str, rules: EncodingRules) -> None:
    try:
        rules.validate()
    except ValueError as error:
        section.fail(key, str(error))
