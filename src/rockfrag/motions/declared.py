"""Intensity measures, each declared once beside its function: read by tables, schema, curves, figures and exports.

A measure is one declaration, ``@intensity_measure(unit, power=…, label=…)`` above a function of a motion in SI.
"""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache
from importlib import import_module
from typing import Any, TypeVar

from rockfrag.errors import InputError
from rockfrag.records.motion import Motion
from rockfrag.units import CENTIMETRES_PER_METRE, GRAVITY

SPECTRAL_PERIODS = (0.3, 1.0)  # of the 5 % damped spectrum in a table, unless others are asked for
SUFFIXES = {
    "g": "g", "cm/s": "cm_s", "m/s": "m_s", "m/s²": "m_s2", "cm": "cm", "m": "m", "s": "s", "1/s": "1_s",
    "Hz": "hz",
}  # fmt: skip
"""What a unit adds to the name of a column."""

_UNITS = {suffix: unit for unit, suffix in SUFFIXES.items()}
_COLUMN = re.compile(rf"(?P<name>.+?)_(?P<unit>{'|'.join(sorted(_UNITS, key=len, reverse=True))})")
_SPECTRAL = re.compile(r"(?P<name>.+?)_(?P<whole>\d+)(_(?P<part>\d+))?s")
_PEAKS = ("amplitude", "input")  # what else tables call the peak acceleration
Shared = Callable[[Motion, float], Any]
Function = TypeVar("Function", bound=Callable[..., Any])


@dataclass(frozen=True)
class IntensityMeasure:
    """One intensity measure."""

    name: str  # in columns, to which the unit is added
    unit: str  # in columns; empty for a number without one
    power: int  # of the amplitude of a motion with which it grows
    label: str  # what the field calls it; of a spectral measure without its period
    # gives it in SI units of the motion, of what ``shared`` made of it, or of a response spectrum
    value: Callable[[Any], Any]
    # of the motion and the damping [-], whose result several measures read; None: the motion itself
    shared: Shared | None = None
    spectral: bool = False  # whether there is one for each period
    of_block: bool = False  # whether it compares a motion with a block; tables of motions have none
    compared: bool = False  # whether a study compares how well it predicts overturning
    decimals: int | None = None  # in the table of motions of a report; None: not shown there
    title: str = ""  # in that table, if it is not the label
    openquake: str = ""  # name in OpenQuake; empty where it has none
    demand: str = ""  # what SimCenter calls it behind "Peak Ground" and "Peak Floor"; empty if none
    floor_label: str = ""  # where the motion is that of a floor above the ground
    period: float | None = None  # of a spectral measure [s]

    @property
    def column(self) -> str:
        """Name of its column."""
        return f"{self.name}_{SUFFIXES[self.unit]}" if self.unit else self.name

    def at(self, period: float) -> "IntensityMeasure":
        """Return the spectral measure of one period [s]."""
        digits = f"{period:.12g}".replace(".", "_") + ("" if period % 1 else "_0")
        name, label = f"{self.name}_{digits}s", f"{self.label}({period:g}s)"
        return replace(self, name=name, label=label, period=period, shared=_spectrum_at(period))

    @property
    def imt(self) -> str:
        """Name in hazard models, as OpenQuake writes it: ``PGA``, ``SA(0.3)``."""
        return self.openquake if self.period is None else f"{self.openquake}({self.period:g})"

    def of_motion(self, motion: Motion, damping: float = 0.05) -> float:
        """Return its value of a motion, in its unit; ``damping`` [-] is that of what is spectral."""
        return float(self.of(motion if self.shared is None else self.shared(motion, damping)))

    def of(self, subject: Any) -> Any:
        """Return its value of a motion, or of what several measures share of it, in its unit."""
        value = self.value(subject) if self.period is None else float(self.value(subject)[0])
        if self.unit == "g":
            return value / GRAVITY
        return value * CENTIMETRES_PER_METRE if self.unit in ("cm", "cm/s") else value


