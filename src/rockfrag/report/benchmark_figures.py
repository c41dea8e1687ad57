"""Figures of the benchmarks: speed against accuracy, and cost against the number of cases."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from rockfrag.report.style import BLUE, ORANGE, PAGE_WIDTH, figure_style, new_figure

COLOURS = {"single block": BLUE, "two blocks": ORANGE}


def draw_benchmark(programs: pd.DataFrame, scaling: pd.DataFrame) -> Figure:
    """Draw histories per second and core of each program, and seconds against histories.

    Parameters
    ----------
    programs
        Columns ``bodies``, ``program``, ``histories_per_s_core``, ``wrong_share``.
    scaling
        Columns ``bodies``, ``histories``, ``seconds``.
    """
    with figure_style():
        figure = new_figure(PAGE_WIDTH, 3.0)
        left, right = figure.subplots(1, 2, width_ratios=(1.5, 1.0))
        table = programs.iloc[::-1].reset_index(drop=True)
        place = np.arange(len(table))
        left.barh(
            place,
            table["histories_per_s_core"],
            height=0.7,
            color=[COLOURS[bodies] for bodies in table["bodies"]],
        )
        left.set_xscale("log")
        left.set_yticks(place, table["program"])
        left.set_xlim(right=table["histories_per_s_core"].max() * 300)
        for y, speed, wrong in zip(
            place, table["histories_per_s_core"], table["wrong_share"], strict=True
        ):
            left.text(speed * 1.2, y, f"{speed:.3g}/s, {100 * wrong:.2g} % wrong", va="center")
        left.set_xlabel("histories per second and core")
        for bodies, part in scaling.groupby("bodies", sort=True):
            right.loglog(
                part["histories"], part["seconds"], "o-", color=COLOURS[str(bodies)], label=bodies
            )
        right.set_xlabel("histories")
        right.set_ylabel("CPU time [s]")
        right.legend()
    return figure
