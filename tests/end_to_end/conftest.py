"""Pages to look at, and browsers to look with."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from rockfrag import Block, Stack
from rockfrag.assess.motions import MotionSet
from rockfrag.report.play_page import write_play_page

from ..conftest import wave
from ..own_kinds import cabinet as cabinet
from .browsers import BROWSERS, Browser
from .studies import STUDIES, run


@pytest.fixture(scope="session", params=list(BROWSERS))
def browser(request: pytest.FixtureRequest) -> Iterator[Browser]:
    kind, program = BROWSERS[request.param]
    if program is None:
        pytest.skip(f"{request.param} is not installed")
    with kind() as item:
        yield item


@pytest.fixture(scope="session")
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The report of a study with pairs, on a floor of a building."""
    study = STUDIES["with and without a plinth on one upper floor"]
    return run(study, tmp_path_factory.mktemp("study")) / "report.html"


@pytest.fixture(scope="session")
def motions(made_motions) -> MotionSet:
    """Twelve made motions of six records with both components."""
    made = made_motions(12)
    return MotionSet(
        made, made, tuple((i, i + 1) for i in range(0, 12, 2)), "12 made motions"
    )


@pytest.fixture(scope="session")
def play_page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page of one stack under one record."""
    path = tmp_path_factory.mktemp("play") / "play.html"
    body = Stack(Block(0.5, 0.6, 350.0), Block(0.3, 1.2, 110.0))
    write_play_page(body, wave(), path)
    return path
