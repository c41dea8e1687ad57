from .intensity import (
    pga as pga,
    pgv as pgv,
)
from .measures import (
    measure_motion as measure_motion,
    measure_motions as measure_motions,
    measure_pair as measure_pair,
    measure_rocking as measure_rocking,
)
from .processing import (
    process as process,
)
from .pulse_extraction import (
    StrongestPulse as StrongestPulse,
    strongest_pulse as strongest_pulse,
)
from .pulses import (
    half_sine as half_sine,
    mavroeidis_papageorgiou as mavroeidis_papageorgiou,
    one_cosine as one_cosine,
    one_sine as one_sine,
    rectangular as rectangular,
    ricker_antisymmetric as ricker_antisymmetric,
    ricker_symmetric as ricker_symmetric,
    sine as sine,
    sine_sweep as sine_sweep,
)
from .rotation import (
    rotate as rotate,
    rotd as rotd,
)
from .processing import (
    scale as scale,
    scale_to_pga as scale_to_pga,
    scale_to_pgv as scale_to_pgv,
)
from .response_spectra import (
    ResponseSpectrum as ResponseSpectrum,
    response_spectrum as response_spectrum,
)
from .synthetic import (
    evolutionary as evolutionary,
    spectrum_compatible as spectrum_compatible,
)
