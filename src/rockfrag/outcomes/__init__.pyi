from .limit_states import (
    LimitState as LimitState,
    limit_state as limit_state,
    limit_states as limit_states,
)
from .outcomes import Outcomes as Outcomes
