"""What the motions as recorded do to each configuration: overturned, or how far it rocked."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from rockfrag.figure_style import BLUE, COLUMN_WIDTH, RED, figure_style, new_figure
from rockfrag.report.figures.amplitudes import GREY
from rockfrag.report.wording import shortened

MOST_ROWS = 30
"""More motions than this are not legible; the strongest are drawn."""


def recorded_map(recorded: pd.DataFrame) -> Figure:
    """Draw a row for each motion and a column for each configuration.

    Parameters
    ----------
    recorded
        As :func:`rockfrag.stages.sweep.as_recorded` returns it, of every configuration.
    """
    names = list(dict.fromkeys(recorded["configuration"]))
    motions = recorded.drop_duplicates("motion")
    if len(motions) > MOST_ROWS:
        motions = motions.nlargest(MOST_ROWS, "pga_g")
    titles = [shortened(name, 16) for name in names]
    upright = max(map(len, titles)) * len(titles) <= 28
    lines = {name: number for number, name in enumerate(motions["motion"])}
    with figure_style():
        figure = new_figure(COLUMN_WIDTH, (0.9 if upright else 1.8) + 0.21 * len(motions))
        axes = figure.subplots()
        for row in recorded[recorded["motion"].isin(motions["motion"])].to_dict("records"):
            x, y = names.index(row["configuration"]), lines[row["motion"]]
            rocked = 1.0 if row["overturned"] else min(float(row["peak_rotation"]), 1.0)
            colour = RED if row["overturned"] else BLUE
            axes.add_patch(
                Rectangle((x - 0.4, y + 0.36 - 0.72 * rocked), 0.8, 0.72 * rocked, fc=colour, lw=0)
            )
            if 0 < row["share_near"] < 1:
                axes.plot(x, y, "o", mfc="none", mec="black", ms=6, mew=0.9)
        axes.set_xlim(-0.6, len(names) - 0.4)
        axes.set_ylim(len(motions) - 0.4, -0.6)
        axes.hlines(np.arange(len(motions)) + 0.36, -0.4, len(names) - 0.6, color="#cccccc", lw=0.6)
        axes.set_yticks(
            range(len(motions)),
            [
                f"{shortened(motion, 20)}, {peak:.2f} g"
                for motion, peak in motions[["motion", "pga_g"]].itertuples(index=False)
            ],
        )
        axes.set_xticks(range(len(names)), titles, rotation=0 if upright else 60)
        axes.tick_params(length=0)
        axes.xaxis.tick_top()
        for side in axes.spines.values():
            side.set_visible(False)
        handles = [
            Rectangle((0, 0), 1, 1, fc=RED, label="overturns"),
            Rectangle((0, 0), 1, 1, fc=BLUE, label="rocks"),
            *axes.plot([], [], "o", mfc="none", mec=GREY, label="within a tenth of the other"),
        ]
        figure.legend(
            handles=handles,
            loc="outside lower center",
            ncols=3,
            handlelength=1.0,
            columnspacing=1.0,
        )
        return figure
