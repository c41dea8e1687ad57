"""Elastic and hysteretic buildings: published numbers, exact solutions, OpenSees, and what is refused."""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import yaml
from scipy.interpolate import CubicSpline
from scipy.linalg import eigh, expm

from rockfrag.base.errors import InputError
from rockfrag.building.floors import floor_motions, judge_drift, respond
from rockfrag.building.inelastic import (
    FORCE,
    MEMORY,
    law_parameters,
    move,
    respond_hysteretically,
    storey_envelopes,
)
from rockfrag.building.model import ShearBuilding
from rockfrag.building.response import BuildingResponse, find_modes, respond_elastically
from rockfrag.building.settings import make_building

from ..case_tables import case_tables
from ..conftest import shaking

CONFIG = Path(__file__).resolve().parents[2] / "config" / "building.yaml"


@pytest.fixture
def settings():
    """Settings of the reference building."""
    return yaml.safe_load(CONFIG.read_text(encoding="utf-8"))


CASES = case_tables(__file__)


def test_reference_building_has_the_published_periods_and_stiffnesses(settings):
    building = make_building(settings)
    period = find_modes(building).period
    assert [f"{value:.5f}" for value in period[:3]] == ["0.35000", "0.11880", "0.07409"]
    assert [f"{value:.3e}" for value in building.stiffnesses[:2]] == [
        "1.580e+09",
        "1.871e+09",
    ]
    assert building.stiffnesses[1:] == (building.stiffnesses[1],) * 5
    assert building.model == "elastic"
    with pytest.raises(InputError, match="floor 'F7' is not defined"):
        building.level("F7")


@pytest.mark.parametrize(("period", "name", "third", "fifth"), CASES["amplification"])
def test_reference_building_amplifies_the_four_records_as_published(
    settings, four_records, period, name, third, fifth
):
    building = make_building(settings | {"first_period_s": period})
    ground, *floors = floor_motions(building, four_records[name])
    assert [f"{floor.pga / ground.pga:.2f}" for floor in floors] == [third, fifth]
    assert floors[0].name.endswith("_F3")
    assert floors[0].metadata["floor"] == "F3"
    assert floors[0].metadata["ground_motion"] == ground.name.removesuffix("_GF")
    step = floors[0].provenance[-1]
    assert (step["step"], step["model"]) == ("floor_motion", "elastic")
    assert "elastic: storey" in step["outcome"]


@pytest.mark.parametrize(
    "damping",
    [
        {"kind": "modal", "ratio": 0.05},
        {"kind": "rayleigh", "ratio": 0.08, "modes": [1, 3]},
    ],
)
def test_modal_superposition_equals_the_matrix_exponential(settings, damping, noise):
    building = make_building(settings | {"first_period_s": 0.6, "damping": damping})
    motion = noise(3, 400)
    n, ratio = building.storeys, building.damping.ratio
    mass, stiffness = np.diag(building.masses), building.stiffness_matrix()
    if damping["kind"] == "rayleigh":
        w1, w3 = find_modes(building).frequency[[0, 2]]
        factor = 2 * ratio / (w1 + w3)
        viscous = factor * w1 * w3 * mass + factor * stiffness
    else:
        # C = 2 ζ M (M⁻¹K)^½ has the ratio ζ in every mode
        values, vectors = eigh(stiffness, mass)
        root = vectors @ np.diag(np.sqrt(values)) @ np.linalg.inv(vectors)
        viscous = 2 * ratio * mass @ root
    system = np.zeros((2 * n + 2, 2 * n + 2))
    system[:n, n : 2 * n] = np.eye(n)
    system[n : 2 * n, :n] = -np.linalg.solve(mass, stiffness)
    system[n : 2 * n, n : 2 * n] = -np.linalg.solve(mass, viscous)
    system[n : 2 * n, 2 * n] = -1
    system[2 * n, 2 * n + 1] = 1
    step = expm(system * motion.dt)[: 2 * n]
    state = np.zeros((2 * n, motion.acceleration.size))
    slopes = np.diff(motion.acceleration) / motion.dt
    for i, slope in enumerate(slopes):
        state[:, i + 1] = step @ [*state[:, i], motion.acceleration[i], slope]
    total = system[n : 2 * n, : 2 * n] @ state
    found = respond_elastically(building, motion)
    scale = np.abs(total).max()
    assert np.abs(found.acceleration[1:] - total).max() < 1e-9 * scale
    drift = np.diff(state[:n], axis=0, prepend=0) / np.array(building.heights)[:, None]
    assert np.abs(found.drift - drift).max() < 1e-9 * np.abs(drift).max()


