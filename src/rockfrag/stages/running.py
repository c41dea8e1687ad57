"""Running a study's stages as the workflow does: what comes before the first job, and one job.

In: a configuration and the paths of a rule. Out: the results of one stage, and a lock of the study. Docs:
``docs/reliability.md``.
"""

import os
import platform
import time
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from rockfrag.base.errors import InputError
from rockfrag.base.files import write_text
from rockfrag.runtime.lock import locked
from rockfrag.runtime.processes import end_with
from rockfrag.stages.job import Job
from rockfrag.stages.log import logged
from rockfrag.study.loading import AnyStudy, any_study, check_building, check_records
from rockfrag.study.study import RECORDS_FOLDER, Study

RESULTS = Path("results")
"""Folder of all studies' results, from the folder in which the workflow runs."""

OWNER = "configuration.txt"
"""File in a study's folder that names the configuration whose results these are."""

LOCK, HOLDER = ".lock", ".run"
"""Files in a study's folder: the one that its run holds locked, and the one that says which process that is."""

# Variable of the environment: the process of the run, with which its jobs end
RUN = "ROCKFRAG_RUN"


def prepared(
    content: Mapping[str, Any], path: str | os.PathLike[str]
) -> tuple[AnyStudy, Path]:
    """Make all checks that come before the first job; return the study, and the folder of its results."""
    study = any_study(content, path)
    folder = results_folder(study)
    if (
        isinstance(study, Study)
        and not (folder / "motions" / "records.parquet").exists()
    ):
        check_building(study)
        check_records(study)
    return study, folder


def results_folder(study: AnyStudy) -> Path:
    """Folder of a study's results; refuse one that holds those of another configuration.

    Parameters
    ----------
    study : the study

    Returns
    -------
    The folder.
    """
    folder = RESULTS / study.name
    owner = folder / OWNER
    if owner.is_file():
        other = owner.read_text(encoding="utf-8").strip()
        if other != _named(study) and Path(other).is_file():
            raise InputError(
                f"{study.source}: key study: {folder} holds the results of {other}; give this study a "
                "name of its own, or remove that folder."
            )
    return folder


@contextmanager
def run_lock(results: Path) -> Iterator[None]:
    """Be the only run of a study while the block lasts; half-written files of a killed one are removed.

    A study that is running already is refused; the message says in which process and since when.
    """
    holder = results / HOLDER
    with locked(results / LOCK) as free:
        if not free:
            # it may be about to write who it is
            who = holder.read_text() if holder.is_file() else "of another run"
            raise InputError(
                f"{results}: the study is running already, in process {who}; wait for it, or end that process."
            )
        for part in results.rglob(".*.part"):
            part.unlink(missing_ok=True)
        bring_to_now([*results.rglob("*"), *Path(RECORDS_FOLDER).glob("*/*.json")])
        results.mkdir(parents=True, exist_ok=True)
        holder.write_text(
            f"{os.getpid()} since {time.strftime('%H:%M:%S on %Y-%m-%d')}"
        )
        yield


def bring_to_now(files: Iterable[Path]) -> None:
    """Give files whose time lies in the future, as after a clock was set back, times up to now in the same order.

    Results that are written now would seem to be older than those that they are made of.
    """
    now = time.time_ns()
    times = {file: file.stat().st_mtime_ns for file in files if file.is_file()}
    ahead = sorted({moment for moment in times.values() if moment > now})
    earlier = {moment: now - rank for rank, moment in enumerate(reversed(ahead))}
    for file, moment in times.items():
        if moment in earlier:
            os.utime(file, ns=(earlier[moment], earlier[moment]))


def run_job(
    stage: str,
    config: Mapping[str, Any],
    study_file: str,
    *,
    inputs: Iterable[str],
    outputs: Iterable[str],
    part: int,
    threads: int,
    log_file: str,
) -> None:
    """Run a stage of a study, as a job of the workflow does, and write what it yields.

    Parameters
    ----------
    stage : ``module:function``
    config, study_file : configuration of the study, and the file that it was read from
    inputs, outputs : paths that the rule of the workflow declares
    part : number of the job's part of the motions, see :class:`rockfrag.stages.job.Job`
    threads : to use
    log_file : its stem names the job
    """
    end_with_run()
    module, _, function = stage.partition(":")
    with logged(log_file, Path(log_file).stem) as log:
        study = any_study(config, study_file)
        folder = RESULTS / study.name
        write_text(f"{_named(study)}\n", folder / OWNER)
        declared = [
            frozenset(Path(path) for path in paths) for paths in (inputs, outputs)
        ]
        job = Job(study, folder, threads, log, part, *declared)
        for name, value in getattr(import_module(module), function)(job):
            job.write(name, value)


def end_with_run() -> None:
    """Let this job end as soon as its run does, or the shell in which the run started it."""
    if RUN in os.environ:
        end_with(int(os.environ[RUN]))


def _named(study: AnyStudy) -> str:
    return Path(os.path.relpath(study.source)).as_posix()


_BLAS = {
    "x86_64": "PRESCOTT",
    "AMD64": "PRESCOTT",
    "aarch64": "ARMV8",
    "arm64": "ARMV8",
}
"""The kernels of OpenBLAS that every processor of an architecture can run."""

_C_LIBRARY = "glibc.cpu.hwcaps=" + ",".join(
    # the C library has known each of them by two names
    f"-{feature}{ending}"
    for feature in ("FMA", "FMA4", "AVX2")
    for ending in ("", "_Usable")
)


def same_numbers(environment: Mapping[str, str]) -> dict[str, str]:
    """Variables, set before Python starts, by which numbers depend on architecture and libraries alone.

    Versions of a function for older and for newer processors add in another order or round once, not twice. A
    job takes the oldest of each, so that all machines of one architecture write the same bytes; kernels need none.
    """
    tunables = environment.get("GLIBC_TUNABLES", "").split(":")
    kept = [
        each for each in tunables if each and not each.startswith("glibc.cpu.hwcaps=")
    ]
    simd = np.show_config(mode="dicts")["SIMD Extensions"]
    chosen = {
        "NPY_ENABLE_CPU_FEATURES": "",
        "NPY_DISABLE_CPU_FEATURES": " ".join(
            [*simd.get("found", ()), *simd.get("not found", ())]
        ),
        # sums of several threads are added in another order
        "OPENBLAS_NUM_THREADS": "1",
        "GLIBC_TUNABLES": ":".join([*kept, _C_LIBRARY]),
    }
    if blas := _BLAS.get(platform.machine()):
        chosen["OPENBLAS_CORETYPE"] = blas
    return chosen
