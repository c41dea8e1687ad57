"""How often the interval of ``assess`` holds the truth, in synthetic worlds of boxes and of scans.

In each world earthquakes, the body's edges, contact, direction, restitution, the floor's period and the errors of
the model are drawn from the distributions that :mod:`rockfrag.assess` states; it is told what a user would know.
What is sought is the PGV at which half of all earthquakes topple the object, and the fraction at a PGV. Printed by
``python -m tests.validation.test_assess_coverage 300``.
"""

import sys
from dataclasses import replace
from functools import cache
from itertools import product

import numpy as np
import pytest

from rockfrag.assess.answer import assess_with
from rockfrag.assess.hazard.curve import PGA, PGV, VELOCITY_PER_G
from rockfrag.assess.motions import MotionSet
from rockfrag.assess.outcomes import make_intensity_levels
from rockfrag.assess.place import Place
from rockfrag.assess.request import Request, make_request
from rockfrag.assess.risk import amplitude_target, fraction_target
from rockfrag.assess.scan import make_scan
from rockfrag.assess.sources import SPACE
from rockfrag.assess.standing import Standing
from rockfrag.assess.standing.contract import stretched_block
from rockfrag.assess.standing.scanned import ON_POINTS, Scanned
from rockfrag.campaign.standing import body_of, draw_arrangements, unknowns_of
from rockfrag.fragility.model_error import CUT, MODEL_ERRORS, SCAN
from rockfrag.motions import scale_to_pga
from rockfrag.motions.processing import bandpass
from rockfrag.records.motion import Motion
from rockfrag.system.mesh import Shape

EARTHQUAKES, OF_A_SET, COMPONENTS, COUNT = 240, 14, 2, 600
QUICK = 60
OF_A_SITE = 60  # motions of a world that come with about the PGV/PGA of a site

SETTINGS = {"width": "0.3 m", "height": "1.2 m", "cg_height": "0.6 m", "mass": "200 kg"}
IN_A_BUILDING = {"floor": "2/3"}


@cache
def _pool() -> list[Motion]:
    """Synthetic earthquakes: noise in a band about a frequency of its own, two components each."""
    random, found = np.random.default_rng(1), []
    for number in range(EARTHQUAKES):
        middle = np.exp(random.normal(np.log(1.2), 0.5))
        about = {"earthquake": f"synthetic {number}", "station": "s"}
        for component in range(COMPONENTS):
            raw = random.standard_normal(COUNT) * np.hanning(COUNT)
            name = f"synthetic {number} {component}"
            motion = Motion(raw, 0.01, name, metadata=about)
            found.append(scale_to_pga(bandpass(motion, 0.4 * middle, 2 * middle), 0.35))
    return found


def _set(numbers: np.ndarray) -> MotionSet:
    chosen = tuple(
        _pool()[COMPONENTS * i + k] for i in numbers for k in range(COMPONENTS)
    )
    pairs = tuple((i, i + 1) for i in range(0, len(chosen), COMPONENTS))
    return MotionSet(chosen, chosen, pairs, "synthetic motions")


def _scanned(random: np.random.Generator) -> Shape:
    """A synthetic scan of a column: a foot whose points lie at heights of their own, and a top."""
    angle, radius = (
        random.uniform(0, 2 * np.pi, 80),
        0.18 * np.sqrt(random.uniform(0.2, 1, 80)),
    )
    foot = np.column_stack(
        [
            radius * np.cos(angle),
            radius * np.sin(angle),
            0.003 * random.uniform(0, 1, 80) ** 2,
        ]
    )
    foot[:, 2] -= foot[:, 2].min()
    around = np.linspace(0, 2 * np.pi, 12, endpoint=False)
    top = np.column_stack(
        [0.15 * np.cos(around), 0.15 * np.sin(around), np.full(12, 1.2)]
    )
    points = np.vstack([foot, top]) - [0, 0, 0.6]
    return Shape(points, 200.0, np.diag([26.0, 26.0, 3.0]), 0.09, "synthetic scan")


def _told_of(shape: Shape, objects: Standing) -> Standing:
    """The object as assess takes it from a scan of which nothing else is known."""
    scan, _ = make_scan(shape, {}, None)
    usual = {**objects.under.tolerances, "restitution": ON_POINTS["restitution"]}
    under = replace(objects.under, tolerances=usual)
    return Scanned(scan.block(), objects.plane, under, ON_POINTS["livelier"], scan=scan)


def _true_scan(shape: Shape, told: Standing, seed: int, outside: float) -> Standing:
    """The object as it stands, with a contact tolerance whose quantiles may lie further from the middle."""
    unknowns = unknowns_of(SCAN)
    tolerance = unknowns["contact_tolerance_mm"]
    middle = tolerance(0.5)
    unknowns["contact_tolerance_mm"] = lambda u: (
        middle * (tolerance(u) / middle) ** outside
    )
    way = dict(draw_arrangements(shape, unknowns, 64, seed).table.iloc[0])
    return replace(told, block=body_of(shape, way), livelier=way["restitution_ratio"])


