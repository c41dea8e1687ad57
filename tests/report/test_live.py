"""The element of a page that carries the simulation: what it holds, and what it shows without scripts."""

import base64
import json
import math
import re
from pathlib import Path

import numpy as np
import pytest

from rockfrag import Block, Column, Stack, overturns, simulate
from rockfrag.base.errors import InputError
from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.report.live import (
    MOST_SAMPLES,
    carried,
    frames_svg,
    live_kernel,
    live_texts,
    outlines,
    swept,
)
from rockfrag.report.live.live_space import Standing, live_in_space
from rockfrag.report.play_page import MOST_SAMPLES as MOST_PLAYED
from rockfrag.report.play_page import write_play_page
from rockfrag.simulation.options import system_of
from rockfrag.study.holding import held_as_stated
from rockfrag.system.system import turned_about_vertical
from rockfrag.words.catalogue import catalogue

from ..conftest import wave as motion

STATUE = Block(0.3, 1.2, 110.0)
BODIES = {
    "figure": STATUE.system(),
    "figure </script> on plinth": Stack(Block(0.5, 0.6, 350.0), STATUE).system(),
}


def data_of(html: str) -> dict:
    return json.loads(re.search(r'id="live-data">(.*?)</script>', html, re.DOTALL)[1])


def test_the_page_carries_motions_to_the_last_bit_and_bodies_as_given():
    html = live_kernel(BODIES, [motion("</script><b>")])
    assert html.count("</script>") == 2 and "<b>" not in html
    data = data_of(html)
    samples = np.frombuffer(base64.b64decode(data["motions"][0]["samples"]))
    assert samples.tobytes() == motion().acceleration.tobytes()
    assert [body["name"] for body in data["bodies"]] == list(BODIES)
    assert data["bodies"][1]["pedestal"]["width"] == 0.5
    assert data["bodies"][0]["pedestal"] is None


def test_bodies_in_space_stand_in_a_small_page_with_both_components():
    vase, box = (
        Block(0.3, 1.0, 90.0, round=True),
        Block(0.3, 1.2, 110.0, depth=0.4, cg_offset=0.02),
    )
    bodies = {"a </script> vase": Standing(vase.system(), Block(0.5, 0.6, 350.0))}
    bodies["turned"] = Standing(turned_about_vertical(box.system(), 30.0))
    both = GroundMotion(motion(), motion("other"))
    html = live_in_space(bodies, [both] * 100, ["the drums"])
    assert html.count("</script>") == 2
    assert "not here: the drums." in html and "The pedestal stays" in html
    data = data_of(html)
    sizes = data["bodies"][1]["sizes"]
    assert [sizes[key] for key in ("width", "depth", "cgOffset")] == pytest.approx(
        [0.3, 0.4, 0.02]
    )
    assert sizes["turn"] == pytest.approx(math.radians(30))
    assert len(data["motions"]) == 50
    assert data["motions"][0]["peak_g"] == pytest.approx(motion().pga / 9.81)
    # what the simulation takes of the page
    assert (
        len(live_in_space(bodies, [both])) - len(data["motions"][0]["samples"]) * 6400
        < 130_000
    )


def test_what_the_kernel_of_the_page_does_not_know_is_left_out_by_name():
    held = system_of(STATUE, restitution=0.9)
    slippery = system_of(STATUE, friction=0.4)
    drum = Column((Block(0.5, 0.3, 150.0), Block(0.4, 0.3, 100.0), STATUE)).system()
    others = {"measured": held, "slippery": slippery, "drums": drum}
    html = live_kernel({**BODIES, **others}, [motion()])
    assert [body["name"] for body in data_of(html)["bodies"]] == list(BODIES)
    assert "and so not: measured, slippery, drums." in html
    assert live_kernel({"measured": held}, [motion()]) == ""


def test_the_outcomes_are_those_of_a_table_or_are_tried():
    item = motion()
    table = swept({"figure": STATUE.system()}, [item])
    scales = table["amplitude_g"].to_numpy() * 9.81 / item.pga
    fell = overturns(
        [STATUE], [item.acceleration], [item.dt], scales
    ).overturned.ravel()
    assert table["overturned"].to_numpy(dtype=bool).tolist() == fell.tolist()
    assert 0 < fell.sum() < fell.size
    table["overturned"] = table["amplitude_g"] > 0.7
    data = data_of(live_kernel({"figure": STATUE.system()}, [item], table))
    assert data["start"]["body"] == 0
    assert data["start"]["amplitude"] == pytest.approx(0.7, rel=0.03)
    expected = "".join("1" if g > 0.7 else "0" for g in data["amplitudes"])
    assert data["outcomes"][0][0] == expected


def test_a_page_carries_no_more_motions_than_it_has_room_for():
    many = [motion(f"wave {number}", 3000) for number in range(40)]
    assert sum(item.acceleration.size for item in carried(many)) <= MOST_SAMPLES
    assert len(carried([motion("long", 2 * MOST_SAMPLES)])) == 1


