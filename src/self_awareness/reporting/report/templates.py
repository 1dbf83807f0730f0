"""The templates of this folder, which jinja2 fills."""
from __future__ import annotations

import os
from typing import Any

_FOLDER = os.path.dirname(__file__)


def template(name: str) -> Any:
    """Return a template; what it is not given is an error, and all texts are escaped."""
    # Takes long to import: only a program that writes a page imports it.
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    environment = Environment(loader=FileSystemLoader(_FOLDER), autoescape=True,
                              undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    # JSON has no numbers that are not finite.
    environment.policies['json.dumps_kwargs'] = {'separators': (',', ':'), 'allow_nan': False}
    return environment.get_template(name)
