"""What a reader needs to get the same results again."""

from collections.abc import Mapping
from importlib.metadata import version
from pathlib import Path
from typing import Any

from rockfrag.plugins import plugins_of
from rockfrag.report.page import MOST_TABLE_ROWS
from rockfrag.report.part import Results
from rockfrag.stages.digest import package_digest
from rockfrag.study.heading import Heading
from rockfrag.study.study import Study

_LIBRARIES = ("numpy", "scipy", "pandas", "numba", "statsmodels", "obspy", "matplotlib")


def provenance(study: Heading, about: Mapping[str, str], *plugins: Path) -> dict[str, str]:
    """Return names and values for the last section of a page; no dates, no names of machines."""
    return {
        "Configuration": study.source.name,
        **about,
        "Seed": str(study.seed),
        "Source": f"rockfrag {version('rockfrag')}, digest {package_digest(*plugins)}",
    }


def study_provenance(results: Results) -> dict[str, str]:
    """Return that of a simulated study, with the libraries behind its numbers."""
    study, amplitudes = results.study, results.study.amplitudes
    hashes = sorted(set(results.table("fragility")["record_set_sha256"]))
    about = {
        "Amplitudes": f"{amplitudes.lowest_g:g} to {amplitudes.highest_g:g} g in steps of "
        f"{amplitudes.step_percent:g} %",
        "Step protocol": f"from {amplitudes.lowest_g:g} g in steps of "
        f"{study.protocol_step_percent:g} %, read before overturning",
        "Records": _records(study),
        "Motions, SHA-256": ", ".join(hashes),
    }
    libraries = ", ".join(f"{name} {version(name)}" for name in _LIBRARIES)
    plugins = (plugin.rules.parent for plugin in plugins_of(study))
    return {**provenance(study, about, *plugins), "Libraries": libraries}


def _records(study: Study) -> str:
    rows = study.catalogue.head(MOST_TABLE_ROWS).to_dict("records")
    rest = len(study.catalogue) - len(rows)
    named = ", ".join(_record(row) for row in rows)
    return f"{named} and {rest} more of {study.catalogue_file.name}" if rest else named


def _record(row: dict[Any, Any]) -> str:
    about = [str(row["source"])]
    if row["sha256"]:
        about.append(f"SHA-256 {row['sha256'][:12]} checked")
    return f"{row['name']} ({', '.join(about)})"