@pytest.mark.parametrize("storeys", [1, 2, 7, 40])
def test_modes_are_those_of_lapack(storeys):
    """Rotations find what another method finds, of storeys that differ by a factor of 30."""
    random = np.random.default_rng(storeys)
    masses, stiffnesses = (
        scale * np.exp(random.uniform(0, np.log(30), storeys)) for scale in (1e5, 1e8)
    )
    building = ShearBuilding(tuple(masses), (3.5,) * storeys, tuple(stiffnesses))
    squares, vectors = eigh(building.stiffness_matrix(), np.diag(masses))
    found = find_modes(building)
    np.testing.assert_allclose(found.frequency, np.sqrt(squares), rtol=1e-10)
    # what floors take of each mode, whose shape may be next to nothing at the top
    parts = vectors * (vectors.T @ masses)
    assert np.abs(found.participation * found.shape - parts).max() < 1e-9


def test_modes_take_up_the_whole_mass_and_every_floor_moves_with_the_ground(settings):
    modes = find_modes(make_building(settings))
    assert modes.mass_fraction.sum() == pytest.approx(1, rel=1e-12)
    assert modes.shape @ modes.participation == pytest.approx(np.ones(6), rel=1e-12)


@pytest.mark.parametrize(("key", "value", "times", "message"), CASES["refused"])
def test_unphysical_buildings_are_refused_in_one_sentence(
    settings, key, value, times, message
):
    if key.startswith("only "):
        del settings["first_period_s"]
    settings[key.removeprefix("only ")] = [value] * times if times else value
    with pytest.raises(InputError, match=message) as refused:
        make_building(settings, "building.yaml")
    text = str(refused.value)
    assert text.startswith("building.yaml: ")
    assert text.endswith((".", "?"))


def test_heights_and_masses_may_be_in_any_unit_and_stiffnesses_stand_for_a_period(
    settings,
):
    usual = make_building(settings)
    del settings["first_period_s"]
    settings["storey_stiffnesses_N_m"] = list(usual.stiffnesses)
    settings["storey_heights_cm"] = [100 * h for h in settings.pop("storey_heights_m")]
    settings["masses"] = [f"{m / 1000} t" for m in settings.pop("masses_kg")]
    other = make_building(settings)
    assert other.stiffnesses == usual.stiffnesses
    assert other.heights == pytest.approx(usual.heights, rel=1e-15)
    assert other.masses == pytest.approx(usual.masses, rel=1e-15)


@pytest.fixture
def opensees():
    """OpenSees, where it can be imported: its wheel lacks libraries that some systems lack too."""
    try:
        import openseespy.opensees as ops
    except (ImportError, RuntimeError) as error:
        pytest.skip(f"OpenSees cannot be imported: {error}")
    ops.wipe()
    ops.model("basic", "-ndm", 1, "-ndf", 1)
    yield ops
    ops.wipe()


@pytest.fixture
def masonry(settings):
    """Maker of the reference building as hysteretic masonry, with changes to its law."""

    def make(**law):
        return make_building(
            settings | {"model": "hysteretic"} | {"masonry": settings["masonry"] | law}
        )

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
    """Path through cycles of displacement."""
    turns = np.array([0.0, *np.ravel([(a, -a) for a in amplitudes]), 0.0])
    legs = [np.linspace(a, b, points)[1:] for a, b in pairwise(turns)]
    return np.concatenate(legs)


