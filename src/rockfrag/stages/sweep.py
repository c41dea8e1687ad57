"""Every configuration under every motion at every amplitude: what all statistics start from."""

import warnings
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockfrag.records.motion import Motion
from rockfrag.stages.stage import Job, Results, Stage
from rockfrag.study.amplitudes import Amplitudes
from rockfrag.study.configurations import Configuration
from rockfrag.study.study import Study
from rockfrag.units import GRAVITY

if TYPE_CHECKING:
    from rockfrag.rocking import EnsembleResult

FALLEN = ("", "pedestal", "statue")

NEAR = 1 + 0.01 * np.arange(-10, 11)
"""Factors on a motion as recorded: itself, and up to a tenth weaker and stronger."""

SLIPS = ("slip_ground", "slip_interface", "peak_slip_ground", "peak_slip_interface")
"""What an ensemble says of sliding [m]."""

BATCH = 12
"""Motions shaken at a time: few enough for little memory, enough to keep every core busy."""


def run(job: Job[Study]) -> Results:
    """Yield the sweep of every configuration."""
    from rockfrag.rocking.ensemble import LIGHT

    motions = job.motions("motions/floors")
    ups = job.motions("motions/vertical") if job.study.vertical else None
    histories, recorded = 0, []
    for configuration in job.study.configurations:
        parts = [
            sweep(
                configuration,
                motions[i : i + BATCH],
                job.study.amplitudes,
                job.threads,
                None if ups is None else ups[i : i + BATCH],
            )
            for i in range(0, len(motions), BATCH)
        ]
        table = pd.concat(parts, ignore_index=True)
        yield f"sweep/{configuration.slug}", table
        if ups is not None and configuration.friction is None:
            light = int((table["lightest"] < LIGHT).sum())
            job.log.info(
                "%s: the ground takes more than half of all weight in %d of %d histories",
                configuration.name,
                light,
                len(table),
            )
        recorded.append(as_recorded(configuration, motions, job.threads, ups))
        histories += len(table)
        job.log.info("%s: %d histories so far", configuration.name, histories)
    yield "as_recorded", pd.concat(recorded, ignore_index=True)
    job.log.info("response histories: %d", histories)


def sweep(
    configuration: Configuration,
    motions: Sequence[Motion],
    amplitudes: Amplitudes,
    threads: int = 1,
    vertical: Sequence[Motion] | None = None,
) -> pd.DataFrame:
    """Shake one configuration by every motion, scaled to every amplitude.

    Parameters
    ----------
    configuration
        What stands on the table.
    motions
        Motions of the table; each is scaled so that its peak is the amplitude.
    amplitudes
        Peaks of the motion.
    threads
        Threads to use; the result does not depend on it.
    vertical
        Vertical motion beside each motion, which is scaled with it; None shakes horizontally alone.

    Returns
    -------
    One row per motion and amplitude: ``configuration``, ``object``, ``pedestal`` (``P`` or ``NP``),
    ``motion``, ``event``, ``floor``, ``amplitude_g``, ``overturned``, ``overturned_body``,
    ``overturning_time_s``, ``peak_rotation_statue``, ``peak_rotation_pedestal`` (|θ| over the
    critical angle), ``impacts``, ``closest_approach`` (small where the verdict nearly flipped); with vertical
    motion and without friction also ``lightest``, the least weight over that on a ground at rest; with friction
    also ``slip_ground_m``, ``slip_interface_m`` (at the end), ``peak_slip_ground_m``, ``peak_slip_interface_m``,
    ``flights`` and ``overturned_without_sliding``, the verdict if nothing could slide or fly.
    """
    from rockfrag.motions.scaling import factors_to_pga

    values = amplitudes.values_g
    scales = np.array([factors_to_pga(motion, values) for motion in motions])
    result = _shaken(configuration, motions, scales, threads, vertical)
    each = len(values)
    table = pd.DataFrame(
        {
            "configuration": configuration.name,
            "object": configuration.object,
            "pedestal": configuration.label,
            "motion": np.repeat([motion.name for motion in motions], each),
            "event": np.repeat(
                [motion.metadata.get("event") or motion.name for motion in motions], each
            ),
            "floor": np.repeat([motion.metadata["floor"] for motion in motions], each),
            "amplitude_g": np.tile(values, len(motions)),
            "overturned": result.overturned[0].ravel(),
            "overturned_body": np.take(FALLEN, result.overturned_body[0].ravel()),
            "overturning_time_s": result.overturning_time[0].ravel(),
            "peak_rotation_statue": result.peak_rotation[0].ravel(),
            "peak_rotation_pedestal": result.peak_rotation_pedestal[0].ravel(),
            "impacts": result.impacts[0].ravel(),
            "closest_approach": result.closest_approach[0].ravel(),
        }
    )
    if configuration.friction is None:
        return table if vertical is None else table.assign(lightest=result.lightest[0].ravel())
    rough = _shaken(replace(configuration, friction=None), motions, scales, threads, vertical)
    return table.assign(
        **{f"{name}_m": getattr(result, name)[0].ravel() for name in SLIPS},
        flights=result.flights[0].ravel(),
        overturned_without_sliding=rough.overturned[0].ravel(),
    )


