"""The command line: whether an object topples, what is in a record, how a body rocks, whether a study is right."""

import argparse
import os
import re
import sys
import warnings
from collections.abc import Sequence
from typing import NoReturn

from rockfrag import __version__
from rockfrag.base.errors import InputError
from rockfrag.cli.after_commands import add_after_command
from rockfrag.cli.assess_commands import (
    add_app_command,
    add_assess_commands,
)
from rockfrag.cli.collection_commands import add_collection_command
from rockfrag.cli.constrain_command import add_constrain_command
from rockfrag.cli.export_command import add_export_command
from rockfrag.cli.record_commands import add_record_commands
from rockfrag.cli.simulate_command import add_play_command, add_simulate_command
from rockfrag.runtime.processes import speak_utf8


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line.

    Parameters
    ----------
    arguments : words behind the name of the command, those of the process if None

    Returns
    -------
    Exit status: 0, 1 if a file could not be read, 2 if an input is not usable.
    """
    with warnings.catch_warnings():
        # a warning is a sentence, without the line of code that gave it
        warnings.showwarning = lambda said, *_: print(
            f"warning: {said}", file=sys.stderr
        )
        try:
            if arguments is None:
                speak_utf8()
            words = sys.argv[1:] if arguments is None else arguments
            options = make_parser().parse_args(with_negative_sizes(words))
            status = int(options.run(options))
            sys.stdout.flush()
        except InputError as error:
            print(error, file=sys.stderr)
            return 2
        except BrokenPipeError:
            # whoever reads the output, such as `head`, has had enough; Python must not try again
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            return 0
    return status


_NEGATIVE = re.compile(r"-(?:\d|\.\d)")


def with_negative_sizes(words: Sequence[str]) -> list[str]:
    """Join an option and a negative number behind it, such as ``--cg-offset -2cm``, which is no option itself.

    Parameters
    ----------
    words : of a command line

    Returns
    -------
    The words, ``--cg-offset=-2cm`` for two of them.
    """
    joined: list[str] = []
    for word in words:
        is_value = joined and joined[-1].startswith("--") and "=" not in joined[-1]
        if is_value and _NEGATIVE.match(word):
            joined[-1] = f"{joined[-1]}={word}"
        else:
            joined.append(word)
    return joined


class _Parser(argparse.ArgumentParser):
    """A parser that says what is wrong with an option in a sentence."""

    def error(self, message: str) -> NoReturn:
        """End with what is wrong, in words that say what is expected."""
        found = re.fullmatch(
            r"argument (\S+?)(?:/\S+)?: invalid (float|int) value: (.*)", message
        )
        if found:
            kind = "a number" if found[2] == "float" else "a whole number"
            message = f"{found[1]}: expected {kind}, got {found[3]}"
        super().error(message)


def make_parser() -> argparse.ArgumentParser:
    """Return the parser of the whole command line."""
    parser = _Parser(
        prog="rockfrag", description="Rocking and overturning of free-standing objects."
    )
    parser.add_argument(
        "--version", action="version", version=f"rockfrag {__version__}"
    )
    commands = parser.add_subparsers(required=True, metavar="COMMAND")

    add_assess_commands(commands)
    add_app_command(commands)
    add_after_command(commands)
    add_export_command(commands)
    add_constrain_command(commands)
    add_record_commands(commands)
    add_collection_command(commands)
    add_simulate_command(commands)
    add_play_command(commands)

    check = commands.add_parser(
        "check-config", help="check the configuration of a study"
    )
    check.add_argument(
        "file", metavar="FILE", help="configuration, such as config/config.yaml"
    )
    check.add_argument(
        "--quiet", action="store_true", help="say only what is wrong or doubtful"
    )
    check.set_defaults(run=_check_config)
    return parser


def _check_config(options: argparse.Namespace) -> int:
    """Run ``check-config``: say what a study will do, and what looks wrong with it."""
    from rockfrag.stages.running import results_folder
    from rockfrag.study.loading import (
        check_building,
        check_records,
        check_tables,
        load_any,
    )
    from rockfrag.study.study import Study

    study = load_any(options.file)
    folder = results_folder(study)
    check_tables(study)
    if isinstance(study, Study):
        check_building(study)
        for quality_flag in (*study.quality_flags(), *check_records(study)):
            print(f"warning: {quality_flag}", file=sys.stderr)
    if not options.quiet:
        print(
            f"{options.file} is right: study {study.name}, {study.summary}; its report will be "
            f"{folder}/report.html."
        )
    return 0


if __name__ == "__main__":
    sys.exit(main())