def drawn(system, theta):
    """Outlines of bodies that are let go at rotations."""
    response = simulate(system, np.zeros(2), 0.01, theta0=theta)
    return outlines(system, response.position[0], response.theta[0])


def test_a_block_is_drawn_on_the_edge_on_which_it_rocks():
    (corners,) = drawn(STATUE.system(), -0.2)
    assert min(corners, key=lambda item: item[1]) == pytest.approx(
        (-0.15, 0), abs=1e-12
    )
    for a, b, length in zip(corners, corners[1:], (0.3, 1.2, 0.3), strict=False):
        assert math.dist(a, b) == pytest.approx(length)


@pytest.mark.parametrize("theta", [(0.1, 0.3), (0.1, -0.2), (0.0, 0.2)])
def test_a_statue_is_drawn_on_its_pedestal(theta: tuple[float, float]):
    """The corner on which it rocks is on the pedestal's top, and no corner is below it."""
    stack = BODIES["figure </script> on plinth"]
    pedestal, statue = map(np.array, drawn(stack, theta))
    along, corners = pedestal[2] - pedestal[3], statue - pedestal[3]
    heights = [(along[0] * y - along[1] * x) / math.hypot(*along) for x, y in corners]
    assert min(heights) == pytest.approx(0, abs=1e-12)


def test_frames_say_what_becomes_of_the_body():
    item = motion()
    drawing, words = frames_svg(STATUE.system(), item, [0.05, 0.5, 2.0])
    assert "at 0.050 g it stays at rest" in words
    assert drawing.count("<polygon") == 3
    assert "overturns at" in words or "rocks to" in words


def test_the_played_page_is_small_and_the_same_every_time(tmp_path: Path):
    item = motion(samples=MOST_PLAYED)
    for name in ("a.html", "b.html"):
        write_play_page(BODIES["figure"], item, tmp_path / name)
    assert (tmp_path / "a.html").read_bytes() == (tmp_path / "b.html").read_bytes()
    assert (tmp_path / "a.html").stat().st_size < 400_000
    with pytest.raises(InputError, match="more than the"):
        write_play_page(STATUE, motion(samples=MOST_PLAYED + 1), tmp_path / "c.html")
    with pytest.raises(InputError, match="zero throughout"):
        write_play_page(
            STATUE, Motion(np.zeros(100), 0.01, "still", {}), tmp_path / "c.html"
        )


HELD_IN_SPACE = Block(0.3, 1.2, 110.0, depth=0.4)
NOT_PLAYED = {
    "wall": (STATUE, {"wall_m": 0.02}, "it has a wall, and"),
    "wax": (STATUE, {"putty_n": 90.0}, "it has a bond, and"),
    "isolator": (STATUE, {"isolator": {"mass_kg": 9.0}}, "it has an isolator, and"),
    "casters": (STATUE, {"casters": "free"}, "it has friction, and"),
    "wax in space": (HELD_IN_SPACE, {"putty_n": 90.0}, "it has a bond, and"),
    "casters in space": (HELD_IN_SPACE, {"casters": "free"}, "it has friction, and"),
    "both in space": (
        HELD_IN_SPACE,
        {"wall_m": 0.02, "cord_n_m": 1e5},
        "it has a wall and a tie, and",
    ),
}


@pytest.mark.parametrize("name", NOT_PLAYED)
def test_a_page_shows_no_free_body_beside_the_numbers_of_a_held_one(
    tmp_path: Path, name: str
):
    """In space the view was of the free body; in the plane the sentence spoke of too many bodies."""
    block, stated, said = NOT_PLAYED[name]
    held, shaking = held_as_stated(block.system(), stated), motion()
    if not held.planar:
        shaking = GroundMotion(motion(), motion("other"))
    with pytest.raises(InputError) as refused:
        write_play_page(held, shaking, tmp_path / "held.html")
    assert str(refused.value) == (
        f"body: {said} a page does not simulate that; leave it out, or use rockfrag simulate."
    )
    write_play_page(block, shaking, tmp_path / "free.html")


def test_a_page_refuses_what_no_page_knows_by_its_own_reason(tmp_path: Path):
    three = Column((Block(0.5, 0.3, 150.0), Block(0.4, 0.3, 100.0), STATUE))
    with pytest.raises(InputError, match="--pedestal: a page simulates two bodies"):
        write_play_page(three, motion(), tmp_path / "a.html")
    measured = system_of(STATUE, restitution=0.9)
    with pytest.raises(InputError, match="it has a measured restitution, and"):
        write_play_page(measured, motion(), tmp_path / "a.html")


def test_the_live_part_is_in_the_language_of_its_page():
    italian = live_kernel(BODIES, [motion()], texts=catalogue("it"))
    assert "Provi: simuli in questa pagina" in italian
    english = live_texts(catalogue())
    left = [text for text in english.values() if len(text) > 12 and text in italian]
    assert not left
    assert set(live_texts(catalogue("it"))) == set(english)
