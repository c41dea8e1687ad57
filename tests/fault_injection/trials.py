"""What a machine or a person might do to a run, other than killing it."""

import io
import os
import random
import resource
import shutil
import subprocess
import tempfile
import time
import zipfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from pathlib import Path

from .studies import COMMAND, PATIENCE_S, Study, Tally, write_small

NAMES = ("T/1", "$x^{2$", "<b>&", "像", "a'b\"c", "con", "T{x}")
"""Names of blocks that are data and nothing else."""

FOREIGN = (
    {"OPENBLAS_CORETYPE": "Haswell", "NPY_DISABLE_CPU_FEATURES": "X86_V4", "NUMBA_CPU_NAME": "generic"},
    {"OPENBLAS_CORETYPE": "Sandybridge", "NPY_DISABLE_CPU_FEATURES": "X86_V3", "PYTHONHASHSEED": "7"},
    {"LC_ALL": "tr_TR.UTF-8", "TZ": "Asia/Kathmandu", "OPENBLAS_NUM_THREADS": "2"},
)  # fmt: skip


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
    for name in ("results", "results/own", "results/own/figures"):
        study.forget("report.html")
        folder = study.folder / name
        if name == "results":
            shutil.rmtree(folder / "own")
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
        subprocess.run(
            ["chattr", flag, str(folder)], capture_output=True, check=False
        ).returncode
        == 0
    )


def damaged(study: Study, tally: Tally, rng: random.Random) -> None:
    """Damage what a run keeps beside its results, what was compiled, and what it downloads."""
    for name in (".snakemake/metadata", "results/own/.run", ".snakemake/incomplete"):
        study.forget("report.html")
        place = study.folder / name
        files = (
            [path for path in place.rglob("*") if path.is_file()]
            if place.is_dir()
            else [place]
        )
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
    for content in (
        b"PK\x03\x04 cut",
        _wheel({"gmspy/accelerograms/Friuli.dat": "0.0 0.1"}),
    ):
        study.anew()
        shelf = Path(tempfile.mkdtemp(prefix="shelf "))
        (shelf / "gmspy-0.1.3-py3-none-any.whl").write_bytes(content)
        table = study.folder / "motions.csv"
        usual = table.read_text(encoding="utf-8")
        table.write_text(
            usual + "fetched,Friuli,,,,,,gmspy,Friuli.dat,,,,\n", encoding="utf-8"
        )
        study.refused(
            tally, study.run({"PIP_NO_INDEX": "1", "PIP_FIND_LINKS": shelf.as_uri()})
        )
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
    lock = study.folder / "results" / "own" / ".run"
    while first.poll() is None and not (lock.is_file() and lock.stat().st_size):
        time.sleep(0.05)
    second = study.run()
    if "is running already, in process" not in second.stderr:
        tally.noise.append(
            f"the second run was not told of the first: {second.stderr[-200:]!r}"
        )
    study.refused(tally, second)
    _, words = first.communicate(timeout=PATIENCE_S)
    study.judge(
        tally, subprocess.CompletedProcess(COMMAND, first.returncode, "", words)
    )


def foreign_names(study: Study, tally: Tally, rng: random.Random) -> None:
    """Use names that mean something elsewhere, and names that cannot be."""
    with tempfile.TemporaryDirectory(prefix="names ") as scratch:
        other = Study(Path(scratch), partial(write_small, names=NAMES))
        other.anew()
        other.judge(tally, other.run())
        for name in ("../T1", "..", "=1+1", "-rf", "x" * 300, "a\x07b"):
            table = other.folder / "blocks.csv"
            usual = table.read_text(encoding="utf-8")
            table.write_text(usual + f'"{name}",12.4,37.2,2.172\n', encoding="utf-8")
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
