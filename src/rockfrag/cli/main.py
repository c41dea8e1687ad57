"""The command line: whether an object topples, what is in a record, how a body rocks, whether a study is right."""

import argparse
import os
import re
import sys
import warnings
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NoReturn

from rockfrag import __version__
from rockfrag.base.errors import InputError, errors_of
from rockfrag.base.plausible import STONE, check_density, peak_warning, size_warning
from rockfrag.base.units import GRAVITY, quantity
from rockfrag.cli.after_commands import add_after_command
from rockfrag.cli.assess_commands import (
    add_app_command,
    add_assess_commands,
)
from rockfrag.cli.collection_commands import add_collection_command
from rockfrag.cli.constrain_command import add_constrain_command
from rockfrag.cli.export_command import add_export_command
from rockfrag.cli.held import (
    add_holding_options,
    held,
    is_held,
    lines_on_holding,
)
from rockfrag.cli.record_commands import add_record_commands, read_as_asked
from rockfrag.runtime.processes import speak_utf8

if TYPE_CHECKING:
    from rockfrag.records.motion import Motion
    from rockfrag.simulation.options import FrictionInput
    from rockfrag.system.blocks import Block, Body

# lines of the history of rocking modes that are printed unless all are asked for
MOST_CONTACT_EVENTS = 30


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

    command = commands.add_parser("simulate", help="shake one body by one record")
    _add_case(command)
    command.add_argument(
        "--pga",
        metavar="LEVEL",
        help="scale the record to this peak, as 0.6g or a number of g",
    )
    command.add_argument(
        "--restitution", type=float, help="measured ratio of angular velocities"
    )
    command.add_argument(
        "--friction", nargs="+", type=float, metavar="MU",
        help="coefficient of friction of all contacts, or of each from the ground up",
    )  # fmt: skip
    add_holding_options(command)
    words = "file with the vertical component of the record"
    command.add_argument("--vertical", metavar="RECORD", help=words)
    command.add_argument(
        "--plot", metavar="IMAGE", help="draw the response, as .png or .svg"
    )
    words = "print the whole history of rocking modes"
    command.add_argument("--all-contact-events", action="store_true", help=words)
    command.set_defaults(run=_simulate)

    words = (
        "write a page in which one body rocks under one record, live, in any browser"
    )
    play = commands.add_parser("play", help=words)
    _add_case(play)
    words = "where to write it, as .html"
    play.add_argument("--output", metavar="PAGE", default="rocking.html", help=words)
    play.set_defaults(run=_play)

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


def _add_case(parser: argparse.ArgumentParser) -> None:
    """Add what tells one body and one record."""
    parser.add_argument("record", help="file with the record")
    parser.add_argument(
        "--body", nargs="+", required=True, metavar="SIZE",
        help="the statue, or the lone block: width, height and mass, as 35cm 120cm 180kg or numbers of m, m and "
        "kg; without a mass a square block of stone",
    )  # fmt: skip
    parser.add_argument(
        "--pedestal", nargs="+", action="append", metavar="SIZE",
        help="the block it stands on, in the same way; again for what that stands on",
    )  # fmt: skip
    parser.add_argument(
        "--second", metavar="RECORD",
        help="file with the second horizontal component: the body then moves in space, with --depth or --round",
    )  # fmt: skip
    parser.add_argument(
        "--depth", metavar="SIZE", help="side of the base across its width"
    )
    parser.add_argument("--round", action="store_true", help="the base is round")
    parser.add_argument("--unit", help="unit of a record that does not state its own")
    parser.add_argument(
        "--dt", type=float, help="sampling interval [s] of a record without one"
    )
    parser.add_argument("--channel", help="channel, where the record has several")


# each command imports what it needs when it runs: `rockfrag --help` should not wait for numba
def _simulate(options: argparse.Namespace) -> int:
    """Run ``simulate``, with a sign of life while it takes long."""
    from rockfrag.runtime.progress import sign_of_life

    words = (
        "still simulating; kernels are compiled once a machine, and many bodies, friction or a body in space take "
        "longer than blocks that only rock"
    )
    with sign_of_life(words, expected=_compiling_s(options)):
        lines = _simulated(options)
    print("\n".join(lines))
    return 0


