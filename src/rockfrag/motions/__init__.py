"""Motions: processing, scaling, spectra, intensity measures, pulses and synthetic motions."""

from typing import TYPE_CHECKING

from rockfrag._lazy import loader

if TYPE_CHECKING:
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
    from rockfrag.motions.measures import (
        measure_motion,
        measure_motions,
        measure_pair,
        measure_rocking,
        rocking_measures,
    )
    from rockfrag.motions.processing import STEPS, check_steps, process
    from rockfrag.motions.pulse_extraction import StrongestPulse, pulse_motion, strongest_pulse
    from rockfrag.motions.pulses import (
        half_sine,
        mavroeidis_papageorgiou,
        one_cosine,
        one_sine,
        rectangular,
        ricker_antisymmetric,
        ricker_symmetric,
        sine,
        sine_sweep,
    )
    from rockfrag.motions.rotation import rotate, rotd, rotd50, rotd100
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
    from rockfrag.motions.synthetic import evolutionary, spectrum_compatible

__all__ = [
    "STEPS",
    "ResponseSpectrum",
    "StrongestPulse",
    "arias",
    "arias_times",
    "bandpass",
    "baseline",
    "bracketed_part",
    "bracketed_times",
    "cav",
    "check_steps",
    "compress_time",
    "cumulative_arias",
    "demean",
    "displacement_baseline",
    "evolutionary",
    "fourier_amplitude",
    "frequency_ratio",
    "half_sine",
    "highpass",
    "housner_intensity",
    "integrate",
    "interpolate",
    "lowpass",
    "mavroeidis_papageorgiou",
    "mean_period",
    "measure_motion",
    "measure_motions",
    "measure_pair",
    "measure_rocking",
    "one_cosine",
    "one_sine",
    "oscillator_response",
    "pad",
    "peak_displacement",
    "peak_velocity",
    "pga",
    "pgd",
    "pgv",
    "pgv_over_pga",
    "predominant_period",
    "process",
    "pulse_motion",
    "rectangular",
    "resample",
    "response_spectrum",
    "ricker_antisymmetric",
    "ricker_symmetric",
    "rocking_measures",
    "rotate",
    "rotd",
    "rotd50",
    "rotd100",
    "scale",
    "scale_to_arias",
    "scale_to_pga",
    "scale_to_pgv",
    "scale_to_sa",
    "significant_duration",
    "sine",
    "sine_sweep",
    "spectral_acceleration",
    "spectral_displacement",
    "spectral_velocity",
    "spectrum_compatible",
    "strong_part",
    "strongest_pulse",
    "taper",
    "trim",
    "uplift_ratio",
    "velocity_ratio",
]

_HOMES = {
    "conditioning": (
        "baseline",
        "demean",
        "displacement_baseline",
        "pad",
        "taper",
    ),
    "filtering": (
        "bandpass",
        "highpass",
        "interpolate",
        "lowpass",
        "resample",
    ),
    "integration": (
        "integrate",
        "peak_displacement",
        "peak_velocity",
    ),
    "intensity": (
        "arias",
        "arias_times",
        "bracketed_times",
        "cav",
        "cumulative_arias",
        "frequency_ratio",
        "housner_intensity",
        "mean_period",
        "pga",
        "pgd",
        "pgv",
        "pgv_over_pga",
        "predominant_period",
        "significant_duration",
        "spectral_acceleration",
        "spectral_displacement",
        "spectral_velocity",
        "uplift_ratio",
        "velocity_ratio",
    ),
    "measures": (
        "measure_motion",
        "measure_motions",
        "measure_pair",
        "measure_rocking",
        "rocking_measures",
    ),
    "processing": (
        "STEPS",
        "check_steps",
        "process",
    ),
    "pulse_extraction": (
        "StrongestPulse",
        "pulse_motion",
        "strongest_pulse",
    ),
    "pulses": (
        "half_sine",
        "mavroeidis_papageorgiou",
        "one_cosine",
        "one_sine",
        "rectangular",
        "ricker_antisymmetric",
        "ricker_symmetric",
        "sine",
        "sine_sweep",
    ),
    "rotation": (
        "rotate",
        "rotd",
        "rotd50",
        "rotd100",
    ),
    "scaling": (
        "compress_time",
        "scale",
        "scale_to_arias",
        "scale_to_pga",
        "scale_to_pgv",
        "scale_to_sa",
    ),
    "selection": (
        "bracketed_part",
        "strong_part",
        "trim",
    ),
    "spectra": (
        "ResponseSpectrum",
        "fourier_amplitude",
        "oscillator_response",
        "response_spectrum",
    ),
    "synthetic": (
        "evolutionary",
        "spectrum_compatible",
    ),
}

__getattr__ = loader(
    __name__,
    {name: f"{__name__}.{home}" for home, names in _HOMES.items() for name in names},
)


def __dir__() -> list[str]:
    return __all__
