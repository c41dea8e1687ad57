"""Whatever cannot be used is refused with one sentence, never trimmed, never a traceback of another kind."""

import math

import numpy as np
import pytest

from rockfrag.errors import InputError
from rockfrag.records.motion import Motion
from rockfrag.rocking import (
    find_step_size_sensitive,
    find_thresholds,
    outcome_robustness,
    overturns,
    restitution_from_history,
    restitution_from_impacts,
    restitution_from_peaks,
    rocking_spectrum,
    simulate,
)
from rockfrag.rocking.inputs import UnitWarning
from rockfrag.system import Block, Stack

from .reference_bodies import T2, P

STACK = Stack(P, T2)
SHAKE = 4.0 * np.sin(np.arange(100) * 0.2)
MOTION = Motion(SHAKE, 0.01)
NINE = np.arange(9)
MASKED = np.ma.masked_array(SHAKE, mask=np.abs(SHAKE) > 3)


def simulated(body=T2, motion=SHAKE, dt=0.01, **more):
    return lambda: simulate(body, motion, dt, **more)


def stacked(**more):
    return simulated(STACK, **more)


def examined(door, **more):
    return lambda: door(T2, MOTION, None, [1.0], **more)


def searched(**changed):
    given = {"highest": 1.0, "tolerance": 0.1, "narrowest_resurrection": 0.5} | changed
    return lambda: find_thresholds(T2, MOTION, None, **given)


def swept(bodies=T2, motions=SHAKE, dt=0.01, scales=(1.0,), **more):
    return lambda: overturns(bodies, motions, dt, scales, **more)


