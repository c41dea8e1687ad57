"""Motions: processing, scaling, spectra and intensity measures."""

from rockfrag.motions.conditioning import baseline, demean, displacement_baseline, pad, taper
from rockfrag.motions.filtering import bandpass, highpass, interpolate, lowpass, resample
from rockfrag.motions.integration import integrate, peak_displacement, peak_velocity
from rockfrag.motions.intensity import (
    arias,
    arias_times,
    bracketed_times,
    cav,
    cumulative_arias,
    frequency_ratio,
    housner_intensity,
    mean_period,
    pga,
    pgd,
    pgv,
    pgv_over_pga,
    predominant_period,
    significant_duration,
    spectral_acceleration,
    spectral_displacement,
    spectral_velocity,
    uplift_ratio,
    velocity_ratio,
)
from rockfrag.motions.processing import STEPS, check_steps, process
from rockfrag.motions.rotation import over_directions, rotate, rotd, rotd50, rotd100
from rockfrag.motions.scaling import (
    compress_time,
    scale,
    scale_to_arias,
    scale_to_pga,
    scale_to_pgv,
    scale_to_sa,
)
from rockfrag.motions.selection import bracketed_part, strong_part, trim
from rockfrag.motions.spectra import (
    ResponseSpectrum,
    fourier_amplitude,
    oscillator_response,
    response_spectrum,
)
