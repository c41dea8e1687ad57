"""Buildings: elastic and hysteretic shear models, floor motions, and how far they can be believed."""

from rockfrag.building.drift import DriftVerdict, judge_drift
from rockfrag.building.floors import floor_motions, floor_spectra, respond
from rockfrag.building.hysteresis import push_storey, storey_envelopes
from rockfrag.building.inelastic import respond_hysteretically
from rockfrag.building.masonry import MasonryLaw
from rockfrag.building.model import (
    ModalDamping,
    RayleighDamping,
    ShearBuilding,
    stiffnesses_for_period,
)
from rockfrag.building.modes import Modes, find_modes
from rockfrag.building.response import BuildingResponse, EnergyLedger, respond_elastically
from rockfrag.building.settings import make_building, read_building

__all__ = [
    "BuildingResponse",
    "DriftVerdict",
    "EnergyLedger",
    "MasonryLaw",
    "ModalDamping",
    "Modes",
    "RayleighDamping",
    "ShearBuilding",
    "find_modes",
    "floor_motions",
    "floor_spectra",
    "judge_drift",
    "make_building",
    "push_storey",
    "read_building",
    "respond",
    "respond_elastically",
    "respond_hysteretically",
    "stiffnesses_for_period",
    "storey_envelopes",
]
