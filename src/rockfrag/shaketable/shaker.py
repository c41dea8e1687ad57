"""The shaking table: what it can do, what a motion asks of it, and what it would really have produced.

Displacements, at the samples, come from integrating the acceleration exactly, linear between samples, from rest.

In: limits of a table (stroke [m], velocity [m/s], force [N], band [Hz]) and motions. Out: the peak up to which
each is reproduced [g], and the motion produced. Theory: ``docs/shaketable.md``.
"""

import os
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
import pandas as pd

from rockfrag.base.errors import InputError, errors_of
from rockfrag.base.input_checks import number_from_zero, positive_number
from rockfrag.base.units import CENTIMETRES_PER_METRE, GRAVITY
from rockfrag.base.yaml_file import read_yaml
from rockfrag.config.schema import checked
from rockfrag.motions.processing import highpass, pad, scale_to_pga
from rockfrag.records.motion import Motion, integrate

# order of the zero-phase Butterworth high-pass that makes room for a motion
FILTER_ORDER = 4
CORNERS_HZ = tuple(
    float(corner) for corner in np.round(np.arange(0.02, 5.001, 0.02), 2)
)
"""Corners tried, from the mildest on [Hz]."""

# what keys of a shaker's file have more than its fields
_UNIT = re.compile(r"_(?:m_s|m|n|kg)$")


@dataclass(frozen=True)
class Shaker:
    """Limits of a uniaxial electrodynamic shaker; by default a Wölfel BD.5, whose moving masses are assumed."""

    stroke: float = 0.290  # distance between the end stops [m]
    force: float = 500.0  # largest force [N]
    # lowest_hz, highest_hz: frequency band [Hz]
    lowest_hz: float = 0.5
    highest_hz: float = 200.0
    # wherever the motion needs to start to use the whole stroke, or in the middle, with half of it to either side
    start: Literal["off-centre", "centred"] = "off-centre"
    # armature_mass, table_mass: masses that always move [kg]
    armature_mass: float = 5.0
    table_mass: float = 5.0
    # largest velocity [m/s]; None where it is not limited
    velocity: float | None = None

    def __post_init__(self) -> None:
        for name in ("stroke", "force", "lowest_hz", "velocity"):
            if getattr(self, name) is not None:
                positive_number(f"shaker: {name}", getattr(self, name))
        if not self.lowest_hz < self.highest_hz:
            raise InputError(
                f"shaker: the band from {self.lowest_hz} to {self.highest_hz} Hz is empty."
            )
        if self.start not in ("off-centre", "centred"):
            raise InputError(
                f"shaker: start must be off-centre or centred, got {self.start!r}."
            )
        for name in ("armature_mass", "table_mass"):
            number_from_zero(f"shaker: {name}", getattr(self, name), "kg")

    def demand(
        self, motion: Motion, amplitude_g: float, payload: float = 0.0
    ) -> "Demand":
        """What a motion scaled to a peak of ``amplitude_g`` [g] asks, with ``payload`` [kg] on it."""
        velocity, displacement = integrate(
            scale_to_pga(motion, amplitude_g).acceleration, motion.dt
        )
        travel = float(np.ptp(displacement))
        excursion = float(np.abs(displacement).max())
        force = amplitude_g * GRAVITY * self.moved_mass(payload)
        speed = np.abs(velocity).max()
        reach = 2 * excursion if self.start == "centred" else travel
        uses = {"stroke": reach / self.stroke, "force": force / self.force}
        if self.velocity is not None:
            uses["velocity"] = float(speed) / self.velocity
        return Demand(travel, excursion, float(speed), force, uses)

    def moved_mass(self, payload: float) -> float:
        """Mass that moves with ``payload`` on the table [kg]; the specimen as if it were bolted on."""
        mass = self.armature_mass + self.table_mass
        mass += number_from_zero("shaker: the payload", payload, "kg")
        if mass <= 0:
            raise InputError(
                "shaker: nothing moves; give armature_mass, table_mass or payload."
            )
        return mass

    def limit(self, motion: Motion, payload: float = 0.0) -> tuple[float, str]:
        """Largest amplitude of a motion as it is [g], and which limit sets it."""
        uses = self.demand(motion, 1.0, payload).uses
        governing = max(uses, key=uses.__getitem__)
        return 1 / uses[governing], governing


