"""Typed and checked access to a parsed YAML mapping; errors name the file and the key."""
from __future__ import annotations

import re
from typing import Any, Dict, List, NoReturn, Tuple, Union

_REQUIRED = object()


class SectionError(ValueError):
    """A YAML file cannot be used; the message names the file, the key and the way out."""


class Section:
    """A mapping in a YAML file.

    Each getter checks its value, returns `default` where the key is absent, and raises
    SectionError where it is absent without a default, of another kind or out of range. Used as a
    context manager, it raises SectionError at the end for keys that no getter has asked for.

    Args:
        data: what the YAML parser made of the section.
        path: the file, for error messages.
        where: the keys that lead to the section, for error messages; empty for the whole file.
    """

    def __init__(self, data: Any, path: str, where: str = '') -> None:
        self._path = path
        self._where = where
        self._known: Dict[str, None] = {}
        if not isinstance(data, dict):
            raise SectionError(f'{path}: {where or "the file"}: expected keys with values, '
                               f'found {shown(data)}')
        self._data = data

    def __contains__(self, key: str) -> bool:
        self._known[key] = None
        return key in self._data

    def __enter__(self) -> Section:
        return self

    def __exit__(self, kind: Any, error: Any, trace: Any) -> None:
        if error is not None:
            return
        for key in self._data:
            if key not in self._known:
                self.fail(str(key), f'unknown key; allowed are: {", ".join(sorted(self._known))}')

    def fail(self, key: str, problem: str) -> NoReturn:
        """Raise SectionError about one key of this section."""
        raise SectionError(f'{self._path}: {self._name(key)}: {problem}')

    def is_number(self, key: str) -> bool:
        """Return whether the key is there and holds a number."""
        value = self._data.get(key)
        return isinstance(value, (int, float)) and not isinstance(value, bool)

    def number(self, key: str, low: float = float('-inf'), high: float = float('inf'),
               default: Any = _REQUIRED) -> Any:
        """Return a finite number in [low, high]."""
        if self._absent(key, default):
            return default
        return self._checked_number(key, self._data[key], low, high)

    def numbers(self, key: str, low: float) -> Tuple[float, ...]:
        """Return a list of at least one finite number, each >= low."""
        return tuple(self._checked_number(key, value, low, float('inf'))
                     for value in self._list(key))

    def integer(self, key: str, low: int, default: Any = _REQUIRED) -> Any:
        """Return an integer >= low."""
        value = self.number(key, low=low, default=default)
        if not isinstance(value, int):
            self.fail(key, f'expected an integer, found {shown(value)}')
        return value

    def boolean(self, key: str, default: Any = _REQUIRED) -> Any:
        """Return true or false."""
        if self._absent(key, default):
            return default
        if not isinstance(self._data[key], bool):
            self.fail(key, f'expected true or false, found {shown(self._data[key])}')
        return self._data[key]

    def text(self, key: str, pattern: str = r'.+', default: Any = _REQUIRED) -> Any:
        """Return a text that matches the whole regular expression."""
        if self._absent(key, default):
            return default
        value = self._data[key]
        if not isinstance(value, str) or not re.fullmatch(pattern, value):
            self.fail(key, f'expected a text of the form {pattern}, found {shown(value)}')
        return value

    def texts(self, key: str, default: Any = _REQUIRED) -> Any:
        """Return a list of at least one text."""
        if self._absent(key, default):
            return default
        for value in self._list(key):
            if not isinstance(value, str):
                self.fail(key, f'expected texts, found {shown(value)}')
        return tuple(self._data[key])

    def values(self, key: str, default: Any = _REQUIRED) -> Any:
        """Return one value or a list of values as a tuple: booleans, integers or texts."""
        if self._absent(key, default):
            return default
        found = self._list(key) if isinstance(self._data[key], list) else [self._data[key]]
        for value in found:
            if not isinstance(value, (bool, int, str)):
                self.fail(key, 'expected true, false, an integer or a text, '
                               f'found {shown(value)}')
        return tuple(found)

    def texts_by_key(self, key: str) -> Dict[str, str]:
        """Return a mapping of texts to texts."""
        value = None if self._absent(key, _REQUIRED) else self._data[key]
        if not isinstance(value, dict) or not all(
                isinstance(part, str) for pair in value.items() for part in pair):
            self.fail(key, f'expected texts with texts, found {shown(value)}')
        return dict(value)

    def section(self, key: str) -> Section:
        """Return the mapping under the key."""
        self._absent(key, _REQUIRED)
        return Section(self._data[key], self._path, self._name(key))

    def sections(self, key: str, default: Any = _REQUIRED) -> Union[Tuple[()], List[Section]]:
        """Return a list of at least one mapping."""
        if self._absent(key, default):
            return default
        return [Section(value, self._path, f'{self._name(key)}[{index}]')
                for index, value in enumerate(self._list(key))]

    def _absent(self, key: str, default: Any) -> bool:
        if key in self:
            return False
        if default is _REQUIRED:
            self.fail(key, 'missing')
        return True

    def _checked_number(self, key: str, value: Any, low: float, high: float) -> Any:
        # Comparisons with NaN are false, so that it fails here as well.
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not (
                low <= value <= high and abs(value) != float('inf')):
            allowed = _range(low, high)
            self.fail(key, f'expected a finite number{allowed}, found {shown(value)}')
        return value

    def _list(self, key: str) -> List[Any]:
        value = None if self._absent(key, _REQUIRED) else self._data[key]
        if not isinstance(value, list) or not value:
            self.fail(key, f'expected a list of at least one entry, found {shown(value)}')
        return value

    def _name(self, key: str) -> str:
        return f'{self._where}.{key}' if self._where else key


def _range(low: float, high: float) -> str:
    if low > float('-inf') and high < float('inf'):
        return f' from {low:g} to {high:g}'
    return f' of at least {low:g}' if low > float('-inf') else ''


def shown(value: Any) -> str:
    """Return a value of a file for an error message, not longer than a line."""
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + '...'
