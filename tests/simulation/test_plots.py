"""Figures of results, names in their tables, and calls with arguments in the wrong place."""

import matplotlib.pyplot as plt
import numpy as np
import pytest

import rockfrag
from rockfrag import (
    Block,
    Column,
    InputError,
    Motion,
    Stack,
    find_thresholds,
    overturns,
    response_spectrum,
    rocking_spectrum,
    simulate,
)
from rockfrag.base.units import GRAVITY
from rockfrag.motions import one_sine
from rockfrag.records.sources.fema_p695 import read_set
from rockfrag.simulation.inputs import UnitWarning
from rockfrag.system.blocks import UnlikelyBlock

STATUE, BASE = Block(0.3, 1.2, 180.0), Block(0.6, 0.4, 300.0)
SHORT, LONG = one_sine(1.0, period=0.6), one_sine(1.0, period=1.2)
SCALES = np.linspace(1.5, 9.0, 16)


@pytest.fixture(scope="module")
def outcomes():
    systems = {"venus": STATUE, "venus on its plinth": Stack(BASE, STATUE)}
    return overturns(systems, [SHORT, LONG], scales=SCALES)


def test_tables_name_systems_and_motions(outcomes):
    table = outcomes.table()
    assert set(table["system_name"]) == {"venus", "venus on its plinth"}
    assert set(table["motion_name"]) == {SHORT.name, LONG.name}
    fallen = table.groupby("system_name")["overturned"].sum()
    assert fallen["venus"] == outcomes.overturned[0].sum()
    bodies = outcomes.table("bodies")
    assert (bodies["system_name"] == "venus").sum() == 2 * len(SCALES)
    assert set(overturns(STATUE, SHORT.acceleration, SHORT.dt).table().system_name) == {
        ""
    }


def test_the_figure_of_an_ensemble_shows_each_motion_up_to_its_fall(outcomes):
    figure = outcomes.plot("two statues")
    panels = figure.axes
    assert [panel.get_title(loc="left") for panel in panels[:2]] == [
        "(a) venus",
        "(b) venus on its plinth",
    ]
    lines = {line.get_label(): line for line in panels[0].lines}
    shown = lines[LONG.name].get_ydata()
    expected = outcomes.peak_rotation[0, 1, :, 0]
    np.testing.assert_array_equal(shown, np.where(np.isinf(expected), np.nan, expected))
    peaks_g = SCALES * LONG.pga / GRAVITY
    np.testing.assert_allclose(lines[LONG.name].get_xdata(), peaks_g)
    (fraction,) = panels[2].lines
    # both sines have the same peak, so both are tried at every level
    np.testing.assert_allclose(
        fraction.get_ydata(), outcomes.overturned[0].mean(axis=0)
    )
    plt.close("all")


def test_motions_of_unlike_strength_are_counted_where_most_of_them_were_tried():
    """As recorded they have few levels in common, and the panel was all but empty."""
    unlike = [Motion(k * SHORT.acceleration, SHORT.dt) for k in (0.1, 1.0, 1.2)]
    found = overturns(STATUE, unlike, scales=SCALES)
    _, below = found.plot().axes
    solid, dotted = below.lines
    assert len(solid.get_xdata()) < len(dotted.get_xdata())
    assert dotted.get_ydata().max() == 1.0
    plt.close("all")


def test_the_figure_of_a_rocking_spectrum_marks_blocks_that_overturn():
    spectrum = rocking_spectrum(one_sine(4.0, period=1.0), [2.0, 4.0, 6.0], [0.2, 0.3])
    rotation = spectrum.plot().axes[0]
    lines = {line.get_label(): line for line in rotation.lines}
    standing = np.isfinite(lines["α = 0.2 rad"].get_ydata())
    np.testing.assert_array_equal(standing, ~spectrum.overturned[0])
    crosses = [line for line in rotation.lines if line.get_marker() == "x"]
    assert [len(each.get_xdata()) for each in crosses] == [
        *spectrum.overturned.sum(axis=1)
    ]


def test_the_figure_of_thresholds_leaves_gaps_where_stronger_shaking_is_survived():
    p, alpha = 2.14, 0.25
    radius = 3 * GRAVITY / 4 / p**2
    block = Block(2 * radius * np.sin(alpha), 2 * radius * np.cos(alpha), 100.0)
    time = np.arange(0, 2 * np.pi / (5 * p), 0.001)
    pulse = np.append(alpha * GRAVITY * np.sin(5 * p * time), np.zeros(8000))
    motion = Motion(pulse, 0.001, name="pulse")
    found = find_thresholds(
        {"slab": block},
        motion,
        highest=9.0,
        tolerance=1e-3,
        narrowest_resurrection=0.25,
        restitution=[0.9],
    )
    row = found.table.iloc[0]
    assert (row.body_name, row.motion_name) == ("slab", "pulse")
    bars = found.plot().axes[0].patches
    window = found.resurrections.iloc[0]
    ends = [(bar.get_x(), bar.get_x() + bar.get_width()) for bar in bars]
    peak_g = motion.pga / GRAVITY
    first = (row.first_overturning * peak_g, window.lower * peak_g)
    assert ends[0] == pytest.approx(first)
    assert ends[1] == pytest.approx((window.upper * peak_g, 9.0 * peak_g))


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda: simulate(SHORT, STATUE), "motion: expected a motion, got a Block"),
        (lambda: overturns(SHORT, STATUE), "exchange them|bodies stand before them"),
        (lambda: overturns(SHORT, [SHORT]), "exchange them"),
        (
            lambda: Column(BASE, STATUE),
            r"a list of blocks from below, such as Column\(",
        ),
        (lambda: response_spectrum(SHORT, [1.0], damping=5), "such as 0.05 for 5 %"),
        (lambda: simulate(STATUE, SHORT).plot(3), "title: expected a text"),
        (lambda: overturns(STATUE, SHORT).plot(3), "title: expected a text"),
        (lambda: overturns(STATUE, SHORT).table("nonsense"), "cases, bodies, contacts"),
        (lambda: rockfrag.read_request({"width": "35 cm"}), "height"),
        (lambda: read_set("."), r"rockfrag\.read_motions"),
    ],
)
def test_an_argument_in_the_wrong_place_is_answered_in_a_sentence(call, sentence):
    with pytest.raises(InputError, match=sentence):
        call()


def test_what_is_probably_a_slip_is_warned_of():
    with pytest.warns(UnlikelyBlock, match="upside down"):
        Stack(Block(0.3, 1.2, 180.0), Block(0.6, 0.8, 700.0))
    with pytest.warns(UnitWarning, match="negative factor"):
        overturns(STATUE, SHORT, scales=[-1.0, 1.0])


def test_a_name_that_is_nearly_right_is_answered_with_the_right_one():
    with pytest.raises(AttributeError, match="did you mean find_thresholds"):
        rockfrag.find_treshold  # noqa: B018
