from itertools import pairwise

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from rockfrag.building.floors import floor_motions, judge_drift, respond
from rockfrag.building.inelastic import (
    FORCE,
    MEMORY,
    law_parameters,
    move,
    respond_hysteretically,
    storey_envelopes,
)
from rockfrag.building.response import BuildingResponse, respond_elastically
from rockfrag.building.settings import make_building
from rockfrag.errors import InputError

from ..conftest import shaking


@pytest.fixture
def masonry(settings):
    """Maker of the reference building as hysteretic masonry, with changes to its law."""

    def make(damping=None, **law):
        changed = settings | {"model": "hysteretic", "masonry": settings["masonry"] | law}
        return make_building(changed | ({"damping": damping} if damping else {}))

    return make


def strong_motion(peak_g=0.25):
    """Eight seconds around 2 Hz that crack the reference building and take it past yield."""
    return shaking(1, 1, 4, peak_g)


def push_storey(building, storey, path):
    """Shears [N] of one storey, from 1, that is pushed along straight lines through displacements [m]."""
    corner, strength = (envelope[storey - 1] for envelope in storey_envelopes(building))
    memory, moved, forces = np.zeros(MEMORY), np.zeros(MEMORY), []
    for to in path:
        move(memory, to, corner, strength, law_parameters(building.masonry), moved)
        memory[:] = moved
        forces.append(moved[FORCE])
    return np.array(forces)


def cycles(amplitudes, points=150):
    """Path through growing cycles of displacement."""
    turns = np.array([0.0, *np.ravel([(a, -a) for a in amplitudes]), 0.0])
    legs = [np.linspace(a, b, points)[1:] for a, b in pairwise(turns)]
    return np.concatenate(legs)


GROWING = cycles(4.5 * np.array([2e-4, 5e-4, 1e-3, 1e-3, 2e-3, 3.9e-3, 3.9e-3, 6e-3, 6e-3, 9e-3]))


def test_the_envelope_follows_from_weight_and_drift_limits(masonry):
    displacement, force = storey_envelopes(masonry())
    weight = (5 * 350e3 + 245e3) * 9.81
    assert force[0] == pytest.approx(0.12 * weight * np.array([0.5, 1, 1, 0.4]))
    assert displacement[0, 1:] == pytest.approx(4.5 * np.array([0.001, 0.004, 0.008]))
    assert force[0, 0] / displacement[0, 0] == pytest.approx(masonry().stiffnesses[0])
    # the same walls in every storey have the same strength
    assert np.ptp(force, axis=0) == pytest.approx(np.zeros(4), abs=1e-3)


def test_a_single_push_follows_the_envelope(masonry):
    building = masonry()
    displacement, force = storey_envelopes(building)
    path = np.linspace(0, 0.05, 500)
    expected = np.interp(path, [0, *displacement[1]], [0, *force[1]])
    assert push_storey(building, 2, path) == pytest.approx(expected, rel=1e-12)
    assert push_storey(building, 2, -path) == pytest.approx(-expected, rel=1e-12)


def test_repeated_cycles_lose_force_and_never_give_energy(masonry):
    building = masonry(damage_energy=0.05)
    path = cycles([0.009] * 4)
    force = push_storey(building, 1, path)
    peaks = [
        force[path == 0.009][0]
        for path, force in zip(
            np.split(path, [298, 596, 894]), np.split(force, [298, 596, 894]), strict=True
        )
    ]
    assert (np.diff(peaks) < 0).all()
    both = np.concatenate([[0.0], path]), np.concatenate([[0.0], force])
    work = np.cumsum(np.diff(both[0]) * (both[1][1:] + both[1][:-1]) / 2)
    assert (work > 0).all()
    assert np.all(np.diff(work[297::298]) > 0)


def test_below_cracking_the_storeys_dissipate_nothing_and_the_building_is_elastic(masonry):
    building, motion = masonry(base_shear=0.3), strong_motion(0.03)
    found = respond_hysteretically(building, motion)
    exact = respond_elastically(building, motion)
    energy_balance = found.energy
    assert energy_balance.hysteretic.max() < 1e-9 * energy_balance.input.max()
    assert np.abs(found.acceleration - exact.acceleration).max() < 2e-4 * motion.pga
    assert np.abs(found.drift - exact.drift).max() < 2e-4 * exact.peak_drift.max()


def test_the_energy_balance_closes_beyond_yield(masonry):
    found = respond_hysteretically(masonry(), strong_motion())
    assert found.peak_drift.max() > 0.002
    assert found.energy.gap < 1e-6
    # most of the energy is dissipated, never returned, and all of it at rest
    dissipated = found.energy.hysteretic
    assert np.diff(dissipated).min() > -1e-6 * dissipated.max()
    assert dissipated[-1] > 0.2 * found.energy.input[-1]