class Demand(NamedTuple):
    """What one motion at one amplitude asks of a shaker."""

    travel: float  # peak-to-peak displacement [m]
    excursion: float  # largest displacement from the start [m]
    velocity: float  # [m/s]
    force: float  # [N]
    uses: dict[str, float]  # fraction of each limit that is used [-]

    @property
    def fits(self) -> bool:
        """Whether every limit is kept."""
        return max(self.uses.values()) <= 1


def read_shaker(path: str | os.PathLike[str]) -> Shaker:
    """Read a shaker from a YAML file such as ``config/experiment/shaker.yaml``.

    Parameters
    ----------
    path : of the file

    Returns
    -------
    The :class:`Shaker`.
    """
    values = checked(read_yaml(path), "shaker", str(path))
    with errors_of(str(path)):
        return Shaker(**{_UNIT.sub("", key): value for key, value in values.items()})


def required_corner(
    shaker: Shaker, motion: Motion, amplitude_g: float, payload: float = 0.0
) -> float:
    """Lowest high-pass corner up to 5 Hz with which a motion keeps the limits.

    Parameters
    ----------
    shaker, motion, amplitude_g, payload : the wanted motion, its peak [g], and the mass on the table [kg]

    Returns
    -------
    The frequency [Hz]; 0 if it does without.
    """
    if shaker.demand(motion, amplitude_g, payload).fits:
        return 0.0
    wanted = scale_to_pga(motion, amplitude_g)
    for corner in (corner for corner in CORNERS_HZ if corner < 0.5 / motion.dt):
        filtered = _filtered(wanted, corner)
        if shaker.demand(filtered, filtered.pga / GRAVITY, payload).fits:
            return corner
    raise InputError(
        f"shaker: no high-pass corner up to {CORNERS_HZ[-1]:g} Hz lets motion {motion.name!r} at "
        f"{amplitude_g:g} g keep the limits of {shaker.stroke:g} m and {shaker.force:g} N."
    )


def produced_motion(
    shaker: Shaker, motion: Motion, amplitude_g: float, payload: float = 0.0
) -> Motion:
    """Motion that the table would really have produced.

    It is high-passed at the lower end of the shaker's band, or higher where the stroke needs it. Its peak is not
    the wanted ``amplitude_g`` [g], as the filter takes out what the stroke cannot hold: a fifth less for a long
    pulse, a tenth more where the filter takes what was opposed to the peak. The provenance has both.

    Parameters
    ----------
    shaker, motion, amplitude_g, payload : as of :func:`required_corner`, which says what is refused

    Returns
    -------
    The motion with zeros before and after it, for the filter's transients.
    """
    wanted = scale_to_pga(motion, amplitude_g)
    corner = max(
        shaker.lowest_hz, required_corner(shaker, motion, amplitude_g, payload)
    )
    return _filtered(wanted, corner)


def shaker_table(
    shaker: Shaker, motions: Sequence[Motion], payload: float = 0.0
) -> pd.DataFrame:
    """Demands of each motion, as it is, per g of its peak, and the peak up to which it fits.

    A row a motion: ``motion``, ``earthquake``, ``floor``, ``travel_cm_per_g``, ``excursion_cm_per_g``,
    ``velocity_cm_s_per_g``, ``force_n_per_g``, ``limit_g``, ``limited_by``.

    Parameters
    ----------
    shaker, motions, payload : the table, the motions, and the mass on it [kg]

    Returns
    -------
    pandas.DataFrame.
    """
    rows = []
    for motion in motions:
        demand = shaker.demand(motion, 1.0, payload)
        limit_g, governing = shaker.limit(motion, payload)
        labels = {key: motion.metadata.get(key, "") for key in ("earthquake", "floor")}
        asked = {
            "travel_cm_per_g": demand.travel * CENTIMETRES_PER_METRE,
            "excursion_cm_per_g": demand.excursion * CENTIMETRES_PER_METRE,
            "velocity_cm_s_per_g": demand.velocity * CENTIMETRES_PER_METRE,
            "force_n_per_g": demand.force,
        }
        limit = {"limit_g": limit_g, "limited_by": governing}
        rows.append({"motion": motion.name, **labels, **asked, **limit})
    return pd.DataFrame(rows)


def _filtered(motion: Motion, corner: float) -> Motion:
    """Motion without what is slower than a corner frequency [Hz], by an acausal filter."""
    # room for the transients of an acausal filter: Converse & Brady (1992)
    room = 1.5 * FILTER_ORDER / corner
    return highpass(pad(motion, room, room), corner, FILTER_ORDER)
