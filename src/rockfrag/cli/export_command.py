"""The command ``rockfrag export``: the fragility of an inventory for ShakeCast, NED and pelicun."""

import argparse
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

from rockfrag.cli.assess_commands import add_records_option


def add_export_command(commands: Any) -> None:
    """Add ``export`` to the parsers of a command line."""
    command = commands.add_parser(
        "export",
        help="write the fragility of an inventory for ShakeCast, NED and pelicun",
        description="ShakeCast takes curves in the motion of the ground, the other two in that of the floor.",
    )
    words = "inventory with an object a row, with latitude and longitude for ShakeCast"
    command.add_argument("file", metavar="INVENTORY.csv", help=words)
    command.add_argument(
        "--measure", choices=("PGA", "PGV"), default="PGV", help="of the curves"
    )
    words = "place of objects without coordinates of their own [degrees]"
    command.add_argument(
        "--at", metavar=("LATITUDE", "LONGITUDE"), nargs=2, type=float, help=words
    )
    words = "floor of objects whose row has none, such as 2/4"
    command.add_argument("--floor", metavar="LEVEL/STOREYS", help=words)
    words = "facility type of ShakeCast"
    command.add_argument("--facility-type", default="STRUCTURE", help=words)
    words = "components of NED that the objects are of, such as E.20.2.2.D"
    command.add_argument("--ned-component", metavar="ID", default="", help=words)
    add_records_option(command)
    command.add_argument("--output", metavar="FOLDER", default="export")
    command.set_defaults(run=_export)


# imported when it runs: `rockfrag --help` should not wait for numba
def _warn(words: str) -> None:
    """Print what is left out, beside the results."""
    print(f"warning: {words}", file=sys.stderr)


def _export(options: argparse.Namespace) -> int:
    """Run ``export``: write fragilities of objects for other programs."""
    from rockfrag.aftermath.object_fragility import object_fragilities
    from rockfrag.assess.hazard.curve import read_measure
    from rockfrag.assess.inventory import FaultyRows, read_inventory
    from rockfrag.assess.motions import motion_set
    from rockfrag.runtime.progress import progress_line

    shared = {"floor": options.floor} if options.floor else {}
    requests, faults = read_inventory(options.file, shared)
    if faults:
        raise FaultyRows(faults)
    if options.at is not None:
        place = tuple(options.at)
        requests = [
            replace(each, coordinates=each.coordinates or place) for each in requests
        ]
    measure = read_measure(options.measure, "--measure")
    motions = motion_set(requests[0].records, requests[0].place, Path(options.records))
    folder = Path(options.output)
    on_floor, without = object_fragilities(
        requests,
        motions,
        measure,
        on_floor=True,
        progress=progress_line("objects in the motion of their floors"),
    )
    for name in without:
        _warn(f"left out: {name}: half of the motions topple it at no level.")
    if on_floor:
        _write_on_floors(on_floor, options.ned_component, folder)
    placed = [each for each in requests if each.coordinates is not None]
    if placed:
        say = progress_line("objects in the motion of the ground")
        of_ground, _ = object_fragilities(placed, motions, measure, progress=say)
        _write_on_ground(of_ground, options.facility_type, folder)
    else:
        _warn("no object has a place; ShakeCast's files are left out.")
    print(f"{len(on_floor)} of {len(requests)} objects in {folder}")
    return 0


def _write_on_floors(found: list[Any], component: str, folder: Path) -> None:
    """Write the files of NED and SimCenter, of objects in the motion of their floors."""
    from rockfrag.aftermath.component_tables import (
        fragility_rows,
        ned_reference,
        ned_table,
    )
    from rockfrag.base.files import write_table
    from rockfrag.fragility.exports import write_simcenter

    write_table(ned_table(found, component), folder / "ned.csv")
    write_table(ned_reference(), folder / "ned_reference.csv")
    write_simcenter(
        fragility_rows(found),
        folder / "fragility.csv",
        folder / "fragility.json",
        # beta holds the error of the model already
        model_error=False,
    )


def _write_on_ground(found: list[Any], kind: str, folder: Path) -> None:
    """Write the files of ShakeCast, of objects in the motion of the ground, which are facilities of a kind."""
    from rockfrag.aftermath.shakecast import shakecast_tables, shakecast_xml
    from rockfrag.base.files import write_table, write_text

    facilities, curves = shakecast_tables(found, kind)
    write_text(shakecast_xml(found, kind), folder / "shakecast.xml")
    write_table(facilities, folder / "shakecast_facilities.csv")
    write_table(curves, folder / "shakecast_fragility.csv")
