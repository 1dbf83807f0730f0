"""Encoding files, and the example among the configurations."""
from __future__ import annotations

import pickle
from pathlib import Path
from typing import Callable

import pytest
import yaml

from self_awareness import EncodingRules, encoding_file

EXAMPLE = Path(__file__).resolve().parents[2] / 'config' / 'encoding.yaml'


def test_the_example_is_what_train_does_without_a_file() -> None:
    assert encoding_file.load(str(EXAMPLE)) == EncodingRules.defaults()


def test_the_example_shows_every_key() -> None:
    keys = set(yaml.safe_load(EXAMPLE.read_text()))
    assert keys == {'source', 'rename', 'include_topics', 'exclude_topics', 'include_sources',
                    'exclude_sources', 'type_fields', 'mode'}


@pytest.fixture
def read(tmp_path: Path) -> Callable[[str], EncodingRules]:
    """Return a function that reads a text as an encoding file, e.yaml."""
    def read(text: str) -> EncodingRules:
        (tmp_path / 'e.yaml').write_text(text)
        return encoding_file.load(str(tmp_path / 'e.yaml'))
    return read


@pytest.mark.parametrize('text', ['', '# nothing but a comment\n', '{}', 'mode: {}'])
def test_keys_left_out_keep_their_default(read: Callable[[str], EncodingRules], text: str) -> None:
    rules = read(text)
    assert rules == EncodingRules.defaults()
    assert rules.mode is None and encoding_file.values(rules)['mode'] == {}


def test_keys_are_read(read: Callable[[str], EncodingRules]) -> None:
    rules = read('source: none\ninclude_topics: ["/a.*"]\nexclude_topics: []\n'
                 'include_sources: [/b]\nexclude_sources: []\ntype_fields: {a/B: c.d}\n'
                 "rename: [['/r(.)/x', '/\\1'], [/a, /b]]\n"
                 'mode: {topic: a1, field: s.t}\n')
    assert rules.source == 'none'
    assert (rules.include_topics, rules.exclude_topics) == (['/a.*'], [])
    assert (rules.include_sources, rules.exclude_sources) == (['/b'], [])
    assert rules.type_fields == {'a/B': 'c.d'}
    assert rules.mode == ('/a1', 's.t')
    assert encoding_file.values(rules)['mode'] == {'topic': '/a1', 'field': 's.t'}
    assert pickle.loads(pickle.dumps(rules)) == rules
    assert rules.rename == [('/r(.)/x', '/\\1'), ('/a', '/b')]
    assert encoding_file.values(rules)['rename'] == [['/r(.)/x', '/\\1'], ['/a', '/b']]


def test_a_field_may_have_classes(read: Callable[[str], EncodingRules]) -> None:
    rules = read('type_fields: {a/B: c.d, e/F: {field: g, classes: 4}}\n')
    assert rules.type_fields == {'a/B': 'c.d', 'e/F': 'g'}
    assert rules.classes == {'e/F': (4, [])}
    assert encoding_file.values(rules)['type_fields'] == {
        'a/B': 'c.d', 'e/F': {'field': 'g', 'classes': 4, 'bounds': []}}
    assert pickle.loads(pickle.dumps(rules)) == rules


@pytest.mark.parametrize('text, key', [
    ('sources: none', 'sources'),
    ('source: topic', 'source'),
    ('source: 1', 'source'),
    ('include_topics: /a', 'include_topics'),
    ('exclude_sources: [1]', 'exclude_sources'),
    ('exclude_topics: ["(/a"]', 'exclude_topics'),
    ('type_fields: [level]', 'type_fields'),
    ('rename: /a', 'rename'),
    ('rename: [[/a]]', 'rename'),
    ('rename: [[/a, 1]]', 'rename'),
    ('rename: [[/a, b]]', 'rename'),
    ('rename: [["/(a", /b]]', 'rename'),
    ('type_fields: {a/B: 1}', 'type_fields.a/B'),
    ('type_fields: {a/B: {field: c}}', 'type_fields.a/B.classes'),
    ('type_fields: {a/B: {classes: 4}}', 'type_fields.a/B.field'),
    ('type_fields: {a/B: {field: c, classes: 1}}', 'type_fields.a/B.classes'),
    ('type_fields: {a/B: {field: c, classes: 17}}', 'type_fields.a/B.classes'),
    ('type_fields: {a/B: {field: c, classes: 2.5}}', 'type_fields.a/B.classes'),
    ('type_fields: {a/B: {field: c, classes: 4, bounds: [1]}}', 'type_fields.a/B.bounds'),
    ('mode: /state', 'mode'),
    ('mode: {topic: /state}', 'mode.field'),
    ('mode: {topic: /state, field: data, value: 1}', 'mode.value'),
    ('mode: {topic: ~state, field: data}', 'mode'),
    ('mode: {topic: /clock, field: clock}', 'mode'),
    ('include_topics: [/a]\nmode: {topic: /b, field: data}', 'mode'),
])
def test_an_error_names_the_file_and_the_key(read: Callable[[str], EncodingRules], text: str,
                                             key: str) -> None:
    with pytest.raises(ValueError, match=f'e.yaml: {key}: '):
        read(text)
