"""Reads YAML files that may be anybody's: bounded, and wrong ones in one line."""
from __future__ import annotations

from collections import Counter
from typing import Any

from self_awareness import printable

_LARGEST = 1 << 20
"""Of a file [bytes]: it takes seconds. The graph of a robot of 1000 nodes has half of it."""
_DEEPEST = 20  # values may lie in each other so often


def load(path: str) -> Any:
    """Return what a YAML file holds.

    Aliases (`*name`) are refused: a few lines of them stand for more than any memory holds.

    Raises:
        OSError: the file cannot be read.
        ValueError: it is no YAML, too large or too deep, or has aliases, control characters or a
            key twice; the message names it.
    """
    # Imported here: it takes long, and most programs read no such file.
    import yaml

    class Loader(yaml.CSafeLoader):
        """Refuses keys that are given twice, the last of which would count."""

        def construct_mapping(self, node: Any, deep: bool = False) -> Any:
            mapping = super().construct_mapping(node, deep)
            if len(mapping) < len(node.value):
                keys = [self.construct_object(key, deep) for key, _ in node.value]
                key = Counter(keys).most_common(1)[0][0]
                raise yaml.YAMLError(f'the key {key!r} is there twice{node.start_mark}')
            return mapping

    with open(path, 'rb') as file:
        content = file.read(_LARGEST + 1)
    if len(content) > _LARGEST:
        raise ValueError(f'{path}: larger than {_LARGEST >> 20} MB')
    try:
        text = content.decode()
        _check(text)
        # Numbers and dates that do not exist, and bytes that are no text, are ValueErrors.
        return yaml.load(text, Loader)
    except (yaml.YAMLError, ValueError, TypeError) as error:
        told = printable(' '.join(str(error).split()))
        raise ValueError(f'{path}: not YAML: {told}') from error


def _check(text: str) -> None:
    """Refuse what needs more memory or stack than the file has bytes, and what is no plain text.

    It looks at one event of the parser after the other: what is too deep is not read to its end.

    Raises:
        yaml.YAMLError: what it is, and where.
    """
    import yaml

    depth = 0
    for event in yaml.parse(text, yaml.CSafeLoader):
        if isinstance(event, yaml.AliasEvent):
            raise yaml.YAMLError(f'an alias, which is not allowed{event.start_mark}')
        depth += isinstance(event, yaml.CollectionStartEvent)
        depth -= isinstance(event, yaml.CollectionEndEvent)
        if depth > _DEEPEST:
            raise yaml.YAMLError(f'values in each other more than {_DEEPEST} deep')
        if isinstance(event, yaml.ScalarEvent) and printable(event.value) != event.value:
            raise yaml.YAMLError(f'control characters in a text{event.start_mark}')
