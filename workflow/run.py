"""Run a study: check it, see that no other run of it lives, and let Snakemake do the rest.

    python workflow/run.py config/thesis.yaml --cores all

What stands behind the study goes to Snakemake. Whatever goes wrong is said in one sentence.
"""

import io
import os
import sys
from collections.abc import Sequence
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path

from rockfrag.errors import InputError
from rockfrag.stages.means import check_folders, check_memory

SNAKEFILE = Path(os.path.relpath(Path(__file__).resolve().parents[1] / "Snakefile"))


def main(study_file: str, arguments: Sequence[str]) -> int:
    """Run a study; return 0, or another number if it could not be run to its end."""
    try:
        check_memory()
    except InputError as error:
        print(error, file=sys.stderr)
        return 1
    # what takes much memory is loaded now that there is some
    from rockfrag.cli import main as rockfrag
    from rockfrag.stages.loaded import loaded
    from rockfrag.stages.log import in_words
    from rockfrag.stages.one_run import RUNS, only_run
    from rockfrag.stages.running import results_folder
    from rockfrag.study.loading import load_any

    status = rockfrag(["check-config", "--quiet", study_file])
    if status:
        return status
    try:
        study = load_any(study_file)
        results = results_folder(study)
        try:
            check_folders(results, RUNS)
        except PermissionError:
            # a finished study may lie where nobody writes
            if not _is_finished(study_file, arguments):
                raise
            print(f"Nothing to do; the report is {results}/report.html")
            return 0
        with only_run(study.name, results), loaded(RUNS / f"{study.name}.socket"):
            return _snakemake(study_file, ["--keep-going", *arguments])
    except InputError as error:
        print(error, file=sys.stderr)
    except KeyboardInterrupt:
        print("stopped; the same command takes it up again", file=sys.stderr)
    except Exception as error:
        print(in_words(error), file=sys.stderr)
    return 1


def _is_finished(study_file: str, arguments: Sequence[str]) -> bool:
    """Whether all that was asked for is there, found out without having to write anything."""
    listed = io.StringIO()
    # a dry run would write down what it has seen
    with redirect_stdout(listed), redirect_stderr(io.StringIO()):
        status = _snakemake(study_file, [*arguments, "--summary"])
    return status == 0 and "update pending" not in listed.getvalue()


def _snakemake(study_file: str, arguments: Sequence[str]) -> int:
    from snakemake.cli import main as snakemake

    # our own lock knows whether its owner lives, Snakemake's does not; for some ten jobs the best
    # schedule takes longer to find than it saves
    ours = ("--nolock", "--rerun-incomplete", "--workflow-profile", "none", "--scheduler", "greedy")
    try:
        snakemake(["--snakefile", str(SNAKEFILE), "--configfile", study_file, *ours, *arguments])
    except SystemExit as end:
        return end.code if isinstance(end.code, int) else 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2:]))
