"""Steps by name, as a configuration lists them."""

import inspect
from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import Any

from rockfrag.errors import InputError
from rockfrag.motions import conditioning, filtering, scaling
from rockfrag.records.motion import Motion

STEPS: Mapping[str, Callable[..., Motion]] = MappingProxyType(
    {
        step.__name__: step
        for step in (
            *(conditioning.demean, conditioning.remove_median, conditioning.despike),
            *(conditioning.baseline, conditioning.displacement_baseline, conditioning.taper),
            *(conditioning.pad, filtering.highpass, filtering.lowpass, filtering.bandpass),
            *(filtering.resample, filtering.interpolate, conditioning.strong_part),
            *(conditioning.bracketed_part, conditioning.trim, scaling.scale, scaling.scale_to_pga),
            *(scaling.scale_to_pgv, scaling.scale_to_sa, scaling.scale_to_arias),
            scaling.compress_time,
        )
    }
)
"""Every step that :func:`process` knows, by its name."""

_FOUND = frozenset({"removed_m_s2", "replaced", "peak_before_m_s2", "peak_after_m_s2", "ends_m_s2"})
"""What steps write into the provenance of what they found: no parameters, when they are taken again."""


def process(motion: Motion, steps: Sequence[Mapping[str, Any]] = ()) -> Motion:
    """Take a motion through steps in the order given; no steps leave it as it is.

    Parameters
    ----------
    motion : what to process
    steps
        Each a mapping with the ``step``'s name and its parameters, such as
        ``{"step": "highpass", "corner_hz": 0.1, "order": 4}``.

    Returns
    -------
    The processed motion; each step and its parameters are appended to its provenance.
    """
    # a misspelt last step is reported before the first one has cost anything
    for function, parameters in check_steps(steps):
        motion = function(motion, **parameters)
    return motion


def check_steps(
    steps: Sequence[Mapping[str, Any]],
) -> list[tuple[Callable[..., Motion], dict[str, Any]]]:
    """Return the functions and parameters of steps; InputError if :func:`process` does not know one."""
    if isinstance(steps, str | Mapping) or not isinstance(steps, Sequence):
        raise InputError(f"processing: a list of steps is needed, got {steps!r}.")
    return [_checked(number, entry) for number, entry in enumerate(steps, start=1)]


def _checked(number: int, entry: Mapping[str, Any]) -> tuple[Callable[..., Motion], dict[str, Any]]:
    """Return the function of the ``number``-th entry of a list of steps, and the parameters that it names."""
    if not isinstance(entry, Mapping) or "step" not in entry:
        raise InputError(
            f"processing, entry {number}: {entry!r} is not a mapping with a key 'step'."
        )
    name = entry["step"]
    if not isinstance(name, str) or name not in STEPS:
        raise InputError(
            f"processing, entry {number}: there is no step {name!r}; known are {', '.join(STEPS)}."
        )
    parameters = {key: value for key, value in entry.items() if key != "step" and key not in _FOUND}
    # the first parameter is the motion itself
    known = dict(list(inspect.signature(STEPS[name]).parameters.items())[1:])
    unknown = [key for key in parameters if key not in known]
    if unknown:
        raise InputError(
            f"processing, entry {number}: step {name} has no parameter {unknown[0]!r}; "
            f"known are {', '.join(known) or 'none'}."
        )
    missing = [
        key
        for key, p in known.items()
        if p.default is inspect.Parameter.empty and key not in parameters
    ]
    if missing:
        raise InputError(f"processing, entry {number}: step {name} needs {', '.join(missing)}.")
    return STEPS[name], parameters