GROWING = cycles(
    4.5 * np.array([2e-4, 5e-4, 1e-3, 1e-3, 2e-3, 3.9e-3, 3.9e-3, 6e-3, 6e-3, 9e-3])
)


def test_a_single_push_follows_the_envelope_of_weight_and_drift_limits(masonry):
    building = masonry()
    displacement, force = storey_envelopes(building)
    weight = (5 * 350e3 + 245e3) * 9.81
    assert force[0] == pytest.approx(0.12 * weight * np.array([0.5, 1, 1, 0.4]))
    assert displacement[0, 1:] == pytest.approx(4.5 * np.array([0.001, 0.004, 0.008]))
    assert force[0, 0] / displacement[0, 0] == pytest.approx(building.stiffnesses[0])
    # the same walls in every storey have the same strength
    assert np.ptp(force, axis=0) == pytest.approx(np.zeros(4), abs=1e-3)
    path = np.linspace(0, 0.05, 500)
    expected = np.interp(path, [0, *displacement[1]], [0, *force[1]])
    assert push_storey(building, 2, path) == pytest.approx(expected, rel=1e-12)
    assert push_storey(building, 2, -path) == pytest.approx(-expected, rel=1e-12)
    with pytest.raises(
        InputError, match=r"storey 1 reaches its shear .* lower base_shear"
    ):
        storey_envelopes(masonry(base_shear=0.9))


def test_repeated_cycles_lose_force_and_never_give_energy(masonry):
    path = np.append(0.0, cycles([0.009] * 4))
    force = push_storey(masonry(damage_energy=0.05), 1, path)
    assert (np.diff(force[path == 0.009]) < 0).all()
    work = np.cumsum(np.diff(path) * (force[1:] + force[:-1]) / 2)
    assert (work > 0).all()
    assert np.all(np.diff(work[297::298]) > 0)


def test_below_cracking_the_storeys_dissipate_nothing_and_the_building_is_elastic(
    masonry,
):
    building, motion = masonry(base_shear=0.3), strong_motion(0.03)
    found = respond(building, motion)
    exact = respond_elastically(building, motion)
    assert found.energy.hysteretic.max() < 1e-9 * found.energy.input.max()
    assert np.abs(found.acceleration - exact.acceleration).max() < 2e-4 * motion.pga
    assert np.abs(found.drift - exact.drift).max() < 2e-4 * exact.peak_drift.max()


def test_beyond_yield_the_energy_balance_closes_and_half_the_step_changes_nothing(
    masonry,
):
    building, motion = masonry(), strong_motion()
    found = respond(building, motion)
    assert found.peak_drift.max() > 0.002
    assert found.energy.gap < 1e-6
    # most of the energy is dissipated, never returned, and all of it at rest
    dissipated = found.energy.hysteretic
    assert np.diff(dissipated).min() > -1e-6 * dissipated.max()
    assert dissipated[-1] > 0.2 * found.energy.input[-1]
    fine = respond_hysteretically(building, motion, 1e-4)
    coarse_peaks, peaks = (
        np.abs(each.acceleration).max(axis=1) for each in (found, fine)
    )
    assert coarse_peaks == pytest.approx(peaks, rel=1e-3)
    assert found.peak_drift == pytest.approx(fine.peak_drift, rel=1e-3)


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


def material(ops, building, storey, tag=1):
    """Define the storey's law as OpenSees' HystereticSM."""
    displacement, force = storey_envelopes(building)
    pairs = [
        float(x)
        for xy in zip(force[storey], displacement[storey], strict=True)
        for x in xy
    ]
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
    assert (
        np.abs(found - pushed(opensees, GROWING)).max()
        < tolerance * np.abs(found).max()
    )


