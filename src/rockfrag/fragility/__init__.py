"""Fragility: how probable is overturning at a given intensity of shaking, and how sure is that?"""

from typing import TYPE_CHECKING

from rockfrag._lazy import loader

if TYPE_CHECKING:
    from rockfrag.fragility.censored import (
        Brackets,
        bracket_interval,
        brackets_from_table,
        fit_brackets,
    )
    from rockfrag.fragility.discrete_hazard import StepHazard, fit_step_hazard
    from rockfrag.fragility.empirical import (
        isotonic_share,
        local_share,
        share_in_bins,
        survival_windows,
        wilson_interval,
    )
    from rockfrag.fragility.estimators import (
        Fragility,
        IncrementalFragility,
        fit_cloud,
        fit_incremental,
        fit_step_tests,
        fit_stripes,
        fragility_of,
    )
    from rockfrag.fragility.goodness import GoodnessOfFit, goodness_of_fit
    from rockfrag.fragility.intervals import Interval, interval_over_motions
    from rockfrag.fragility.lognormal import FragilityFit, fit_lognormal
    from rockfrag.fragility.measure_choice import MeasureChoice, area_under_curve, recommend_measure
    from rockfrag.fragility.measure_choice_sweeps import recommend_sweep_measure
    from rockfrag.fragility.nrml import write_nrml
    from rockfrag.fragility.observations import Outcomes, outcomes_from_table
    from rockfrag.fragility.seismic_hazard import OverturningRate, overturning_rate
    from rockfrag.fragility.simcenter import write_simcenter
    from rockfrag.fragility.states import ThreeStates, fit_three_states
    from rockfrag.fragility.surface import FragilitySurface, fit_surface
    from rockfrag.fragility.sweeps import (
        fragility_row,
        fragility_table,
        fragility_tables,
        record_set_hash,
        table_hash,
        with_measures,
    )
    from rockfrag.fragility.tests_file import read_tests
    from rockfrag.fragility.user_table import UserFragility, fit_user_table
    from rockfrag.fragility.variance import VarianceSplit, split_variance

__all__ = [
    "Brackets",
    "Fragility",
    "FragilityFit",
    "FragilitySurface",
    "GoodnessOfFit",
    "IncrementalFragility",
    "Interval",
    "MeasureChoice",
    "Outcomes",
    "OverturningRate",
    "StepHazard",
    "ThreeStates",
    "UserFragility",
    "VarianceSplit",
    "area_under_curve",
    "bracket_interval",
    "brackets_from_table",
    "fit_brackets",
    "fit_cloud",
    "fit_incremental",
    "fit_lognormal",
    "fit_step_hazard",
    "fit_step_tests",
    "fit_stripes",
    "fit_surface",
    "fit_three_states",
    "fit_user_table",
    "fragility_of",
    "fragility_row",
    "fragility_table",
    "fragility_tables",
    "goodness_of_fit",
    "interval_over_motions",
    "isotonic_share",
    "local_share",
    "outcomes_from_table",
    "overturning_rate",
    "read_tests",
    "recommend_measure",
    "recommend_sweep_measure",
    "record_set_hash",
    "share_in_bins",
    "split_variance",
    "survival_windows",
    "table_hash",
    "wilson_interval",
    "with_measures",
    "write_nrml",
    "write_simcenter",
]

_HOMES = {
    "censored": (
        "Brackets",
        "bracket_interval",
        "brackets_from_table",
        "fit_brackets",
    ),
    "discrete_hazard": (
        "StepHazard",
        "fit_step_hazard",
    ),
    "empirical": (
        "isotonic_share",
        "local_share",
        "share_in_bins",
        "survival_windows",
        "wilson_interval",
    ),
    "estimators": (
        "Fragility",
        "IncrementalFragility",
        "fit_cloud",
        "fit_incremental",
        "fit_step_tests",
        "fit_stripes",
        "fragility_of",
    ),
    "goodness": (
        "GoodnessOfFit",
        "goodness_of_fit",
    ),
    "intervals": (
        "Interval",
        "interval_over_motions",
    ),
    "lognormal": (
        "FragilityFit",
        "fit_lognormal",
    ),
    "measure_choice": (
        "MeasureChoice",
        "area_under_curve",
        "recommend_measure",
    ),
    "measure_choice_sweeps": ("recommend_sweep_measure",),
    "nrml": ("write_nrml",),
    "observations": (
        "Outcomes",
        "outcomes_from_table",
    ),
    "seismic_hazard": (
        "OverturningRate",
        "overturning_rate",
    ),
    "simcenter": ("write_simcenter",),
    "states": (
        "ThreeStates",
        "fit_three_states",
    ),
    "surface": (
        "FragilitySurface",
        "fit_surface",
    ),
    "sweeps": (
        "fragility_row",
        "fragility_table",
        "fragility_tables",
        "record_set_hash",
        "table_hash",
        "with_measures",
    ),
    "tests_file": ("read_tests",),
    "user_table": (
        "UserFragility",
        "fit_user_table",
    ),
    "variance": (
        "VarianceSplit",
        "split_variance",
    ),
}

__getattr__ = loader(
    __name__,
    {name: f"{__name__}.{home}" for home, names in _HOMES.items() for name in names},
)


def __dir__() -> list[str]:
    return __all__
