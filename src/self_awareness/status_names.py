"""What the statuses of nodes of this package are called on /diagnostics.

The namespace of the node comes last: so one beginning fits the monitors of all robots, for
config/diagnostic_analyzers.yaml and for whoever looks.
"""
from __future__ import annotations

from typing import Optional


def status_name(node: str, task: str) -> str:
    """Return the name of a node's status.

    Args:
        node: its full name.
        task: what the status is about.

    Example:
        >>> status_name('/self_awareness', 'monitor')
        'self_awareness: monitor'
        >>> status_name('/robot1/self_awareness', '/robot1/player')
        'self_awareness: /robot1/player (robot1)'
    """
    namespace, _, own = node.rpartition('/')
    where = f' ({namespace[1:]})' if namespace else ''
    return f'{own}: {task}{where}'


def task_of(node: str, name: str) -> Optional[str]:
    """Return what a status is about; None if it is not the node's.

    Example:
        >>> task_of('/robot1/self_awareness', 'self_awareness: monitor (robot1)')
        'monitor'
        >>> task_of('/self_awareness', 'self_awareness: monitor (robot1)') is None
        True
    """
    begin, end = status_name(node, '\0').split('\0')
    if not name.startswith(begin) or not name.endswith(end):
        return None
    task = name[len(begin):len(name) - len(end)]
    return None if not end and task.endswith(')') and ' (' in task else task
