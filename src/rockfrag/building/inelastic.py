"""Hysteretic response of a masonry building, with an energy balance that closes.

Average acceleration (Newmark 1959, γ = 1/2, β = 1/4) in small steps, iterated to equilibrium. With Δu = h (v₀ +
v₁)/2 and m Δv = h (f₀ + f₁)/2 the mean of the equations of motion at both ends of a step, times Δu, is an exact
balance of energies: the work of every force is its mean over the step times Δu. So the balance closes to the
precision of the iteration, whatever the storeys do, and a gap in it shows an equilibrium that was missed.

A storey degrades and pinches by Filippou's law as OpenSees' ``Hysteretic`` and ``HystereticSM`` have it, for an
envelope that is the same on both sides:

1. Beyond the largest displacement reached so far on its side it follows the envelope.
2. It unloads with the elastic stiffness over (largest displacement / cracking displacement)^β.
3. Reloading starts where the force is zero, and goes in two straight lines through the pinching point to the
   envelope at the aim: the largest displacement reached on that side, enlarged by damage at each reversal from
   beyond cracking on the other side. It is nowhere steeper than unloading.

In: a building, and a motion of the ground [m/s²]. Out: histories of floors and storeys, with energies [J].
Theory: ``docs/building.md``, "Masonry model".
"""

from typing import Any

import numpy as np

from rockfrag.base.arrays import Floats
from rockfrag.base.errors import InputError
from rockfrag.base.units import GRAVITY
from rockfrag.building.model import MasonryLaw, ShearBuilding
from rockfrag.building.response import (
    BuildingResponse,
    EnergyBalance,
    damping_matrix,
    find_modes,
)
from rockfrag.records.motion import Motion
from rockfrag.runtime.machine_code import cached_njit

# the memory of a storey: present displacement and force, aim on either side (as magnitudes), where
# the force was zero after unloading from the other side, direction of motion, and work done on it
DISPLACEMENT, FORCE, AIM_POS, AIM_NEG, ZERO_POS, ZERO_NEG, DIRECTION, WORK = range(8)
MEMORY = 8
# rows of the floors' state: displacement, velocity and acceleration relative to the ground, force of the storeys
PLACE, SPEED, ACCELERATION, SHEAR = range(4)


def shear_strengths(building: ShearBuilding) -> Floats:
    """Shear strength of each storey [N], shape (storeys,): the same walls have the same everywhere."""
    section = np.asarray(building.stiffnesses) * np.asarray(building.heights)
    base = building.masonry.base_shear * building.mass * GRAVITY
    return np.asarray(base * section / section[0])


def storey_envelopes(building: ShearBuilding) -> tuple[Floats, Floats]:
    """Corners of the envelope of each storey: cracking, yield, shear limit, rocking limit.

    Parameters
    ----------
    building : with its masonry law

    Returns
    -------
    Displacements [m] and forces [N], shape (storeys, 4) each.

    Raises
    ------
    InputError : where a storey is too soft to reach its strength before it yields
    """
    law = building.masonry
    heights = np.asarray(building.heights)
    stiffnesses = np.asarray(building.stiffnesses)
    strength = shear_strengths(building)
    cracking = law.cracking * strength
    limits = (
        limit * heights
        for limit in (law.yield_drift, law.shear_drift, law.rocking_drift)
    )
    displacement = np.column_stack([cracking / stiffnesses, *limits])
    force = np.column_stack([cracking, strength, strength, law.residual * strength])
    soft = np.flatnonzero(strength / stiffnesses > displacement[:, 1])
    if soft.size:
        storey = int(soft[0])
        drift = strength[storey] / stiffnesses[storey] / heights[storey]
        raise InputError(
            f"{building.name}: storey {storey + 1} reaches its shear strength at a drift of "
            f"{100 * drift:.3f} % elastically, beyond the yield drift {100 * law.yield_drift:.3f} %; give the "
            "period of the uncracked building or a lower base_shear."
        )
    return displacement, force


PINCH_FORCE, PINCH_DRIFT, BY_DUCTILITY, BY_ENERGY, UNLOADING = range(5)
"""Places of the parameters of a law: force and displacement of the pinching point, damage by ductility and by
work, and exponent of unloading [-]."""


