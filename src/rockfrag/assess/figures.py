"""What stands on the page of one object as drawings."""

import numpy as np
from matplotlib.figure import Figure

from rockfrag.assess.answer import Assessment
from rockfrag.assess.words import NAMES
from rockfrag.figure_style import BLUE, COLUMN_WIDTH, OKABE_ITO, one_panel, plain_log

_REACHED = 0.995  # Fraction of motions up to which the curves are shown


def fractions_figure(found: Assessment) -> Figure:
    """Fraction of the motions that topple the object over the level of shaking, for each arrangement."""
    with one_panel(COLUMN_WIDTH, 2.7) as (figure, axes):
        ends = []
        for colour, (name, outcomes) in zip(OKABE_ITO, found.arrangements.items(), strict=False):
            levels, fractions = outcomes.intensity_levels.levels, outcomes.fractions()
            if outcomes is found.outcomes:
                low, high = outcomes.band()
                axes.fill_between(
                    levels, 100 * low, 100 * high, color=colour, alpha=0.18, linewidth=0
                )
            axes.plot(levels, 100 * fractions, color=colour, label=name)
            shown = levels[(fractions > 0) & (fractions < _REACHED)]
            ends += [shown.min(), shown.max()] if shown.size else [levels[0], levels[-1]]
        if found.level is not None:
            axes.axvline(found.level.value, color="#555555", linestyle="--", linewidth=0.9)
            at = (found.level.value, 98)
            words = axes.annotate("the site", at, (3, 0), textcoords="offset points", va="top")
            words.set_color("#555555")
            ends.append(found.level.value)
        axes.set(
            xlim=(0.8 * min(ends), 1.25 * max(ends)),
            ylim=(0, 100),
            xlabel=f"{found.measure.imt} of the ground [{found.measure.unit}]",
            ylabel="Motions that topple it [%]",
        )
        plain_log(axes, "x")
        if len(found.arrangements) > 1:
            axes.legend(loc="upper left" if found.level is None else "center right")
    return figure


def sources_figure(found: Assessment) -> Figure:
    """How much each source of uncertainty adds to the interval."""
    ranked = sorted(found.main.sources.items(), key=lambda item: item[1])
    known = {NAMES[name]: value for name, value in ranked if np.isfinite(value)}
    with one_panel(COLUMN_WIDTH, 0.6 + 0.24 * len(known)) as (figure, axes):
        axes.barh(list(known), list(known.values()), color=BLUE, height=0.6)
        axes.set(xlabel="Standard deviation on the scale of the interval")
    return figure
