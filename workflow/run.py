"""Run a study: check it, see that no other run of it lives, and let Snakemake do the rest.

    python workflow/run.py config/thesis.yaml --cores all

What stands behind the study goes to Snakemake. Whatever goes wrong is said in one sentence; the exit status is 2
where the study, its folder or the machine is to be mended, and 1 where a stage failed.
"""

import io
import os
import sys
from collections.abc import Sequence
from contextlib import redirect_stderr, redirect_stdout
from importlib.util import find_spec
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryFile

from rockfrag.base.errors import InputError
from rockfrag.base.yaml_file import read_yaml
from rockfrag.runtime.memory import check_memory
from rockfrag.runtime.processes import speak_utf8
from rockfrag.stages.log import check_folders, in_words

SNAKEFILE = Path(os.path.relpath(Path(__file__).resolve().parent / "Snakefile"))


def main(study_file: str, arguments: Sequence[str]) -> int:
    """Run a study; return 0, or the exit status if it could not be run to its end."""
    if study_file.startswith("-"):
        # neither our command line nor Snakemake's shall take it for an option
        study_file = os.path.join(os.curdir, study_file)
    try:
        check_memory()
        # what takes much memory is loaded now that there is some
        from rockfrag.cli.main import main as rockfrag
        from rockfrag.stages.running import results_folder, run_lock
        from rockfrag.study.loading import load_any
    except InputError as error:
        print(error, file=sys.stderr)
        return 2
    status = rockfrag(["check-config", "--quiet", study_file])
    if status:
        return status
    try:
        _check_executor(arguments)
        results = results_folder(load_any(study_file))
        try:
            check_folders(results, Path(".snakemake") / "metadata")
        except PermissionError:
            # a finished study may lie where nobody writes
            if not _is_finished(study_file, arguments):
                raise
            print(f"Nothing to do; the report is {results}/report.html")
            return 0
        with run_lock(results):
            return _snakemake(study_file, ["--keep-going", *arguments])
    except KeyboardInterrupt:
        print("stopped; the same command takes it up again", file=sys.stderr)
        return 1
    except Exception as error:
        print(
            error if isinstance(error, InputError) else in_words(error), file=sys.stderr
        )
        return 2


def _check_executor(arguments: Sequence[str]) -> None:
    """See that the plugin is installed by which a profile has jobs executed."""
    for option, profile in pairwise(arguments):
        file = Path(profile) / "config.yaml"
        known = option == "--profile" and file.is_file()
        executor = read_yaml(file).get("executor", "local") if known else "local"
        plugin = f"snakemake-executor-plugin-{executor}"
        if executor != "local" and find_spec(plugin.replace("-", "_")) is None:
            raise InputError(
                f"{file}: {plugin} is not installed; install it with '{sys.executable} -m pip install {plugin}'."
            )


def _is_finished(study_file: str, arguments: Sequence[str]) -> bool:
    """Whether all that was asked for is there, found out without having to write anything."""
    listed = io.StringIO()
    # a dry run would write down what it has seen
    with redirect_stdout(listed), redirect_stderr(io.StringIO()):
        status = _snakemake(study_file, [*arguments, "--summary"])
    return status == 0 and "update pending" not in listed.getvalue()


def _see_to_cache() -> None:
    """Let Snakemake keep copies of sources beside the study where it may not keep them in the user's home."""
    from snakemake.common import get_appdirs

    kept = Path(get_appdirs().user_cache_dir, "snakemake", "source-cache")
    try:
        for folder in (kept, kept / "snakemake-runtime-cache"):
            folder.mkdir(parents=True, exist_ok=True)
            TemporaryFile(dir=folder).close()
    except OSError:
        os.environ["XDG_CACHE_HOME"] = str(Path(".snakemake", "cache").resolve())


def _snakemake(study_file: str, arguments: Sequence[str]) -> int:
    from snakemake.cli import main as snakemake

    _see_to_cache()
    # our own lock knows whether its owner lives, Snakemake's does not; for some ten jobs the best
    # schedule takes longer to find than it saves
    ours = (
        "--nolock",
        "--rerun-incomplete",
        "--workflow-profile",
        "none",
        "--scheduler",
        "greedy",
    )
    try:
        snakemake(
            [
                "--snakefile",
                str(SNAKEFILE),
                "--configfile",
                study_file,
                *ours,
                *arguments,
            ]
        )
    except SystemExit as end:
        return end.code if isinstance(end.code, int) else 1
    return 0


if __name__ == "__main__":
    speak_utf8()
    if sys.argv[1:2] in ([], ["-h"], ["--help"]):
        print(__doc__)
        sys.exit(0 if sys.argv[1:] else 2)
    sys.exit(main(sys.argv[1], sys.argv[2:]))
