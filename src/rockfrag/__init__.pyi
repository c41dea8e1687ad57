from . import (
    assess as assess,
    building as building,
    collections as collections,
    effects as effects,
    fragility as fragility,
    motions as motions,
    outcomes as outcomes,
    records as records,
    shaketable as shaketable,
    simulation as simulation,
    system as system,
)
from .assess.request import read_request as read_request
from .outcomes.response import Response as Response
from .base.errors import InputError as InputError
from .fragility.estimators import (
    fit_cloud as fit_cloud,
    fit_incremental as fit_incremental,
    fit_stripes as fit_stripes,
)
from .fragility.lognormal import fit_lognormal as fit_lognormal
from .motions.catalogued import read_motions as read_motions
from .motions.measures import measure_motion as measure_motion
from .motions.response_spectra import response_spectrum as response_spectrum
from .outcomes.outcomes import Outcomes as Outcomes
from .records.motion import GroundMotion as GroundMotion, Motion as Motion
from .records.read import read_motion as read_motion
from .records.write import write_motion as write_motion
from .simulation.ensemble import overturns as overturns
from .simulation.options import MeasuredRestitution as MeasuredRestitution
from .simulation.history import simulate as simulate
from .simulation.rocking_spectra import rocking_spectrum as rocking_spectrum
from .simulation.robustness import find_step_size_sensitive as find_step_size_sensitive
from .simulation.robustness import outcome_robustness as outcome_robustness
from .simulation.thresholds import (
    Thresholds as Thresholds,
    find_thresholds as find_thresholds,
    worst_direction as worst_direction,
)
from .system.blocks import Block as Block, Column as Column, Stack as Stack
from .system.system import System as System

__version__: str
