"""The laboratory's protocol of a study."""

from rockfrag.shaketable.protocols import GeometricSteps, Protocol
from rockfrag.study.study import Study


def protocol_of(study: Study, step_percent: float | None = None) -> Protocol:
    """Return the step protocol of a study, or the same with another step [%]."""
    step = study.protocol_step_percent if step_percent is None else step_percent
    amplitudes = study.amplitudes
    return Protocol(GeometricSteps(amplitudes.lowest_g, step / 100), amplitudes.highest_g)
