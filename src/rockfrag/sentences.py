"""Sentences of results: macros of a template that stands beside the module whose results it words."""

import math
from collections.abc import Callable, Mapping
from functools import cache
from typing import Any


def environment(package: str) -> Any:
    """Return what loads the templates of a package; line breaks around blocks are none."""
    # imported when something is said: most commands and jobs say nothing
    from jinja2 import Environment, PackageLoader, StrictUndefined

    found = Environment(
        loader=PackageLoader(package, ""),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    found.tests |= {"finite": math.isfinite, "nan": math.isnan}
    found.filters["one_line"] = one_line
    return found


def said(text: str) -> list[str]:
    """Lines of what a macro says that are not empty, each a part of a sentence or more."""
    return [line.strip() for line in text.split("\n") if line.strip()]


def one_line(text: str) -> str:
    """What a macro says, in one line."""
    return " ".join(said(text))


def sayer(package: str, template: str, words: Mapping[str, Any]) -> Callable[..., list[str]]:
    """Return the function that gives the lines of a macro by its name; macros know the ``words``."""

    @cache
    def module() -> Any:
        found = environment(package)
        found.globals |= words
        return found.get_template(template).module

    return lambda macro, *about: said(getattr(module(), macro)(*about))
