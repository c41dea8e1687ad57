"""What a user asks of the engine in space."""

import math

import numpy as np
import pandas as pd
import pytest

from rockfrag import find_thresholds, overturns, simulate
from rockfrag.base.errors import InputError
from rockfrag.base.units import GRAVITY
from rockfrag.cli.main import main
from rockfrag.engines.contract import Case, Request
from rockfrag.engines.spatial import body as bodies
from rockfrag.engines.spatial.body import kernel_body
from rockfrag.engines.spatial.engine import ENGINE, run_case
from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.report.live.live_space import AMPLITUDES_G
from rockfrag.simulation.parquet import stream_histories, stream_overturns
from rockfrag.system import Block, Bond, Contact, Stack, System, Wall, as_system, hold
from rockfrag.system.system import box, cylinder
from rockfrag.words.sentences import number

from .samples import DT, synthetic_motion


def ground_motion(seed, peak_g):
    x, y, z = (synthetic_motion(np.random.default_rng(seed), 3) * peak_g).T
    return GroundMotion(Motion(x, DT), Motion(y, DT), Motion(z, DT))


def lone(body):
    return System((body,), (Contact(),))


BOX = lone(box((0.35, 0.35, 1.2), 300.0, None, (0, 0, 0.6)))
ROUND = lone(cylinder(0.3, 1.0, 100.0, None, (0, 0, 0.5)))


def test_outcomes_do_not_depend_on_threads_or_on_what_else_is_asked():
    motions = [ground_motion(seed, 1.0) for seed in range(3)]
    scales = [0.1, 0.35, 0.6]
    first = overturns([BOX, ROUND], motions, scales=scales)
    second = overturns([ROUND, BOX], motions[::-1], scales=scales[::-1], threads=2)
    for name in ("overturned", "peak_rotation", "turn", "walk", "impacts", "fell_over"):
        other = np.flip(getattr(second, name), axis=(0, 1, 2))
        np.testing.assert_array_equal(getattr(first, name), other)
    assert 0 < first.overturned.sum() < first.overturned.size
    assert set(first.table("bodies").columns) >= {
        "turn_rad",
        "walk_m",
        "fall_direction_rad",
    }


def test_outcomes_say_over_which_edge_or_vertex_each_body_fell_and_a_file_keeps_it(
    tmp_path,
):
    motions, scales = [ground_motion(seed, 1.0) for seed in range(3)], [0.1, 0.6]
    table = overturns([BOX, ROUND], motions, scales=scales).table("bodies")
    fell = table["fell_over"]
    alone = [
        ENGINE.history(Case((BOX, ROUND)[i], motions[j], scale)).outcome.fell_over
        for i, j, scale in zip(
            table["system"], table["motion"], table["scale"], strict=True
        )
    ]
    assert fell.tolist() == alone
    assert (fell[table["system"] == 0].str.match(r"edge \d-\d$|vertex \d$|$")).all()
    assert set(fell[table["system"] == 1]) == {"", "rim"}
    assert ((fell == "") == table["fall_direction_rad"].isna()).all()
    file = tmp_path / "bodies.parquet"
    stream_overturns([BOX, ROUND], motions, None, scales, file, table="bodies")
    assert pd.read_parquet(file)["fell_over"].tolist() == alone


def test_a_round_body_falls_before_a_box_of_its_slenderness():
    motions = [ground_motion(seed, 1.0) for seed in range(10, 16)]
    scales = [0.3, 0.4, 0.5]
    box_as_wide = lone(box((0.3, 0.3, 1.0), 100.0, None, (0, 0, 0.5)))
    fallen = overturns(
        [ROUND, box_as_wide], motions, scales=scales, threads=2
    ).overturned
    assert fallen[0].sum() > fallen[1].sum()


@pytest.mark.parametrize(
    ("peak_g", "said"), [(0.2, "Does not fall"), (0.6, "Falls over")]
)
def test_a_response_draws_the_path_of_its_axis_and_its_plan(peak_g, said):
    response = simulate(BOX, ground_motion(2, peak_g))
    assert response.history.tilt_rad.max() <= response.outcome.peak_tilt + 1e-9
    assert abs(response.outcome.residual) < 1e-6
    axis, plan = response.plot("A box").axes
    assert axis.get_title(loc="left").startswith(said)
    path = axis.get_lines()[0].get_xydata()
    np.testing.assert_allclose(np.hypot(*path.T), response.history.tilt_rad, atol=1e-12)
    stood = plan.get_lines()[0].get_xydata()
    assert np.ptp(stood, axis=0) == pytest.approx([0.35, 0.35])


