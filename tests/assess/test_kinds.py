"""A kind of standing is a class and its texts: nothing else knows it, from the settings to the page."""

import json
import shutil
from collections.abc import Mapping
from dataclasses import replace

import pytest

from rockfrag.assess import standing
from rockfrag.assess.answer import assess_with
from rockfrag.assess.assumed import assume
from rockfrag.assess.findings import details_of, lines_of
from rockfrag.assess.page import page_of
from rockfrag.assess.standing import KINDS, make_standing
from rockfrag.assess.standing.contract import Standing
from rockfrag.assess.standing.dimensions import on_foundation, sizes_of
from rockfrag.system.blocks import Block
from rockfrag.words import catalogue as catalogues
from rockfrag.words.catalogue import TEXTS
from rockfrag.words.findings import finding

from .conftest import asked

SIZES = {"width": "30 cm", "height": "1 m"}


@pytest.mark.parametrize(
    ("settings", "kind"),
    [
        ({}, "Planar"),
        ({"depth": "40 cm"}, "Box"),
        ({"round": True}, "Round"),
        ({"round": True, "depth": "30 cm"}, "Round"),
    ],
)
def test_settings_are_of_the_first_kind_that_takes_them(settings, kind):
    made = asked(**SIZES, **settings).objects
    assert type(made).__name__ == kind
    # none has more than a handful of fields of its own
    own = set(vars(made)) - set(vars(asked(**SIZES).objects))
    assert len(own) <= 3


class OnFeet(Standing):
    """A narrow kind: an object on feet that stand further in than its sides, by a tenth of its width each."""

    @classmethod
    def takes(cls, settings: Mapping) -> bool:
        return settings.get("name") == "cabinet"

    @classmethod
    def of(cls, settings, folder, under):
        sizes = sizes_of(settings)
        block = replace(sizes.block, width=0.8 * sizes.block.width)
        first = (assume("on_feet"), *sizes.assumed)
        return cls(block, finding("rocks_on_feet"), on_foundation(under, block, first))

    def arrangements(self):
        return {**super().arrangements(), "without_feet": self._lowered()}

    def changes(self):
        return {finding("taking_its_feet_off"): self._lowered(), **super().changes()}

    def _lowered(self) -> Block:
        return replace(self.block, width=self.block.width / 0.8)


NEW = {
    "rocks_on_feet": "It rocks on its feet.",
    "without_feet": "without its feet",
    "taking_its_feet_off": "taking its feet off",
    "assumed_on_feet": "it stands on its feet",
    "why_on_feet": "Its feet stand a tenth of its width further in than its sides.",
}


@pytest.fixture
def cabinet(tmp_path, monkeypatch):
    """A kind that is one class and its texts."""
    folder = tmp_path / "texts"
    shutil.copytree(TEXTS, folder)
    english = json.loads((folder / "en.json").read_text(encoding="utf-8"))
    (folder / "en.json").write_text(json.dumps(english | NEW), encoding="utf-8")
    monkeypatch.setattr(catalogues, "TEXTS", folder)
    monkeypatch.setattr(standing, "KINDS", [OnFeet, *KINDS])


def test_a_kind_added_by_a_class_and_its_texts_runs_to_the_page(cabinet, motions):
    request = asked(name="cabinet", **SIZES, pga="0.3 g", return_period="475")
    assert isinstance(request.objects, OnFeet)
    assert make_standing({"width_m": 0.3, "height_m": 1.0}, None).block.width == 0.3
    found = assess_with(request, motions)
    # statics of its feet: b/h
    assert found.rocks_from == pytest.approx(0.24)
    ways = found.by_arrangement
    assert ways["without_feet"] < ways["on_the_floor"]
    said = " ".join([*lines_of(found), *details_of(found)])
    assert "It rocks on its feet." in said
    assert "it stands on its feet" in said or "more assumptions" in said
    page = page_of(found)
    # in a few words it stands in lists only
    for id in set(NEW) - {"assumed_on_feet"}:
        assert NEW[id].lower() in page.lower(), id
