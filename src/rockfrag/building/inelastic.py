"""Hysteretic response of a masonry building, with an energy balance that closes.

Average acceleration (Newmark 1959, γ = 1/2, β = 1/4) in small steps, iterated to equilibrium. With
Δu = h (v₀ + v₁)/2 and m Δv = h (f₀ + f₁)/2 the mean of the equations of motion at both ends of a
step, times Δu, is an exact balance of energies: the work of every force is its mean over the step
times Δu. So the balance closes to the precision of the iteration, whatever the storeys do, and a gap
in it shows an equilibrium that was missed.
"""

from typing import Any

import numpy as np

from rockfrag.building import hysteresis
from rockfrag.building.model import ShearBuilding
from rockfrag.building.response import BuildingResponse, EnergyBalance, damping_matrix, find_modes
from rockfrag.machine_code import cached_njit
from rockfrag.records.motion import Motion

LONGEST_STEP = 2e-4
"""Longest step [s]: halving it changes floor peaks of the reference building by less than 0.1 %."""


def respond_hysteretically(
    building: ShearBuilding, motion: Motion, longest_step: float = LONGEST_STEP
) -> BuildingResponse:
    """Integrate the building with its masonry law; damping is that of the elastic modes."""
    corner, strength = hysteresis.storey_envelopes(building)
    parts = max(1, int(np.ceil(motion.dt / longest_step - 1e-9)))
    step = motion.dt / parts
    mass = np.asarray(building.masses)
    viscous = damping_matrix(building, find_modes(building))
    effective = building.stiffness_matrix() + 2 / step * viscous + np.diag(4 / step**2 * mass)
    matrices = mass, viscous, np.linalg.inv(effective)
    law = corner, strength, hysteresis.law_parameters(building.masonry)
    total, shift, energy = _integrate(motion.acceleration, step, parts, *matrices, *law)
    return BuildingResponse(
        time=motion.time,
        acceleration=np.vstack([motion.acceleration, total]),
        drift=shift / np.asarray(building.heights)[:, None],
        energy=EnergyBalance(*energy),
    )


@cached_njit()
def _shears(
    u: Any, memory: Any, moved: Any, corner: Any, strength: Any, law: Any, force: Any
) -> None:
    """Storey states at floor displacements u, and the forces they put on the floors."""
    n = u.size
    below = 0.0
    for i in range(n):
        hysteresis.move(memory[i], u[i] - below, corner[i], strength[i], law, moved[i])
        below = u[i]
    for i in range(n):
        above = moved[i + 1, hysteresis.FORCE] if i + 1 < n else 0.0
        force[i] = moved[i, hysteresis.FORCE] - above


@cached_njit()
def _integrate(
    ground: Any,
    step: float,
    parts: int,
    mass: Any,
    viscous: Any,
    inverse: Any,
    corner: Any,
    strength: Any,
    law: Any,
) -> Any:
    n, samples = mass.size, ground.size
    total, shift = np.zeros((n, samples)), np.zeros((n, samples))
    energy = np.zeros((5, samples))
    u, v, a = np.zeros(n), np.zeros(n), -ground[0] * np.ones(n)
    memory, moved = np.zeros((n, hysteresis.MEMORY)), np.zeros((n, hysteresis.MEMORY))
    force, force1 = np.zeros(n), np.zeros(n)
    u1, v1, a1, rest = np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(n)
    total[:, 0] = a + ground[0]
    work_in = work_damped = work_storeys = 0.0
    for k in range(samples - 1):
        for part in range(parts):
            g0 = ground[k] + (ground[k + 1] - ground[k]) * (part / parts)
            g1 = ground[k] + (ground[k + 1] - ground[k]) * ((part + 1) / parts)
            change = step * v + 0.5 * step * step * a
            for _ in range(100):
                for i in range(n):
                    u1[i] = u[i] + change[i]
                    v1[i] = 2 / step * change[i] - v[i]
                    a1[i] = 4 / step * (change[i] / step - v[i]) - a[i]
                _shears(u1, memory, moved, corner, strength, law, force1)
                for i in range(n):
                    rest[i] = -mass[i] * (g1 + a1[i]) - force1[i]
                    for j in range(n):
                        rest[i] -= viscous[i, j] * v1[j]
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
            for i in range(n):
                # the work of a force over the step: its mean times the displacement
                du = u1[i] - u[i]
                work_in -= mass[i] * 0.5 * (g0 + g1) * du
                work_storeys += 0.5 * (force[i] + force1[i]) * du
                for j in range(n):
                    work_damped += viscous[i, j] * 0.5 * (v[j] + v1[j]) * du
            u[:], v[:], a[:], force[:] = u1, v1, a1, force1
            memory[:] = moved
        strain = kinetic = 0.0
        for i in range(n):
            aim = (
                memory[i, hysteresis.AIM_POS]
                if memory[i, hysteresis.FORCE] > 0
                else memory[i, hysteresis.AIM_NEG]
            )
            stiffness = hysteresis.unloading_stiffness(aim, corner[i], strength[i], law[4])
            strain += 0.5 * memory[i, hysteresis.FORCE] ** 2 / stiffness
            kinetic += 0.5 * mass[i] * v[i] ** 2
            shift[i, k + 1] = memory[i, hysteresis.DISPLACEMENT]
            total[i, k + 1] = a[i] + ground[k + 1]
        energy[0, k + 1] = work_in
        energy[1, k + 1] = kinetic
        energy[2, k + 1] = strain
        energy[3, k + 1] = work_damped
        energy[4, k + 1] = work_storeys - strain
    return total, shift, energy