def law_parameters(law: MasonryLaw) -> Floats:
    """Parameters of the law as the kernels take them, shape (5,)."""
    return np.array(
        [
            law.pinch_force,
            law.pinch_drift,
            law.damage_ductility,
            law.damage_energy,
            law.unloading,
        ]
    )


@cached_njit()
def envelope(x: float, corner: Any, strength: Any) -> float:
    """Force of the envelope [N] at a displacement x ≥ 0 [m]; ``corner`` [m] and ``strength`` [N], shape (4,)."""
    if x <= corner[0]:
        return float(strength[0] / corner[0] * x)
    for i in range(1, corner.size):
        if x <= corner[i]:
            slope = (strength[i] - strength[i - 1]) / (corner[i] - corner[i - 1])
            return float(strength[i - 1] + slope * (x - corner[i - 1]))
    return float(strength[-1])


@cached_njit()
def unloading_stiffness(
    aim: float, corner: Any, strength: Any, exponent: float
) -> float:
    """Stiffness of unloading [N/m] from the side whose largest displacement is ``aim`` [m].

    ``corner``, ``strength``: of the envelope; ``exponent``: β of rule 2 of the module.
    """
    ductility = max(aim / corner[0], 1.0)
    return float(strength[0] / corner[0] / ductility**exponent)


@cached_njit()
def _area(corner: Any, strength: Any) -> float:
    """Area under both sides of the envelope [J]."""
    total = corner[0] * strength[0]
    for i in range(1, corner.size):
        total += (corner[i] - corner[i - 1]) * (strength[i] + strength[i - 1])
    return float(total)


@cached_njit()
def move(
    memory: Any, to: float, corner: Any, strength: Any, law: Any, moved: Any
) -> None:
    """Move a storey to a displacement by rules 1 to 3 of the module; all is seen from the side that it moves to.

    Parameters
    ----------
    memory : state of the storey, shape (``MEMORY``,)
    to : displacement [m]
    corner, strength : of its envelope [m], [N], shape (4,)
    law : its parameters (:func:`law_parameters`)
    moved : filled with the state there, shape (``MEMORY``,)
    """
    moved[:] = memory
    step = to - memory[DISPLACEMENT]
    if step == 0.0:
        return
    side = 1.0 if step > 0 else -1.0
    front, back = (AIM_POS, AIM_NEG) if step > 0 else (AIM_NEG, AIM_POS)
    zero = ZERO_POS if step > 0 else ZERO_NEG
    # displacement and force now, and the displacement to come
    x0, f0, x = side * memory[DISPLACEMENT], side * memory[FORCE], side * to
    back_stiffness = unloading_stiffness(memory[back], corner, strength, law[UNLOADING])
    front_stiffness = unloading_stiffness(
        memory[front], corner, strength, law[UNLOADING]
    )

    if memory[DIRECTION] != side and f0 <= 0.0:
        # a reversal: note where the force will be zero, and enlarge the aim by damage
        moved[zero] = x0 - f0 / back_stiffness
        if memory[back] > corner[0]:
            work = memory[WORK] - 0.5 * f0 * f0 / back_stiffness
            damage = law[BY_ENERGY] * work / _area(corner, strength)
            damage += law[BY_DUCTILITY] * (memory[back] - corner[0]) / corner[0]
            moved[front] = memory[front] * (1.0 + damage)

    moved[front] = max(moved[front], corner[0])
    aim = moved[front]
    if x >= aim:
        force = envelope(x, corner, strength)
        moved[front] = x
    elif x < moved[zero]:
        force = min(f0 + back_stiffness * (x - x0), 0.0)
    else:
        force = _reload(
            x, moved[zero], aim, envelope(aim, corner, strength), front_stiffness, law
        )
        force = min(force, f0 + front_stiffness * (x - x0))
    moved[DISPLACEMENT] = to
    moved[FORCE] = side * force
    moved[DIRECTION] = side
    moved[WORK] = memory[WORK] + 0.5 * (f0 + force) * (x - x0)


