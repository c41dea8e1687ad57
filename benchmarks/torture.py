"""Interrupt, starve and misuse a small study, and see that it ends in the same bytes by itself.

    python benchmarks/torture.py            # all of it, under 15 minutes
    python benchmarks/torture.py --kills 6 --only kills

Each trial starts from the results of an undisturbed run, or from nothing, does what a machine or a person
might do, and then gives the same command once more. It passes if that command ends well without any other
step, all results have the bytes of the undisturbed run, and nothing lies outside of ``results`` and
``.snakemake`` that was not there before. Prints a table in Markdown; exit status 1 if a trial failed.
"""

import argparse
import hashlib
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import psutil
import yaml

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


@dataclass
class Tally:
    """What came of the trials of one kind."""

    kind: str
    trials: int = 0
    steps: int = 0
    differing: int = 0
    outside: int = 0
    noise: list[str] = field(default_factory=list)


def main() -> int:
    """Run the trials; return 0 if all passed."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--kills", type=int, default=30, help="at how many moments to kill")
    parser.add_argument("--seed", type=int, default=1, help="seed of the moments")
    parser.add_argument("--only", help="kinds of trials, by a word of their names")
    options = parser.parse_args()
    rng = random.Random(options.seed)
    begin = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="torture ") as scratch:
        study = Study(Path(scratch))
        kinds: list[tuple[str, Callable[[Study, Tally, random.Random], None]]] = [
            (
                f"killed at {options.kills} moments, on three levels",
                lambda *a: kills(*a, options.kills),
            ),
            ("full disk", full_disk),
            ("too little memory", little_memory),
            ("read-only folders", read_only),
            ("damaged downloads and caches", damaged),
            ("two runs at once", at_once),
            ("foreign names", foreign_names),
            ("foreign processors and places", foreign_processors),
        ]
        tallies = []
        print("| trial | runs | manual steps | differing files | files outside | time |")
        print("|---|--:|--:|--:|--:|--:|")
        for name, trial in kinds:
            if options.only and options.only not in name:
                continue
            tally = Tally(name)
            started = time.monotonic()
            trial(study, tally, rng)
            tallies.append(tally)
            counts = f"{tally.trials} | {tally.steps} | {tally.differing} | {tally.outside}"
            print(f"| {name} | {counts} | {time.monotonic() - started:.0f} s |", flush=True)
    print(f"\n{time.monotonic() - begin:.0f} s")
    for one in tallies:
        for words in one.noise:
            print(f"{one.kind}: {words}")
    return int(any(one.steps or one.differing or one.outside or one.noise for one in tallies))


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

    def run(
        self, more: Mapping[str, str] = {}, **options: object
    ) -> subprocess.CompletedProcess[str]:
        """Give the command of a user and wait for its end."""
        process = self.start(more, **options)
        _, said = process.communicate(timeout=600)
        return subprocess.CompletedProcess(COMMAND, process.returncode, "", said)

    def start(self, more: Mapping[str, str] = {}, **options: object) -> "subprocess.Popen[str]":
        """Give the command of a user."""
        return subprocess.Popen(
            (*COMMAND, *SCREEN),
            cwd=self.folder,
            env={**os.environ, **more},
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
            **options,  # type: ignore[call-overload]
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


def kills(study: Study, tally: Tally, rng: random.Random, count: int) -> None:
    """Kill the run, one of its jobs, or all of its processes, at moments spread over its time."""
    for number in range(count):
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
        level = number % 3
        victims = family[:1] if level == 0 else family[-1:] if level == 1 else family
        for victim in victims:
            with suppress(psutil.NoSuchProcess):
                victim.send_signal(rng.choice([signal.SIGKILL, signal.SIGTERM]))
        if level == 0 and victims:
            process.wait()
        # what is left of it runs on beside the next command
        again = study.run() if level == 0 else (process.communicate(timeout=600), study.run())[1]
        if level == 0 and process.stderr:
            process.stderr.close()
        study.judge(tally, again)


def full_disk(study: Study, tally: Tally, rng: random.Random) -> None:
    """Allow no file beyond a size, as a full disk does, and then allow it."""
    for size in (2_000, 20_000, 60_000):
        study.anew()
        said = study.run(preexec_fn=lambda size=size: _limit_files(size))
        study.refused(tally, said)
        study.judge(tally, study.run())
    if os.geteuid() == 0:
        for size in ("300k", "1m"):
            study.anew()
            with _small_disk(study.folder / "results", size):
                said = study.run()
                study.refused(tally, said)
            study.judge(tally, study.run())


def _limit_files(size: int) -> None:
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, resource.RLIM_INFINITY))


@contextmanager
def _small_disk(folder: Path, size: str) -> Iterator[None]:
    folder.mkdir(exist_ok=True)
    mount = ["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", str(folder)]
    mounted = subprocess.run(mount, capture_output=True, check=False).returncode == 0
    try:
        yield
    finally:
        if mounted:
            subprocess.run(["umount", str(folder)], check=True)


def little_memory(study: Study, tally: Tally, rng: random.Random) -> None:
    """Allow too little address space, and then enough."""
    for mebibytes in (300, 700, 1000):
        study.anew()
        limit = mebibytes * 2**20
        said = study.run(
            preexec_fn=lambda limit=limit: resource.setrlimit(
                resource.RLIMIT_AS, (limit, resource.RLIM_INFINITY)
            )
        )
        if said.returncode != 0 and len(said.stderr.splitlines()) > 40:
            tally.noise.append(f"says too much: {said.stderr[-300:]!r}")
        study.judge(tally, study.run())


def read_only(study: Study, tally: Tally, rng: random.Random) -> None:
    """Forbid writing to the results, to Snakemake's folder, and to everything."""
    for name in ("results", "results/tiny", "results/tiny/figures"):
        study.forget("report.html")
        folder = study.folder / name
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
    """Damage what a run keeps beside its results: caches, provenance of Snakemake, the run's own file."""
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


def at_once(study: Study, tally: Tally, rng: random.Random) -> None:
    """Start the same study while it runs."""
    study.anew()
    first = study.start()
    time.sleep(4.0)
    second = study.run()
    if "is running in process" not in second.stderr:
        tally.noise.append(f"the second run was not told of the first: {second.stderr[-200:]!r}")
    study.refused(tally, second)
    _, words = first.communicate(timeout=600)
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
