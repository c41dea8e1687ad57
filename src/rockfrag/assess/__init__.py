"""One object at one place: does it rock, does it topple, how probable is that, and what helps?"""

from typing import TYPE_CHECKING

from rockfrag._lazy import loader

if TYPE_CHECKING:
    from rockfrag.assess.answer import Assessment, assess
    from rockfrag.assess.hazard.curve import HazardCurve
    from rockfrag.assess.hazard.reading import read_hazard
    from rockfrag.assess.request import Request, read_request
    from rockfrag.assess.risk import Estimate

__all__ = [
    "Assessment",
    "Estimate",
    "HazardCurve",
    "Request",
    "assess",
    "read_hazard",
    "read_request",
]

_HOMES = {
    "answer": ("Assessment", "assess"),
    "hazard.curve": ("HazardCurve",),
    "hazard.reading": ("read_hazard",),
    "request": ("Request", "read_request"),
    "risk": ("Estimate",),
}

__getattr__ = loader(
    __name__, {name: f"{__name__}.{home}" for home, names in _HOMES.items() for name in names}
)


def __dir__() -> list[str]:
    return __all__
