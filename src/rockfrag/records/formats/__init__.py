"""Formats of strong-motion records, one module a format."""

from importlib import import_module
from pkgutil import iter_modules

from rockfrag.records.parsing.format import Format

HEADED: tuple[Format, ...] = tuple(
    import_module(f"{__name__}.{module.name}").FORMAT
    for module in iter_modules(__path__)
    if module.name not in ("obspy_native", "plain")
)
"""Text formats whose header says what they are; plain text is what none of them knows."""
