"""What a shaking table can do, beside what objects need to overturn."""

import pandas as pd
from matplotlib.artist import Artist
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from rockfrag.figure_style import OKABE_ITO, WIDEST, one_panel
from rockfrag.report.figures.amplitudes import GREY, MARKERS, drawn_tests
from rockfrag.report.figures.ida import MOST_ROWS
from rockfrag.report.wording import label, shortened


def shaker_limits(limits: pd.DataFrame, tests: pd.DataFrame) -> Figure:
    """Draw the amplitude at which each motion leaves the shaker's limits beside what lone objects need, if any."""
    motions = list(limits["motion"])[:MOST_ROWS][::-1]
    place = {motion: number for number, motion in enumerate(motions)}
    lone = tests[tests["pedestal"] == "NP"]
    rows = drawn_tests(lone if len(lone) else tests)
    rows = rows[rows["motion"].isin(motions)]
    names = list(dict.fromkeys(rows["configuration"]))
    with one_panel(WIDEST, 1.2 + 0.22 * len(motions)) as (figure, axes):
        largest = limits.set_index("motion")["limit_g"]
        axes.barh(range(len(motions)), largest[motions], color="#dddddd", height=0.8)
        handles: list[Artist] = [
            Patch(color="#dddddd", label="up to the table's limit of the stated quantity")
        ]
        for number, name in enumerate(names):
            marker, colour = MARKERS[number % len(MARKERS)], OKABE_ITO[number % len(OKABE_ITO)]
            own = rows[rows["configuration"] == name]
            y = own["motion"].map(place).to_numpy(dtype=float)
            (line,) = axes.plot(own["a"], y, ls="", marker=marker, mfc="none", mec=colour, ms=4)
            line.set_label(f"{shortened(name)} overturns")
            handles.append(line)
            bounds = own["up"].to_numpy(dtype=bool)
            axes.plot(own["a"].to_numpy()[bounds], y[bounds], ls="", marker=">", color=colour, ms=3)
        reasons = limits.set_index("motion")["limited_by"]
        for place_of, motion in enumerate(motions):
            axes.text(
                largest[motion],
                place_of,
                f" {reasons[motion]}",
                va="center",
                fontsize=6.5,
                color=GREY,
            )
        axes.set_xlim(0, 1.2 * float(largest[motions].max()))
        axes.set_yticks(range(len(motions)), [label(name) for name in motions])
        axes.tick_params(axis="y", length=0)
        axes.set_xlabel("Peak acceleration of the motion [g]")
        figure.legend(handles=handles, loc="outside upper center", ncols=2)
        return figure
