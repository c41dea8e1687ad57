"""The shaking table: its limits, the protocols of its tests, and tables of measured ones."""

from typing import TYPE_CHECKING

from rockfrag._lazy import loader

if TYPE_CHECKING:
    from rockfrag.shaketable.high_pass import filter_effect
    from rockfrag.shaketable.instruments import Accelerometer, Exact, ForceOverMass
    from rockfrag.shaketable.laboratory_table import read_measured
    from rockfrag.shaketable.protocols import Outcome, Protocol, climb
    from rockfrag.shaketable.readings import (
        always_overturning,
        first_overturning,
        step_protocol,
        tests_from_sweep,
    )
    from rockfrag.shaketable.settings import make_shaker, read_shaker
    from rockfrag.shaketable.shaker import (
        Demand,
        Shaker,
        limits_g,
        produced_motion,
        required_corner,
        shaker_table,
    )
    from rockfrag.shaketable.steps import ForceSteps, GeometricSteps, LinearSteps

__all__ = [
    "Accelerometer",
    "Demand",
    "Exact",
    "ForceOverMass",
    "ForceSteps",
    "GeometricSteps",
    "LinearSteps",
    "Outcome",
    "Protocol",
    "Shaker",
    "always_overturning",
    "climb",
    "filter_effect",
    "first_overturning",
    "limits_g",
    "make_shaker",
    "produced_motion",
    "read_measured",
    "read_shaker",
    "required_corner",
    "shaker_table",
    "step_protocol",
    "tests_from_sweep",
]

_HOMES = {
    "high_pass": ("filter_effect",),
    "instruments": (
        "Accelerometer",
        "Exact",
        "ForceOverMass",
    ),
    "laboratory_table": ("read_measured",),
    "protocols": (
        "Outcome",
        "Protocol",
        "climb",
    ),
    "readings": (
        "always_overturning",
        "first_overturning",
        "step_protocol",
        "tests_from_sweep",
    ),
    "settings": (
        "make_shaker",
        "read_shaker",
    ),
    "shaker": (
        "Demand",
        "Shaker",
        "limits_g",
        "produced_motion",
        "required_corner",
        "shaker_table",
    ),
    "steps": (
        "ForceSteps",
        "GeometricSteps",
        "LinearSteps",
    ),
}

__getattr__ = loader(
    __name__,
    {name: f"{__name__}.{home}" for home, names in _HOMES.items() for name in names},
)


def __dir__() -> list[str]:
    return __all__
