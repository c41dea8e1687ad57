"""Public names say what they are, their examples are run, and what they show at a prompt fits the screen."""

import doctest
import importlib
import inspect
import pydoc
import re
import warnings

import numpy as np
import pytest

import rockfrag
from rockfrag import (
    Block,
    Motion,
    Stack,
    find_thresholds,
    overturns,
    read_motion,
    simulate,
)
from rockfrag.base.errors import InputError
from rockfrag.base.units import GRAVITY
from rockfrag.simulation.inputs import UnitWarning
from rockfrag.system.blocks import UnlikelyBlock

from ..conftest import SUBPACKAGES

SHOWN_FIRST = (
    *("Block", "Stack", "simulate", "overturns", "find_thresholds", "rocking_spectrum"),
    *("find_step_size_sensitive", "outcome_robustness"),
)
TIME = np.arange(0, 2, 0.01)
PULSE = np.sin(2 * np.pi * TIME) * (TIME < 1)
STATUE = Block(0.3, 1.2, 180.0)
STACK = Stack(Block(0.6, 0.4, 300.0), STATUE)


def public() -> dict[str, object]:
    """Functions and classes that the package and its subpackages export, by their full names."""
    found = {}
    for subpackage in SUBPACKAGES:
        package = importlib.import_module(f"rockfrag{subpackage}")
        for name in package.__all__:
            value = getattr(package, name)
            if inspect.isfunction(value) or inspect.isclass(value):
                found[f"{value.__module__}.{name}"] = value
    return found


PUBLIC = public()
FORM = {"GL05", "GL06", "GL07", "GL08", "PR02", "PR03", "YD01"}
PARAMETERS = "PR01"
WITH_EXAMPLES = {
    name: value
    for name, value in PUBLIC.items()
    if ">>>" in (inspect.getdoc(value) or "")
} | {"rockfrag": rockfrag}


