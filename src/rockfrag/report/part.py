"""What a report is made of: parts, each with its words, tables and figures in one file of ``report/sections``."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from markupsafe import Markup
from matplotlib.figure import Figure
from numpy.typing import NDArray

from rockfrag.records.motion import Motion, read_motion_metadata, read_motion_set
from rockfrag.shaketable.definitions import DEFINITION, read_swept
from rockfrag.study.study import Study
from rockfrag.words.sentences import Macros

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


class Says(Macros):
    """What the parts of a page say: macros that part what they say by ``{{ part }}``."""

    def finding(self, macro: str, *about: Any) -> Finding:
        """A finding of which a macro says headline, text and numbers."""
        return Finding(*map(" ".join, self.parts(macro, *about)))

    def figure(
        self, name: str, draw: Callable[[], Figure], *about: Any, of: str = ""
    ) -> FigureSpec:
        """A figure of which ``<name>_figure``, or that ``of`` others, says what it shows and its caption."""
        alt, caption = map(" ".join, self.parts(f"{of or name}_figure", *about))
        return FigureSpec(name, alt, caption, draw)

    def table(
        self,
        name: str,
        table: pd.DataFrame,
        *about: Any,
        more: Sequence[Any] = (),
        file: str = "",
    ) -> Markup:
        """A table of which ``<name>_table`` says caption and columns, with ``more`` behind them."""
        from rockfrag.report.page import table_html

        caption, columns = self.parts(f"{name}_table", *about)
        return table_html(table, [*columns, *more], " ".join(caption), file)

    def section(
        self,
        anchor: str,
        parts: Sequence[Markup | FigureSpec],
        *about: Any,
        of: str = "",
    ) -> Section:
        """A chapter of which the macro of its anchor, or another, says title, message and paragraphs."""
        title, message, paragraphs = self.parts(of or anchor.replace("-", "_"), *about)
        return Section(anchor, " ".join(title), " ".join(message), paragraphs, parts)


says = Says("rockfrag.report.sections", "sections.j2")  # what the parts of a report say


class Results:
    """The results of a study in a folder, read when asked for."""

    def __init__(self, study: Study, folder: Path) -> None:
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
        name, paths = (
            "minimum_gravity_ratio",
            (self.folder / path for path in self.study.ida_files),
        )
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
