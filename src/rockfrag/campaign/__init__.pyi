from .table_motions import table_motions as table_motions
from .tests import (
    Campaign as Campaign,
    read_campaign as read_campaign,
)
from .thresholds import (
    best_threshold as best_threshold,
    cross_validated_threshold as cross_validated_threshold,
)
from .trials import (
    Trials as Trials,
    sample_trials as sample_trials,
)
from .validation import (
    Validated as Validated,
    cross_validate as cross_validate,
)
from .outcomes import simulate_tests as simulate_tests