@pytest.mark.parametrize(
    "name",
    [name for name in sorted(PUBLIC) if not hasattr(PUBLIC[name], "with_traceback")],
)
def test_public_name_is_documented(name):
    """In the form of numpydoc."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        validation = pytest.importorskip(
            "numpydoc.validate", reason="numpydoc is not installed"
        )
    found = validation.validate(
        f"{PUBLIC[name].__module__}.{PUBLIC[name].__qualname__}"
    )
    wrong = [f"{code}: {words}" for code, words in found["errors"] if code in FORM]
    # the fields of a class are described as its attributes
    value = PUBLIC[name]
    if inspect.isfunction(value):
        wrong += [
            f"{code}: {words}" for code, words in found["errors"] if code == PARAMETERS
        ]
        returned = inspect.signature(value).return_annotation
        if returned not in (None, "None") and "Returns\n-------" not in inspect.getdoc(
            value
        ):
            wrong += ["it does not say what it returns"]
    elif inspect.signature(value).parameters and not re.search(
        r"(Attributes|Parameters)\n", found["docstring"]
    ):
        wrong += ["neither attributes nor parameters are described"]
    assert not wrong


@pytest.mark.parametrize("name", sorted(WITH_EXAMPLES))
def test_an_example_shows_what_it_says(name):
    examples = doctest.DocTestFinder(recurse=False).find(
        WITH_EXAMPLES[name], name, globs={}
    )
    assert any(example.examples for example in examples)
    for example in examples:
        report: list[str] = []
        doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE).run(
            example, out=report.append
        )
        assert not report, "".join(report)


def test_what_is_used_first_shows_what_comes_back():
    for name in SHOWN_FIRST:
        assert "Examples\n--------" in inspect.getdoc(getattr(rockfrag, name))


@pytest.mark.parametrize("name", sorted(PUBLIC))
def test_help_begins_with_types_that_a_person_can_read(name):
    head = pydoc.render_doc(PUBLIC[name], renderer=pydoc.plaintext).splitlines()[2]
    assert "numpy._typing" not in head
    assert len(head) < 1000


RESULTS = {
    "Motion": lambda: Motion(PULSE, 0.01, metadata={str(i): i for i in range(9)}),
    "Response of a block": lambda: simulate(STATUE, 4 * PULSE, 0.01),
    "Response of a stack": lambda: simulate(STACK, 4 * PULSE, 0.01),
    "Outcomes": lambda: overturns([STATUE, STACK], PULSE, 0.01, np.arange(2.5, 8, 0.1)),
    "Thresholds": lambda: find_thresholds(
        [STATUE] * 9,
        PULSE,
        0.01,
        highest=8.0,
        tolerance=0.1,
        narrowest_resurrection=0.5,
    ),
    "RockingSpectrum": lambda: rockfrag.rocking_spectrum(
        Motion(4 * PULSE, 0.01), [1, 2, 3], 0.2
    ),
    "ResponseSpectrum": lambda: rockfrag.response_spectrum(
        Motion(PULSE, 0.01), np.linspace(0.1, 2, 50)
    ),
}


@pytest.mark.parametrize("name", RESULTS)
def test_a_result_at_the_prompt_fits_a_screen(name):
    lines = repr(RESULTS[name]()).splitlines()
    assert len(lines) <= 30
    assert max(map(len, lines)) <= 100
    assert lines[0] == f"{name.split()[0]}("


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda: overturns(STATUE, PULSE, 0.01, scale=2), "did you mean scales?"),
        (
            lambda: simulate(STATUE, PULSE, 0.01, frictions=0.3),
            "did you mean friction?",
        ),
        (lambda: simulate(STATUE, PULSE, 0.01, mu=0.3), "it has body, motion, dt, "),
        (lambda: Block(0.3, 1.2, 180.0, cgheight=0.5), "did you mean cg_height?"),
        (lambda: Stack(plinth=STATUE, statue=STATUE), "it has lower, upper, offset."),
        (lambda: read_motion("x.AT2", units="g"), "did you mean unit?"),
    ],
)
def test_a_wrong_keyword_is_answered_with_the_right_one(call, sentence):
    with pytest.raises(TypeError) as caught:
        call()
    assert isinstance(caught.value, InputError)
    assert sentence in str(caught.value)


def test_a_file_name_in_place_of_a_motion_is_answered_with_how_to_read_it():
    motion = "records/Kobe.dat"
    for call in (
        lambda: simulate(STATUE, motion),
        lambda: overturns(STATUE, motion),
        lambda: overturns(STATUE, [motion, motion], 0.01),
        lambda: find_thresholds(
            STATUE, motion, highest=8.0, tolerance=0.1, narrowest_resurrection=0.5
        ),
    ):
        with pytest.raises(InputError, match=r"rockfrag\.read_motion") as caught:
            call()
        assert motion in str(caught.value)


@pytest.mark.parametrize("body", [STATUE, STACK])
@pytest.mark.parametrize("peak", [0.26, 2.0])
def test_accelerations_in_g_are_warned_of_by_what_they_would_lift(body, peak):
    with pytest.warns(
        UnitWarning, match=r"less than the 2\.45 m/s² that start rocking"
    ):
        assert not simulate(body, peak * PULSE, 0.01).overturned
    with pytest.warns(UnitWarning, match=r"multiply it by 9\.81"):
        overturns([body], [peak * PULSE], 0.01, [0.5, 1.0])


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(
    "call",
    [
        lambda: simulate(STATUE, 2.5 * PULSE, 0.01),
        lambda: overturns(STATUE, PULSE, 0.01, [1.0, 3.0]),
        # its unit is known
        lambda: simulate(STATUE, Motion(PULSE, 0.01)),
        lambda: overturns(STATUE, Motion(PULSE, 0.01)),
        # in g it would lift nothing either
        *(lambda f=f: simulate(STATUE, f * PULSE, 0.01) for f in (0.2, 0.0)),
        lambda: find_thresholds(
            STATUE, PULSE, 0.01, highest=8.0, tolerance=0.01, narrowest_resurrection=0.5
        ),
    ],
)
def test_what_is_in_the_right_unit_is_not_doubted(call):
    call()


def test_a_block_in_centimetres_or_millimetres_is_doubted():
    with pytest.warns(
        UnlikelyBlock, match="42 m wide, 165 m high and of 410 kg .* give metres"
    ):
        Block(42, 165, 410)
    with pytest.warns(UnlikelyBlock, match="lighter than air"):
        Block(200.0, 800.0, 50.0)
    # a wall of 50 t: a planar block does not say how deep it is
    assert Block(0.2, 0.8, 50_000.0).mass == 50_000.0


def test_an_inertia_or_a_centre_of_gravity_of_another_body_is_doubted_or_refused():
    with pytest.warns(UnlikelyBlock, match="radius of gyration"):
        Block(0.2, 0.8, 50.0, inertia=1e-9)
    with pytest.raises(
        InputError, match=r"cg_height 2 m is above the top, .* height 1\.65 m"
    ):
        Block(0.42, 1.65, 410, cg_height=2)


SECONDS = np.arange(0, 5, 0.01)
MOTION = Motion(
    3.5 * np.sin(np.pi * SECONDS / 5) * np.sin(2 * np.pi * SECONDS), 0.01, "burst"
)


def test_a_motion_shows_acceleration_velocity_and_displacement() -> None:
    constant = Motion(np.full(201, 2.0), 0.01).plot()
    assert [panel.get_ylabel() for panel in constant.axes] == [
        "Acceleration [g]",
        "Velocity [cm/s]",
        "Displacement [cm]",
    ]
    last = [panel.lines[1].get_ydata()[-1] for panel in constant.axes]
    # a, a t and a t²/2 after 2 s
    assert last == pytest.approx([2.0 / GRAVITY, 400.0, 400.0])


def test_a_motion_is_drawn_as_it_is_between_its_samples() -> None:
    # t³/6 of an acceleration t, which a velocity taken for linear between samples would miss by an eighth
    drawn = Motion(np.array([0.0, 1.0, 2.0]), 1.0).plot().axes[2].lines[1].get_ydata()
    assert drawn == pytest.approx([0.0, 100 / 6, 800 / 6])


def test_a_response_shows_rotations_over_the_critical_angle_and_every_impact() -> None:
    response = simulate(STACK, MOTION.acceleration, MOTION.dt)
    ground, rotation, _ = response.plot().axes
    lines = {line.get_label(): line for line in rotation.lines}
    statue = np.asarray(lines["upper body"].get_ydata())
    assert statue == pytest.approx(response.theta[:, 1] / STATUE.alpha)
    assert (
        len(lines["impact"].get_xdata())
        == (response.contact_events["kind"] == "impact").sum()
        > 0
    )
    assert ground.get_ylabel() == "Ground [g]"
