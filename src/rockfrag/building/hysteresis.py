"""Degrading, pinching law of one storey between force and displacement.

The rules are those of Filippou's law as OpenSees' ``Hysteretic`` and ``HystereticSM`` have it, for
an envelope that is the same on both sides, so that the two can be compared:

1. Beyond the largest displacement reached so far on its side a storey follows the envelope.
2. It unloads with the elastic stiffness over (largest displacement / cracking displacement)^β.
3. Reloading starts where the force is zero, and goes in two straight lines through the pinching
   point to the envelope at the aim: the largest displacement reached on that side, enlarged by
   damage at each reversal from beyond cracking on the other side. It is nowhere steeper than
   unloading.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from rockfrag.building.model import MasonryLaw, ShearBuilding
from rockfrag.errors import InputError
from rockfrag.machine_code import cached_njit
from rockfrag.units import GRAVITY

Floats = NDArray[np.float64]

# the memory of a storey: present displacement and force, aim on either side (as magnitudes), where
# the force was zero after unloading from the other side, direction of motion, and work done on it
DISPLACEMENT, FORCE, AIM_POS, AIM_NEG, ZERO_POS, ZERO_NEG, DIRECTION, WORK = range(8)
MEMORY = 8


def shear_strengths(building: ShearBuilding) -> Floats:
    """Shear strength of each storey [N], shape (storeys,): the same walls have the same everywhere."""
    section = np.asarray(building.stiffnesses) * np.asarray(building.heights)
    base = building.masonry.base_shear * building.mass * GRAVITY
    return np.asarray(base * section / section[0])


def storey_envelopes(building: ShearBuilding) -> tuple[Floats, Floats]:
    """Corners of the envelope of each storey: cracking, yield, shear limit, rocking limit."""
    law = building.masonry
    heights, stiffnesses = np.asarray(building.heights), np.asarray(building.stiffnesses)
    strength = shear_strengths(building)
    cracking = law.cracking * strength
    limits = (limit * heights for limit in (law.yield_drift, law.shear_drift, law.rocking_drift))
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


def law_parameters(law: MasonryLaw) -> Floats:
    """Parameters of the law as the kernels take them, shape (5,)."""
    return np.array(
        [law.pinch_force, law.pinch_drift, law.damage_ductility, law.damage_energy, law.unloading]
    )


@cached_njit()
def envelope(x: float, corner: Any, strength: Any) -> float:
    """Force of the envelope at a displacement x ≥ 0."""
    if x <= corner[0]:
        return float(strength[0] / corner[0] * x)
    for i in range(1, corner.size):
        if x <= corner[i]:
            slope = (strength[i] - strength[i - 1]) / (corner[i] - corner[i - 1])
            return float(strength[i - 1] + slope * (x - corner[i - 1]))
    return float(strength[-1])


@cached_njit()
def unloading_stiffness(aim: float, corner: Any, strength: Any, exponent: float) -> float:
    """Stiffness of unloading from the side whose largest displacement is ``aim``."""
    ductility = max(aim / corner[0], 1.0)
    return float(strength[0] / corner[0] / ductility**exponent)


@cached_njit()
def _area(corner: Any, strength: Any) -> float:
    """Area under both sides of the envelope."""
    total = corner[0] * strength[0]
    for i in range(1, corner.size):
        total += (corner[i] - corner[i - 1]) * (strength[i] + strength[i - 1])
    return float(total)


@cached_njit()
def move(memory: Any, to: float, corner: Any, strength: Any, law: Any, moved: Any) -> None:
    """Move a storey from the state ``memory`` to a displacement, as seen from where it moves; fill ``moved``."""
    moved[:] = memory
    step = to - memory[DISPLACEMENT]
    if step == 0.0:
        return
    side = 1.0 if step > 0 else -1.0
    front, back = (AIM_POS, AIM_NEG) if step > 0 else (AIM_NEG, AIM_POS)
    zero = ZERO_POS if step > 0 else ZERO_NEG
    x0, f0, x = side * memory[DISPLACEMENT], side * memory[FORCE], side * to
    back_stiffness = unloading_stiffness(memory[back], corner, strength, law[4])
    front_stiffness = unloading_stiffness(memory[front], corner, strength, law[4])

    if memory[DIRECTION] != side and f0 <= 0.0:
        # a reversal: note where the force will be zero, and enlarge the aim by damage
        moved[zero] = x0 - f0 / back_stiffness
        if memory[back] > corner[0]:
            work = memory[WORK] - 0.5 * f0 * f0 / back_stiffness
            damage = law[3] * work / _area(corner, strength)
            damage += law[2] * (memory[back] - corner[0]) / corner[0]
            moved[front] = memory[front] * (1.0 + damage)

    moved[front] = max(moved[front], corner[0])
    aim = moved[front]
    if x >= aim:
        force = envelope(x, corner, strength)
        moved[front] = x
    elif x < moved[zero]:
        force = min(f0 + back_stiffness * (x - x0), 0.0)
    else:
        force = _reload(x, moved[zero], aim, envelope(aim, corner, strength), front_stiffness, law)
        force = min(force, f0 + front_stiffness * (x - x0))
    moved[DISPLACEMENT] = to
    moved[FORCE] = side * force
    moved[DIRECTION] = side
    moved[WORK] = memory[WORK] + 0.5 * (f0 + force) * (x - x0)


@cached_njit()
def _reload(x: float, zero: float, aim: float, force: float, stiffness: float, law: Any) -> float:
    """Force at x on the two lines from (zero, 0) through the pinching point to (aim, force)."""
    pinch = zero + (aim - (1.0 - law[0]) * force / stiffness - zero) * law[1]
    if x < pinch:
        return float(law[0] * force * (x - zero) / (pinch - zero))
    if aim <= pinch:
        return float(force)
    return float(force * (law[0] + (1.0 - law[0]) * (x - pinch) / (aim - pinch)))
