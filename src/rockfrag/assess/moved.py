"""What is not known to the digit, moved to both sides."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Generic, TypeVar

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


def moved_to_both_sides(
    moves: Mapping[str, Callable[[float], T]], spreads: Mapping[str, float]
) -> list[Moved[T]]:
    """Move each property by its standard deviation; one that is known exactly is left out."""
    return [
        Moved(name, spread, move(1 - spread), move(1 + spread))
        for name, move in moves.items()
        if (spread := spreads.get(name, 0.0)) > 0
    ]
