"""What comes out: outcomes of cases, bodies and contacts, and the limit states that are read off them."""

from typing import TYPE_CHECKING

from rockfrag._lazy import loader

if TYPE_CHECKING:
    from rockfrag.outcomes.limit_states import LimitState, limit_state, limit_states
    from rockfrag.outcomes.outcomes import Outcomes

__all__ = ["LimitState", "Outcomes", "limit_state", "limit_states"]

_HOMES = {
    "limit_states": ("LimitState", "limit_state", "limit_states"),
    "outcomes": ("Outcomes",),
}

__getattr__ = loader(
    __name__, {name: f"{__name__}.{home}" for home, names in _HOMES.items() for name in names}
)
