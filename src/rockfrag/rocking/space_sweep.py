"""What a comparison of bodies in space with planar ones tries."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Sweep:
    """Levels and directions that are tried."""

    # lowest, highest: lowest and highest level over the uplift of the narrow side, b/h [-]
    lowest: float
    highest: float
    levels: int  # number of levels, a constant factor apart
    directions: int  # directions of planar rocking over half a turn
    resamples: int  # times that earthquakes are drawn again for intervals
    # largest displacement of each vertex of a base over its extent [-], and turn [rad]
    spread: float