@cache
def _spectrum_at(period: float) -> Shared:
    def spectrum(motion: Motion, damping: float) -> Any:
        from rockfrag.motions.spectra import response_spectrum

        return response_spectrum(motion, [period], damping)

    return spectrum


_MEASURES: dict[str, IntensityMeasure] = {}


def intensity_measure(
    unit: str, *, power: int, label: str, name: str = "", **more: Any
) -> Callable[[Function], Function]:
    """Declare the function below as an intensity measure, whose name is the function's if it is not given.

    The rest is as of :class:`IntensityMeasure`; the unit that of tables: g, cm/s, m/s, cm, s, or empty.
    """

    def declare(function: Function) -> Function:
        known = name or function.__name__
        if known in _MEASURES:
            raise InputError(
                f"intensity measure {known!r} is declared twice; give the second another name."
            )
        if unit and unit not in SUFFIXES:
            raise InputError(f"unit {unit!r} is not known; choose one of {', '.join(SUFFIXES)}.")
        _MEASURES[known] = IntensityMeasure(known, unit, power, label, function, **more)
        return function

    return declare


def forget_intensity_measure(name: str) -> None:
    """Take back a declaration, as a plugin that is unloaded does."""
    _MEASURES.pop(name, None)


@cache
def _load_built_in() -> None:
    import_module("rockfrag.motions.intensity")


def declared() -> tuple[IntensityMeasure, ...]:
    """Return all measures in the order in which they were declared, a spectral one once for all periods."""
    _load_built_in()
    return tuple(_MEASURES.values())


def intensity_measures(periods: Sequence[float] = SPECTRAL_PERIODS) -> tuple[IntensityMeasure, ...]:
    """Return the measures that a table of motions has, in its order, spectral ones at these periods [s]."""
    found: list[IntensityMeasure] = []
    spectral = [measure for measure in declared() if measure.spectral]
    for measure in declared():
        if measure in spectral[:1]:
            found += [each.at(period) for period in periods for each in spectral]
        elif not (measure.of_block or measure.spectral):
            found.append(measure)
    return tuple(found)


def measure_columns(growing: bool = False) -> tuple[str, ...]:
    """Return the columns of the measures of motions; only of those that grow with the amplitude if asked."""
    found = (measure for measure in intensity_measures() if measure.power > 0 or not growing)
    return tuple(measure.column for measure in found)


def split_column(column: str) -> tuple[str, str]:
    """Split the name of a column into name and unit, which is empty where the name has none that is known."""
    found = _COLUMN.fullmatch(column)
    return (found["name"], _UNITS[found["unit"]]) if found else (column, "")


def measure_of(column: str) -> IntensityMeasure | None:
    """Return the measure of a column such as ``pga_g`` or ``sa_0_3s_g``, in the unit of its name; None if none."""
    _load_built_in()
    name, unit = split_column(column)
    if name in _PEAKS:
        return replace(_MEASURES["pga"], unit=unit)
    spectral = _SPECTRAL.fullmatch(name)
    if spectral and spectral["name"] in _MEASURES:
        period = float(f"{spectral['whole']}.{spectral['part'] or 0}")
        return replace(_MEASURES[spectral["name"]].at(period), unit=unit)
    for measure in _MEASURES.values():
        if measure.floor_label and name == measure.floor_label.lower():
            return replace(measure, label=measure.floor_label, unit=unit)
    if name in _MEASURES:
        return replace(_MEASURES[name], unit=unit)
    return None


def measure_labelled(label: str) -> IntensityMeasure | None:
    """Return the measure of a label: ``PGA``, ``SA(0.3s)`` or, of a floor, ``PFA``; None if there is none."""
    kind, _, rest = label.partition("(")
    for measure in declared():
        if label in (measure.label, measure.floor_label):
            return measure
        if measure.spectral and kind == measure.label and rest.endswith("s)"):
            return measure.at(float(rest.removesuffix("s)")))
    return None
