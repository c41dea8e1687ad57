"""Interrupt, starve and misuse a small study, and see that it ends in the same bytes by itself.

    python benchmarks/torture.py                 # all of it, under 15 minutes of two idle cores
    python benchmarks/torture.py --only memory   # one kind of trials

Each trial starts from the results of an undisturbed run, or from nothing, does what a machine or a person
might do, and then gives the same command once more. It passes if that command ends well without any other
step, all results have the bytes of the undisturbed run, and nothing lies outside of ``results`` and
``.snakemake`` that was not there before. Two kinds of trials run at a time, each in a folder of its own.
Prints a table in Markdown, and puts it into ``docs/reliability.md`` if all trials of all kinds passed; exit
status 1 if one failed.
"""

import argparse
import copy
import hashlib
import io
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import zipfile
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

import numpy as np
import psutil
import yaml

from rockfrag.files import write_text

ROOT = Path(__file__).resolve().parents[1]
COMMAND = (sys.executable, str(ROOT / "workflow" / "run.py"), "study.yaml", "--cores", "2")
SCREEN = ("--logger", "rockfrag")
NAMES = ("T/1", "$x^{2$", "<b>&", "像", "a'b\"c", "con", "T{x}")
"""Names of blocks that are data and nothing else."""

FOREIGN = (
    {"OPENBLAS_CORETYPE": "Haswell", "NPY_DISABLE_CPU_FEATURES": "X86_V4", "NUMBA_CPU_NAME": "generic"},
    {"OPENBLAS_CORETYPE": "Sandybridge", "NPY_DISABLE_CPU_FEATURES": "X86_V3", "PYTHONHASHSEED": "7"},
    {"LC_ALL": "tr_TR.UTF-8", "TZ": "Asia/Kathmandu", "OPENBLAS_NUM_THREADS": "2"},
)  # fmt: skip


PAGE = ROOT / "docs" / "reliability.md"
BEGIN, END = "<!-- results of make torture -->\n", "<!-- end of results -->\n"
PATIENCE_S = 3600.0
"""A run may take as long as a loaded machine needs; here only what never ends is ended."""


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

    @property
    def row(self) -> str:
        """Row of the table."""
        counts = f"{self.trials} | {self.steps} | {self.differing} | {self.outside}"
        return f"| {self.kind} | {counts} | {self.seconds:.0f} s |"