@cached_njit()
def _reload(
    x: float, zero: float, aim: float, force: float, stiffness: float, law: Any
) -> float:
    """Force [N] at x on the two lines from (zero, 0) through the pinching point to (aim, force).

    ``x``, ``zero``, ``aim``: displacements [m]; ``force``: at the aim [N]; ``stiffness``: of unloading from there
    [N/m]; ``law``: its parameters.
    """
    low, drift = law[PINCH_FORCE], law[PINCH_DRIFT]
    # between where the force is zero and where unloading from the aim would have the pinching force
    pinch = zero + (aim - (1.0 - low) * force / stiffness - zero) * drift
    if x < pinch:
        return float(low * force * (x - zero) / (pinch - zero))
    if aim <= pinch:
        return float(force)
    return float(force * (low + (1.0 - low) * (x - pinch) / (aim - pinch)))


# [s]; halving it changes floor peaks of the reference building by less than 0.1 %
LONGEST_STEP = 2e-4


def respond_hysteretically(
    building: ShearBuilding, motion: Motion, longest_step: float = LONGEST_STEP
) -> BuildingResponse:
    """Integrate the building with its masonry law; damping is that of the elastic modes.

    Parameters
    ----------
    building : the storeys, from below
    motion : of the ground [m/s²]
    longest_step : of the integration [s]

    Returns
    -------
    Histories of floors and storeys at the samples, with energies.
    """
    corner, strength = storey_envelopes(building)
    parts = max(1, int(np.ceil(motion.dt / longest_step - 1e-9)))
    step = motion.dt / parts
    mass = np.asarray(building.masses)
    viscous = damping_matrix(building, find_modes(building))
    effective = (
        building.stiffness_matrix() + 2 / step * viscous + np.diag(4 / step**2 * mass)
    )
    matrices = mass, viscous, np.linalg.inv(effective)
    law = corner, strength, law_parameters(building.masonry)
    total, shift, energy = _integrate(motion.acceleration, step, parts, matrices, law)
    return BuildingResponse(
        time=motion.time,
        acceleration=np.vstack([motion.acceleration, total]),
        drift=shift / np.asarray(building.heights)[:, None],
        energy=EnergyBalance(*energy),
    )


@cached_njit()
def _shears(u: Any, memory: Any, moved: Any, masonry: Any, force: Any) -> None:
    """Fill storey states at floor displacements u [m], and the forces that they put on the floors [N].

    ``memory``, ``moved``: states of storeys before and at u, shape (storeys, ``MEMORY``); ``masonry``: envelopes
    and law as of :func:`_integrate`; ``force``: shape (storeys,).
    """
    n = u.size
    corner, strength, law = masonry
    below = 0.0
    for i in range(n):
        move(memory[i], u[i] - below, corner[i], strength[i], law, moved[i])
        below = u[i]
    for i in range(n):
        above = moved[i + 1, FORCE] if i + 1 < n else 0.0
        force[i] = moved[i, FORCE] - above


@cached_njit()
def _integrate(
    ground: Any, step: float, parts: int, matrices: Any, masonry: Any
) -> Any:
    """Integrate the equations of motion of a building with masonry (``docs/building.md``); compiled.

    Parameters
    ----------
    ground : acceleration at each sample [m/s²], shape (samples,)
    step, parts : length of a step [s], and steps a sample
    matrices : masses [kg], viscous damping [N s/m], inverse of the effective stiffness [m/N]
    masonry : corners of the envelopes [m], their forces [N], parameters of the law

    Returns
    -------
    Total accelerations of floors [m/s²] and drifts of storeys [m], shape (storeys, samples); energies [J], shape
    (5, samples): what the ground put in, kinetic, elastic, lost in damping, lost in storeys.
    """
    n, samples = matrices[0].size, ground.size
    total, shift = np.zeros((n, samples)), np.zeros((n, samples))
    energy = np.zeros((5, samples))
    # floors and memories of storeys as a step begins and as it ends
    now, then = np.zeros((4, n)), np.zeros((4, n))
    memory, moved = np.zeros((n, MEMORY)), np.zeros((n, MEMORY))
    now[ACCELERATION] = -ground[0]
    total[:, 0] = now[ACCELERATION] + ground[0]
    work, building = np.zeros(3), (matrices, masonry)
    for k in range(samples - 1):
        rise = ground[k + 1] - ground[k]
        for part in range(parts):
            begin = ground[k] + rise * (part / parts)
            end = ground[k] + rise * ((part + 1) / parts)
            _find_equilibrium(end, step, building, (now, then), (memory, moved))
            _add_work(0.5 * (begin + end), matrices, now, then, work)
            now[:] = then
            memory[:] = moved
        kinetic, strain = _stored(matrices[0], masonry, now, memory)
        by_ground, damped, by_storeys = work
        energy[:, k + 1] = by_ground, kinetic, strain, damped, by_storeys - strain
        for i in range(n):
            shift[i, k + 1] = memory[i, DISPLACEMENT]
            total[i, k + 1] = now[ACCELERATION, i] + ground[k + 1]
    return total, shift, energy


