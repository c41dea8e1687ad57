"""What the motions as recorded do to each configuration: how far it rocked, up to overturning."""

import numpy as np
import pandas as pd
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure

from rockfrag.figure_style import BLACK, WIDEST, one_panel
from rockfrag.report.wording import label, shortened

MOST_ROWS = 30
"""More motions than this are not legible; the strongest are drawn."""

_SHADES = ListedColormap(["#ffffff", "#d6e6f2", "#a9cbe3", "#74abd2", "#3d86bb"])
"""Rotation from none to the critical angle; darker is nearer to overturning."""

_OVERTURNED = "#8c2d04"


def recorded_map(recorded: pd.DataFrame) -> Figure:
    """Draw a row for each motion and a column for each configuration, shaded by the largest rotation."""
    names = list(dict.fromkeys(recorded["configuration"]))
    motions = recorded.drop_duplicates("motion")
    if len(motions) > MOST_ROWS:
        motions = motions.nlargest(MOST_ROWS, "pga_g")
    rows = list(motions["motion"])
    shown = recorded[recorded["motion"].isin(rows)]
    rotation = np.where(shown["overturned"], np.inf, shown["peak_rotation"].clip(0.0, 0.999))
    table = shown.assign(rotation=rotation).pivot_table(
        index="motion", columns="configuration", values="rotation", aggfunc="first"
    )
    table = table.reindex(index=rows, columns=names)
    sensitive = shown[shown["fraction_near"].between(0, 1, inclusive="neither")]
    with one_panel(WIDEST, 1.35 + 0.185 * len(rows)) as (figure, axes):
        colours = _SHADES.with_extremes(over=_OVERTURNED, bad="#ffffff")
        mesh = axes.pcolormesh(
            np.arange(len(names) + 1) - 0.5,
            np.arange(len(rows) + 1) - 0.5,
            np.where(np.isinf(table.to_numpy(dtype=float)), 2.0, table.to_numpy(dtype=float)),
            cmap=colours,
            vmin=0.0,
            vmax=1.0,
            edgecolors="#cccccc",
            linewidth=0.4,
        )
        axes.plot(
            [names.index(name) for name in sensitive["configuration"]],
            [rows.index(motion) for motion in sensitive["motion"]],
            ls="",
            marker="o",
            ms=3.4,
            mfc="white",
            mec=BLACK,
            mew=0.7,
        )
        axes.set_ylim(len(rows) - 0.5, -0.5)
        peaks = dict(zip(motions["motion"], motions["pga_g"], strict=True))
        axes.set_yticks(range(len(rows)), [f"{label(row)}, {peaks[row]:.2f} g" for row in rows])
        axes.set_xticks(range(len(names)), [shortened(name, 16) for name in names], rotation=90)
        axes.tick_params(length=0, labelsize=7)
        axes.xaxis.tick_top()
        axes.spines[:].set_visible(False)
        bar = figure.colorbar(
            mesh, ax=axes, location="bottom", extend="max", extendfrac=0.12, aspect=28, pad=0.02
        )
        bar.set_label("Rotation / critical angle (brown: overturned)")
        return figure
