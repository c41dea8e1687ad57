"""What was not given and had to be assumed, with what depends on it.

In: a request. Out: assumptions, each with its value and reason, as ids of texts. Docs: ``docs/defaults.md``.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from rockfrag.words.findings import Finding, Value, finding


@dataclass(frozen=True)
class Assumption:
    """Something that was not given."""

    # In a few words that go into a list, such as ``its mass is 368 kg``; None if it goes into none
    short: Finding | None
    why: Finding  # The same in a sentence, with its reason
    # Names of its sources of uncertainty; empty where it has none
    sources: tuple[str, ...] = ()


def assume(what: str, *sources: str, **about: Value) -> Assumption:
    """Return an assumption with the values that its two texts hold; see :class:`Assumption`."""
    short = finding(f"assumed_{what}", **about)
    return Assumption(short, finding(f"why_{what}", **about), sources)


T = TypeVar("T")
U = TypeVar("U")


@dataclass(frozen=True)
class Moved(Generic[T]):
    """Something with one property moved by its standard deviation: an object, a place, outcomes, an answer."""

    name: str  # The property
    spread: float  # Its relative standard deviation [-]
    # What there is with the property smaller and larger by that
    lower: T
    upper: T

    @property
    def sides(self) -> tuple[T, T]:
        """Both sides, the smaller first."""
        return self.lower, self.upper

    def turned(self, change: Callable[[T], U]) -> "Moved[U]":
        """Return what both sides become, by the same property and spread."""
        return Moved(self.name, self.spread, change(self.lower), change(self.upper))


def tolerances_in(
    settings: Mapping[str, Any], usual: Mapping[str, float]
) -> dict[str, float]:
    """Standard deviations by property: the usual ones, in place of which ``statue.yaml`` may state others."""
    given = settings.get("tolerances", {})
    return {key: float(given.get(key, spread)) for key, spread in usual.items()}


def moved_to_both_sides(
    moves: Mapping[str, Callable[[float], T]], spreads: Mapping[str, float]
) -> list[Moved[T]]:
    """Move each property by its standard deviation; one that is known exactly is left out."""
    return [
        Moved(name, spread, move(1 - spread), move(1 + spread))
        for name, move in moves.items()
        if (spread := spreads.get(name, 0.0)) > 0
    ]