@cached_njit()
def _find_equilibrium(
    ground: float, step: float, building: Any, floors: Any, storeys: Any
) -> None:
    """Find where a step ends, by average acceleration and Newton's iteration with the elastic stiffness.

    ``ground`` is its acceleration at the end, and ``building`` the matrices and the masonry of :func:`_integrate`;
    of ``floors`` and ``storeys`` the first is the beginning, and the second is filled.
    """
    (mass, viscous, inverse), masonry = building
    (now, then), (memory, moved) = floors, storeys
    n = mass.size
    u, v, a = now[:3]
    u1, v1, a1, force1 = then
    rest = np.zeros(n)
    change = step * v + 0.5 * step * step * a
    for _ in range(100):
        # at the end of the step by a ``change`` of the displacements
        for i in range(n):
            u1[i] = u[i] + change[i]
            v1[i] = 2 / step * change[i] - v[i]
            a1[i] = 4 / step * (change[i] / step - v[i]) - a[i]
        _shears(u1, memory, moved, masonry, force1)
        for i in range(n):
            rest[i] = -mass[i] * (ground + a1[i]) - force1[i]
            for j in range(n):
                rest[i] -= viscous[i, j] * v1[j]
        # what the equations of motion lack, over the effective stiffness, corrects the change
        largest = correction = 0.0
        for i in range(n):
            better = 0.0
            for j in range(n):
                better += inverse[i, j] * rest[j]
            change[i] += better
            correction = max(correction, abs(better))
            largest = max(largest, abs(change[i]), 1e-6 * abs(u[i]))
        if correction <= 1e-13 * largest:
            break


@cached_njit()
def _add_work(ground: float, matrices: Any, now: Any, then: Any, work: Any) -> None:
    """Add the work of a step [J] of the ground, of damping and of storeys: mean forces times displacements.

    ``ground``: its mean acceleration in the step [m/s²]; ``matrices`` as of :func:`_integrate`; ``now``, ``then``:
    states of floors at both ends, shape (4, floors); ``work``: shape (3,).
    """
    mass, viscous, _ = matrices
    n = mass.size
    for i in range(n):
        moved = then[PLACE, i] - now[PLACE, i]
        work[0] -= mass[i] * ground * moved
        for j in range(n):
            mean = 0.5 * (now[SPEED, j] + then[SPEED, j])
            work[1] += viscous[i, j] * mean * moved
        work[2] += 0.5 * (now[SHEAR, i] + then[SHEAR, i]) * moved


@cached_njit()
def _stored(mass: Any, masonry: Any, floors: Any, memory: Any) -> Any:
    """Kinetic energy of the floors, and energy that the storeys would give back on unloading [J].

    ``mass``: of floors [kg]; ``floors``: their state, shape (4, floors); ``memory``: of storeys.
    """
    corner, strength, law = masonry
    strain = kinetic = 0.0
    for i in range(mass.size):
        aim = memory[i, AIM_POS] if memory[i, FORCE] > 0 else memory[i, AIM_NEG]
        stiffness = unloading_stiffness(aim, corner[i], strength[i], law[UNLOADING])
        strain += 0.5 * memory[i, FORCE] ** 2 / stiffness
        kinetic += 0.5 * mass[i] * floors[SPEED, i] ** 2
    return kinetic, strain
