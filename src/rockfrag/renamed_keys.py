"""Keys and columns that have a new name, which an old study or table is told."""

from collections.abc import Iterable

from rockfrag.errors import InputError

RENAMED = {
    "claims": "hypotheses",
    "doubts": "quality_flags",
    "event": "earthquake",
    "events": "contact_events",
    "explanation": "sensitivity_analysis",
    "inversion": "inverse_problem",
    "n_events": "n_earthquakes",
    "pattern": "rocking_mode",
    "reading": "definition",
    "remedies": "mitigations",
    "share": "fraction",
    "statement": "hypothesis",
    "survival_windows": "resurrections",
    "verdict": "outcome",
    "verdicts": "outcomes",
    "windows": "resurrections",
}
"""Old name of a key or a column, and its new one."""


def renamed(names: Iterable[object], known: Iterable[object]) -> str:
    """Sentence on the first name of old whose new one is among those known here, empty without one."""
    expected, given = set(known), set(names)
    for old, new in RENAMED.items():
        if old in given - expected and new in expected - given:
            return f"{old} is now called {new}; rename it."
    return ""


def check_names(where: str, names: Iterable[object], known: Iterable[object]) -> None:
    """Refuse a name of old whose new one is among those known here: where, the name, and what it is called now."""
    if said := renamed(names, known):
        raise InputError(f"{where}: {said}")
