"""Kinds of things: usual sizes where none were measured, and those that were measured where they were."""

import math
import re
from pathlib import Path

import pytest

from rockfrag import InputError, read_request
from rockfrag.config.schema import read_schema
from rockfrag.system import block_of_kind, kind_named
from rockfrag.system.kinds import KINDS

DOCS = Path(__file__).resolve().parents[2] / "docs"


@pytest.mark.parametrize("name", KINDS)
def test_each_kind_stands_and_can_be_asked_about(name):
    block = block_of_kind(name)
    assert 0 < block.h < block.height
    asked = read_request({"kind": name, "pga": "0.3 g"}).objects.body.blocks[-1]
    assert (asked.width, asked.height) == (block.width, block.height)
    assert asked.mass == pytest.approx(block.mass) and asked.h == pytest.approx(block.h)


def test_what_was_measured_stands_and_the_rest_follows_from_it():
    usual, taller = block_of_kind("bookcase"), block_of_kind("bookcase", height=2.4)
    assert taller.mass / usual.mass == pytest.approx(2.4 / usual.height)
    assert taller.h / 2.4 == pytest.approx(usual.h / usual.height)
    asked = read_request({"kind": "bookcase", "mass": "90 kg", "pga": "0.3 g"})
    assert asked.objects.body.blocks[-1].mass == 90


def test_weights_are_those_of_common_makes():
    """50 l of steel weigh 60 to 80 kg; a metre of shelf bears 20 to 40 kg of books, on five shelves of 0.8 m."""
    assert 60 < block_of_kind("gas-cylinder").mass < 80
    assert 30 + 5 * 0.8 * 20 < block_of_kind("bookcase").mass < 45 + 5 * 0.8 * 40
    assert 400 < block_of_kind("server-rack").mass < 1000
    cylinder = kind_named("gas-cylinder")
    volume = math.pi / 4 * cylinder.width_m**2 * cylinder.height_m
    assert 0.05 < volume < 0.075


def test_a_kind_that_does_not_exist_is_answered_with_those_that_do():
    with pytest.raises(InputError, match="bookcase"):
        kind_named("wardrobe")
    with pytest.raises(InputError, match="it has width"):
        block_of_kind("bust", breadth=0.3)
    known = read_schema("statue")["properties"]["kind"]["enum"]
    assert known == list(KINDS)


def test_the_documented_sizes_weights_and_friction_are_those_of_the_kinds():
    text = (DOCS / "how-to" / "kinds.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| `(\S+)` \| (.+?) \| (\S+) \|", text, re.MULTILINE)
    assert [name for name, *_ in rows] == list(KINDS)
    for name, usual, friction in rows:
        block, kind = block_of_kind(name), kind_named(name)
        sizes = [
            float(size) for size in usual.split(" cm")[0].split(" (")[0].split(" × ")
        ]
        outline = [kind.width_m, kind.depth_m, kind.height_m]
        if len(sizes) == 2:
            del outline[1]
        assert [100 * size for size in outline] == pytest.approx(sizes)
        mass, unit = re.search(r"([\d.]+) (kg|t)\b", usual).groups()
        stated = float(mass) * (1000 if unit == "t" else 1)
        assert block.mass == pytest.approx(stated, abs=50 if unit == "t" else 0.5)
        centre = re.search(r"centre at (\d+) %", usual)
        assert block.h / block.height == pytest.approx(
            float(centre.group(1)) / 100 if centre else 0.5
        )
        assert kind.friction == float(friction)
        assert block.round == ("round" in usual)