@pytest.mark.peers
def test_damage_by_energy_equals_opensees(opensees, masonry):
    # its trilinear law has the same envelope if nothing is lost after the shear limit, but relates
    # the energy to the area under three corners
    building = masonry(residual=1.0, damage_energy=0.1)
    displacement, force = (values[0] for values in storey_envelopes(building))
    areas = np.diff(displacement, prepend=0) * (
        force + np.concatenate([[0], force[:-1]])
    )
    pairs = [
        float(x) for xy in zip(force[:3], displacement[:3], strict=True) for x in xy
    ]
    law = building.masonry
    damage = law.damage_energy * areas[:3].sum() / areas.sum()
    opensees.uniaxialMaterial(
        "Hysteretic", 1, *pairs, *[-x for x in pairs], law.pinch_drift, law.pinch_force, 0.0,
        float(damage), law.unloading,
    )  # fmt: skip
    found = push_storey(building, 1, GROWING)
    assert np.abs(found - pushed(opensees, GROWING)).max() < 1e-9 * np.abs(found).max()


def shaken(ops, building, motion, parts):
    """Absolute floor accelerations and drifts of the building in OpenSees."""
    n = building.storeys
    ops.node(0, 0.0)
    ops.fix(0, 1)
    for i in range(n):
        ops.node(i + 1, 0.0)
        ops.mass(i + 1, building.masses[i])
        material(ops, building, i, i + 1)
        ops.element(
            "zeroLength", i + 1, i, i + 1, "-mat", i + 1, "-dir", 1, "-doRayleigh", 1
        )
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
        drift[:, k] = (
            np.diff([ops.nodeDisp(i, 1) for i in range(n + 1)]) / building.heights
        )
    return total, drift


@pytest.mark.peers
@pytest.mark.parametrize(("damage", "tolerance"), [(0.0, 1e-3), (0.02, 0.03)])
def test_hysteretic_floor_motions_under_a_record_are_those_of_opensees(
    opensees, settings, masonry, four_records, damage, tolerance
):
    # without damage by energy the two laws are the same, with it they differ by its reference area
    settings["damping"] = {"kind": "rayleigh", "ratio": 0.05, "modes": [1, 2]}
    building, motion = masonry(damage_energy=damage), four_records["Friuli"]
    total, drift = shaken(opensees, building, motion, 20)
    found = respond_hysteretically(building, motion, motion.dt / 20)
    assert (
        np.abs(found.acceleration[1:] - total).max() < tolerance * np.abs(total).max()
    )
    assert np.abs(found.drift - drift).max() < tolerance * np.abs(drift).max()


def judged(building, storey, drift):
    """Outcome on a building of which one storey, from 1, drifts so much, over its height."""
    drifts = np.zeros((6, 2))
    drifts[storey - 1, 1] = -drift
    return judge_drift(
        building, BuildingResponse(np.zeros(2), np.zeros((7, 2)), drifts)
    )


def test_an_elastic_building_is_believed_up_to_its_strength(settings):
    # a storey that carries the weight times the base shear coefficient is at its strength
    building = make_building(settings)
    strength = (
        0.12 * 9.81 * building.mass / building.stiffnesses[0] / building.heights[0]
    )
    fractions = (0.1, 0.999, 1.001, 9.0)
    outcomes = [judged(building, 1, fraction * strength) for fraction in fractions]
    assert [v.strength_fraction for v in outcomes] == pytest.approx(fractions)
    assert [v.credible for v in outcomes] == [True, True, False, False]
    assert [v.state for v in outcomes] == [
        "uncracked",
        "cracked",
        *["beyond strength"] * 2,
    ]
    assert "cannot break" in outcomes[-1].statement


@pytest.mark.parametrize(("drift", "state", "credible"), CASES["judged"])
def test_masonry_is_judged_by_the_drift_limits(masonry, drift, state, credible):
    outcome = judged(masonry(), 3, drift)
    assert (outcome.storey, outcome.state, outcome.credible) == (3, state, credible)
    assert outcome.statement.endswith(".")