def _compiling_s(options: argparse.Namespace) -> float | None:
    """About how long the kernels of a history compile once a machine [s]; None where they are at hand."""
    from rockfrag.engines.planar import integrate as contact
    from rockfrag.engines.pure_rocking.kernels import single
    from rockfrag.engines.spatial import _integrate as space
    from rockfrag.runtime.machine_code import is_kept

    in_contact = options.friction or len(options.pedestal or []) > 1 or is_held(options)
    if options.second is not None:
        entry, seconds = space.integrate_scales, 40.0
    elif in_contact:
        entry, seconds = contact.integrate, 40.0
    else:
        entry, seconds = single.integrate, 20.0
    return None if is_kept(entry) else seconds


def _simulated(options: argparse.Namespace) -> list[str]:
    """Simulate what the options tell, draw it if asked for, and return the lines to print."""
    from rockfrag.cli.simulated import (
        contact_event_lines,
        lines_in_plane,
        lines_in_space,
    )
    from rockfrag.motions.processing import scale
    from rockfrag.records.motion import GroundMotion
    from rockfrag.simulation import simulate
    from rockfrag.simulation.options import system_of

    if options.plot is not None and not options.plot.endswith((".png", ".svg")):
        raise InputError(
            f"--plot: expected a name that ends in .png or .svg, got {options.plot}."
        )
    body, motion = _case(options)
    factor = _factor(options, motion)
    scaled = scale(motion, factor)
    _warn_of_unit(options.record, scaled.pga, body)
    restitution: Any = options.restitution
    if restitution is not None and options.pedestal:
        restitution = (restitution,) * len(body.blocks)
    given = {"restitution": restitution, "friction": _friction(options)}
    response: Any
    if options.second is not None:
        if is_held(options):
            raise InputError(
                "--second: what holds a body is told of one in its plane here; leave it out."
            )
        block, components = _case_in_space(options, body, motion, options.vertical)
        components = [scale(component, factor) for component in components]
        response = simulate(block, GroundMotion(*components), **given)
        peaks = [component.pga / GRAVITY for component in components]
        title = motion.name
        lines = lines_in_space(options.record, peaks, response.outcome)
    else:
        up = None
        if options.vertical is not None:
            up = scale(read_as_asked(options.vertical, options, None), factor)
        with warnings.catch_warnings():
            # what `simulate` doubts of the acceleration has been said
            warnings.simplefilter("ignore", UserWarning)
            system = system_of(body, **given)
            if is_held(options):
                system = held(options, system)
            response = simulate(system, scaled.acceleration, motion.dt, vertical=up)
        peak = scaled.pga / GRAVITY
        most = sys.maxsize if options.all_contact_events else MOST_CONTACT_EVENTS
        title = f"{motion.name}, peak {peak:.3f} g"
        is_loose = options.friction is not None or is_held(options)
        lines = lines_in_plane(
            options.record, motion, peak, response, is_loose=is_loose
        )
        lines += lines_on_holding(response)
        contact_events = response.contact_events.to_dict("records")
        lines += contact_event_lines(contact_events, most)
    if options.plot:
        from rockfrag.base.figure_style import save_figure

        save_figure(response.plot(title), options.plot)
        lines.append(f"drawn in {options.plot}")
    return lines


def _factor(options: argparse.Namespace, motion: "Motion") -> float:
    """Return the factor that scales a record to the peak that the options tell [-]."""
    from rockfrag.motions.processing import scale_to_pga

    if options.pga is None:
        return 1.0
    with errors_of("--pga"):
        # a bare number is one of g
        peak_g = quantity(options.pga, "m_s2", "g") / GRAVITY
    if not peak_g > 0:
        raise InputError(f"--pga: expected a number of g above 0, got {options.pga}.")
    return float(scale_to_pga(motion, peak_g).provenance[-1]["factor"])