def _shaken(
    configuration: Configuration,
    motions: Sequence[Motion],
    scales: NDArray[np.float64],
    threads: int,
    vertical: Sequence[Motion] | None,
) -> "EnsembleResult":
    """Outcomes of one configuration under every motion at every scale."""
    from rockfrag.rocking.ensemble import LightBodies, overturns

    with warnings.catch_warnings():
        # told of in the column lightest and in the report
        warnings.simplefilter("ignore", LightBodies)
        return overturns(
            [configuration.body],
            [motion.acceleration for motion in motions],
            [motion.dt for motion in motions],
            scales,
            restitution=[configuration.restitution],
            friction=None if configuration.friction is None else [configuration.friction],
            vertical=None if vertical is None else [motion.acceleration for motion in vertical],
            threads=threads,
        )


def as_recorded(
    configuration: Configuration,
    motions: Sequence[Motion],
    threads: int = 1,
    vertical: Sequence[Motion] | None = None,
) -> pd.DataFrame:
    """Shake one configuration by every motion as it was recorded.

    Parameters
    ----------
    configuration
        What stands on the table.
    motions
        Motions of the table.
    threads
        Threads to use; the result does not depend on it.
    vertical
        Vertical motion beside each motion, which is scaled with it; None shakes horizontally alone.

    Returns
    -------
    One row per motion: ``configuration``, ``object``, ``pedestal`` (``P`` or ``NP``), ``motion``, ``event``,
    ``floor``, ``pga_g``, ``overturned``, ``overturned_body``, ``peak_rotation`` (of the object, |θ| over the
    critical angle), ``share_near`` (share that overturns of the motions up to a tenth weaker or stronger);
    with friction also ``peak_slip_m``.
    """
    scales = np.tile(NEAR, (len(motions), 1))
    result = _shaken(configuration, motions, scales, threads, vertical)
    itself = len(NEAR) // 2
    table = pd.DataFrame(
        {
            "configuration": configuration.name,
            "object": configuration.object,
            "pedestal": configuration.label,
            "motion": [motion.name for motion in motions],
            "event": [motion.metadata.get("event") or motion.name for motion in motions],
            "floor": [motion.metadata["floor"] for motion in motions],
            "pga_g": [motion.pga / GRAVITY for motion in motions],
            "overturned": result.overturned[0, :, itself],
            "overturned_body": np.take(FALLEN, result.overturned_body[0, :, itself]),
            "peak_rotation": result.peak_rotation[0, :, itself],
            "share_near": result.overturned[0].mean(axis=1),
        }
    )
    if configuration.friction is None:
        return table
    peaks = np.maximum(result.peak_slip_ground, result.peak_slip_interface)
    return table.assign(peak_slip_m=peaks[0, :, itself])


STAGE = Stage(
    name="sweep",
    run=run,
    inputs=lambda study: study.motion_sets,
    files=lambda study: study.body_files,
    outputs=lambda study: [*study.sweep_tables, "as_recorded"],
    settings=("bodies", "amplitudes", "friction", "vertical"),
    parallel=True,
)