def test_input_energy_equals_its_integral_over_the_floor_velocities(masonry):
    motion = strong_motion()
    building = masonry()
    found = respond_hysteretically(building, motion, 5e-5)
    # splines through the displacements at the samples know nothing of the steps of the integration
    heights = np.array(building.heights)[:, None]
    displacement = np.cumsum(found.drift * heights, axis=0)
    velocity = CubicSpline(motion.time, displacement, axis=1).derivative()(motion.time)
    power = -motion.acceleration * (np.array(building.masses) @ velocity)
    total = CubicSpline(motion.time, power).integrate(0, motion.time[-1])
    assert found.energy.input[-1] == pytest.approx(total, rel=2e-3)


def test_halving_the_step_changes_nothing_that_matters(masonry):
    building, motion = masonry(), strong_motion()
    coarse = respond_hysteretically(building, motion)
    fine = respond_hysteretically(building, motion, 1e-4)
    assert np.abs(coarse.acceleration).max(axis=1) == pytest.approx(
        np.abs(fine.acceleration).max(axis=1), rel=1e-3
    )
    assert coarse.peak_drift == pytest.approx(fine.peak_drift, rel=1e-3)


def test_floor_motions_of_masonry_are_hysteretic_and_weaker(masonry, settings):
    motion = strong_motion()
    cracked = floor_motions(masonry(), motion, ["F5"])[0]
    elastic = floor_motions(make_building(settings), motion, ["F5"])[0]
    assert cracked.provenance[-1]["model"] == "hysteretic"
    assert cracked.pga < 0.7 * elastic.pga
    assert respond(masonry(), motion).energy is not None


def test_a_law_that_the_stiffness_does_not_allow_is_refused(masonry):
    with pytest.raises(
        InputError, match=r"storey 1 reaches its shear strength .* lower base_shear"
    ):
        storey_envelopes(masonry(base_shear=0.9))


def material(ops, building, storey, tag=1):
    """Define the storey's law as OpenSees' HystereticSM."""
    displacement, force = storey_envelopes(building)
    pairs = [float(x) for xy in zip(force[storey], displacement[storey], strict=True) for x in xy]
    law = building.masonry
    ops.uniaxialMaterial(
        "HystereticSM", tag, "-posEnv", *pairs, "-negEnv", *[-x for x in pairs],
        "-pinch", law.pinch_drift, law.pinch_force,
        "-damage", law.damage_ductility, law.damage_energy, "-beta", law.unloading,
    )  # fmt: skip


def pushed(ops, path):
    ops.testUniaxialMaterial(1)
    forces = []
    for x in path:
        ops.setStrain(float(x))
        forces.append(ops.getStress())
    return np.array(forces)


@pytest.mark.peers
@pytest.mark.parametrize(
    ("law", "tolerance"),
    [
        ({"damage_energy": 0.0}, 1e-9),
        ({"damage_energy": 0.0, "damage_ductility": 0.05}, 1e-9),
        ({"damage_energy": 0.0, "unloading": 0.0}, 1e-9),
        # HystereticSM relates the energy to an area of its own, which is the whole difference
        ({}, 0.03),
    ],
)
def test_a_cyclic_push_is_that_of_opensees(opensees, masonry, law, tolerance):
    building = masonry(**law)
    material(opensees, building, 0)
    found = push_storey(building, 1, GROWING)
    assert np.abs(found - pushed(opensees, GROWING)).max() < tolerance * np.abs(found).max()


@pytest.mark.peers
def test_damage_by_energy_equals_opensees(opensees, masonry):
    # its trilinear law has the same envelope if nothing is lost after the shear limit, but relates
    # the energy to the area under three corners
    building = masonry(residual=1.0, damage_energy=0.1)
    displacement, force = (values[0] for values in storey_envelopes(building))
    areas = np.diff(displacement, prepend=0) * (force + np.concatenate([[0], force[:-1]]))
    pairs = [float(x) for xy in zip(force[:3], displacement[:3], strict=True) for x in xy]
    law = building.masonry
    damage = law.damage_energy * areas[:3].sum() / areas.sum()
    opensees.uniaxialMaterial(
        "Hysteretic", 1, *pairs, *[-x for x in pairs], law.pinch_drift, law.pinch_force, 0.0,
        float(damage), law.unloading,
    )  # fmt: skip
    found = push_storey(building, 1, GROWING)
    assert np.abs(found - pushed(opensees, GROWING)).max() < 1e-9 * np.abs(found).max()


