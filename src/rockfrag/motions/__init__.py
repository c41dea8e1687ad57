"""Motions: processing, scaling, spectra, intensity measures, pulses and synthetic motions."""

from typing import TYPE_CHECKING

from rockfrag._lazy import loader

if TYPE_CHECKING:
    from rockfrag.motions.conditioning import baseline, demean, displacement_baseline, pad, taper
    from rockfrag.motions.filtering import bandpass, highpass, interpolate, lowpass, resample
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
    from rockfrag.motions.rotation import (
        fault_normal,
        radial,
        rotate,
        rotate_to_azimuth,
        rotd,
        rotd50,
        rotd100,
        stronger_direction,
    )
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
    from rockfrag.motions.time_base import common_time
    from rockfrag.records.integration import integrate, peak_displacement, peak_velocity

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
    "common_time",
    "compress_time",
    "cumulative_arias",
    "demean",
    "displacement_baseline",
    "evolutionary",
    "fault_normal",
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
    "radial",
    "rectangular",
    "resample",
    "response_spectrum",
    "ricker_antisymmetric",
    "ricker_symmetric",
    "rocking_measures",
    "rotate",
    "rotate_to_azimuth",
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
    "stronger_direction",
    "strongest_pulse",
    "taper",
    "trim",
    "uplift_ratio",
    "velocity_ratio",
]

_HOMES = {
    "time_base": ("common_time",),
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
        "fault_normal",
        "radial",
        "rotate_to_azimuth",
        "stronger_direction",
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
    {name: f"{__name__}.{home}" for home, names in _HOMES.items() for name in names}
    # what a record is between its samples
    | dict.fromkeys(
        ("integrate", "peak_displacement", "peak_velocity"), "rockfrag.records.integration"
    ),
)


def __dir__() -> list[str]:
    return __all__
