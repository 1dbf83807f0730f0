"""Statuses of nodes in namespaces; test/aggregator.test sees the names of the monitor's own."""
from __future__ import annotations

import doctest

import pytest

from self_awareness import status_names
from self_awareness.status_names import status_name, task_of


def test_the_examples_of_docstrings_do_what_they_say() -> None:
    result = doctest.testmod(status_names)
    assert result.attempted > 2 and result.failed == 0


@pytest.mark.parametrize('node', ['/self_awareness', '/steps/self_awareness', '/a/b/watch'])
@pytest.mark.parametrize('task', ['communication', '/arm/driver'])
def test_each_node_knows_its_own(node: str, task: str) -> None:
    name = status_name(node, task)
    assert task_of(node, name) == task
    for other in ('/self_awareness', '/steps/self_awareness', '/a/b/watch', '/watch', '/other'):
        assert (task_of(other, name) is None) == (other != node)
