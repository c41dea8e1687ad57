"""What a stage is: a rule of the workflow that says itself what it reads, writes and depends on.

A new stage is one file in this folder with a constant ``STAGE``, listed in :mod:`rockfrag.guests`.
"""

import json
import logging
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, Protocol, TypeVar

import pandas as pd

from rockfrag.files import write_table
from rockfrag.stages.digest import source_digest

if TYPE_CHECKING:
    from rockfrag.records.motion import Motion


class Named(Protocol):
    """Whatever a study is, it has a name."""

    @property
    def name(self) -> str:
        """Folder under ``results/``."""


S = TypeVar("S", bound=Named)
Names = Sequence[str] | Callable[[Any], Sequence[str]]
"""Names, or a function that tells them for a study."""

Results = Iterator[tuple[str, "pd.DataFrame | list[Motion]"]]
"""What a stage yields: each of its results by name, as soon as it is there."""


_LIBRARIES_MB = 1500
"""Memory of a process that has loaded and compiled all that a stage uses [MiB]."""

_BYTES_A_SWEEP = 20_000
"""Memory for what statistics know of a configuration under a motion, whatever the number of amplitudes."""


@dataclass(frozen=True)
class Stage(Generic[S]):
    """One stage of a study, which is one rule of the workflow.

    Results are named by their path in the study's folder: ``tests`` is a table (``tests.csv`` and
    ``tests.parquet``), ``motions/ground.parquet`` a file, ``exports/`` a folder.

    Attributes
    ----------
    name
        Name of the rule.
    run
        Computes and yields the results; what it does not yield it writes itself.
    outputs
        Names of its results.
    inputs
        Names of the results of other stages that it reads.
    files
        Files of the user that it depends on.
    settings
        Keys of the configuration that it depends on; a change of one computes it again.
    wanted
        Whether a study has this stage at all.
    parallel
        Whether it can use all cores, and gets them.
    leaves_half
        Whether it leaves half of them to the stages that do not wait for it, though it could use all.
    small
        Whether it takes seconds, less than a cluster takes to start it.
    minutes
        For how long a cluster should lend a machine [min].
    """

    name: str
    run: Callable[["Job[S]"], Results]
    outputs: Names
    inputs: Names = ()
    files: Names = ()
    settings: tuple[str, ...] = ()
    wanted: Callable[[S], bool] = lambda study: True
    parallel: bool = False
    leaves_half: bool = False
    small: bool = False
    minutes: int = 120

    def threads(self, cores: int) -> int:
        """Threads that it gets of so many cores."""
        if not self.parallel:
            return 1
        return max(1, cores // 2) if self.leaves_half else cores

    def memory_mb(self, study: S) -> int:
        """Memory that a cluster should lend [MiB]: libraries, and what is known of every sweep."""
        return _LIBRARIES_MB + int(getattr(study, "sweeps", 0) * _BYTES_A_SWEEP / 2**20)

    def output_files(self, study: S) -> list[str]:
        """Paths of the results in the study's folder, those of a table in both forms."""
        paths = []
        for name in _of(self.outputs, study):
            is_table = not name.endswith("/") and not Path(name).suffix
            paths += [f"{name}.csv", f"{name}.parquet"] if is_table else [name]
        return paths

    def input_files(self, study: S) -> list[str]:
        """Paths of what it reads in the study's folder: of a table the form for programs."""
        return [
            name if Path(name).suffix else f"{name}.parquet" for name in _of(self.inputs, study)
        ]

    def user_files(self, study: S) -> list[str]:
        """Paths of the user's files that it depends on."""
        return list(_of(self.files, study))

    def triggers(self, config: Mapping[str, Any]) -> str:
        """Everything beside files whose change means computing again: settings and source."""
        chosen = {key: config.get(key) for key in self.settings}
        return json.dumps(
            {"settings": chosen, "source": source_digest(self.run.__module__)},
            sort_keys=True,
            default=str,
        )


@dataclass(frozen=True)
class Job(Generic[S]):
    """One stage of one study at work: what it may read, and where it writes.

    Attributes
    ----------
    study
        The study.
    stage
        The stage.
    folder
        Folder of the study's results.
    threads
        Threads to use; no result depends on their number.
    log
        Log of the job; its last line says what was found.
    """

    study: S
    stage: Stage[S]
    folder: Path
    threads: int
    log: logging.Logger

    def table(self, name: str) -> pd.DataFrame:
        """Read a table of another stage by its name."""
        return pd.read_parquet(self._declared(f"{name}.parquet"))

    def motions(self, name: str, part: tuple[int, int] = (0, 1)) -> "list[Motion]":
        """Read a set of motions of another stage, such as ``motions/ground``, or part k of n of it."""
        from rockfrag.records.motion import read_motion_set

        return read_motion_set(self._declared(f"{name}.parquet"), part)

    def file(self, path: str) -> Path:
        """Return the whole path of another stage's file."""
        return self._declared(path)

    def write(self, name: str, result: "pd.DataFrame | list[Motion]") -> None:
        """Write a result in the forms that its stage declares."""
        declared = _of(self.stage.outputs, self.study)
        if isinstance(result, pd.DataFrame) and f"{name}.parquet" in declared:
            write_table(result, self.folder / f"{name}.parquet")
        elif isinstance(result, pd.DataFrame) and name in declared:
            write_table(result, self.folder / f"{name}.csv", self.folder / f"{name}.parquet")
        elif isinstance(result, list) and f"{name}.parquet" in declared:
            from rockfrag.records.motion import write_motion_set

            write_motion_set(result, self.folder / f"{name}.parquet")
        else:
            raise ValueError(f"stage {self.stage.name} does not declare its result {name}")

    def _declared(self, path: str) -> Path:
        if path not in self.stage.input_files(self.study):
            raise ValueError(f"stage {self.stage.name} reads {path} without declaring it")
        return self.folder / path


def priorities(stages: Sequence[Stage[Any]], study: Any) -> dict[str, int]:
    """Say which of the stages that could start does so first, by its name: the larger number.

    First what most others wait for, then what takes long.
    """
    waiting: dict[str, set[str]] = {}
    for one in reversed(stages):
        written = set(one.output_files(study))
        readers = [other for other in stages if written.intersection(other.input_files(study))]
        waiting[one.name] = {
            name for other in readers for name in (other.name, *waiting[other.name])
        }
    return {one.name: 2 * len(waiting[one.name]) + one.parallel for one in stages}


def _of(names: Names, study: Any) -> Sequence[str]:
    return names(study) if callable(names) else names
