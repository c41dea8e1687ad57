from .estimators import (
    Fragility as Fragility,
    IncrementalFragility as IncrementalFragility,
    fit_cloud as fit_cloud,
    fit_incremental as fit_incremental,
    fit_step_tests as fit_step_tests,
    fit_stripes as fit_stripes,
)
from .intervals import (
    Interval as Interval,
    interval_over_motions as interval_over_motions,
)
from .lognormal import (
    FragilityFit as FragilityFit,
    fit_lognormal as fit_lognormal,
)
from .measure_selection import (
    MeasureSelection as MeasureSelection,
    area_under_curve as area_under_curve,
    recommend_measure as recommend_measure,
)
from .observations import (
    Observations as Observations,
    observations_from_table as observations_from_table,
)
from .toppling_velocity import (
    toppling_velocity as toppling_velocity,
)
from .exports import (
    write_nrml as write_nrml,
    write_simcenter as write_simcenter,
)
from .ida_curves import fragility_table as fragility_table
from .user_table import (
    UserFragility as UserFragility,
    fit_user_table as fit_user_table,
)
from .vector import (
    Interaction as Interaction,
    VectorChecks as VectorChecks,
    VectorFragility as VectorFragility,
    check_vector as check_vector,
    fit_vector as fit_vector,
)
