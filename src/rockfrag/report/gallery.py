"""All figures of a study: how each is drawn, named and captioned."""

from collections.abc import Sequence
from pathlib import Path

import pandas as pd
from matplotlib.figure import Figure

from rockfrag.records.motion import Motion
from rockfrag.report.motion_figures import acceleration_histories
from rockfrag.report.page import Picture
from rockfrag.report.sweep_figures import verdict_map
from rockfrag.studies import Study


def figure_names(study: Study) -> list[str]:
    """Names of a study's figures, in the order of the report."""
    return ["figure_3_4", *(f"verdicts_{tower}" for tower in _towers(study))]


def draw_all(
    study: Study,
    *,
    ground: Sequence[Motion],
    sweep: pd.DataFrame,
    tests: pd.DataFrame,
    fragility: pd.DataFrame,
) -> dict[str, Figure]:
    """Draw every figure named by :func:`figure_names`."""
    figures = {"figure_3_4": acceleration_histories(ground)}
    figures |= {f"verdicts_{tower}": verdict_map(sweep, tower) for tower in _towers(study)}
    return figures


def pictures(study: Study, folder: Path) -> dict[str, Picture]:
    """Figures with their captions, from the files in ``folder``."""
    captions = {
        "figure_3_4": "Counterpart of figure 3.4: accelerations of the ground motions as recorded; "
        "the dot marks the peak."
    }
    captions |= {
        f"verdicts_{tower}": f"{tower}: every amplitude that overturns it, per motion."
        for tower in _towers(study)
    }
    return {
        name: Picture(folder / f"{name}.svg", captions[name], captions[name])
        for name in figure_names(study)
    }


def _towers(study: Study) -> list[str]:
    return list(dict.fromkeys(one.tower for one in study.configurations))