def _friction(options: argparse.Namespace) -> "FrictionInput | None":
    """Return the friction that the options tell, of each contact by its name."""
    given = options.friction
    if given is None or len(given) == 1:
        return None if given is None else float(given[0])
    if len(given) != 1 + len(options.pedestal or []):
        raise InputError(
            f"--friction: expected one coefficient, or one for the ground and for the interface under each block "
            f"above a --pedestal, from below, got {len(given)}."
        )
    return {"ground": given[0], "interface": list(given[1:])}


def _case(options: argparse.Namespace) -> "tuple[Body, Motion]":
    """Return the body and the motion that the options tell."""
    from rockfrag.system.blocks import stacked

    based = options.depth is not None or options.round
    if based and options.second is None:
        raise InputError(
            "--depth and --round are of a body in space; give --second as well."
        )
    if not based and options.second is not None:
        raise InputError(
            "--second: a body in space has --depth or is --round; give either."
        )
    if based and options.pedestal:
        raise InputError(
            "--second: a body in space stands on the ground; leave out --pedestal."
        )
    below = [_block("--pedestal", size) for size in reversed(options.pedestal or [])]
    body = stacked([*below, _block("--body", options.body)])
    return body, read_as_asked(options.record, options, options.channel)


def _case_in_space(
    options: argparse.Namespace,
    body: "Body",
    first: "Motion",
    vertical: str | None = None,
) -> "tuple[Block, list[Motion]]":
    """Return the body in space and the components of its motion, at the same times, that the options tell."""
    from rockfrag.motions.rotation import common_time

    others = [name for name in (options.second, vertical) if name is not None]
    components = [first, *(read_as_asked(name, options, None) for name in others)]
    with errors_of("--depth"):
        depth = None if options.depth is None else quantity(options.depth, "m", "m")
    block = replace(body.blocks[0], depth=depth, round=options.round)
    return block, common_time(components, verticals=(2,))


def _play(options: argparse.Namespace) -> int:
    """Run ``play``: write the page of one history."""
    from rockfrag.records.motion import GroundMotion
    from rockfrag.report.play_page import write_play_page

    if not options.output.endswith(".html"):
        raise InputError(
            f"--output: expected a name that ends in .html, got {options.output}."
        )
    body, motion = _case(options)
    _warn_of_unit(options.record, motion.pga, body)
    if options.second is None:
        write_play_page(body, motion, options.output)
    else:
        block, components = _case_in_space(options, body, motion)
        write_play_page(block, GroundMotion(*components), options.output)
    print(f"open {options.output} in a browser; it needs no network")
    return 0


def _block(option: str, given: Sequence[str]) -> "Block":
    """Make a block of width, height and mass as people write them."""
    from rockfrag.base.input_checks import positive_number
    from rockfrag.system.blocks import Block

    with errors_of(option):
        if len(given) not in (2, 3):
            raise InputError(
                f"expected width, height and, if known, mass, such as 35cm 120cm 180kg; got {' '.join(given)}."
            )
        width, height = quantity(given[0], "m", "m"), quantity(given[1], "m", "m")
        mass = (
            quantity(given[2], "kg", "kg")
            if len(given) == 3
            else STONE * width**2 * height
        )
        for name, value in (("width", width), ("height", height), ("mass", mass)):
            positive_number(name, value)
        check_density(width, height, mass)
        block = Block(width, height, mass)
    if quality_flag := size_warning(width, height):
        print(f"warning: {option}: {quality_flag}", file=sys.stderr)
    return block


def _warn_of_unit(record: str, peak: float, body: "Body") -> None:
    """Say that a motion looks as if it were in another unit, if it does."""
    from rockfrag.system.system import uplift_ratios

    if quality_flag := peak_warning(peak, GRAVITY * min(uplift_ratios(body.system()))):
        print(f"warning: {record}: {quality_flag}", file=sys.stderr)


def _check_config(options: argparse.Namespace) -> int:
    """Run ``check-config``: say what a study will do, and what looks wrong with it."""
    from rockfrag.stages.running import results_folder
    from rockfrag.study.loading import check_records, check_tables, load_any
    from rockfrag.study.study import Study

    study = load_any(options.file)
    folder = results_folder(study)
    check_tables(study)
    if isinstance(study, Study):
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
