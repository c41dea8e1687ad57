"""Studies to be disturbed, each in a folder of its own, with the bytes of their undisturbed runs."""

import copy
import hashlib
import os
import resource
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from ..end_to_end.studies import Foreign, write

ROOT = Path(__file__).resolve().parents[2]
COMMAND = (
    sys.executable,
    str(ROOT / "workflow" / "run.py"),
    "study.yaml",
    "--cores",
    "2",
)
SCREEN = ("--logger", "rockfrag")

PATIENCE_S = 1200.0
"""A run may take as long as a loaded machine needs; here only what never ends is ended."""


def write_small(folder: Path, names: tuple[str, ...] = ("T1", "T2", "P")) -> str:
    """Write a study of two objects and more under synthetic motions on floors of a building; return its name."""
    content = {
        "bodies": {"specimens": "blocks.csv"},
        "fragility": {"measures": ["pga_g", "pgv_cm_s"], "confidence": 0.9},
    }
    blocks = dict.fromkeys(names[:-1], (12.4, 37.2, 2.172)) | {
        names[-1]: (18.4, 20.8, 2.3)
    }
    records = {"motion 0": "First", "motion 1": "Second", "motion 2": "Third"}
    write(Foreign(blocks, {}, records, {"ground": 0, "top": 2}, content), folder)
    return "own"


@dataclass
class Tally:
    """What came of the trials of one kind."""

    kind: str
    trials: int = 0
    steps: int = 0
    differing: int = 0
    outside: int = 0
    seconds: float = 0.0
    noise: list[str] = field(default_factory=list)


class Study:
    """A study in a folder of its own, the bytes of its undisturbed run, and studies that are disturbed with it."""

    def __init__(
        self,
        scratch: Path,
        write: Callable[[Path], str] = write_small,
        more: Mapping[str, str] = {},
    ) -> None:
        self.folder = scratch / "a study"
        self.folder.mkdir(parents=True)
        self.name = write(self.folder)
        self.more = dict(more)
        self.beside: list[Study] = []
        started = time.monotonic()
        done = self.run()
        assert done.returncode == 0, done.stderr
        self.seconds = time.monotonic() - started
        self.wanted = self.bytes()
        self.inputs = self.others()
        self.kept = scratch / "kept"
        shutil.copytree(self.folder, self.kept, symlinks=True)

    def twin(self, scratch: Path) -> "Study":
        """The same study in another folder, with the results of this one's undisturbed run."""
        other = copy.copy(self)
        other.more = dict(self.more)
        other.folder = scratch / self.folder.name
        shutil.copytree(self.kept, other.folder, symlinks=True)
        other.beside = [
            item.twin(scratch.parent / f"{scratch.name} {item.name}")
            for item in self.beside
        ]
        return other

    def run(
        self, more: Mapping[str, str] = {}, limit: tuple[int, int] | None = None
    ) -> subprocess.CompletedProcess[str]:
        """Give the command of a user, with less of something than usual, and wait for its end."""
        process = self.start(more)
        if limit:
            resource.prlimit(process.pid, limit[0], (limit[1], resource.RLIM_INFINITY))
        _, said = process.communicate(timeout=PATIENCE_S)
        return subprocess.CompletedProcess(COMMAND, process.returncode, "", said)

    def start(self, more: Mapping[str, str] = {}) -> "subprocess.Popen[str]":
        """Give the command of a user."""
        return subprocess.Popen(
            (*COMMAND, *SCREEN),
            cwd=self.folder,
            env={**os.environ, **self.more, **more},
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
        )

    def anew(self) -> None:
        """Remove all results and all that Snakemake knows."""
        for name in ("results", ".snakemake"):
            shutil.rmtree(self.folder / name, ignore_errors=True)

    def forget(self, *stages: str) -> None:
        """Go back to the undisturbed results, without those of some stages."""
        self.anew()
        for name in ("results", ".snakemake"):
            shutil.copytree(self.kept / name, self.folder / name)
        for pattern in stages:
            for path in (self.folder / "results" / self.name).glob(pattern):
                path.unlink()

    def bytes(self) -> dict[str, str]:
        """Digest of each result; logs have times in them."""
        results = self.folder / "results"
        return {
            path.relative_to(results).as_posix(): hashlib.sha256(
                path.read_bytes()
            ).hexdigest()
            for path in sorted(results.rglob("*"))
            if path.is_file()
            and "logs" not in path.parts
            and path.name not in (".run", ".lock")
        }

    def others(self) -> set[str]:
        """Files beside the results, in the folder above too."""
        above = self.folder.parent
        return {
            path.relative_to(above).as_posix()
            for path in above.rglob("*")
            if not {"results", ".snakemake", "kept"}
            & set(path.relative_to(above).parts)
        }

    def judge(self, tally: Tally, said: subprocess.CompletedProcess[str]) -> None:
        """Count what the last run of a trial left."""
        tally.trials += 1
        if said.returncode != 0:
            tally.steps += 1
            tally.noise.append(said.stderr.strip()[-300:])
            return
        found = self.bytes()
        names = set(found) | set(self.wanted)
        differing = sorted(
            name for name in names if found.get(name) != self.wanted.get(name)
        )
        tally.differing += len(differing)
        tally.noise += [f"differs: {', '.join(differing[:5])}"] if differing else []
        tally.outside += len(self.others() - self.inputs)

    def refused(self, tally: Tally, said: subprocess.CompletedProcess[str]) -> None:
        """See that a run that could not succeed says so in a few words."""
        if said.returncode == 0:
            tally.noise.append("ended well where it could not")
        if "Traceback" in said.stderr or len(said.stderr.splitlines()) > 8:
            tally.noise.append(f"says too much: {said.stderr[-300:]!r}")


def write_shipped(folder: Path, name: str) -> str:
    """Write a study that comes with the project, and return its name; its records are fetched or linked."""
    shutil.copytree(ROOT / "config", folder, dirs_exist_ok=True)
    (folder / f"{name}.yaml").rename(folder / "study.yaml")
    (ROOT / "resources").mkdir(exist_ok=True)
    (folder / "resources").symlink_to(ROOT / "resources")
    return name
