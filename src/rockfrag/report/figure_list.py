"""All figures of a study: how each is drawn, named and captioned."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import pandas as pd
from matplotlib.figure import Figure

from rockfrag.fragility.estimators import fit_incremental
from rockfrag.fragility.observations import outcomes_from_table
from rockfrag.records.motion import Motion
from rockfrag.report.figures.fragility import fragility_figure
from rockfrag.report.figures.motion import acceleration_histories
from rockfrag.report.figures.pedestal import (
    forest_figure,
    pedestal_scatter,
    sides_figure,
    slenderness_figure,
)
from rockfrag.report.figures.sweep import verdict_map
from rockfrag.report.page import Picture
from rockfrag.shaketable.readings import READING
from rockfrag.study.study import Study


@dataclass(frozen=True)
class Results:
    """What figures are drawn from.

    Attributes
    ----------
    study
        The study.
    ground
        Ground motions.
    sweep
        Sweeps of all configurations.
    tests
        Table of tests with all readings.
    effects
        The pedestal's effect by scope and reading, or None where there are no pairs.
    """

    study: Study
    ground: Sequence[Motion]
    sweep: pd.DataFrame
    tests: pd.DataFrame
    effects: pd.DataFrame | None

    @property
    def laboratory(self) -> pd.DataFrame:
        """Tests as the laboratory's protocol reads them."""
        return self.tests[self.tests["reading"] == READING]

    @property
    def slenderness(self) -> dict[str, float]:
        """Height over width of each block [-]."""
        return {name: block.slenderness for name, block in self.study.specimens.items()}


@dataclass(frozen=True)
class Plate:
    """One figure: its name, its caption, and how it is drawn."""

    name: str
    caption: str
    draw: Callable[[Results], Figure]


def _forest(results: Results) -> Figure:
    effects = results.effects
    if effects is None:
        raise ValueError("a study without pairs has no effect of a pedestal")
    return forest_figure(effects[effects["reading"] == READING])


_COUNTERPARTS = (
    Plate(
        "figure_4_1",
        "Counterpart of figure 4.1: overturning amplitude against slenderness, with means.",
        lambda r: slenderness_figure(r.laboratory, slenderness=r.slenderness),
    ),
    Plate(
        "figure_4_2",
        "Counterpart of figure 4.2: the same for each floor.",
        lambda r: slenderness_figure(r.laboratory, by_floor=True, slenderness=r.slenderness),
    ),
    Plate(
        "figure_4_3",
        "Counterpart of figure 4.3: amplitude with the pedestal against that without.",
        lambda r: pedestal_scatter(r.laboratory, slenderness=r.slenderness),
    ),
    Plate(
        "figure_4_4",
        "Counterpart of figure 4.4: amplitude by object, without and with the pedestal.",
        lambda r: sides_figure(r.laboratory, "object", slenderness=r.slenderness),
    ),
    Plate(
        "figure_4_5",
        "Counterpart of figure 4.5: figure 4.3 for each floor.",
        lambda r: pedestal_scatter(r.laboratory, "floor", slenderness=r.slenderness),
    ),
    Plate(
        "figure_4_6a",
        "Counterpart of figure 4.6a: amplitude by floor, without and with the pedestal.",
        lambda r: sides_figure(r.laboratory, "floor", slenderness=r.slenderness),
    ),
    Plate(
        "figure_4_6b",
        "Counterpart of figure 4.6b: the same for each object.",
        lambda r: sides_figure(r.laboratory, "floor", panels="object", slenderness=r.slenderness),
    ),
    Plate(
        "figure_4_7",
        "Counterpart of figure 4.7: figure 4.3 for each earthquake.",
        lambda r: pedestal_scatter(r.laboratory, "event", slenderness=r.slenderness),
    ),
    Plate(
        "pedestal_effect",
        "Amplitude with over amplitude without pedestal, with 95 % intervals; grey is the range "
        "that counts as no effect. Step protocol.",
        _forest,
    ),
)


def plates(study: Study) -> list[Plate]:
    """Figures of a study in the order of its report."""
    objects = list(dict.fromkeys(one.object for one in study.configurations))
    found = [
        Plate(
            "figure_3_4",
            "Counterpart of figure 3.4: accelerations of the ground motions as recorded; the dot "
            "marks the peak.",
            lambda r: acceleration_histories(r.ground),
        )
    ]
    if study.has_pairs:
        found += _COUNTERPARTS
    found += [
        Plate(
            f"verdicts_{object_name}",
            f"{object_name}: every amplitude that overturns it, per motion.",
            partial(_verdicts, object_name=object_name),
        )
        for object_name in objects
    ]
    found += [
        Plate(
            f"fragility_{object_name}",
            f"{object_name}: probability of overturning over the peak of the motion, with intervals over "
            "earthquakes; points are shares of all runs in bins. Below, the share of motions "
            "between their first and their last change of verdict.",
            partial(_fragility, object_name=object_name),
        )
        for object_name in objects
    ]
    return found


def figure_names(study: Study) -> list[str]:
    """Names of a study's figures, in the order of the report."""
    return [plate.name for plate in plates(study)]


def pictures(study: Study, folder: Path) -> dict[str, Picture]:
    """Figures with their captions, from the files in ``folder``."""
    return {
        plate.name: Picture(folder / f"{plate.name}.svg", plate.caption) for plate in plates(study)
    }


def _verdicts(results: Results, object_name: str) -> Figure:
    return verdict_map(results.sweep, object_name)


def _fragility(results: Results, object_name: str) -> Figure:
    rows = results.sweep[results.sweep["object"] == object_name]
    level = results.study.fragility.confidence
    curves, outcomes, windows = {}, {}, {}
    # with the pedestal first: it then has the same colour as in the other figures
    rows = rows.sort_values("pedestal", ascending=False, kind="stable")
    for name, part in rows.groupby("configuration", sort=False):
        found = fit_incremental(part, event="event", level=level)
        curves[str(name)] = found.probability
        outcomes[str(name)] = outcomes_from_table(part, "amplitude_g", event="event")
        windows[str(name)] = found.windows
    return fragility_figure(curves, outcomes, windows)