def main() -> int:
    """Run the trials; return 0 if all passed."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, default=1, help="seed of the moments")
    parser.add_argument("--only", default="", help="kinds of trials, by a word of their names")
    options = parser.parse_args()
    begin = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="torture ") as scratch:
        whole = Study(Path(scratch) / "whole")

        def tried(name: str) -> Tally:
            tally, started = Tally(name), time.monotonic()
            rng = random.Random(f"{options.seed} {name}")
            KINDS[name](whole.twin(Path(scratch) / name), tally, rng)
            tally.seconds = time.monotonic() - started
            print("\n".join([tally.row, *tally.noise]), file=sys.stderr, flush=True)
            return tally

        with ThreadPoolExecutor(2) as lanes:
            tallies = list(lanes.map(tried, (name for name in KINDS if options.only in name)))
    table = "\n".join(
        [
            "| trial | runs | steps by hand | differing files | files outside | time |",
            "|---|--:|--:|--:|--:|--:|",
            *(one.row for one in tallies),
        ]
    )
    print(f"{table}\n\n{time.monotonic() - begin:.0f} s")
    failed = any(one.steps or one.differing or one.outside or one.noise for one in tallies)
    if not failed and len(tallies) == len(KINDS):
        before, _, rest = PAGE.read_text(encoding="utf-8").partition(BEGIN)
        write_text(f"{before}{BEGIN}{table}\n{END}{rest.partition(END)[2]}", PAGE)
    return int(failed)


class Study:
    """A small study in a folder of its own, and the bytes of its undisturbed run."""

    def __init__(self, scratch: Path, names: tuple[str, ...] = ("T1", "T2", "P")) -> None:
        self.folder = scratch / "a study"
        self.folder.mkdir(parents=True)
        _write_study(self.folder, names)
        started = time.monotonic()
        done = self.run()
        assert done.returncode == 0, done.stderr
        self.seconds = time.monotonic() - started
        self.wanted = self.bytes()
        self.inputs = self.others()
        self.kept = scratch / "kept"
        shutil.copytree(self.folder, self.kept)

    def twin(self, scratch: Path) -> "Study":
        """The same study in another folder, with the results of this one's undisturbed run."""
        other = copy.copy(self)
        other.folder = scratch / self.folder.name
        shutil.copytree(self.kept, other.folder)
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
            env={**os.environ, **more},
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
            for path in (self.folder / "results" / "tiny").glob(pattern):
                path.unlink()

    def bytes(self) -> dict[str, str]:
        """Digest of each result; logs have times in them."""
        results = self.folder / "results"
        return {
            path.relative_to(results).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
            for path in sorted(results.rglob("*"))
            if path.is_file() and "logs" not in path.parts
        }

    def others(self) -> set[str]:
        """Files beside the results, in the folder above too."""
        above = self.folder.parent
        return {
            path.relative_to(above).as_posix()
            for path in above.rglob("*")
            if not {"results", ".snakemake", "kept"} & set(path.relative_to(above).parts)
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
        differing = sorted(name for name in names if found.get(name) != self.wanted.get(name))
        tally.differing += len(differing)
        tally.noise += [f"differs: {', '.join(differing[:5])}"] if differing else []
        tally.outside += len(self.others() - self.inputs)

    def refused(self, tally: Tally, said: subprocess.CompletedProcess[str]) -> None:
        """See that a run that could not succeed says so in a few words."""
        if said.returncode == 0:
            tally.noise.append("ended well where it could not")
        if "Traceback" in said.stderr or len(said.stderr.splitlines()) > 8:
            tally.noise.append(f"says too much: {said.stderr[-300:]!r}")


def killed(study: Study, tally: Tally, rng: random.Random, level: str) -> None:
    """Kill the run, one of its jobs, or all of its processes, at moments spread over its time."""
    for _ in range(KILLS):
        study.forget(
            *rng.choice(
                [
                    ("measures.*", "report.html"),
                    ("tests.*", "fragility.*", "report.html"),
                    ("report.html", "sweep/*"),
                ]
            )
        )
        process = study.start()
        time.sleep(rng.uniform(0.2, 0.5 * study.seconds))
        family = [psutil.Process(process.pid)] if process.poll() is None else []
        if family:
            family += family[0].children(recursive=True)
        victims = {"run": family[:1], "job": family[1:][-1:], "all": family}[level]
        for victim in victims:
            with suppress(psutil.NoSuchProcess):
                victim.send_signal(rng.choice([signal.SIGKILL, signal.SIGTERM]))
        if level == "run":
            # what is left of it runs on beside the next command
            process.wait()
            assert process.stderr is not None
            process.stderr.close()
        else:
            process.communicate(timeout=PATIENCE_S)
        study.judge(tally, study.run())


def full_disk(study: Study, tally: Tally, rng: random.Random) -> None:
    """Allow no file beyond a size, as a full disk does, and then allow it."""
    for size in (2_000, 20_000, 60_000):
        study.anew()
        said = study.run(limit=(resource.RLIMIT_FSIZE, size))
        study.refused(tally, said)
        study.judge(tally, study.run())
    if os.geteuid() == 0:
        for size in ("300k", "1m"):
            study.anew()
            with _small_disk(study.folder / "results", size) as small:
                if small:
                    study.refused(tally, study.run())
            if small:
                study.judge(tally, study.run())


@contextmanager
def _small_disk(folder: Path, size: str) -> Iterator[bool]:
    folder.mkdir(exist_ok=True)
    mount = ["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", str(folder)]
    mounted = subprocess.run(mount, capture_output=True, check=False).returncode == 0
    try:
        yield mounted
    finally:
        if mounted:
            subprocess.run(["umount", str(folder)], check=True)


def little_memory(study: Study, tally: Tally, rng: random.Random) -> None:
    """Allow too little address space, and then enough."""
    for mebibytes in (300, 700, 1000):
        study.anew()
        said = study.run(limit=(resource.RLIMIT_AS, mebibytes * 2**20))
        if said.returncode != 0 and len(said.stderr.splitlines()) > 40:
            tally.noise.append(f"says too much: {said.stderr[-300:]!r}")
        study.judge(tally, study.run())


def read_only(study: Study, tally: Tally, rng: random.Random) -> None:
    """Forbid writing to the folder of all results, of the study's, and of its figures."""
    for name in ("results", "results/tiny", "results/tiny/figures"):
        study.forget("report.html")
        folder = study.folder / name
        if name == "results":
            shutil.rmtree(folder / "tiny")
        # root writes wherever permissions forbid it, but not where the folder itself may not change
        locked = _lock(folder, True)
        said = study.run()
        if locked:
            study.refused(tally, said)
        _lock(folder, False)
        study.judge(tally, study.run())


def _lock(folder: Path, closed: bool) -> bool:
    if os.geteuid() != 0:
        folder.chmod(0o500 if closed else 0o700)
        return True
    flag = "+i" if closed else "-i"
    return (
        subprocess.run(["chattr", flag, str(folder)], capture_output=True, check=False).returncode
        == 0
    )


def damaged(study: Study, tally: Tally, rng: random.Random) -> None:
    """Damage what a run keeps beside its results, what was compiled, and what it downloads."""
    for name in (".snakemake/metadata", ".snakemake/rockfrag/tiny.json", ".snakemake/incomplete"):
        study.forget("report.html")
        place = study.folder / name
        files = [path for path in place.rglob("*") if path.is_file()] if place.is_dir() else [place]
        for path in files:
            if path.is_file():
                path.write_bytes(b"\x00 damaged {")
        study.judge(tally, study.run())
    cache = Path(tempfile.mkdtemp(prefix="cache "))
    study.anew()
    more = {"NUMBA_CACHE_DIR": str(cache)}
    study.judge(tally, study.run(more))
    for path in cache.rglob("*.nb?"):
        content = path.read_bytes()
        path.write_bytes(content[: len(content) // 2])
    study.anew()
    study.judge(tally, study.run(more))
    shutil.rmtree(cache)
    for content in (b"PK\x03\x04 cut", _wheel({"gmspy/accelerograms/Friuli.dat": "0.0 0.1"})):
        study.anew()
        shelf = Path(tempfile.mkdtemp(prefix="shelf "))
        (shelf / "gmspy-0.1.3-py3-none-any.whl").write_bytes(content)
        table = study.folder / "motions.csv"
        usual = table.read_text(encoding="utf-8")
        table.write_text(usual + "fetched,Friuli,gmspy,Friuli.dat,\n", encoding="utf-8")
        study.refused(tally, study.run({"PIP_NO_INDEX": "1", "PIP_FIND_LINKS": shelf.as_uri()}))
        shutil.rmtree(shelf)
        table.write_text(usual, encoding="utf-8")
        # nothing of such a download is taken for a record
        tally.outside += len(list((study.folder / "resources").rglob("*.dat")))
        shutil.rmtree(study.folder / "resources")
        study.judge(tally, study.run())


def _wheel(files: Mapping[str, str]) -> bytes:
    """A wheel that pip accepts, of the pinned name and version, with other bytes."""
    buffer = io.BytesIO()
    facts = "Metadata-Version: 2.1\nName: gmspy\nVersion: 0.1.3\n"
    form = "Wheel-Version: 1.0\nGenerator: torture\nRoot-Is-Purelib: true\nTag: py3-none-any\n"
    about = {"METADATA": facts, "WHEEL": form, "RECORD": ""}
    with zipfile.ZipFile(buffer, "w") as archive:
        for name, text in about.items():
            archive.writestr(f"gmspy-0.1.3.dist-info/{name}", text)
        for name, text in files.items():
            archive.writestr(name, text)
    return buffer.getvalue()


def at_once(study: Study, tally: Tally, rng: random.Random) -> None:
    """Start the same study while it runs."""
    study.anew()
    first = study.start()
    lock = study.folder / ".snakemake" / "rockfrag" / "tiny.json"
    while first.poll() is None and not (lock.is_file() and lock.stat().st_size):
        time.sleep(0.05)
    second = study.run()
    if "is running in process" not in second.stderr:
        tally.noise.append(f"the second run was not told of the first: {second.stderr[-200:]!r}")
    study.refused(tally, second)
    _, words = first.communicate(timeout=PATIENCE_S)
    study.judge(tally, subprocess.CompletedProcess(COMMAND, first.returncode, "", words))


def foreign_names(study: Study, tally: Tally, rng: random.Random) -> None:
    """Use names that mean something elsewhere, and names that cannot be."""
    with tempfile.TemporaryDirectory(prefix="names ") as scratch:
        other = Study(Path(scratch), NAMES)
        other.anew()
        other.judge(tally, other.run())
        for name in ("../T1", "..", "=1+1", "-rf", "x" * 300, "a\x07b"):
            table = other.folder / "specimens.csv"
            usual = table.read_text(encoding="utf-8")
            table.write_text(usual + f'"{name}",12.4,37.2,2172\n', encoding="utf-8")
            before = other.others()
            said = other.run()
            if name != "../T1":
                other.refused(tally, said)
            tally.trials += 1
            tally.outside += len(other.others() - before)
            table.write_text(usual, encoding="utf-8")


def foreign_processors(study: Study, tally: Tally, rng: random.Random) -> None:
    """Pretend to be other processors and to stand elsewhere."""
    for more in FOREIGN:
        study.anew()
        study.judge(tally, study.run(more))


KILLS = 10
"""Moments on each of three levels."""

KINDS: Mapping[str, Callable[[Study, Tally, random.Random], None]] = {
    "run killed": partial(killed, level="run"),
    "job killed": partial(killed, level="job"),
    "all processes killed": partial(killed, level="all"),
    "full disk": full_disk,
    "too little memory": little_memory,
    "read-only folders": read_only,
    "damaged downloads and caches": damaged,
    "two runs at once": at_once,
    "foreign names": foreign_names,
    "foreign processors and places": foreign_processors,
}
"""All kinds of trials; the longest first, as two run at a time."""


def _write_study(folder: Path, names: tuple[str, ...]) -> None:
    """A study of two objects and more, with synthetic motions on the floors of a building."""
    rows = ["name,event,source,file,unit"]
    for number, event in enumerate(("First", "Second", "Third")):
        rng = np.random.default_rng(number)
        time_s = np.arange(600) * 0.01
        waves = np.sin(
            2 * np.pi * np.outer(time_s, rng.uniform(0.5, 5, 30)) + rng.uniform(0, 6, 30)
        )
        values = np.exp(-(((time_s - 2.5) / 1.2) ** 2)) * waves.sum(axis=1)
        lines = [
            f"{t:.2f} {a:.6f}"
            for t, a in zip(time_s, 0.3 * values / abs(values).max(), strict=True)
        ]
        (folder / f"record{number}.txt").write_text("\n".join(lines) + "\n")
        rows.append(f"motion {number},{event},folder,record{number}.txt,g")
    (folder / "motions.csv").write_text("\n".join(rows) + "\n")
    blocks = ["name,width_cm,height_cm,mass_g"]
    for name in names[:-1]:
        quoted = name.replace('"', '""')
        blocks.append(f'"{quoted}",12.4,37.2,2172')
    blocks.append(f'"{names[-1]}",18.4,20.8,2300')
    (folder / "specimens.csv").write_text("\n".join(blocks) + "\n", encoding="utf-8")
    (folder / "building.yaml").write_text(
        "storey_heights_m: [3, 3]\nmasses_kg: [20000, 20000]\nfirst_period_s: 0.2\n"
        "floors: {ground: 0, top: 2}\n"
    )
    content = {
        "study": "tiny",
        "title": "A study that is tortured",
        "seed": 3,
        "motions": {"catalogue": "motions.csv"},
        "building": "building.yaml",
        "bodies": {"specimens": "specimens.csv"},
        "amplitudes": {"lowest_g": 0.2, "highest_g": 1.6, "step_percent": 16},
        "protocol": {"step_percent": 16},
        "fragility": {"measures": ["pga_g", "pgv_cm_s"], "confidence": 0.9},
    }
    (folder / "study.yaml").write_text(yaml.safe_dump(content, sort_keys=False))


if __name__ == "__main__":
    sys.exit(main())
