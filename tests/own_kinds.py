"""Kinds of standing that tests add, as one would: a class each, and their texts."""

import json
import shutil
from collections.abc import Mapping
from dataclasses import replace

import pytest

from rockfrag.assess import standing
from rockfrag.assess.assumed import assume
from rockfrag.assess.core import bodies
from rockfrag.assess.standing import KINDS
from rockfrag.assess.standing.contract import Standing
from rockfrag.assess.standing.declared import Declared, Way
from rockfrag.assess.standing.dimensions import on_foundation, sizes_of
from rockfrag.system.blocks import Block
from rockfrag.words import catalogue as catalogues
from rockfrag.words.catalogue import TEXTS
from rockfrag.words.findings import finding


class OnFeet(Standing):
    """A narrow kind: an object on feet that stand further in than its sides, by a tenth of its width each."""

    option = "on_feet_of_its_own"

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


class OnTwoFeet(Declared):
    """The same by declaration, with a heavy foot."""

    option, assumption, plane_text = "on_two_feet", "on_feet", "rocks_on_feet"
    steps = ((bodies.add_ballast, (0.1,)), (bodies.stretch, (0.8, 1.0, 1.0)))
    others = (
        Way("without_feet", "taking_its_feet_off", ((bodies.stretch, (1.25, 1, 1)),)),
    )


NEW = {
    "on_two_feet": "on two feet",
    "on_feet_of_its_own": "on feet of its own",
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
    monkeypatch.setattr(standing, "KINDS", [OnFeet, OnTwoFeet, *KINDS])