UNUSABLE = [
    # bodies
    *(
        (
            lambda width=width: Block(width, 0.5, 3.0),
            f"Block: width: expected a positive number of metres, got {said}",
        )
        for width, said in [
            ("0.1", "'0.1'"),
            (None, "None"),
            (np.array([0.1, 0.2]), "array"),
            (0.1 + 0.1j, "(0.1+0.1j)"),
            (True, "True"),
            (0.0, "0.0"),
            (10**400, "1000"),
        ]
    ),
    (lambda: Block(0.1, -0.5, 3.0), "height: expected a positive number of metres, got -0.5"),
    (lambda: Block(0.1, 0.5, math.inf), "Block: mass: expected a positive number of kilograms"),
    (
        lambda: Block(0.2, 1e12, 30.0),
        "no block is larger than 1e+06 m; give its width and height in metres",
    ),
    (simulated(g=10**400), "g: expected"),
    (lambda: Block(0.1, 0.5, 3.0, inertia=[1.0]), "Block: inertia: expected a positive number"),
    (lambda: Block(0.1, 0.5, 3.0, cg_height="low"), "Block: cg_height: expected a positive number"),
    (lambda: Block(0.1, 0.5, 3.0, cg_offset=None), "Block: cg_offset: expected a finite number"),
    (lambda: Block(0.1, 0.5, 3.0, lean=math.nan), "lean: expected a finite number of radians"),
    (lambda: Block(0.1, 0.5, 3.0, cg_offset=0.06), "so it cannot stand"),
    (lambda: Block(1.0, 4.0, 1.0, lean=0.3), "cannot stand"),
    (lambda: Stack(P, None), "Stack: upper must be a Block, got None"),
    (lambda: Stack("plinth", T2), "Stack: lower must be a Block, got 'plinth'"),
    (lambda: Stack(STACK, T2), "Stack: lower must be a Block"),
    (lambda: Stack(P, T2, offset="left"), "Stack: offset: expected a finite number of metres"),
    (lambda: Stack(P, T2, offset=0.2), "does not lie on the pedestal"),
    (lambda: Stack(P, T2, offset=0.1), "so the stack cannot stand"),
    (lambda: Stack(P, Block(0.7, 0.4, 5.0)), "could touch the ground"),
    # motions
    (simulated(motion=None), "motion: expected numbers [m/s²], got None"),
    (simulated(motion="shake"), "motion: expected numbers [m/s²], got 'shake'"),
    (simulated(motion=["a", "b"]), "motion: expected numbers [m/s²], got text"),
    (simulated(motion=SHAKE + 0j), "motion: expected numbers [m/s²], got complex ones"),
    (simulated(motion=MASKED), "motion: expected numbers [m/s²], got a masked array"),
    (simulated(motion=SHAKE > 0), "motion: expected numbers [m/s²], got booleans"),
    (simulated(motion={"a": 1.0}), "motion: expected numbers [m/s²], got {'a': 1.0}"),
    (simulated(motion=[[1.0, 2.0], [3.0]]), "motion: expected numbers [m/s²]"),
    (simulated(motion=[[0.0, 1.0]]), "motion: expected shape (n,), got (1, 2)"),
    (simulated(motion=[3.0]), "motion: a motion needs at least two samples, got 1"),
    (simulated(motion=[0.0, math.nan, 1.0]), "motion: sample 1 is not a finite number"),
    (simulated(motion=[0.0, 1e6]), "motion: a peak of 1e+06 m/s² is beyond any earthquake"),
    (simulated(motion=MOTION), "dt: motion is a Motion, which has its own sampling interval"),
    (simulated(dt=None), "dt: motion is an array; give its sampling interval in seconds"),
    (simulated(dt=0.0), "dt: expected a positive number of seconds, got 0.0"),
    (simulated(dt="x"), "dt: expected a positive number of seconds, got 'x'"),
    (simulated(dt=math.nan), "dt: expected a positive number of seconds, got nan"),
    (simulated(dt=1e-12), "dt: free rocking sampled every 1e-12 s would take"),
    (simulated(dt=1e6), "is too long for a block of p"),
    # a single simulation's own arguments
    (simulated(body="T2"), "body: expected a Block, a Stack, a Column or a System, got 'T2'"),
    (simulated(theta0=math.nan), "theta0: expected 1 finite number(s), got nan"),
    (simulated(theta0=(0.1, 0.1)), "theta0: expected 1 finite number(s), got (0.1, 0.1)"),
    (simulated(theta0="far"), "theta0: expected numbers, got 'far'"),
    (simulated(theta0=2.0), "theta0: a block turned by π/2 or more lies on its side already"),
    (stacked(omega0=(0.1, math.inf)), "omega0: expected 2 finite number(s)"),
    (simulated(linear="yes"), "linear: expected True or False, got 'yes'"),
    (simulated(g=-9.81), "g: expected a positive number of m/s², got -9.81"),
    (simulated(restitution=1.01), "restitution of the block: 1.01 would gain energy"),
    (simulated(restitution="a"), "restitution of the block: expected a finite number, got 'a'"),
    (simulated(restitution=(0.9,) * 3), "restitution of the block: expected one ratio, or two"),
    (stacked(restitution=0.9), "restitution: a stack takes a pair (ground, interface)"),
    (stacked(restitution=("a", 0.9)), "restitution of the ground: expected a finite number"),
    (stacked(restitution={"floor": 0.9}), "restitution: 'floor' is no contact of a system of 2"),
    (stacked(restitution=(0.9, 1.2)), "restitution of the interface: 1.2 would gain energy"),
    (simulated(friction=-0.1), "friction of the ground: a coefficient is 0 or more, got -0.1"),
    (simulated(friction="rough"), "friction of the ground: expected a coefficient or a pair"),
    (simulated(friction=math.nan), "friction of the ground: a coefficient is 0 or more, got nan"),
    (simulated(friction=(0.3, 0.4)), "the static coefficient 0.3 is less than the kinetic one 0.4"),
    (stacked(friction=(0.3,)), "friction: a stack takes (ground, interface)"),
    (simulated(friction=True), "friction of the ground: a coefficient is 0 or more, got True"),
    (simulated(friction=0.4, linear=True), "friction cannot be had together with the linearised"),
    (simulated(vertical=SHAKE[:50]), "vertical: 50 samples for 100 horizontal ones"),
    (simulated(vertical=Motion(SHAKE, 0.02)), "vertical: sampled every 0.02 s, the horizontal"),
    (simulated(vertical=SHAKE * math.nan), "vertical: sample 0 is not a finite number"),
    # ensembles
    (swept(friction=[0.3, 0.4]), "friction: expected a number or a list with 1 entries"),
    (swept(friction=[(0.3, 0.4, 0.5)]), "friction of the ground: expected a coefficient or a pair"),
    (swept(friction="0.4"), "friction: expected a number or a list with 1 entries"),
    (swept(friction=0.4, forces=True), "forces cannot be had together with friction"),
    (swept(vertical=[SHAKE, SHAKE]), "vertical: expected 1 entries, one per motion, got 2"),
    (swept(vertical=[SHAKE[1:]]), "vertical[0]: 99 samples for 100 horizontal ones"),
    (swept(bodies=["T2"]), "bodies[0]: expected a Block, a Stack, a Column or a System, got 'T2'"),
    (
        swept(bodies=None),
        "bodies: expected a Block, a Stack, a Column, a System or a list of them, got None",
    ),
    (swept(motions=None), "motions: expected a Motion, accelerations or a list of them, got None"),
    (swept(motions=[SHAKE, [0.0, math.nan]]), "motions[1]: sample 1 is not a finite number"),
    (swept(dt=[0.01, 0.02]), "dt: expected one number or 1, got 2"),
    (swept(dt={"a": 1}), "dt: expected numbers [s], got {'a': 1}"),
    (swept(scales="x"), "scales: expected numbers, got 'x'"),
    (swept(scales=[math.nan]), "scales: expected finite numbers of shape"),
    (swept(scales=np.ones((3, 2))), "scales: expected finite numbers of shape"),
    (swept(scales=[1e300]), "scales: motions[0] is scaled to 4e+300 m/s²"),
    (swept(scales=[True, False]), "scales: expected numbers, got booleans"),
    (swept(scales=np.broadcast_to(1.0, 10**9)), "1000000000 cases are more than the"),
    (swept(threads=-2), "threads: expected a whole number from 1 to 4096, got -2"),
    (swept(threads=1.5), "threads: expected a whole number, got 1.5"),
    (swept(step=0.0), "step: expected a positive number, got 0.0"),
    (swept(step="fine"), "step: expected a positive number, got 'fine'"),
    (swept(restitution=0.9), "restitution: expected a list with one entry per body, got 0.9"),
    (swept(restitution=[0.9, 0.9]), "restitution: expected 1 entries, one per body, got 2"),
    (swept(theta0=0.1), "theta0: expected a list with one entry per body, got 0.1"),
    (swept(theta0=[(0.1, 0.2)]), "theta0: expected 1 finite number(s), got (0.1, 0.2)"),
    # what is built on them
    (examined(find_step_size_sensitive, sample=0), "sample: expected at least one"),
    (examined(find_step_size_sensitive, sample="x"), "sample: expected a whole number"),
    (examined(outcome_robustness, perturbation=0.0), "perturbation: expected a relative change"),
    (examined(outcome_robustness, perturbation="a"), "perturbation: expected a finite number"),
    (examined(outcome_robustness, perturbation=0.01, copies=0), "copies: expected at least one"),
    (searched(highest=-1.0), "highest: expected a positive number"),
    (searched(tolerance=-1.0), "tolerance: expected a positive number"),
    (searched(narrowest_resurrection=-1.0), "narrowest_resurrection: expected a positive number"),
    (lambda: rocking_spectrum(MOTION, ["a"], [0.2]), "periods: expected numbers [s], got text"),
    (lambda: rocking_spectrum(MOTION, [], [0.2]), "at least one period"),
    (lambda: rocking_spectrum(MOTION, [1.0], []), "at least one period"),
    (lambda: rocking_spectrum(MOTION, [0.0], [0.2]), "period: 2π/p"),
    (lambda: rocking_spectrum(MOTION, [math.nan], [0.2]), "period: 2π/p"),
    (lambda: rocking_spectrum(MOTION, [1.0], [2.0]), "alpha: a critical angle lies between"),
    (lambda: rocking_spectrum(MOTION, [1.0], [math.nan]), "critical angle lies between"),
    (lambda: restitution_from_peaks(T2, "peaks"), "peaks: expected numbers [rad], got 'peaks'"),
    (lambda: restitution_from_peaks(T2, [0.1 + 0j, 0.05]), "got complex ones"),
    (lambda: restitution_from_peaks(T2, [0.1]), "at least 2 numbers"),
    (lambda: restitution_from_peaks(T2, [0.1, -0.05, -0.02]), "alternate in sign"),
    (lambda: restitution_from_peaks(T2, [5.0, 3.0]), "critical angle"),
    (lambda: restitution_from_peaks(T2, [0.1, math.nan]), "entry 1 is not a finite"),
    (lambda: restitution_from_peaks(T2, [0.1, 0.07, 0.05], confidence=2.0), "between 0 and 1"),
    (lambda: restitution_from_impacts(T2, [0.0, 0.5]), "at least 3 numbers"),
    (lambda: restitution_from_impacts(T2, [0.0, 0.5, 0.4]), "entry 2 is not later"),
    (lambda: restitution_from_history(T2, NINE**2, np.ones(9)), "evenly spaced"),
    (lambda: restitution_from_history(T2, NINE, np.ones(8)), "one per time"),
    (lambda: restitution_from_history(T2, NINE / 100, np.ones(9) / 10), "two impacts"),
    (lambda: restitution_from_history(T2, NINE, ["a"] * 9), "numbers [rad], got text"),
]


