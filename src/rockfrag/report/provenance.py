"""What a reader needs to get the same results again."""

from collections.abc import Mapping
from importlib.metadata import version

import pandas as pd

from rockfrag.stages.digest import source_digest
from rockfrag.study.study import Study

_LIBRARIES = ("numpy", "scipy", "pandas", "numba", "statsmodels", "obspy", "matplotlib")


def provenance(study: Study, tables: Mapping[str, pd.DataFrame]) -> dict[str, str]:
    """Return names and values for the report's last section; no dates, no names of machines."""
    amplitudes = study.amplitudes
    records = ", ".join(
        f"{row['name']} ({row['source']}, SHA-256 {row['sha256'][:12] or 'not given'})"
        for row in study.catalogue.to_dict("records")
    )
    libraries = ", ".join(f"{name} {version(name)}" for name in _LIBRARIES)
    hashes = sorted(set(tables["fragility"]["record_set_sha256"]))
    return {
        "Configuration": study.source.name,
        "Amplitudes": f"{amplitudes.lowest_g:g} to {amplitudes.highest_g:g} g in steps of "
        f"{amplitudes.step_percent:g} %",
        "Step protocol": f"from {amplitudes.lowest_g:g} g in steps of "
        f"{study.protocol_step_percent:g} %, read before overturning",
        "Records": records,
        "Motions, SHA-256": ", ".join(hashes),
        "Seed": str(study.seed),
        "Source": f"rockfrag {version('rockfrag')}, digest {source_digest('rockfrag.guests')}",
        "Libraries": libraries,
    }
