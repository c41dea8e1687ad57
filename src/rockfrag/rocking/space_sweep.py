"""What a comparison of bodies in space with planar ones tries."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Sweep:
    """Levels and directions that are tried.

    Attributes
    ----------
    lowest, highest
        Lowest and highest level over the uplift of the narrow side, b/h [-].
    levels
        Number of levels, a constant factor apart.
    directions
        Directions of planar rocking over half a turn.
    resamples
        Times that earthquakes are drawn again for intervals.
    spread
        Largest displacement of each vertex of a base over its extent [-], and largest turn [rad].
    """

    lowest: float
    highest: float
    levels: int
    directions: int
    resamples: int
    spread: float
