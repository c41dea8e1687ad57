from .floors import (
    DriftOutcome as DriftOutcome,
    judge_drift as judge_drift,
)
from .floors import (
    floor_motions as floor_motions,
    respond as respond,
)
from .model import MasonryLaw as MasonryLaw
from .model import (
    ModalDamping as ModalDamping,
    RayleighDamping as RayleighDamping,
    ShearBuilding as ShearBuilding,
    stiffnesses_for_period as stiffnesses_for_period,
)
from .response import (
    BuildingResponse as BuildingResponse,
    EnergyBalance as EnergyBalance,
)
from .settings import (
    read_building as read_building,
)