def _true_place(place: Place, random: np.random.Generator) -> Place:
    """The place with period and damping of its building drawn; stiffness goes with the square of frequency."""
    if place.building is None:
        return place
    slower, damped = (
        max(0.2, 1 + place.tolerances[name] * random.standard_normal())
        for name in ("period", "damping")
    )
    stiffnesses = tuple(k / slower**2 for k in place.building.stiffnesses)
    damping = replace(
        place.building.damping, ratio=place.building.damping.ratio * damped
    )
    return replace(
        place,
        building=replace(place.building, stiffnesses=stiffnesses, damping=damping),
    )


def world(seed: int, kind: str, outside: float = 1.0) -> tuple[bool, ...]:
    """Whether the intervals of the median and of the fraction at a level hold the truth in one world.

    ``outside`` is the factor by which one spread is larger in the world than is assumed: that of the contact
    tolerance of a scan, of the model's error of a cut block.
    """
    random = np.random.default_rng([seed, kind == SCAN])
    request, truth, place, error = _drawn(
        seed, kind, outside, random, {"pgv": f"{random.uniform(20, 60):.1f} cm/s"}
    )
    everything = _set(np.arange(EARTHQUAKES)).at(place)
    (outcomes,) = make_intensity_levels(everything, PGV).outcomes_of([truth])
    seen = _set(random.choice(EARTHQUAKES, OF_A_SET, replace=False)).at(request.place)
    found = assess_with(request, seen, brief=True)
    truths = (
        (found.amplitudes[0.5], amplitude_target(0.5).value(outcomes) * np.exp(error)),
        (
            found.fraction,
            fraction_target(request.level.value / np.exp(error)).value(outcomes),
        ),
    )
    return tuple(bool(one.lower <= truth <= one.upper) for one, truth in truths)


def _drawn(
    seed: int,
    kind: str,
    outside: float,
    random: np.random.Generator,
    level: dict[str, str],
) -> tuple[Request, Standing, Place, float]:
    """What assess is told of a world, the object and the place in it, and the error of the model's ln level."""
    in_building = IN_A_BUILDING if seed % 2 else {}
    request = make_request({**SETTINGS, **in_building, **level}, "synthetic")
    told = request.objects
    if kind == SCAN:
        shape = _scanned(random)
        told = _told_of(shape, told)
        truth = _true_scan(shape, told, seed, outside)
    else:
        truth = replace(
            told,
            livelier=1
            + told.under.tolerances["restitution"] * random.standard_normal(),
        )
    z = random.standard_normal(2)
    block = stretched_block(truth.block, 1 + told.under.tolerances["width"] * z[0])
    height = 1 + told.under.tolerances["cg_height"] * z[1]
    truth = replace(truth, block=stretched_block(block, height=height))
    place = _true_place(request.place, random)
    spread = MODEL_ERRORS[kind].beyond * (outside if kind == CUT else 1.0)
    error = random.normal(0, spread) + random.normal(0, SPACE)
    return replace(request, objects=told), truth, place, error


def world_of_both(seed: int) -> bool:
    """Whether the interval of the fraction holds the truth of a box where PGA and PGV at the site are known.

    The truth is that of the earthquakes of the world whose PGV/PGA is about that of the site.
    """
    random = np.random.default_rng([seed, 2])
    everything = _set(np.arange(EARTHQUAKES))
    logs = everything.log_ratios(PGA)
    pga, ratio = random.uniform(0.2, 0.6), random.choice(logs)
    level = {
        "pga": f"{pga:.3f} g",
        "pgv": f"{pga * np.exp(ratio) * VELOCITY_PER_G:.2f} cm/s",
    }
    request, truth, place, error = _drawn(seed, CUT, 1.0, random, level)
    near = np.argsort(abs(logs - ratio), kind="stable")[:OF_A_SITE]
    chosen = tuple(everything.ground[i] for i in near)
    motions = MotionSet(chosen, chosen, (), "synthetic motions").at(place)
    (outcomes,) = make_intensity_levels(motions, PGA).outcomes_of([truth])
    fraction = fraction_target(request.level.value / np.exp(error)).value(outcomes)
    seen = _set(random.choice(EARTHQUAKES, OF_A_SET, replace=False)).at(request.place)
    found = assess_with(request, seen, brief=True).fraction
    return bool(found.lower <= fraction <= found.upper)


def held(kind: str, worlds: int, outside: float = 1.0) -> np.ndarray:
    """Fraction of worlds in which the intervals of median and fraction hold the truth."""
    return np.mean([world(seed, kind, outside) for seed in range(worlds)], axis=0)


@pytest.mark.slow
@pytest.mark.parametrize("kind", [CUT, SCAN])
def test_the_intervals_hold_the_truth_about_as_often_as_they_say(kind):
    """Of 60 worlds at 90 %: four standard errors are 15 points; what is above only says that it is careful."""
    assert (held(kind, QUICK) > 0.75).all()


@pytest.mark.slow
def test_the_interval_holds_the_truth_where_the_velocity_is_known():
    assert np.mean([world_of_both(seed) for seed in range(QUICK)]) > 0.75


if __name__ == "__main__":
    of_both = np.mean([world_of_both(seed) for seed in range(int(sys.argv[1]))])
    print(f"{CUT}, PGA and PGV known: fraction {of_both:.3f}", flush=True)
    for of_kind, by in product((CUT, SCAN), (1.0, 1.5)):
        median, fraction = held(of_kind, int(sys.argv[1]), by)
        said = f"{of_kind}, one spread times {by:g}: median {median:.3f}, fraction {fraction:.3f}"
        print(said, flush=True)
