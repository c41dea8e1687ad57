"""Hazard files as their makers document them, all of one power law."""

from math import expm1
from pathlib import Path

from ..case_tables import case_tables

LEVELS = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0]  # levels of PGA [g]


def rate(level: float, at_a_tenth: float = 0.01) -> float:
    """Annual rate of exceedance: a power law with the exponent 2.5."""
    return at_a_tenth * (level / 0.1) ** -2.5


def openquake_csv(
    imt: str = "PGA", kind: str = "mean", at_a_tenth: float = 0.01
) -> str:
    """OpenQuake's export of one site."""
    comment = (
        f"generated_by='OpenQuake engine 3.20.1', start_date='2024-07-01T10:00:00', checksum=1, kind='{kind}', "
        f"investigation_time=50.0, imt='{imt}'"
    )
    blanks = "," * (len(LEVELS) + 2)
    header = "lon,lat,depth," + ",".join(f"poe-{level:.7f}" for level in LEVELS)
    poes = [-expm1(-50 * rate(level, at_a_tenth)) for level in LEVELS]
    row = "16.37000,48.21000,0.00000," + ",".join(f"{poe:.6E}" for poe in poes)
    return f'#{blanks},"{comment}"\n{header}\n{row}\n'


QUANTILES = {"mean": 0.01, "quantile-0.16": 0.006, "quantile-0.84": 0.015}


def quantile_files(folder: Path, imt: str) -> list[str]:
    """Write OpenQuake's files of a mean and of two quantiles."""
    paths = {kind: folder / f"hazard_curve-{kind}-{imt}_1.csv" for kind in QUANTILES}
    for kind, path in paths.items():
        path.write_text(openquake_csv(imt, kind, QUANTILES[kind]))
    return list(map(str, paths.values()))


_FILES = dict(case_tables(__file__)["files"])
SAMPLES = _FILES | {
    "openquake.csv": openquake_csv(),
    "openquake-median.csv": openquake_csv(kind="quantile-0.5"),
    "efehr-median.xml": _FILES["efehr.xml"].replace(
        '="mean"', '="quantile" quantileValue="0.5"'
    ),
}
"""Texts of files by their names."""
