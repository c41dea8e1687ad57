"""Steps that scale a motion: its amplitude to a measure, its time by a similitude factor."""

import numpy as np
from numpy.typing import NDArray

from rockfrag.errors import InputError
from rockfrag.input_checks import number_from_zero, positive_number
from rockfrag.motions.intensity import arias, pga, pgv, spectral_acceleration
from rockfrag.records.motion import Motion
from rockfrag.units import CENTIMETRES_PER_METRE, GRAVITY

Floats = NDArray[np.float64]


def scale(motion: Motion, factor: float) -> Motion:
    """Multiply the acceleration by ``factor``, a positive number.

    Parameters
    ----------
    motion : motion as it is
    factor : factor on the acceleration [-], positive

    Returns
    -------
    The :class:`Motion` so changed, with the step in its provenance.
    """
    factor = positive_number("step scale: factor", factor)
    return motion.after("scale", motion.acceleration * factor, factor=factor)


def factors_to_pga(motion: Motion, pga_g: Floats) -> Floats:
    """Factors [-] that scale a motion to peak accelerations [g], in the shape in which these come."""
    _check_not_zero("factors_to_pga", motion, motion.pga)
    return pga_g * GRAVITY / motion.pga


def scale_to_pga(motion: Motion, pga_g: float) -> Motion:
    """Scale to a peak acceleration [g].

    Parameters
    ----------
    motion : as of :func:`scale`, not zero throughout
    pga_g : wanted peak acceleration [g], positive

    Returns
    -------
    The :class:`Motion` so changed, with the step in its provenance.
    """
    target = positive_number("step scale_to_pga: pga_g", pga_g, "g")
    return _scaled("scale_to_pga", motion, target * GRAVITY, pga(motion), pga_g=target)


def scale_to_pgv(motion: Motion, pgv_cm_s: float) -> Motion:
    """Scale to a peak velocity [cm/s], between samples too.

    Parameters
    ----------
    motion : as of :func:`scale`, not zero throughout
    pgv_cm_s : wanted peak velocity [cm/s], positive

    Returns
    -------
    The :class:`Motion` so changed, with the step in its provenance.
    """
    target = positive_number("step scale_to_pgv: pgv_cm_s", pgv_cm_s, "cm/s")
    wanted = target / CENTIMETRES_PER_METRE
    return _scaled("scale_to_pgv", motion, wanted, pgv(motion), pgv_cm_s=target)


def scale_to_sa(motion: Motion, sa_g: float, period_s: float, damping: float = 0.05) -> Motion:
    """Scale to a pseudo-spectral acceleration [g] at a period [s] and a damping [-]."""
    target = positive_number("step scale_to_sa: sa_g", sa_g, "g")
    period_s = positive_number("step scale_to_sa: period_s", period_s, "seconds")
    damping = number_from_zero("step scale_to_sa: damping", damping)
    actual = spectral_acceleration(motion, period_s, damping)
    settings = {"sa_g": target, "period_s": period_s, "damping": damping}
    return _scaled("scale_to_sa", motion, target * GRAVITY, actual, **settings)


def scale_to_arias(motion: Motion, arias_m_s: float) -> Motion:
    """Scale to an Arias intensity [m/s]."""
    target = positive_number("step scale_to_arias: arias_m_s", arias_m_s, "m/s")
    return _scaled("scale_to_arias", motion, target, arias(motion), 0.5, arias_m_s=target)


def compress_time(motion: Motion, factor: float) -> Motion:
    """Divide all times by a similitude factor, with the acceleration unchanged.

    A model at length scale 1 : λ under the same gravity needs the factor √λ; velocities are divided
    by √λ and displacements by λ (similitude of Froude; Harris & Sabnis 1999, Structural Modeling
    and Experimental Techniques, 2nd ed.).  A factor below one stretches time.
    """
    factor = positive_number("step compress_time: factor", factor)
    return motion.after("compress_time", motion.acceleration, dt=motion.dt / factor, factor=factor)


def _scaled(
    step: str, motion: Motion, target: float, actual: float, power: float = 1.0, **settings: float
) -> Motion:
    """Scale a motion from the actual value of a measure to a target, by a power of their ratio."""
    _check_not_zero(step, motion, actual)
    factor = (target / actual) ** power
    return motion.after(step, motion.acceleration * factor, **settings, factor=factor)


def _check_not_zero(step: str, motion: Motion, actual: float) -> None:
    if actual <= 0:
        raise InputError(
            f"step {step}: motion {motion.name!r} is zero throughout and cannot be scaled; leave it out."
        )
