"""``rockfrag simulate`` and ``rockfrag play``: one body under one record, in lines, a picture or a live page.

In: options as they are typed. Out: lines on the screen, files that were asked for.
"""

import argparse
import sys
import warnings
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

from rockfrag.base.errors import InputError, errors_of
from rockfrag.base.plausible import STONE, check_density, peak_warning, size_warning
from rockfrag.base.units import GRAVITY, quantity
from rockfrag.cli.held import (
    add_holding_options,
    held,
    is_held,
    lines_on_holding,
)
from rockfrag.cli.record_commands import read_as_asked

if TYPE_CHECKING:
    from rockfrag.records.motion import Motion
    from rockfrag.simulation.options import FrictionInput
    from rockfrag.system.blocks import Block, Body

# lines of the history of rocking modes that are printed unless all are asked for
MOST_CONTACT_EVENTS = 30


def add_simulate_command(commands: Any) -> None:
    """Add ``simulate`` to the command line.

    Parameters
    ----------
    commands : subparsers of the command line
    """
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


def add_play_command(commands: Any) -> None:
    """Add ``play`` to the command line.

    Parameters
    ----------
    commands : subparsers of the command line
    """
    words = (
        "write a page in which one body rocks under one record, live, in any browser"
    )
    play = commands.add_parser("play", help=words)
    _add_case(play)
    words = "where to write it, as .html"
    play.add_argument("--output", metavar="PAGE", default="rocking.html", help=words)
    play.set_defaults(run=_play)


def _add_case(parser: argparse.ArgumentParser) -> None:
    """Add the options that describe one body and one record."""
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
    """Simulate what the options say, draw it if asked for, and return the lines to print."""
    from rockfrag.base.figure_style import save_figure

    _check_image(options.plot)
    body, motion = _case(options)
    factor = _factor(options, motion)
    _warn_of_unit(options.record, factor * motion.pga, body)
    if options.second is None:
        response, title, lines = _in_plane(options, body, motion, factor)
    else:
        response, title, lines = _in_space(options, body, motion, factor)
    if options.plot:
        save_figure(response.plot(title), options.plot)
        lines.append(f"drawn in {options.plot}")
    return lines


def _check_image(name: str | None) -> None:
    """Refuse a name of an image whose ending says no format that figures have."""
    if name is not None and not name.endswith((".png", ".svg")):
        raise InputError(
            f"--plot: expected a name that ends in .png or .svg, got {name}."
        )


class _Simulated(NamedTuple):
    """A response, the title of its picture, and the lines on it."""

    response: Any
    title: str
    lines: list[str]


def _in_plane(
    options: argparse.Namespace, body: "Body", motion: "Motion", factor: float
) -> _Simulated:
    """Simulate a body in its plane under its record, scaled by ``factor``."""
    from rockfrag.cli.simulated import contact_event_lines, lines_in_plane
    from rockfrag.motions.processing import scale
    from rockfrag.simulation import simulate
    from rockfrag.simulation.options import system_of

    scaled = scale(motion, factor)
    up = None
    if options.vertical is not None:
        up = scale(read_as_asked(options.vertical, options, None), factor)
    with warnings.catch_warnings():
        # what `simulate` doubts of the acceleration has been said
        warnings.simplefilter("ignore", UserWarning)
        system = system_of(body, **_contacts(options, body))
        system = held(options, system)
        response = simulate(system, scaled.acceleration, motion.dt, vertical=up)
    peak = scaled.pga / GRAVITY
    is_loose = options.friction is not None or is_held(options)
    lines = lines_in_plane(options.record, motion, peak, response, is_loose=is_loose)
    lines += lines_on_holding(response)
    contact_events = response.contact_events.to_dict("records")
    most = sys.maxsize if options.all_contact_events else MOST_CONTACT_EVENTS
    lines += contact_event_lines(contact_events, most)
    return _Simulated(response, f"{motion.name}, peak {peak:.3f} g", lines)


def _in_space(
    options: argparse.Namespace, body: "Body", motion: "Motion", factor: float
) -> _Simulated:
    """Simulate a body in space under the components of its record, scaled by ``factor``."""
    from rockfrag.cli.simulated import lines_in_space
    from rockfrag.motions.processing import scale
    from rockfrag.records.motion import GroundMotion
    from rockfrag.simulation import simulate
    from rockfrag.simulation.options import system_of

    block, components = _case_in_space(options, body, motion, options.vertical)
    scaled = [scale(component, factor) for component in components]
    system = held(options, system_of(block, **_contacts(options, body)))
    response: Any = simulate(system, GroundMotion(*scaled))
    peaks = [component.pga / GRAVITY for component in scaled]
    lines = lines_in_space(options.record, peaks, response)
    lines += lines_on_holding(response)
    return _Simulated(response, motion.name, lines)


def _contacts(options: argparse.Namespace, body: "Body") -> dict[str, Any]:
    """Restitution and friction of the contacts that the options give, as ``simulate`` takes them."""
    restitution: Any = options.restitution
    if restitution is not None and options.pedestal:
        restitution = (restitution,) * len(body.blocks)
    return {"restitution": restitution, "friction": _friction(options)}


def _factor(options: argparse.Namespace, motion: "Motion") -> float:
    """Return the factor that scales a record to the peak that the options ask for [-]."""
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
    """Return the friction of each contact that the options give, by its name; None without any."""
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
    """Return the body and the motion that the options describe."""
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
    """Return the body in space and the components of its motion, at the same times, that the options describe."""
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
