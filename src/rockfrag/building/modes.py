"""Modes of a chain of masses and springs, and what they add to the motions of its floors; compiled.

Rotations alone (Jacobi 1846; Golub and Van Loan, Matrix Computations, 8.5) and plain arithmetic, so that a
building has the same modes to the bit on every processor, and in a page. They keep small eigenvalues as exact as
large ones.

In: masses [kg], stiffnesses [N/m], a motion of the ground [m/s²]. Out: modes, and motions of floors.
Theory: ``docs/building.md``, "Elastic model"; Chopra, ch. 10 and 13.

The functions without an underscore are entries of the page's module. It takes numbers and arrays by their place
and gives nothing back, so they fill what they are given. In Python call ``find_modes`` and ``respond_elastically``
of :mod:`rockfrag.building.response`, or :func:`rockfrag.building.stiffnesses_for_period`.
"""

import math

from numba.extending import register_jitable

from rockfrag.base.arrays import Floats
from rockfrag.runtime.machine_code import cached_njit

SWEEPS = 100  # Most sweeps over all pairs; some ten are needed
SMALL = 1e-17  # Of the root of both diagonal numbers: what is beside them is none


@register_jitable
def _rotate(a: Floats, v: Floats, p: int, q: int) -> None:
    """Turn rows and columns p and q of a symmetric matrix ``a`` so that a[p, q] vanishes.

    The columns of ``v`` turn likewise, by the smaller of both angles (Golub and Van Loan, 8.5.2).
    """
    theta = (a[q, q] - a[p, p]) / (2.0 * a[p, q])
    t = 1.0 / (abs(theta) + math.sqrt(1.0 + theta * theta))
    if theta < 0.0:
        t = -t
    c = 1.0 / math.sqrt(1.0 + t * t)
    s = t * c
    for k in range(a.shape[0]):
        x, y = a[k, p], a[k, q]
        a[k, p], a[k, q] = c * x - s * y, s * x + c * y
    for k in range(a.shape[0]):
        x, y = a[p, k], a[q, k]
        a[p, k], a[q, k] = c * x - s * y, s * x + c * y
    for k in range(a.shape[0]):
        x, y = v[k, p], v[k, q]
        v[k, p], v[k, q] = c * x - s * y, s * x + c * y


@register_jitable
def _solve_chain(masses: Floats, stiffnesses: Floats, a: Floats, v: Floats) -> None:
    """Solve the undamped eigenproblem of a chain by Jacobi's rotations.

    Parameters
    ----------
    masses, stiffnesses : of each floor [kg] and storey [N/m] from below, shape (n,)
    a : squared circular frequencies on its diagonal, in no order [1/s²], shape (n, n)
    v : in its columns their shapes times the root of the masses, shape (n, n)
    """
    n = masses.size
    # M^-1/2 K M^-1/2, with K of three diagonals
    for i in range(n):
        for j in range(n):
            v[i, j] = 1.0 if i == j else 0.0
            k = 0.0
            if i == j:
                k = stiffnesses[i] + (stiffnesses[i + 1] if i + 1 < n else 0.0)
            elif abs(i - j) == 1:
                k = -stiffnesses[max(i, j)]
            a[i, j] = k / math.sqrt(masses[i]) / math.sqrt(masses[j])
    for _ in range(SWEEPS):
        turned = False
        for p in range(n):
            for q in range(p + 1, n):
                if abs(a[p, q]) > SMALL * math.sqrt(abs(a[p, p] * a[q, q])):
                    _rotate(a, v, p, q)
                    turned = True
        if not turned:
            return