def test_a_spread_moves_vertices_and_turns_the_body_by_no_more_than_it_says():
    other, turned = bodies.perturbed(BOX, 0.01, np.random.default_rng([0, 0, 0]))
    moved = np.array(other.bodies[0].base.vertices) - np.array(
        BOX.bodies[0].base.vertices
    )
    assert 0 < np.abs(moved).max() <= 0.0035
    assert 0 < abs(turned) <= 0.01
    motion = ground_motion(1, 0.4)
    found = overturns([BOX], [motion], spread=0.01)
    with pytest.raises(InputError, match="give its depth"):
        overturns([Block(0.3, 1.0, 100.0)], [motion.x], spread=0.01)
    body = kernel_body(other)
    start = bodies.standing(body, turned)
    expected, _ = run_case(body, motion.accelerations, DT, start=start)
    assert found.turn[0, 0, 0, 0] == expected.turn
    assert found.turn[0, 0, 0, 0] != overturns([BOX], [motion]).turn[0, 0, 0, 0]


@pytest.mark.parametrize("direction", [0.0, 0.5 * math.pi, 0.7])
def test_a_spread_leaves_the_gap_to_a_wall_and_pads_under_the_base(direction):
    """Also of a body at its wall: it begins as far from it as it stood, moved and turned, or further."""
    half = 0.35 / 2
    reach = half * (abs(math.cos(direction)) + abs(math.sin(direction)))
    held = hold(BOX, Wall(reach, direction), bonds=Bond(300.0, 300.0, half))
    for seed in range(8):
        rng = np.random.default_rng(seed)
        near, turned = bodies.perturbed(held, 0.01, rng)
        vertices = np.array(
            [*near.bodies[0].base.vertices, *BOX.bodies[0].face.vertices]
        )
        towards = np.array([math.cos(direction - turned), math.sin(direction - turned)])
        (wall,) = near.constraints
        assert wall.distance >= (vertices @ towards).max() - 1e-12
        assert wall.distance <= reach + 0.01 * 0.35 * 4
        kernel_body(near)
    found = overturns(held, ground_motion(1, 0.4), spread=0.01)
    assert found.overturned.shape == (1, 1, 1)


def test_a_history_has_the_spread_that_its_request_asks_for():
    motion = ground_motion(1, 0.4)
    first, other = (
        overturns(BOX, motion, spread=0.01, seed=seed).turn.item() for seed in (3, 4)
    )
    request = Request(history=True, spread=0.01, seed=3)
    history = ENGINE.history(Case(BOX, motion, 1.0, request))
    assert history.outcome.turn == first != other


BLOCKS = [Block(0.35, 1.2, 300.0, depth=0.35), Block(0.3, 1.0, 100.0, round=True)]


@pytest.mark.filterwarnings("error")
def test_the_usual_doors_answer_in_space_under_two_components():
    motions = [ground_motion(seed, 1.0) for seed in range(2)]
    scales = [0.2, 0.4, 0.6]
    found = overturns(BLOCKS, motions, scales=scales)
    assert set(found.engines) == {"space"} and 0 < found.overturned.mean() < 1
    assert (
        simulate(BLOCKS[0], motions[0]).overturned
        == overturns(BLOCKS[0], motions[0]).overturned
    )
    thresholds = find_thresholds(
        BLOCKS[1],
        motions[0],
        highest=0.6,
        tolerance=0.01,
        narrowest_resurrection=0.2,
    )
    first = float(thresholds.table.first_overturning[0])
    either_side = overturns(BLOCKS[1], motions[0], scales=[first - 0.011, first])
    assert either_side.overturned.tolist() == [[[False, True]]]


def test_under_one_component_a_block_with_a_depth_is_a_planar_one():
    motion = Motion(ground_motion(0, 0.5).x.acceleration, DT)
    planar, deep = (Block(0.35, 1.2, 300.0, depth=depth) for depth in (None, 0.35))
    found = overturns([planar, deep], motion)
    assert found.peak_rotation[0] == found.peak_rotation[1]
    assert np.isnan(found.turn).all()


def test_planar_bodies_and_stacks_are_refused_in_one_sentence():
    with pytest.raises(InputError, match="give its depth"):
        overturns([as_system(Block(0.3, 1.0, 100.0))], [ground_motion(0, 0.3)])


def test_a_base_that_leans_is_refused_in_space_and_taken_in_the_plane():
    leans = Block(0.3, 1.0, 100.0, lean=0.05, depth=0.35)
    along_x = ground_motion(0, 0.3).x
    with pytest.raises(InputError, match="an uneven base in space"):
        overturns([leans], [ground_motion(0, 0.3)])
    upright = overturns([Block(0.3, 1.0, 100.0, depth=0.35)], along_x)
    assert overturns([leans], along_x).peak_rotation != upright.peak_rotation


