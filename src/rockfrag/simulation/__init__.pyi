from . import closed_forms as closed_forms, holding as holding
from .ensemble import (
    LightBodies as LightBodies,
    overturns as overturns,
)
from .options import MeasuredRestitution as MeasuredRestitution
from .parquet import (
    stream_histories as stream_histories,
    stream_overturns as stream_overturns,
)
from .restitution import (
    restitution_from_history as restitution_from_history,
    restitution_from_impacts as restitution_from_impacts,
    restitution_from_peaks as restitution_from_peaks,
)
from .history import simulate as simulate
from .rocking_spectra import rocking_spectrum as rocking_spectrum
from .robustness import (
    find_step_size_sensitive as find_step_size_sensitive,
    outcome_robustness as outcome_robustness,
)
from .thresholds import (
    Thresholds as Thresholds,
    find_thresholds as find_thresholds,
    worst_direction as worst_direction,
)
