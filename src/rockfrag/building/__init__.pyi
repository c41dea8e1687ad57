from .floors import (
    floor_motions as floor_motions,
    judge_drift as judge_drift,
    respond as respond,
)
from .model import (
    ModalDamping as ModalDamping,
    ShearBuilding as ShearBuilding,
    stiffnesses_for_period as stiffnesses_for_period,
)
from .settings import read_building as read_building
