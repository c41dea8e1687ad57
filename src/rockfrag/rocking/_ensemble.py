"""Kernels that march many cases."""

import math

import numpy as np

from rockfrag.rocking._compile import kernel
from rockfrag.rocking._march import march
from rockfrag.rocking._tally import EVENT, HISTORY, scratch


@kernel
def march_cases(
    first, last, parameters, substeps, free, samples, offsets, dts, scales, closing_speed, results
):  # fmt: skip
    """March cases ``first`` ≤ i < ``last`` of bodies × motions × scales, the scale running fastest.

    Parameters
    ----------
    parameters : (bodies, PARAMETERS)
    substeps : (bodies, motions) steps per sample
    free : (bodies, motions) samples of free rocking
    samples : all motions end to end [m/s²]
    offsets : (motions + 1,) where each motion begins in ``samples``
    dts : (motions,) [s]
    scales : (motions, scales)
    results : (last - first, SUMMARY)
    """
    n_motions, n_scales = scales.shape
    q = scratch()
    history = np.zeros((0, HISTORY))
    events = np.zeros((0, EVENT))
    initial = np.zeros(4)
    for i in range(first, last):
        scale = i % n_scales
        motion = (i // n_scales) % n_motions
        body = i // (n_scales * n_motions)
        summary = results[i - first]
        if scales[motion, scale] == 0.0:
            summary[:] = 0.0
            summary[1] = math.nan
            summary[10] = math.inf
            continue
        march(
            parameters[body],
            samples[offsets[motion] : offsets[motion + 1]],
            dts[motion],
            scales[motion, scale],
            substeps[body, motion],
            free[body, motion],
            initial,
            closing_speed,
            history,
            events,
            q,
            summary,
        )
