"""Buildings: elastic and hysteretic shear models, floor motions, and how far they can be believed."""

from typing import TYPE_CHECKING

from rockfrag._lazy import loader

if TYPE_CHECKING:
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

_HOMES = {
    "drift": (
        "DriftVerdict",
        "judge_drift",
    ),
    "floors": (
        "floor_motions",
        "floor_spectra",
        "respond",
    ),
    "hysteresis": (
        "push_storey",
        "storey_envelopes",
    ),
    "inelastic": ("respond_hysteretically",),
    "masonry": ("MasonryLaw",),
    "model": (
        "ModalDamping",
        "RayleighDamping",
        "ShearBuilding",
        "stiffnesses_for_period",
    ),
    "modes": (
        "Modes",
        "find_modes",
    ),
    "response": (
        "BuildingResponse",
        "EnergyLedger",
        "respond_elastically",
    ),
    "settings": (
        "make_building",
        "read_building",
    ),
}

__getattr__ = loader(
    __name__,
    {name: f"{__name__}.{home}" for home, names in _HOMES.items() for name in names},
)


def __dir__() -> list[str]:
    return __all__
