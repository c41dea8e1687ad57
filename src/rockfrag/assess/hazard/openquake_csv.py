"""OpenQuake's export of hazard curves as CSV.

A comment with ``kind``, ``investigation_time`` and ``imt``, a header ``lon,lat,depth,poe-0.0050000,…``
whose names hold the levels (g; cm/s for PGV), and a row of probabilities of exceedance for each site.
"""

import csv
import io
import re

from rockfrag.assess.hazard.curve import (
    Found,
    HazardCurve,
    make_curve,
    rates_of,
    read_measure,
    read_statistic,
)
from rockfrag.errors import InputError

_POE = re.compile(r"poe-([0-9.eE+-]+)")


def recognise(text: str) -> bool:
    """Tell whether a text is such an export."""
    head = text[:20_000]
    return "poe-" in head and head.lstrip().startswith(("#", '"#', "lon", "custom_site_id"))


def read(text: str, path: str) -> list[Found]:
    """Return the one curve of a file with one site, and which statistic it is."""
    curve, kind = _read(text, path)
    return [Found(curve, read_statistic(kind, path))]


def read_curve(text: str, path: str) -> HazardCurve:
    """Return the one curve of a file with one site, whichever realization or statistic it is of."""
    return _read(text, path)[0]


def _read(text: str, path: str) -> tuple[HazardCurve, str]:
    try:
        rows = [row for row in csv.reader(io.StringIO(text)) if any(cell.strip() for cell in row)]
    except csv.Error as error:
        raise InputError(f"{path}: it is damaged as a table ({error}).") from None
    comment = ",".join(rows[0]) if rows[0][0].lstrip().startswith("#") else ""
    table = rows[1:] if comment else rows
    facts = dict(re.findall(r"(\w+)='?([^',\"]+)'?", comment))
    missing = [name for name in ("investigation_time", "imt") if name not in facts]
    if missing:
        raise InputError(
            f"{path}: the first line does not state {missing[0]}; give the file as OpenQuake exported it."
        )
    header, sites = (table[0], table[1:]) if table else ([], [])
    columns = {i: found[1] for i, name in enumerate(header) if (found := _POE.fullmatch(name))}
    if len(sites) != 1 or not columns:
        raise InputError(
            f"{path}: found {len(sites)} sites with {len(columns)} levels; leave the row of one site."
        )
    if len(sites[0]) != len(header):
        raise InputError(f"{path}: the row has {len(sites[0])} cells, its header {len(header)}.")
    try:
        levels = [float(level) for level in columns.values()]
        poes = [float(sites[0][i]) for i in columns]
        years = float(facts["investigation_time"])
    except ValueError as error:
        raise InputError(f"{path}: a level, probability or time is no number ({error}).") from None
    measure = read_measure(facts["imt"], path)
    rates = rates_of(poes, years, path)
    return make_curve(measure, levels, list(rates), path), facts.get("kind", "")
