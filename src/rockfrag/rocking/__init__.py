"""Rigid blocks rocking: bodies, contact states, impacts, histories and ensembles."""

from typing import TYPE_CHECKING

from rockfrag._lazy import loader

if TYPE_CHECKING:
    from rockfrag.rocking.ensemble import EnsembleResult, overturns
    from rockfrag.rocking.measured_restitution import MeasuredRestitution
    from rockfrag.rocking.parquet import stream_histories, stream_overturns
    from rockfrag.rocking.response import Response
    from rockfrag.rocking.restitution import (
        RestitutionFit,
        restitution_from_history,
        restitution_from_impacts,
        restitution_from_peaks,
    )
    from rockfrag.rocking.simulation import simulate
    from rockfrag.rocking.spectra import RockingSpectrum, rocking_spectrum
    from rockfrag.rocking.step_sensitivity import FragileVerdicts, fragile_verdicts
    from rockfrag.rocking.sureness import verdict_sureness
    from rockfrag.rocking.thresholds import Thresholds, find_thresholds
    from rockfrag.system.blocks import Block, Body, Stack

__all__ = [
    "Block",
    "Body",
    "EnsembleResult",
    "FragileVerdicts",
    "MeasuredRestitution",
    "Response",
    "RestitutionFit",
    "RockingSpectrum",
    "Stack",
    "Thresholds",
    "find_thresholds",
    "fragile_verdicts",
    "overturns",
    "restitution_from_history",
    "restitution_from_impacts",
    "restitution_from_peaks",
    "rocking_spectrum",
    "simulate",
    "stream_histories",
    "stream_overturns",
    "verdict_sureness",
]

_HOMES = {
    "ensemble": ("EnsembleResult", "overturns"),
    "measured_restitution": ("MeasuredRestitution",),
    "parquet": ("stream_histories", "stream_overturns"),
    "response": ("Response",),
    "restitution": (
        "RestitutionFit",
        "restitution_from_history",
        "restitution_from_impacts",
        "restitution_from_peaks",
    ),
    "simulation": ("simulate",),
    "spectra": ("RockingSpectrum", "rocking_spectrum"),
    "step_sensitivity": ("FragileVerdicts", "fragile_verdicts"),
    "sureness": ("verdict_sureness",),
    "thresholds": ("Thresholds", "find_thresholds"),
}

__getattr__ = loader(
    __name__,
    {name: f"{__name__}.{home}" for home, names in _HOMES.items() for name in names}
    | dict.fromkeys(("Block", "Body", "Stack"), "rockfrag.system.blocks"),
)
