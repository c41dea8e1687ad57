"""What a study costs against its size: synthetic motions, lone blocks and stacks, through the workflow.

``python -m tests.scale 300 1000 3000`` runs studies of so many motions of 20 s, a third as many earthquakes,
the thesis's six configurations (three lone blocks, three stacks) and 200 amplitudes; ``--amplitudes 2000``
takes more.  Each stage's processor time, what the run takes before and between its jobs, the largest memory
and the wall time of the whole are printed as the table of ``docs/reliability.md``, and go to
``results/bench/scale.csv``.
"""

import argparse
import math
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import pandas as pd

from rockfrag.base.files import write_table
from rockfrag.motions.synthetic import evolutionary
from rockfrag.records.motion import Motion
from rockfrag.study.study import Amplitudes

from ..conftest import write_records
from ..validation.made import markdown
from ..workflow.conftest import study_content, write_study

ROOT = Path(__file__).resolve().parents[2]
SAMPLES, DT = 2000, 0.01
LOWEST_G, HIGHEST_G = 0.05, 2.0
OF_AN_EARTHQUAKE = 3  # motions of one earthquake

CONFIGURATIONS = 6
_TOOK = re.compile(r"took ([0-9.]+) s, ([0-9.]+) s of processors, ([0-9]+) MiB")
_PART = re.compile(r"_\d+$")


def main() -> int:
    """Run what was asked for and print it."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("motions", type=int, nargs="+", help="motions of each study")
    parser.add_argument("--amplitudes", type=int, default=200)
    parser.add_argument("--cores", type=int, default=2)
    parser.add_argument(
        "--folder", type=Path, help="where studies stay; a temporary one without"
    )
    asked = parser.parse_args()
    rows = []
    with tempfile.TemporaryDirectory() as scratch:
        for motions in asked.motions:
            folder = (asked.folder or Path(scratch)) / f"{motions}x{asked.amplitudes}"
            rows += measured(folder, motions, asked.amplitudes, asked.cores)
    table = pd.DataFrame(rows)
    write_table(table, ROOT / "results" / "bench" / "scale.csv")
    print(markdown(shown(table), 0))
    return 0


def measured(
    folder: Path, motions: int, amplitudes: int, cores: int
) -> list[dict[str, object]]:
    """Run one study, and say what each of its stages took."""
    write_scale(folder, motions, amplitudes)
    project = folder / "project"
    shutil.rmtree(project, ignore_errors=True)
    project.mkdir()
    for name in ("workflow", "profiles"):
        (project / name).symlink_to(ROOT / name)
    begin, before = time.monotonic(), _of_children()
    command = [sys.executable, "workflow/run.py", str(folder / "study.yaml")]
    subprocess.run(
        [*command, "--cores", str(cores), "--quiet"], cwd=project, check=True
    )
    wall, whole = time.monotonic() - begin, _of_children() - before
    histories = motions * CONFIGURATIONS * amplitudes
    stages: dict[str, list[tuple[float, float, float]]] = {}
    for log in sorted((project / "results" / "scale" / "logs").glob("*.log")):
        found = _TOOK.search(log.read_text(encoding="utf-8"))
        if found is None:
            raise RuntimeError(f"{log} does not say what its job took")
        item = (float(found[1]), float(found[2]), float(found[3]))
        stages.setdefault(_PART.sub("", log.stem), []).append(item)
    # reading the records beforehand, and planning the jobs
    jobs = sum(job[1] for some in stages.values() for job in some)
    stages["before and between"] = [(math.nan, whole - jobs, math.nan)]
    about = {"motions": motions, "histories": histories, "wall_s": round(wall, 1)}
    return [
        {
            **about,
            "stage": stage,
            "jobs": len(jobs),
            "longest_s": max(job[0] for job in jobs),
            "processor_s": sum(job[1] for job in jobs),
            "memory_mib": max(job[2] for job in jobs),
        }
        for stage, jobs in stages.items()
    ]


def _of_children() -> float:
    """Processor time of all processes that were started from here and have ended [s]."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def shown(table: pd.DataFrame) -> pd.DataFrame:
    """Return processor time of each stage, the largest process and the wall time, a row a study."""
    by = ["motions", "histories"]
    seconds = table.pivot_table("processor_s", by, "stage")
    found = seconds[table["stage"].unique()].round().astype(int).add_suffix(" [s]")
    found["all but IDA curve"] = (1 - seconds["ida"] / seconds.sum(axis=1)).map(
        "{:.0%}".format
    )
    found["memory [MiB]"] = table.groupby(by)["memory_mib"].max()
    found["wall [s]"] = table.groupby(by)["wall_s"].first()
    return found.reset_index()


def write_scale(folder: Path, motions: int, amplitudes: int) -> None:
    """Write a study's configuration and its records."""
    folder.mkdir(parents=True, exist_ok=True)
    write_records(folder, map(strong_motion, range(motions)))
    for name in ("specimens.csv", "configurations.csv"):
        shutil.copy(ROOT / "config" / name, folder / name)
    # a hair less than the step that fits exactly, lest rounding lose the last amplitude
    step = (
        100 * math.expm1(math.log(HIGHEST_G / LOWEST_G) / (amplitudes - 1)) * (1 - 1e-9)
    )
    if len(Amplitudes(LOWEST_G, HIGHEST_G, step).values_g) != amplitudes:
        raise RuntimeError(
            f"{amplitudes} amplitudes do not come out of a step of {step} %"
        )
    content = study_content() | {
        "study": "scale",
        "motions": {"catalogue": "catalogue.csv"},
        "title": f"{motions} synthetic motions",
        "amplitudes": {
            "lowest_g": LOWEST_G,
            "highest_g": HIGHEST_G,
            "step_percent": step,
        },
        "protocol": {"step_percent": 5},
        "fragility": {"measures": ["pga_g", "pgv_cm_s"], "confidence": 0.9},
    }
    write_study(folder, content)


def strong_motion(number: int) -> Motion:
    """Return a stochastic motion of 20 s, of a strong earthquake on firm ground."""
    rng = np.random.default_rng(number)
    duration = rng.uniform(4.0, 12.0)
    made = evolutionary(
        number,
        arias_m_s=rng.uniform(0.5, 3.0),
        d5_95_s=duration,
        mid_s=duration * rng.uniform(0.4, 0.8),
        mid_hz=rng.uniform(1.5, 8.0),
        slope_hz_s=rng.uniform(-0.25, 0.0),
        filter_damping=rng.uniform(0.1, 0.5),
        dt=DT,
    )
    samples = np.zeros(SAMPLES)
    samples[: made.acceleration.size] = made.acceleration[:SAMPLES]
    about = {"earthquake": f"earthquake {number // OF_AN_EARTHQUAKE}", "station": ""}
    return Motion(samples, DT, f"motion {number}", about)


if __name__ == "__main__":
    sys.exit(main())
