from .conditioning import (
    baseline as baseline,
    demean as demean,
    displacement_baseline as displacement_baseline,
    pad as pad,
    taper as taper,
)
from .filtering import (
    bandpass as bandpass,
    highpass as highpass,
    interpolate as interpolate,
    lowpass as lowpass,
    resample as resample,
)
from .integration import (
    integrate as integrate,
    peak_displacement as peak_displacement,
    peak_velocity as peak_velocity,
)
from .intensity import (
    arias as arias,
    arias_times as arias_times,
    bracketed_times as bracketed_times,
    cav as cav,
    cumulative_arias as cumulative_arias,
    frequency_ratio as frequency_ratio,
    housner_intensity as housner_intensity,
    mean_period as mean_period,
    pga as pga,
    pgd as pgd,
    pgv as pgv,
    pgv_over_pga as pgv_over_pga,
    predominant_period as predominant_period,
    significant_duration as significant_duration,
    spectral_acceleration as spectral_acceleration,
    uplift_ratio as uplift_ratio,
    velocity_ratio as velocity_ratio,
)
from .measures import (
    measure_motion as measure_motion,
    measure_motions as measure_motions,
    measure_pair as measure_pair,
    measure_rocking as measure_rocking,
    rocking_measures as rocking_measures,
)
from .processing import (
    STEPS as STEPS,
    check_steps as check_steps,
    process as process,
)
from .pulse_extraction import (
    StrongestPulse as StrongestPulse,
    strongest_pulse as strongest_pulse,
)
from .pulses import (
    commanded_cosine as commanded_cosine,
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
    fault_normal as fault_normal,
    radial as radial,
    rotate as rotate,
    rotate_to_azimuth as rotate_to_azimuth,
    rotd as rotd,
    stronger_direction as stronger_direction,
)
from .scaling import (
    compress_time as compress_time,
    scale as scale,
    scale_to_arias as scale_to_arias,
    scale_to_pga as scale_to_pga,
    scale_to_pgv as scale_to_pgv,
    scale_to_sa as scale_to_sa,
)
from .selection import (
    bracketed_part as bracketed_part,
    strong_part as strong_part,
    trim as trim,
)
from .spectra import (
    ResponseSpectrum as ResponseSpectrum,
    fourier_amplitude as fourier_amplitude,
    oscillator_response as oscillator_response,
    response_spectrum as response_spectrum,
)
from .synthetic import (
    evolutionary as evolutionary,
    spectrum_compatible as spectrum_compatible,
)
from .time_base import common_time as common_time
