from .drift import (
    DriftOutcome as DriftOutcome,
    judge_drift as judge_drift,
)
from .floors import (
    floor_motions as floor_motions,
    respond as respond,
)
from .hysteresis import (
    push_storey as push_storey,
    storey_envelopes as storey_envelopes,
)
from .inelastic import respond_hysteretically as respond_hysteretically
from .masonry import MasonryLaw as MasonryLaw
from .model import (
    ModalDamping as ModalDamping,
    RayleighDamping as RayleighDamping,
    ShearBuilding as ShearBuilding,
    stiffnesses_for_period as stiffnesses_for_period,
)
from .modes import (
    Modes as Modes,
    find_modes as find_modes,
)
from .response import (
    BuildingResponse as BuildingResponse,
    EnergyBalance as EnergyBalance,
    respond_elastically as respond_elastically,
)
from .settings import (
    make_building as make_building,
    read_building as read_building,
)
