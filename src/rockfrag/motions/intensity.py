"""Intensity measures of one component, in SI units, each with its definition and source.

A measure is declared once beside its function, ``@intensity_measure(unit, power=…, label=…)``: tables, schema,
curves, figures and exports read it.

Velocity, displacement and response spectra are those of an acceleration that is linear between samples, exactly,
with the peaks between samples.  The integrals of a² and |a| follow custom instead, the trapezoidal rule on the
samples, so that they can be held against published values; the trapezoidal sum of a² is also the exact energy of
the band-limited signal that was sampled (Parseval).  Spectra and SciPy are loaded where they are computed with:
numba takes most of a second, and steps that scale to a measure are named long before they are taken.

In: a :class:`Motion` [m/s²]. Out: a number in SI units. Theory: ``docs/motions.md``, "Intensity measures".
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache, partial
from operator import attrgetter, itemgetter
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from rockfrag.base.arrays import Floats
from rockfrag.base.errors import InputError
from rockfrag.base.input_checks import number_from_zero, positive_number
from rockfrag.base.units import CENTIMETRES_PER_METRE, GRAVITY
from rockfrag.records.motion import Motion, peak_displacement, peak_velocity

if TYPE_CHECKING:
    from rockfrag.motions.pulse_extraction import StrongestPulse

# of the 5 % damped spectrum in a table, unless others are asked for
SPECTRAL_PERIODS = (0.3, 1.0)
SUFFIXES = {
    "g": "g", "cm/s": "cm_s", "m/s": "m_s", "m/s²": "m_s2", "cm": "cm", "m": "m", "s": "s", "1/s": "1_s",
    "Hz": "hz",
}  # fmt: skip
"""What a unit adds to the name of a column."""

_UNITS = {suffix: unit for unit, suffix in SUFFIXES.items()}
_COLUMN = re.compile(
    rf"(?P<name>.+?)_(?P<unit>{'|'.join(sorted(_UNITS, key=len, reverse=True))})"
)
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
    # whether it compares a motion with a block; tables of motions have none
    of_block: bool = False
    compared: bool = False  # whether a study compares how well it predicts overturning
    # in the table of motions of a report; None: not shown there
    decimals: int | None = None
    title: str = ""  # in that table, if it is not the label
    openquake: str = ""  # name in OpenQuake; empty where it has none
    # what SimCenter calls it behind "Peak Ground" and "Peak Floor"; empty if none
    demand: str = ""
    floor_label: str = ""  # where the motion is that of a floor above the ground
    period: float | None = None  # of a spectral measure [s]

    @property
    def column(self) -> str:
        """Name of its column."""
        return f"{self.name}_{SUFFIXES[self.unit]}" if self.unit else self.name

    def at(self, period: float) -> IntensityMeasure:
        """Return the spectral measure of one period [s]."""
        digits = f"{period:.12g}".replace(".", "_") + ("" if period % 1 else "_0")
        name, label = f"{self.name}_{digits}s", f"{self.label}({period:g}s)"
        return replace(
            self, name=name, label=label, period=period, shared=_spectrum_at(period)
        )

    @property
    def imt(self) -> str:
        """Name in hazard models, as OpenQuake writes it: ``PGA``, ``SA(0.3)``."""
        return (
            self.openquake
            if self.period is None
            else f"{self.openquake}({self.period:g})"
        )

    def of_motion(self, motion: Motion, damping: float = 0.05) -> float:
        """Return its value of a motion, in its unit; ``damping`` [-] is that of what is spectral."""
        return float(
            self.of(motion if self.shared is None else self.shared(motion, damping))
        )

    def of(self, subject: Any) -> Any:
        """Return its value of a motion, or of what several measures share of it, in its unit."""
        value = (
            self.value(subject)
            if self.period is None
            else float(self.value(subject)[0])
        )
        if self.unit == "g":
            return value / GRAVITY
        return value * CENTIMETRES_PER_METRE if self.unit in ("cm", "cm/s") else value


@cache
def _spectrum_at(period: float) -> Shared:
    """Function of a motion and a damping that gives its spectrum at one period."""

    def spectrum(motion: Motion, damping: float) -> Any:
        from rockfrag.motions.response_spectra import response_spectrum

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
        """Register a function as a measure, under its name."""
        known = name or function.__name__
        if known in _MEASURES:
            raise InputError(
                f"intensity measure {known!r} is declared twice; give the second another name."
            )
        if unit and unit not in SUFFIXES:
            raise InputError(
                f"unit {unit!r} is not known; choose one of {', '.join(SUFFIXES)}."
            )
        _MEASURES[known] = IntensityMeasure(known, unit, power, label, function, **more)
        return function

    return declare


def declared() -> tuple[IntensityMeasure, ...]:
    """Measures in the order in which they were declared, a spectral one once for all periods.

    Returns
    -------
    The measures.
    """
    return tuple(_MEASURES.values())


def intensity_measures(
    periods: Sequence[float] = SPECTRAL_PERIODS,
) -> tuple[IntensityMeasure, ...]:
    """Measures that a table of motions has, in its order.

    Parameters
    ----------
    periods : of the spectral ones [s]

    Returns
    -------
    The measures.
    """
    found: list[IntensityMeasure] = []
    spectral = [measure for measure in declared() if measure.spectral]
    for measure in declared():
        if measure in spectral[:1]:
            found += [each.at(period) for period in periods for each in spectral]
        elif not (measure.of_block or measure.spectral):
            found.append(measure)
    return tuple(found)


def measure_columns(growing: bool = False) -> tuple[str, ...]:
    """Columns of the measures of motions.

    Parameters
    ----------
    growing : whether only those that grow with the amplitude

    Returns
    -------
    The columns.
    """
    found = (
        measure for measure in intensity_measures() if measure.power > 0 or not growing
    )
    return tuple(measure.column for measure in found)


def split_column(column: str) -> tuple[str, str]:
    """Name and unit of a column.

    Parameters
    ----------
    column : name of a column

    Returns
    -------
    Name and unit, which is empty where none is known.
    """
    found = _COLUMN.fullmatch(column)
    return (found["name"], _UNITS[found["unit"]]) if found else (column, "")


def measure_of(column: str) -> IntensityMeasure | None:
    """Measure of a column such as ``pga_g`` or ``sa_0_3s_g``, in the unit of its name.

    Parameters
    ----------
    column : name of a column

    Returns
    -------
    The measure; None if there is none.
    """
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
    """Measure of a label, such as ``PGA`` or ``SA(0.3s)``.

    Parameters
    ----------
    label : name as the field writes it

    Returns
    -------
    The measure; None if there is none.
    """
    kind, _, rest = label.partition("(")
    for measure in declared():
        if label == measure.label:
            return measure
        if measure.spectral and kind == measure.label and rest.endswith("s)"):
            return measure.at(float(rest.removesuffix("s)")))
    return None


@intensity_measure(
    "g", power=1, label="PGA", compared=True, decimals=3, openquake="PGA", demand="Acceleration", floor_label="PFA"
)  # fmt: skip
def pga(motion: Motion) -> float:
    """Peak absolute acceleration [m/s²].

    Parameters
    ----------
    motion : motion to be measured

    Returns
    -------
    Peak acceleration [m/s²].
    """
    return motion.pga


@intensity_measure(
    "cm/s", power=1, label="PGV", compared=True, decimals=1, openquake="PGV", demand="Velocity", floor_label="PFV"
)  # fmt: skip
def pgv(motion: Motion) -> float:
    """Peak absolute velocity from rest [m/s], between samples too.

    Parameters
    ----------
    motion : motion to be measured

    Returns
    -------
    Peak velocity [m/s].
    """
    return peak_velocity(motion.acceleration, motion.dt)


@intensity_measure("cm", power=1, label="PGD", compared=True, decimals=2)
def pgd(motion: Motion) -> float:
    """Peak absolute displacement from rest [m], between samples too.

    Parameters
    ----------
    motion : acceleration of n samples [m/s²]

    Returns
    -------
    The displacement [m].
    """
    return peak_displacement(motion.acceleration, motion.dt)


@intensity_measure("s", power=0, label="PGV/PGA", decimals=3)
def pgv_over_pga(motion: Motion) -> float:
    """PGV/PGA [s]; NaN for a motion of zeros."""
    return pgv(motion) / pga(motion) if pga(motion) > 0 else math.nan


def cumulative_arias(motion: Motion) -> Floats:
    """Arias intensity up to each sample, π/(2g) ∫₀ᵗ a² dt [m/s], shape (n,)."""
    from scipy.integrate import cumulative_trapezoid

    energy = cumulative_trapezoid(motion.acceleration**2, dx=motion.dt, initial=0.0)
    return np.asarray(energy * (math.pi / (2 * GRAVITY)))


@intensity_measure("m/s", power=2, label="Arias intensity", compared=True, decimals=2)
def arias(motion: Motion) -> float:
    """Arias intensity π/(2g) ∫ a² dt [m/s], by the trapezoidal rule on the samples.

    Arias (1970), A measure of earthquake intensity, in: Seismic Design for Nuclear Power Plants,
    MIT Press, 438-483.
    """
    return float(cumulative_arias(motion)[-1])


@intensity_measure("m/s", power=1, label="CAV")
def cav(motion: Motion) -> float:
    """Cumulative absolute velocity ∫ |a| dt [m/s] by the trapezoidal rule (EPRI 1988, NP-5930)."""
    return float(np.trapezoid(np.abs(motion.acceleration), dx=motion.dt))


def arias_times(motion: Motion, lower: float, upper: float) -> tuple[float, float]:
    """Find the times at which two fractions of the Arias intensity are reached [s].

    The cumulative intensity is read linearly between samples.  Both are NaN for a motion of zeros.
    """
    history = cumulative_arias(motion)
    if history[-1] <= 0:
        return math.nan, math.nan
    times = [
        float(np.interp(f * history[-1], history, motion.time)) for f in (lower, upper)
    ]
    return times[0], times[1]


def significant_duration(
    motion: Motion, lower: float = 0.05, upper: float = 0.95
) -> float:
    """Time between two fractions of the Arias intensity [s]; NaN for a motion of zeros.

    D5-95 by Trifunac & Brady (1975, Bull. Seism. Soc. Am. 65(3), 581-626), D5-75 by Somerville et
    al. (1997, Seism. Res. Lett. 68(1), 199-222).
    """
    start, end = arias_times(motion, lower, upper)
    return end - start


intensity_measure("s", power=0, label="D5-75", name="d5_75")(
    partial(significant_duration, upper=0.75)
)
intensity_measure(
    "s",
    power=0,
    label="D5-95",
    name="d5_95",
    decimals=1,
    title="Significant duration, 5–95 %",
)(significant_duration)


@intensity_measure("s", power=0, label="mean period", decimals=2, title="Mean period")
def mean_period(motion: Motion) -> float:
    """Mean period Tm = Σ C²/f / Σ C² over 0.25 ≤ f ≤ 20 Hz [s]; NaN where there is no such content.

    C are Fourier amplitudes (Rathje, Abrahamson & Bray 1998, J. Geotech. Geoenviron. Eng. 124(2),
    150-159).  Zeros are added so that frequencies are at most 0.05 Hz apart, as Rathje et al.
    (2004, Earthquake Spectra 20(1), 119-144) require.
    """
    from rockfrag.motions.response_spectra import fourier_amplitude

    frequency, amplitude = fourier_amplitude(motion, math.ceil(1 / (0.05 * motion.dt)))
    band = (frequency >= 0.25) & (frequency <= 20.0)
    power = amplitude[band] ** 2
    total = float(power.sum())
    return float((power / frequency[band]).sum() / total) if total > 0 else math.nan


PREDOMINANT_PERIODS = np.geomspace(0.02, 10.0, 541)  # searched [s]: 200 in a decade


@intensity_measure("s", power=0, label="predominant period")
def predominant_period(motion: Motion) -> float:
    """Period Tp of the largest 5 % damped PSA [s]; NaN for a motion of zeros.

    Rathje, Abrahamson & Bray (1998); searched from 0.02 to 10 s, periods 1.2 % apart.

    Parameters
    ----------
    motion : acceleration of n samples [m/s²]

    Returns
    -------
    The period [s].
    """
    from rockfrag.motions.response_spectra import peak_displacements

    if motion.pga == 0:
        return math.nan
    psa = (
        peak_displacements(motion, PREDOMINANT_PERIODS)
        * (2 * math.pi / PREDOMINANT_PERIODS) ** 2
    )
    return float(PREDOMINANT_PERIODS[psa.argmax()])


def spectral_acceleration(
    motion: Motion, period: float, damping: float = 0.05
) -> float:
    """Pseudo-spectral acceleration Sa(T) = ω² Sd [m/s²], the one that hazard maps are made for."""
    from rockfrag.motions.response_spectra import response_spectrum

    return float(response_spectrum(motion, [period], damping).pseudo_acceleration[0])


HOUSNER_PERIODS = np.linspace(0.1, 2.5, 241)  # periods of the Housner intensity [s]
AVERAGE_PERIODS = np.linspace(0.2, 2.0, 10)  # of the average spectral acceleration [s]


def housner_and_average(motion: Motion, damping: float = 0.05) -> tuple[float, float]:
    """Housner intensity [m] and AvgSA [m/s²], by one integration of all oscillators.

    The Housner (spectrum) intensity is ∫ PSV(T, ζ) dT from 0.1 to 2.5 s (Housner, 1952, Symposium on Earthquake
    and Blast Effects on Structures, UCLA), by the trapezoidal rule on steps of 0.01 s.  Housner gave curves for
    undamped and 20 % damped oscillators; 5 % is today's custom.

    AvgSA is the geometric mean of the pseudo-spectral acceleration at `AVERAGE_PERIODS` (Eads, Miranda and
    Lignos, 2015, Earthquake Eng. Struct. Dyn. 44: 2057-2073); a rocking body has no period of its own, so the
    periods are those from which its overturning threshold feels the motion.
    """
    from rockfrag.motions.response_spectra import peak_displacements

    periods = np.concatenate([HOUSNER_PERIODS, AVERAGE_PERIODS])
    peaks = np.split(
        peak_displacements(motion, periods, damping), [HOUSNER_PERIODS.size]
    )
    housner = np.trapezoid(peaks[0] * (2 * math.pi / HOUSNER_PERIODS), HOUSNER_PERIODS)
    spectrum = peaks[1] * (2 * math.pi / AVERAGE_PERIODS) ** 2
    return float(housner), float(np.prod(spectrum ** (1 / spectrum.size)))


def _pulse(motion: Motion, damping: float) -> StrongestPulse:
    """The strongest pulse of a motion, which no damping changes."""
    from rockfrag.motions.pulse_extraction import strongest_pulse

    return strongest_pulse(motion)


# measures that are part of something that several of them read
intensity_measure(
    "g", power=1, label="SA", name="sa", spectral=True, compared=True, openquake="SA"
)(attrgetter("pseudo_acceleration"))
intensity_measure("cm/s", power=1, label="SV", name="sv", spectral=True)(
    attrgetter("velocity")
)
intensity_measure("cm", power=1, label="SD", name="sd", spectral=True)(
    attrgetter("displacement")
)
intensity_measure(
    "g", power=1, label="AvgSA", name="avgsa", shared=housner_and_average, compared=True, openquake="AvgSA"
)(itemgetter(1))  # fmt: skip
intensity_measure(
    "cm", power=1, label="Housner intensity", name="housner", shared=housner_and_average, compared=True
)(itemgetter(0))  # fmt: skip
intensity_measure(
    "s", power=0, label="pulse period", name="pulse_period", shared=_pulse
)(attrgetter("period"))
intensity_measure(
    "cm/s", power=1, label="pulse velocity", name="pulse_velocity", shared=_pulse
)(attrgetter("velocity"))
intensity_measure(
    "", power=0, label="pulse explained", name="pulse_explained", shared=_pulse
)(attrgetter("explained"))


@intensity_measure("", power=1, label="a/(g tan α)", of_block=True)
def uplift_ratio(motion: Motion, alpha: float) -> float:
    """Peak acceleration over that which starts rocking, a/(g tan α) [-] (Kirkpatrick, 1927)."""
    alpha = positive_number("uplift_ratio: alpha", alpha, "radians")
    return pga(motion) / (GRAVITY * math.tan(alpha))


@intensity_measure("", power=1, label="p PGV/(g tan α)", of_block=True)
def velocity_ratio(motion: Motion, alpha: float, p: float) -> float:
    """Dimensionless velocity p PGV/(g tan α) [-].

    It decides over large or quickly shaken blocks (Ishiyama 1982, Earthquake Eng. Struct. Dyn. 10,
    635-650; Dimitrakopoulos & Paraskeva 2015, Earthquake Eng. Struct. Dyn. 44, 2013-2033).
    """
    alpha = positive_number("velocity_ratio: alpha", alpha, "radians")
    p = number_from_zero("velocity_ratio: p", p, "1/s")
    return p * pgv(motion) / (GRAVITY * math.tan(alpha))


@intensity_measure("", power=0, label="frequency ratio", of_block=True)
def frequency_ratio(pulse_period: float, p: float) -> float:
    """Pulse frequency over frequency parameter, ωp/p = 2π/(Tp p) [-].

    Zhang & Makris (2001, J. Eng. Mech. 127(5), 473-483).
    """
    p = positive_number("frequency_ratio: p", p, "1/s")
    return 2 * math.pi / (pulse_period * p)
