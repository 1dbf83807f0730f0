"""Reads YAML files that may be anybody's: bounded, and wrong ones in one line."""
from __future__ import annotations

from typing import Any

_LARGEST = 16 << 20
"""Of a file [bytes]: a graph of thousands of nodes has some MB."""
_DEEPEST = 20
"""Values may lie in each other so often: the parser calls itself for each."""


def load(path: str) -> Any:
    """Return what a YAML file holds.

    Aliases (`*name`) are refused: a few lines of them stand for more than any memory holds.

    Raises:
        OSError: the file cannot be read.
        ValueError: it is no YAML, too large or too deep, or has aliases; the message names it.
    """
    # Imported here: it takes long, and most programs read no such file.
    import yaml

    class Loader(yaml.SafeLoader):
        """Refuses what needs more memory or time than the file has bytes."""

        depth = 0

        def compose_node(self, parent: Any, index: Any) -> Any:
            if self.check_event(yaml.AliasEvent):
                raise yaml.YAMLError(
                    f'an alias, which is not allowed{self.peek_event().start_mark}')
            self.depth += 1
            if self.depth > _DEEPEST:
                raise yaml.YAMLError(f'values in each other more than {_DEEPEST} deep')
            node = super().compose_node(parent, index)
            self.depth -= 1
            if isinstance(node, yaml.ScalarNode):
                node.value.encode()  # an escape may stand for half a character
            return node

    with open(path, 'rb') as file:
        content = file.read(_LARGEST + 1)
    if len(content) > _LARGEST:
        raise ValueError(f'{path}: larger than {_LARGEST >> 20} MB')
    try:
        # Numbers and dates that do not exist, and bytes that are no text, are ValueErrors.
        return yaml.load(content.decode(), Loader)
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        raise ValueError(f'{path}: not YAML: {error}') from error
