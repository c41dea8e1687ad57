"""Reading hazard files: which kind a file is of, and the mean with its quantiles out of several."""

import os
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

from rockfrag.assess.hazard import nrml, openquake_csv, table, usgs
from rockfrag.assess.hazard.curve import Found, HazardCurve
from rockfrag.errors import InputError
from rockfrag.tabular import read_text

LARGEST_FILE = 50_000_000
"""Bytes of a hazard file; that of one site has some thousand."""

KINDS: tuple[tuple[Callable[[str], bool], Callable[[str, str], list[Found]]], ...] = tuple(
    (kind.recognise, kind.read) for kind in (nrml, usgs, openquake_csv, table)
)
"""Whether a text is of a kind, and its reader, in the order in which they are asked; the last takes any."""


def read_hazard(paths: Sequence[str | os.PathLike[str]]) -> list[HazardCurve]:
    """Read the hazard curves of one site.

    Parameters
    ----------
    paths : files: OpenQuake's CSV or NRML, EFEHR's or the USGS's answer, or tables of levels and rates; those of
        a mean and of quantiles of one measure belong together, and one curve given twice is an InputError

    Returns
    -------
    A curve for each measure, with its quantiles.
    """
    found: list[Found] = []
    for path in paths:
        text = read_text(Path(path), LARGEST_FILE)
        read = next(read for recognise, read in KINDS if recognise(text))
        found += read(text, str(path))
    curves = []
    for measure in dict.fromkeys(part.curve.measure for part in found):
        mine = [part for part in found if part.curve.measure == measure]
        curves.append(_assembled(measure.imt, mine))
    return curves


def _assembled(name: str, found: Sequence[Found]) -> HazardCurve:
    """Put the quantiles of one measure to its mean; the median stands in for a mean that is not there."""
    named: dict[str, Found] = {}
    for part in found:
        if part.statistic in named:
            raise InputError(
                f"{part.curve.source}: {name} ({part.statistic}) is given twice, in "
                f"{named[part.statistic].curve.source} too; leave one out."
            )
        named[part.statistic] = part
    quantiles = {
        float(statistic.removeprefix("quantile-")): part.curve
        for statistic, part in named.items()
        if statistic.startswith("quantile-")
    }
    main = named["mean"].curve if "mean" in named else quantiles.get(0.5)
    if main is None:
        raise InputError(
            f"{found[0].curve.source}: only {', '.join(sorted(named))} of {name} is given; give the mean or the "
            "median curve too."
        )
    return replace(main, quantiles={q: c for q, c in sorted(quantiles.items()) if q != 0.5})