@cached_njit()
def fill_modes(
    masses: Floats, stiffnesses: Floats, a: Floats, v: Floats, frequencies: Floats,
    shape: Floats, fractions: Floats, found: Floats,
) -> None:  # fmt: skip
    """Solve the undamped eigenproblem of a chain, modes from the longest period to the shortest.

    Parameters
    ----------
    masses, stiffnesses : of each floor [kg] and storey [N/m] from below, shape (n,)
    a, v : memory, shape (n, n)
    frequencies : circular frequencies, as they are and of the periods they give [rad/s], shape (2, n)
    shape : of each mode, one at the top [-], shape (floors, modes)
    fractions : what each floor takes of each mode, Γ times its shape [-], shape (floors, modes)
    found : Γ of each mode, and its effective mass over the total mass [-], shape (2, n)
    """
    n, total = masses.size, 0.0
    _solve_chain(masses, stiffnesses, a, v)
    for mode in range(n):
        # the least of those that are left
        least = -1
        for i in range(n):
            if a[i, i] < math.inf and (least < 0 or a[i, i] < a[least, least]):
                least = i
        frequencies[0, mode] = math.sqrt(a[least, least])
        frequencies[1, mode] = 2 * math.pi / (2 * math.pi / frequencies[0, mode])
        a[least, least] = math.inf
        top = v[n - 1, least] / math.sqrt(masses[n - 1])
        modal, excited = 0.0, 0.0
        for i in range(n):
            x = v[i, least] / math.sqrt(masses[i]) / top
            shape[i, mode] = x
            modal += masses[i] * (x * x)
            excited += masses[i] * x
        found[0, mode], found[1, mode] = excited / modal, excited * excited / modal
        for i in range(n):
            fractions[i, mode] = found[0, mode] * shape[i, mode]
        total += masses[mode]
    for mode in range(n):
        found[1, mode] /= total


@cached_njit()
def fill_stiffnesses(
    masses: Floats, heights: Floats, period: float, a: Floats, v: Floats, found: Floats
) -> None:
    """Storey stiffnesses proportional to 1/height that give a first period.

    Parameters
    ----------
    masses, heights : of each floor [kg] and storey [m], shape (n,)
    period : of the first mode [s]
    a, v : memory, shape (n, n)
    found : the stiffnesses [N/m], shape (n,)
    """
    for i in range(found.size):
        found[i] = 1.0 / heights[i]
    _solve_chain(masses, found, a, v)
    least = a[0, 0]
    for i in range(found.size):
        least = min(least, a[i, i])
    wanted = 2 * math.pi / period
    for i in range(found.size):
        found[i] *= wanted * wanted / least


@cached_njit()
def fill_slower(stiffnesses: Floats, factor: float, found: Floats) -> None:
    """Stiffnesses with which every period is longer by a factor.

    Parameters
    ----------
    stiffnesses, found : of each storey, as they are and softer [N/m], shape (n,)
    factor : on the periods [-]
    """
    for i in range(found.size):
        found[i] = stiffnesses[i] / (factor * factor)


@cached_njit()
def add_mode(
    samples: Floats, dt: float, omega: float, damping: float, matrix: Floats,
    fractions: Floats, displacement: Floats, acceleration: Floats,
) -> None:  # fmt: skip
    """Add what a mode does to floors under a ground acceleration that is linear between samples.

    Parameters
    ----------
    samples : accelerations of the ground [m/s²], shape (n,)
    dt : between them [s]
    omega, damping : circular frequency [rad/s] and fraction of critical damping of the mode [-]
    matrix : its propagator (:mod:`rockfrag.motions.oscillator`), shape (2, 4)
    fractions : what each floor takes of the mode [-], shape (floors,)
    displacement, acceleration : of the floors, relative [m] and absolute [m/s²], shape (floors, n)
    """
    damper, spring = 2 * damping * omega, omega * omega
    u, v = 0.0, 0.0
    for i in range(samples.size):
        total = -(damper * v + spring * u)
        for floor in range(fractions.size):
            displacement[floor, i] += fractions[floor] * u
            acceleration[floor, i] += fractions[floor] * total
        if i + 1 < samples.size:
            a = samples[i]
            s = (samples[i + 1] - a) / dt
            u, v = (
                matrix[0, 0] * u + matrix[0, 1] * v + matrix[0, 2] * a + matrix[0, 3] * s,
                matrix[1, 0] * u + matrix[1, 1] * v + matrix[1, 2] * a + matrix[1, 3] * s,
            )  # fmt: skip