@pytest.mark.parametrize(("call", "sentence"), UNUSABLE, ids=[text for _, text in UNUSABLE])
def test_what_cannot_be_used_is_refused_in_one_sentence(call, sentence):
    with pytest.raises(InputError) as caught:
        call()
    message = str(caught.value)
    assert sentence in message
    assert message.count(". ") == 0
    assert len(message) < 300


@pytest.mark.filterwarnings("ignore::rockfrag.rocking.ensemble.LightBodies")
@pytest.mark.parametrize("body", [T2, STACK], ids=["block", "stack"])
def test_a_motion_in_cm_s2_is_warned_about_by_either_function(body):
    with pytest.warns(UnitWarning, match="divide it by 100"):
        simulate(body, 100 * SHAKE, 0.01)
    with pytest.warns(UnitWarning, match="divide it by 100"):
        overturns(body, SHAKE, 0.01, [1.0, 100.0])
    with pytest.warns(UnitWarning, match=r"multiply it by 9\.81"):
        overturns(body, SHAKE, 0.01, [1e-4, 1e-3])


@pytest.mark.filterwarnings("ignore:the peak acceleration")
@pytest.mark.filterwarnings("ignore::rockfrag.rocking.ensemble.LightBodies")
@pytest.mark.parametrize("body", [T2, STACK], ids=["block", "stack"])
def test_hostile_motions_end(body):
    rng = np.random.default_rng(0)
    for values in (
        rng.normal(0, 1000, 200),
        np.tile([50.0, -50.0], 100),
        np.full(200, T2.b / T2.h * 9.81),
        np.r_[np.zeros(199), 1e4],
    ):
        response = simulate(body, values, 0.01)
        assert np.isfinite(response.theta).all()
        assert response.overturned in (True, False)


def test_a_motion_may_be_given_in_every_usual_form():
    first = simulate(T2, MOTION)
    for other in (simulate(T2, SHAKE, 0.01), simulate(T2, SHAKE.tolist(), np.float64(0.01))):
        np.testing.assert_array_equal(first.theta, other.theta)
    outcomes = [
        overturns(T2, MOTION, scales=[0.5, 2.0]),
        overturns([T2], [MOTION], scales=[0.5, 2.0]),
        overturns(T2, SHAKE, 0.01, [0.5, 2.0]),
        overturns(T2, SHAKE.tolist(), 0.01, [0.5, 2.0]),
    ]
    for found in outcomes:
        np.testing.assert_array_equal(found.peak_velocity, outcomes[0].peak_velocity)