def test_histories_in_space_are_streamed_as_simulate_tells_them(tmp_path):
    motions, scales, path = [ground_motion(0, 1.0)], [0.2, 0.5], tmp_path / "h.parquet"
    assert stream_histories(BLOCKS, motions, None, scales, path) == 4
    found = pd.read_parquet(path)
    for i, block in enumerate(BLOCKS):
        for scale in scales:
            case = Case(as_system(block), motions[0], scale)
            rows = found[(found.system == i) & (found.scale == scale)]
            expected = ENGINE.history(case).history
            given = rows[list(expected.columns)].reset_index(drop=True)
            pd.testing.assert_frame_equal(given, expected, check_exact=True)
            assert (rows.body == 1).all()
    # a stack under one component is planar, and its file tells nothing of space
    one = GroundMotion(Motion(motions[0].x.acceleration, DT))
    stack = Stack(Block(0.6, 0.3, 100.0), Block(0.3, 0.9, 100.0))
    stream_histories([stack], [one], None, scales, path)
    assert "theta_rad" in pd.read_parquet(path) and "x_m" not in pd.read_parquet(path)


@pytest.fixture
def two_files(tmp_path):
    """Both components of a synthetic motion, which no rounding turns round, as texts of seconds and g."""
    motion = ground_motion(2, 0.9)
    for name, item in (("x", motion.x), ("y", motion.y)):
        table = np.column_stack([item.time, item.acceleration / GRAVITY])
        np.savetxt(tmp_path / f"{name}.txt", table, "%.9f")
    return [str(tmp_path / name) for name in ("x.txt", "y.txt")]


def test_the_command_line_shakes_a_body_by_both_components(two_files, tmp_path, capsys):
    first, second = two_files
    case = [
        "simulate",
        first,
        "--unit",
        "g",
        "--second",
        second,
        "--body",
        "0.35",
        "1.2",
        "300",
    ]
    assert main([*case, "--depth", "35cm", "--plot", str(tmp_path / "box.svg")]) == 0
    said = capsys.readouterr().out
    motion = ground_motion(2, 0.9)
    outcome = simulate(BLOCKS[0], GroundMotion(motion.x, motion.y)).outcome
    assert f"overturned over {outcome.fell_over}" in said
    assert "turned about the vertical" in said
    assert (tmp_path / "box.svg").stat().st_size > 1000
    assert main([*case, "--round"]) == 0
    assert "overturned over rim" in capsys.readouterr().out


def test_the_played_page_shows_a_body_in_space_and_says_when_it_falls(
    two_files, tmp_path, capsys
):
    first, second = two_files
    page = tmp_path / "page.html"
    case = [
        "play",
        first,
        "--unit",
        "g",
        "--second",
        second,
        "--body",
        "0.35",
        "1.2",
        "300",
    ]
    output = ["--output", str(page)]
    motion = ground_motion(2, 0.6)
    ground = GroundMotion(motion.x, motion.y)
    levels = AMPLITUDES_G * np.array(GRAVITY / np.sqrt(motion.x.pga * motion.y.pga))
    for base, block, name in (
        (["--depth", "45cm"], Block(0.35, 1.2, 300.0, depth=0.45), "35 × 45 × 120 cm"),
        (["--round"], Block(0.35, 1.2, 300.0, round=True), "round, 35 × 120 cm"),
    ):
        assert main([*case, *base, *output]) == 0
        # numbers and their units are held together by a no-break space
        text = page.read_text(encoding="utf-8").replace("\u00a0", " ")
        fell = overturns([block], [ground], scales=levels).overturned.ravel()
        assert f"<h1>{name} under x</h1>" in text
        assert (
            f"first overturns at a peak of {number(AMPLITUDES_G[fell.argmax()], 3)} g"
            in text
        )
        words = (
            "overturns it"
            if simulate(block, ground).overturned
            else "does not overturn it"
        )
        assert f"as recorded {words}" in text
        assert page.stat().st_size < 700_000
        assert 'src="http' not in text
    page.unlink()
    capsys.readouterr()
    np.savetxt(
        tmp_path / "still.txt", np.column_stack([motion.x.time, 0 * motion.x.time])
    )
    for wrong, word in (
        ([*case], "--depth or is --round"),
        ([*case, "--depth", "wide"], "--depth: expected a length"),
        ([*case, "--round", "--pedestal", "1", "1"], "leave out --pedestal"),
        ([*case[:4], *case[6:], "--round"], "give --second"),
        (
            [*case, "--round", "--second", str(tmp_path / "still.txt")],
            "zero throughout",
        ),
        ([*case, "--round", "--second", "absent.txt"], "absent.txt"),
    ):
        assert main([*wrong, *output]) == 2
        said = capsys.readouterr().err
        assert word in said
        assert said.count("\n") == 1
    assert not page.exists()
