"""The effect of a pedestal on overturning: d = ln a_P - ln a_NP, tested as a referee would."""

from typing import TYPE_CHECKING

from rockfrag._lazy import loader

if TYPE_CHECKING:
    from rockfrag.pedestal.explanation import explain
    from rockfrag.pedestal.paired_tests import Pairs, check_tests, pair_tests
    from rockfrag.pedestal.study import PedestalStudy, effects_table, study_pedestal

__all__ = [
    "Pairs",
    "PedestalStudy",
    "check_tests",
    "effects_table",
    "explain",
    "pair_tests",
    "study_pedestal",
]

_HOMES = {
    "explanation": ("explain",),
    "paired_tests": (
        "Pairs",
        "check_tests",
        "pair_tests",
    ),
    "study": (
        "PedestalStudy",
        "effects_table",
        "study_pedestal",
    ),
}

__getattr__ = loader(
    __name__,
    {name: f"{__name__}.{home}" for home, names in _HOMES.items() for name in names},
)


def __dir__() -> list[str]:
    return __all__