def shaken(ops, building, motion, parts, define):
    """Absolute floor accelerations and top displacement of the building in OpenSees."""
    n = building.storeys
    ops.node(0, 0.0)
    ops.fix(0, 1)
    for i in range(n):
        ops.node(i + 1, 0.0)
        ops.mass(i + 1, building.masses[i])
        define(i, i + 1)
        ops.element("zeroLength", i + 1, i, i + 1, "-mat", i + 1, "-dir", 1, "-doRayleigh", 1)
    first, second = np.sqrt(ops.eigen("-fullGenLapack", 2))
    factor = 2 * building.damping.ratio / (first + second)
    ops.rayleigh(factor * first * second, 0.0, factor, 0.0)
    values = [float(x) for x in motion.acceleration]
    ops.timeSeries("Path", 1, "-dt", motion.dt, "-values", *values)
    ops.pattern("UniformExcitation", 1, 1, "-accel", 1)
    ops.constraints("Plain")
    ops.numberer("Plain")
    ops.system("FullGeneral")
    ops.test("NormDispIncr", 1e-12, 50)
    ops.algorithm("Newton")
    ops.integrator("Newmark", 0.5, 0.25)
    ops.analysis("Transient")
    total = np.zeros((n, len(values)))
    drift = np.zeros((n, len(values)))
    for k in range(1, len(values)):
        assert ops.analyze(parts, motion.dt / parts) == 0
        total[:, k] = [ops.nodeAccel(i + 1, 1) + values[k] for i in range(n)]
        drift[:, k] = np.diff([ops.nodeDisp(i, 1) for i in range(n + 1)]) / building.heights
    return total, drift


RAYLEIGH = {"kind": "rayleigh", "ratio": 0.05, "modes": [1, 2]}


@pytest.mark.peers
@pytest.mark.parametrize(("damage", "tolerance"), [(0.0, 1e-3), (0.02, 0.03)])
def test_hysteretic_floor_motions_under_a_record_are_those_of_opensees(
    opensees, masonry, four_records, damage, tolerance
):
    # without damage by energy the two laws are the same, with it they differ by its reference area
    building, motion = masonry(damping=RAYLEIGH, damage_energy=damage), four_records["Friuli"]

    def storey(i, tag):
        material(opensees, building, i, tag)

    total, drift = shaken(opensees, building, motion, 20, storey)
    found = respond_hysteretically(building, motion, motion.dt / 20)
    assert np.abs(found.acceleration[1:] - total).max() < tolerance * np.abs(total).max()
    assert np.abs(found.drift - drift).max() < tolerance * np.abs(drift).max()


@pytest.fixture(scope="module")
def judged(noise):
    """Outcome on a building under noise of a peak acceleration [m/s²]."""
    shaking = noise(5, 1000)

    def judge(building, pga):
        motion = shaking.after("scale", shaking.acceleration * pga / shaking.pga)
        return judge_drift(building, respond(building, motion))

    return judge


def test_an_elastic_building_is_believed_up_to_its_strength(settings, judged):
    building = make_building(settings)
    outcomes = [judged(building, pga) for pga in (0.1, 0.5, 1.0, 2.0, 10.0)]
    fractions = [v.strength_fraction for v in outcomes]
    assert fractions == pytest.approx(
        [fractions[0] * pga / 0.1 for pga in (0.1, 0.5, 1.0, 2.0, 10.0)]
    )
    assert [v.credible for v in outcomes] == [fraction <= 1 for fraction in fractions]
    assert outcomes[0].state == "uncracked"
    assert outcomes[-1].state == "beyond strength"
    assert "cannot break" in outcomes[-1].statement


def test_the_strength_share_is_the_base_shear_over_the_weight(settings):
    # a storey that carries the weight times the base shear coefficient is at its strength
    building = make_building(settings)
    weight = 9.81 * building.mass
    drift = np.zeros((6, 2))
    drift[0, 1] = 0.12 * weight / building.stiffnesses[0] / building.heights[0]
    response = BuildingResponse(np.zeros(2), np.zeros((7, 2)), drift)
    outcome = judge_drift(building, response)
    assert outcome.strength_fraction == pytest.approx(1)
    assert outcome.storey == 1


@pytest.mark.parametrize(
    ("drift", "state", "credible"),
    [
        (1e-5, "uncracked", True),
        (8e-4, "cracked", True),
        (2e-3, "beyond yield", True),
        (6e-3, "beyond the shear limit", True),
        (9e-3, "beyond the rocking limit", False),
    ],
)
def test_masonry_is_judged_by_the_drift_limits(settings, drift, state, credible):
    building = make_building(settings | {"model": "hysteretic"})
    drifts = np.zeros((6, 2))
    drifts[2, 1] = -drift
    outcome = judge_drift(building, BuildingResponse(np.zeros(2), np.zeros((7, 2)), drifts))
    assert (outcome.storey, outcome.state, outcome.credible) == (3, state, credible)
    assert outcome.statement.endswith(".")
