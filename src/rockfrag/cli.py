"""The command line: what is in a record, how a body rocks, whether a configuration is right."""

import argparse
import sys
from collections.abc import Sequence

from rockfrag.errors import InputError
from rockfrag.record_commands import add_record_commands

MOST_EVENTS = 30
"""Lines of the pattern history that are printed unless all are asked for."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; return 0, 1 if a file could not be read, 2 if an input is not usable."""
    options = _parser().parse_args(arguments)
    try:
        return int(options.run(options))
    except InputError as error:
        print(error, file=sys.stderr)
        return 2


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="rockfrag", description="Rocking and overturning of free-standing objects."
    )
    commands = parser.add_subparsers(required=True, metavar="COMMAND")

    add_record_commands(commands)

    one = commands.add_parser("simulate", help="shake one body by one record")
    one.add_argument("record", help="file with the record")
    one.add_argument(
        "--body", nargs=3, type=float, required=True, metavar=("WIDTH", "HEIGHT", "MASS"),
        help="the statue, or the lone block [m, m, kg]",
    )  # fmt: skip
    one.add_argument(
        "--pedestal", nargs=3, type=float, metavar=("WIDTH", "HEIGHT", "MASS"),
        help="the block it stands on [m, m, kg]",
    )  # fmt: skip
    one.add_argument("--pga", type=float, metavar="G", help="scale the record to this peak [g]")
    one.add_argument("--restitution", type=float, help="measured ratio of angular velocities")
    one.add_argument("--unit", help="unit of a record that does not state its own")
    one.add_argument("--dt", type=float, help="sampling interval [s] of a record without one")
    one.add_argument("--channel", help="channel, where the record has several")
    one.add_argument("--plot", metavar="IMAGE", help="draw the response, as .png or .svg")
    one.add_argument("--all-events", action="store_true", help="print the whole pattern history")
    one.set_defaults(run=_simulate)

    check = commands.add_parser("check-config", help="check the configuration of a study")
    check.add_argument("file", metavar="FILE", help="configuration, such as config/thesis.yaml")
    check.add_argument("--report", action="store_true", help="only say where its report will be")
    check.set_defaults(run=_check_config)
    return parser


# each command imports what it needs when it runs: `rockfrag --help` should not wait for numba
def _simulate(options: argparse.Namespace) -> int:
    from rockfrag.records.read import read_motion
    from rockfrag.rocking import Block, Stack, simulate
    from rockfrag.units import STANDARD_GRAVITY

    _check_image(options.plot)
    statue = Block(*options.body)
    body = Stack(Block(*options.pedestal), statue) if options.pedestal else statue
    motion = read_motion(options.record, options.unit, options.channel, options.dt)
    acceleration = motion.acceleration
    if options.pga is not None:
        if options.pga <= 0:
            raise InputError(f"--pga: expected a number of g above 0, got {options.pga}.")
        acceleration = acceleration * (options.pga * STANDARD_GRAVITY / motion.pga)
    restitution = options.restitution
    if restitution is not None and options.pedestal:
        restitution = (restitution, restitution)
    response = simulate(body, acceleration, motion.dt, restitution=restitution)
    peak = abs(acceleration).max() / STANDARD_GRAVITY
    print(
        f"{options.record}: peak {peak:.4f} g, {motion.acceleration.size} samples of {motion.dt} s"
    )
    if response.overturned:
        print(f"overturned: the {response.overturned_body}, at {response.overturning_time:.3f} s")
    else:
        print("not overturned")
    largest = abs(response.theta).max(axis=0)
    print("largest rotation [rad]: " + ", ".join(f"{value:.5f}" for value in largest))
    print(f"impacts: {response.impacts}")
    print("friction needed: " + ", ".join(f"{value:.3f}" for value in response.friction_demand))
    print(_history(response.events, options.all_events))
    if options.plot:
        from rockfrag.report.figures.response import response_figure
        from rockfrag.report.figures.style import save_figure

        save_figure(response_figure(response, f"{motion.name}, peak {peak:.3f} g"), options.plot)
        print(f"drawn in {options.plot}")
    return 0


def _history(events, everything: bool) -> str:  # type: ignore[no-untyped-def]
    if events.empty:
        return "it never rocked"
    shown = events if everything else events.head(MOST_EVENTS)
    lines = [
        f"{row['time']:9.4f} s  {row['kind']:<10} {row['from']:>4} → {row['to']}"
        for row in shown.to_dict("records")
    ]
    hidden = len(events) - len(shown)
    if hidden:
        lines.append(f"… and {hidden} more (--all-events)")
    return "\n".join(["pattern history:", *lines])


def _check_image(path: str | None) -> None:
    if path is not None and not path.endswith((".png", ".svg")):
        raise InputError(f"--plot: expected a name that ends in .png or .svg, got {path}.")


def _check_config(options: argparse.Namespace) -> int:
    from rockfrag.study.loading import load_any
    from rockfrag.study.measured_table import MeasuredTable

    study = load_any(options.file)
    if options.report:
        print(f"The report is results/{study.name}/report.html")
    elif isinstance(study, MeasuredTable):
        print(f"{options.file} is right: study {study.name} of the table {study.table}.")
    else:
        print(
            f"{options.file} is right: study {study.name}, {len(study.catalogue)} records, "
            f"{len(study.configurations)} configurations, "
            f"{len(study.amplitudes.values_g)} amplitudes."
        )
    return 0


if __name__ == "__main__":
    sys.exit(main())
