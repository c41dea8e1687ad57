"""The workflow writes what the stages write, to the byte, and ends well."""

import os
import subprocess
import sys
from pathlib import Path

from rockfrag.stages.same_numbers import same_numbers

from .checked_report import check_report
from .studies import write
from .test_foreign_studies import STUDIES

ROOT = Path(__file__).resolve().parents[2]


def test_one_object_under_one_record_goes_through_the_workflow(tmp_path: Path):
    study = STUDIES["one marble figure, one record"]
    path = write(study, tmp_path / "by the workflow")
    command = [sys.executable, "-m", "snakemake", "--snakefile", str(ROOT / "Snakefile")]
    command += ["--directory", str(path.parent), "--configfile", str(path), "--cores", "1"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)
    assert done.returncode == 0, done.stderr[-3000:]
    results = path.parent / "results" / "own"
    check_report(results, study.names)
    alone = by_hand("one marble figure, one record", tmp_path / "by hand")
    assert (results / "report.html").read_bytes() == (alone / "report.html").read_bytes()


def by_hand(study: str, folder: Path) -> Path:
    """Run the stages of a study one after the other, where libraries choose their functions as in jobs."""
    alone = (
        "import sys; from pathlib import Path; from tests.end_to_end.studies import run; "
        "from tests.end_to_end.test_foreign_studies import STUDIES; "
        "print(run(STUDIES[sys.argv[1]], Path(sys.argv[2])))"
    )
    done = subprocess.run(
        [sys.executable, "-c", alone, study, str(folder)],
        cwd=ROOT,
        env=os.environ | same_numbers(os.environ),
        capture_output=True,
        text=True,
        check=True,
    )
    return Path(done.stdout.splitlines()[-1])
