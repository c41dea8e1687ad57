"""Parts of a report: findings, figures, sections, and the results that they are made of.

In: the tables of a study (:class:`Results`). Out: :class:`Section`, :class:`Finding` and :class:`Answer`, which
:class:`rockfrag.report.page.Page` lays out; a part of the report is a function of the results that returns its
section. Docs: ``docs/report.md``, ``CONTRIBUTING.md`` ("How to add a section of the report").
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
from markupsafe import Markup
from matplotlib.figure import Figure
from numpy.typing import NDArray

from rockfrag.records.motion import Motion, read_motion_metadata, read_motion_set
from rockfrag.shaketable.definitions import DEFINITION, read_swept

if TYPE_CHECKING:
    from rockfrag.study.study import Study

MOST_MOTIONS = 50
"""Motions of which a report shows every outcome; of a larger study it shows the first."""


@dataclass(frozen=True)
class FigureSpec:
    """One figure."""

    name: str  # Name of its files, of letters, digits, ``-``, ``_`` and ``.``
    alt: str  # What it shows, for readers who do not see it
    caption: str  # What stands below it
    draw: Callable[[], Figure]  # Draws it


@dataclass(frozen=True)
class Finding:
    """One finding."""

    headline: str  # What was found, a sentence without its full stop
    text: str = ""  # What it means, in sentences that stand open beside it
    numbers: str = ""  # The numbers behind it, in sentences that a click opens

    @property
    def shown(self) -> str:
        """What stands open on the page."""
        return f"{self.headline}. {self.text}".strip()

    @property
    def said(self) -> str:
        """All of it in a row."""
        return f"{self.shown} {self.numbers}".strip()


@dataclass(frozen=True)
class Answer:
    """What stands first on a page: the question, and what was found."""

    asked: str  # The question, in a sentence
    sentences: Sequence[Finding]  # What was found, most important first; three at most
    figure: FigureSpec | None = None  # The one figure that shows it
    advice: Sequence[str] = ()  # What to do, each in a sentence
    # What the result rests on, and what could change it, each in a sentence or two
    rests_on: Sequence[str] = ()
    could_change: Sequence[str] = ()
    # What a keeper of the objects would ask, each with the anchor of the chapter that answers it
    questions: Sequence[tuple[str, str]] = ()


@dataclass(frozen=True)
class Section:
    """A chapter of the page, which opens on demand."""

    # Its place and its heading
    anchor: str
    title: str
    # What it found, in one short sentence that stands on the page before it is opened
    message: str
    paragraphs: Sequence[str] = ()  # How to read it
    parts: Sequence[Markup | FigureSpec] = ()  # Its figures, and the tables behind them


def chapter(
    anchor: str,
    title: str,
    found: Finding,
    paragraphs: Sequence[str] = (),
    parts: Sequence[Markup | FigureSpec] = (),
) -> Section:
    """Chapter whose message is the headline of a finding, with the sentences behind it first.

    Parameters
    ----------
    anchor, title : its place and its heading
    found : the finding
    paragraphs, parts : further paragraphs, and figures and tables

    Returns
    -------
    The :class:`Section`.
    """
    words = [found.text, found.numbers, *paragraphs]
    return Section(
        anchor, title, f"{found.headline}.", [text for text in words if text], parts
    )


def joined(*sentences: str) -> str:
    """Sentences that are not empty, in a row."""
    return " ".join(filter(None, sentences))


class Results:
    """The results of a study in a folder, read when asked for."""

    def __init__(self, study: "Study", folder: Path) -> None:
        self.study = study
        self.folder = folder
        self._tables: dict[str, pd.DataFrame] = {}

    def table(self, name: str) -> pd.DataFrame:
        """Return a table by its name in the folder, such as ``pedestal/effects``."""
        if name not in self._tables:
            self._tables[name] = pd.read_parquet(self.folder / f"{name}.parquet")
        return self._tables[name]

    @property
    def tests(self) -> pd.DataFrame:
        """Tests as the laboratory's protocol reads them."""
        tests = self.table("tests")
        return tests[tests["definition"] == DEFINITION]

    @cached_property
    def records(self) -> Sequence[Mapping[str, Any]]:
        """What is known of each ground motion."""
        return read_motion_metadata(self.folder / "motions" / "ground.parquet")

    @cached_property
    def ground(self) -> Sequence[Motion]:
        """Ground motions, no more than a page shows."""
        return read_motion_set(
            self.folder / "motions" / "ground.parquet", most=MOST_MOTIONS
        )

    @cached_property
    def floors(self) -> Sequence[Motion]:
        """Motions of every floor, which shake the bodies, no more than a page shows."""
        return read_motion_set(
            self.folder / "motions" / "floors.parquet", most=MOST_MOTIONS
        )

    @cached_property
    def outcomes(self) -> pd.DataFrame:
        """Outcomes of every configuration at every amplitude, under no more motions than a page shows."""
        parts, jobs = [], range(self.study.ida_jobs)
        for configuration in self.study.configurations:
            files = (
                self.folder / self.study.ida_file(configuration, job) for job in jobs
            )
            shown = 0
            for part in read_swept(files):
                parts.append(part.rows(["configuration", "object", "motion"]))
                shown += len(part.about)
                if shown >= MOST_MOTIONS:
                    break
        return pd.concat(parts, ignore_index=True)

    @cached_property
    def least_gravity_ratio(self) -> NDArray[np.float64]:
        """Least weight over that on a ground at rest, of every history of a study with vertical motion."""
        name = "minimum_gravity_ratio"
        paths = [self.folder / path for path in self.study.ida_files]
        return np.concatenate(
            [pd.read_parquet(path, columns=[name])[name] for path in paths]
        )

    @property
    def objects(self) -> list[str]:
        """Names of the objects tested, in the study's order."""
        return list(dict.fromkeys(each.names[-1] for each in self.study.configurations))

    @property
    def level(self) -> str:
        """Confidence of the intervals of curves, in words."""
        return f"{100 * self.study.fragility.confidence:g} %"


Part = Callable[[Results], Section | None]
"""A part of the report: returns its section, None where it is not asked for or has nothing to show."""
