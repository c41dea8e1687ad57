"""Figures of the benchmarks: speed against accuracy, and cost against the number of cases."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from rockfrag.base.figure_style import (
    BLUE,
    OKABE_ITO,
    ORANGE,
    PAGE_WIDTH,
    figure_style,
    new_figure,
    plain_log,
)

COLOURS = {
    "single block": BLUE,
    "two blocks": ORANGE,
    "three blocks": OKABE_ITO[2],
    "five blocks": OKABE_ITO[4],
    "eight blocks": OKABE_ITO[3],
}


def draw_benchmark(programs: pd.DataFrame, scaling: pd.DataFrame) -> Figure:
    """Draw histories per second and core of each program, and seconds against histories.

    Parameters
    ----------
    programs
        Columns ``bodies``, ``program``, ``histories_per_s_core``, ``histories``, ``wrong_outcomes``.
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
        fastest = table["histories_per_s_core"].max()
        left.set_xlim(right=fastest * 3e4)
        ticks = [t for t in 10.0 ** np.arange(-1, 7) if t <= 10 * fastest]
        left.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
        left.minorticks_off()
        columns = ("histories_per_s_core", "wrong_outcomes", "histories")
        for y, (rate, wrong, count) in enumerate(
            zip(*(table[column].tolist() for column in columns), strict=True)
        ):
            speed = (
                f"{rate:.3g}"
                if rate < 1000
                else f"{rate:,.0f}".replace(",", "\N{THIN SPACE}")
            )
            words = f"{speed}/s, {wrong} of {count} wrong"
            left.text(rate * 1.2, y, words, va="center", fontsize=7)
        left.set_xlabel("histories per second and core")
        for bodies, part in scaling.groupby("bodies", sort=True):
            right.loglog(
                part["histories"],
                part["seconds"],
                "o-",
                color=COLOURS[str(bodies)],
                label=bodies,
            )
        plain_log(right, "x")
        plain_log(right, "y")
        right.minorticks_off()
        right.set_xlabel("histories")
        right.set_ylabel("CPU time [s]")
        right.legend()
    return figure
