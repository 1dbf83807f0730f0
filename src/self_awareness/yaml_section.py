"""Typed and checked access to a parsed YAML mapping; errors name the file and the key."""
from __future__ import annotations

import math
import re
from typing import Any, Callable, Dict, List, NoReturn, Sequence, Tuple

_REQUIRED: Any = object()


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
        return _is_number(self._data.get(key))

    def number(self, key: str, low: float = -math.inf, high: float = math.inf,
               default: Any = _REQUIRED) -> Any:
        """Return a finite number in [low, high]."""
        return self._get(key, default, lambda value: _is_number(value, low, high),
                         f'a finite number{_range(low, high)}')

    def numbers(self, key: str, low: float) -> Tuple[float, ...]:
        """Return a list of at least one finite number, each >= low."""
        return tuple(self._checked(key, each, lambda value: _is_number(value, low),
                                   f'a finite number{_range(low, math.inf)}')
                     for each in self._list(key))

    def integer(self, key: str, low: int, default: Any = _REQUIRED,
                high: float = math.inf) -> Any:
        """Return an integer in [low, high]."""
        return self._get(key, default,
                         lambda value: isinstance(value, int) and _is_number(value, low, high),
                         f'an integer{_range(low, high)}')

    def boolean(self, key: str, default: Any = _REQUIRED) -> Any:
        """Return true or false."""
        return self._get(key, default, lambda value: isinstance(value, bool), 'true or false')

    def text(self, key: str, pattern: str = r'.+', default: Any = _REQUIRED) -> Any:
        """Return a text that matches the whole regular expression."""
        return self._get(
            key, default,
            lambda value: isinstance(value, str) and re.fullmatch(pattern, value) is not None,
            f'a text of the form {pattern}')

    def texts(self, key: str, default: Sequence[str] = _REQUIRED, fewest: int = 1
              ) -> Tuple[str, ...]:
        """Return a list of texts, of `fewest` (0 or 1) at least."""
        return tuple(self._checked(key, each, lambda value: isinstance(value, str), 'texts')
                     for each in self._list(key, default, fewest))

    def values(self, key: str, default: Any = _REQUIRED) -> Any:
        """Return one value or a list of values as a tuple: booleans, integers or texts."""
        if default is not _REQUIRED and key not in self:
            return default
        is_list = isinstance(self._data.get(key), list)
        found = self._list(key) if is_list else [self._get(key, _REQUIRED, lambda _: True, '')]
        return tuple(self._checked(key, each, lambda value: isinstance(value, (bool, int, str)),
                                   'true, false, an integer or a text') for each in found)

    def texts_by_key(self, key: str) -> Dict[str, str]:
        """Return a mapping of texts to texts."""
        return dict(self._get(key, _REQUIRED, lambda value: isinstance(value, dict) and all(
            isinstance(part, str) for pair in value.items() for part in pair),
            'texts with texts'))

    def section(self, key: str) -> Section:
        """Return the mapping under the key."""
        return Section(self._get(key, _REQUIRED, lambda _: True, ''), self._path, self._name(key))

    def sections(self, key: str, default: Sequence[Any] = _REQUIRED) -> List[Section]:
        """Return a list of at least one mapping."""
        return [Section(value, self._path, f'{self._name(key)}[{index}]')
                for index, value in enumerate(self._list(key, default))]

    def _get(self, key: str, default: Any, accepts: Callable[[Any], bool], what: str) -> Any:
        """Return a value that is accepted, or the default where the key is absent."""
        if key in self:
            return self._checked(key, self._data[key], accepts, what)
        if default is _REQUIRED:
            self.fail(key, 'missing')
        return default

    def _checked(self, key: str, value: Any, accepts: Callable[[Any], bool], what: str) -> Any:
        if not accepts(value):
            self.fail(key, f'expected {what}, found {shown(value)}')
        return value

    def _list(self, key: str, default: Any = _REQUIRED, fewest: int = 1) -> Any:
        return self._get(key, default,
                         lambda value: isinstance(value, list) and len(value) >= fewest,
                         f'a list{" of at least one entry" if fewest else ""}')

    def _name(self, key: str) -> str:
        return f'{self._where}.{key}' if self._where else key


def _is_number(value: Any, low: float = -math.inf, high: float = math.inf) -> bool:
    """Return whether a value is a finite number in a range; comparisons with NaN are false."""
    return (isinstance(value, (int, float)) and not isinstance(value, bool)
            and low <= value <= high and abs(value) != math.inf)


def _range(low: float, high: float) -> str:
    if low > -math.inf and high < math.inf:
        return f' from {low:g} to {high:g}'
    return f' of at least {low:g}' if low > -math.inf else ''


def shown(value: Any) -> str:
    """Return a value of a file for an error message, not longer than a line."""
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + '...'
