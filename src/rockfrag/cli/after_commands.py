"""The command ``rockfrag after``: which objects of a collection to look at first after an earthquake."""

import argparse
import math
import sys
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from rockfrag.base.errors import InputError
from rockfrag.cli.assess_commands import (
    add_request_options,
    print_faults,
    settings_of,
)

if TYPE_CHECKING:
    from rockfrag.aftermath.shakemap import ShakeMap
    from rockfrag.aftermath.shaken_ground import GroundShaking
    from rockfrag.aftermath.shaken_objects import Ground
    from rockfrag.records.motion import Motion

NEEDED = {
    "map_uncertainty": "shakemap",
    "then_map_uncertainty": "then_shakemap",
    "station_km": "station",
    "then_station": "station",
}
"""Options that say something only beside another one."""

UNUSED = ("name", "width", "height", "depth", "mesh", "sa", "hazard", "return_period")
"""Keys of ``statue.yaml`` that are of one object, or of earthquakes to come."""


def add_after_command(commands: Any) -> None:
    """Add ``after`` to the parsers of a command line."""
    command = commands.add_parser(
        "after",
        help="list which objects to look at first after an earthquake",
        usage="rockfrag after INVENTORY.csv (--shakemap grid.xml | --station RECORD … | --pga LEVEL --pgv LEVEL); "
        "rockfrag after --help lists all options",
        description="Objects of an inventory, with latitude and longitude or all at one place, after an "
        "earthquake that happened.",
    )
    words = "inventory with an object a row, or a table as a museum exports it"
    command.add_argument("file", metavar="INVENTORY.csv", help=words)
    ground = command.add_argument_group("what shook the ground")
    words = "grid.xml of a ShakeMap, or its zip file"
    ground.add_argument("--shakemap", metavar="GRID", help=words)
    words = "uncertainty.xml of the same map, or its zip file"
    ground.add_argument("--map-uncertainty", metavar="GRID", help=words)
    words = "record of a station: one file, or one of each horizontal component"
    ground.add_argument("--station", metavar="RECORD", nargs="+", help=words)
    words = "distance of the station from the objects [km]"
    ground.add_argument("--station-km", metavar="KM", type=float, help=words)
    words = "grid.xml of a second shock, which found the objects as the first left them"
    ground.add_argument("--then-shakemap", metavar="GRID", help=words)
    words = "uncertainty.xml of the map of the second shock"
    ground.add_argument("--then-map-uncertainty", metavar="GRID", help=words)
    words = "record of a second shock, with as many files as --station"
    ground.add_argument("--then-station", metavar="RECORD", nargs="+", help=words)
    words = "place of objects without coordinates of their own [degrees]"
    ground.add_argument(
        "--at", metavar=("LATITUDE", "LONGITUDE"), nargs=2, type=float, help=words
    )
    words = "standard deviation of ln of typed --pga and --pgv [-]"
    ground.add_argument("--sd-ln", metavar="S", type=float, help=words)
    add_request_options(command)
    out = command.add_argument_group("the list")
    words = "where page, table and JSON are written"
    out.add_argument("--output", metavar="FOLDER", default="after", help=words)
    out.add_argument("--json", action="store_true", help="print the list as JSON")
    out.add_argument("--language", default="en", help="of the list, such as it")
    words = "list the rows that are right, and say what is wrong with the others"
    out.add_argument("--keep-going", action="store_true", help=words)
    words = "order of lengths that a museum's table does not name, such as HWD"
    out.add_argument("--order", default="", help=words)
    command.set_defaults(run=_after)


# imported when it runs: `rockfrag --help` should not wait for numba
def _after(options: argparse.Namespace) -> int:
    """Run ``after``: print what an earthquake did to a collection, and write its files."""
    from rockfrag.aftermath.check_list import after_json, after_lines, write_after
    from rockfrag.aftermath.shaken_objects import after_earthquake
    from rockfrag.assess.inventory import FaultyRows
    from rockfrag.runtime.progress import progress_line
    from rockfrag.words.catalogue import catalogue

    # an unknown language is refused before anything is written
    catalogue(options.language)
    about_station = {"unit": options.unit, "dt": options.dt}
    if options.station:
        # the unit of its files, not of records by which objects are shaken
        options.unit = options.dt = None
    given = settings_of(options)
    _check_unused(given)
    typed: dict[str, Any] = {
        key: given.pop(key) for key in ("pga", "pgv") if key in given
    }
    try:
        _check_sources(options, typed)
        first = _map_of(options.shakemap, options.map_uncertainty)
        ground, recorded = _ground_of(options, typed, about_station, first)
        then, then_recorded = _then_of(options, about_station, first)
        found = after_earthquake(
            options.file,
            ground,
            given,
            options.records,
            recorded=recorded,
            then=then,
            then_recorded=then_recorded,
            keep_going=options.keep_going,
            order=options.order,
            progress=progress_line("objects"),
        )
    except FaultyRows as error:
        return print_faults(
            error,
            given,
            "nothing was listed; --keep-going lists the rows that are right.",
        )
    for fault in found.faults:
        print(f"warning: left out: {fault}", file=sys.stderr)
    place = write_after(found, options.output, options.language)
    if options.json:
        print(after_json(found), end="")
    else:
        print("\n".join(after_lines(found, options.language)))
    print(place, file=sys.stderr)
    return 0


def _check_unused(given: Mapping[str, Any]) -> None:
    """Refuse settings of ``assess`` that say nothing of a collection after an earthquake."""
    unfit = [key for key in UNUSED if key in given]
    if unfit:
        raise InputError(
            f"--{unfit[0].replace('_', '-')}: says nothing of an earthquake that happened, or is of one object; "
            "leave it out."
        )


def _check_sources(options: argparse.Namespace, typed: dict[str, Any]) -> None:
    """Refuse options without effect, and what shook the ground in no way or in several."""
    for name, needed in NEEDED.items():
        if getattr(options, name) is not None and not getattr(options, needed):
            raise InputError(
                f"--{name.replace('_', '-')} needs --{needed.replace('_', '-')}."
            )
    if options.sd_ln is not None and not typed:
        raise InputError("--sd-ln is of typed levels; give --pga or --pgv with it.")
    sources = [options.shakemap, options.station, typed]
    if sum(bool(source) for source in sources) != 1:
        raise InputError(
            "give what shook the ground in one way: --shakemap, --station, or --pga with --pgv."
        )


def _map_of(grid: str | None, uncertainty: str | None) -> "ShakeMap | None":
    """Read the map of a shock, if it has one."""
    from rockfrag.aftermath.shakemap import read_shakemap

    return read_shakemap(grid, uncertainty) if grid else None


def _ground_of(
    options: argparse.Namespace,
    typed: dict[str, Any],
    about_station: dict[str, Any],
    shakemap: "ShakeMap | None",
) -> "tuple[Ground, tuple[Motion, ...]]":
    """What shook a place, by the one way that the command line gives.

    Parameters
    ----------
    options : of the command line
    typed : levels that were typed, empty without any
    about_station : what a station's record needs beside it
    shakemap : the map, if one was given

    Returns
    -------
    A function that gives the shaking of a place, and the motions of a record if that is the way.
    """
    if shakemap is not None:
        return _by_map(options, shakemap), ()
    if typed:
        ground = _typed(options, typed)
        return lambda _: ground, ()
    recorded, motions = _of_station(options, options.station, about_station)
    return lambda _: recorded, motions


def _then_of(
    options: argparse.Namespace,
    about_station: dict[str, Any],
    first: "ShakeMap | None",
) -> "tuple[Ground | None, tuple[Motion, ...]]":
    """What shook a place a second time, and the record if that is one."""
    if options.then_shakemap and options.then_station:
        raise InputError("give the second shock by --then-shakemap or --then-station.")
    second = _map_of(options.then_shakemap, options.then_map_uncertainty)
    if second is not None:
        _check_other_shock(options, first, second)
        return _by_map(options, second), ()
    if not options.then_station:
        return None, ()
    recorded, motions = _of_station(options, options.then_station, about_station)
    return lambda _: recorded, motions


def _check_other_shock(
    options: argparse.Namespace, first: "ShakeMap | None", second: "ShakeMap"
) -> None:
    """Refuse two maps of one earthquake."""
    if first is None or not first.identifier:
        return
    if first.identifier == second.identifier:
        raise InputError(
            f"--then-shakemap: {options.then_shakemap} and {options.shakemap} are both of the earthquake "
            f"{first.identifier}; give the map of the second shock."
        )


def _by_map(options: argparse.Namespace, shakemap: "ShakeMap") -> "Ground":
    """Return the function that reads the shaking at a place off a ShakeMap; no place is that of ``--at``."""
    from rockfrag.aftermath.shaken_ground import mapped_ground

    def ground(at: tuple[float, float] | None) -> "GroundShaking | None":
        """Shaking of a place by the map, None where it has no point near."""
        place = at or options.at
        if place is None:
            raise InputError(
                f"{options.file}: the map needs the place of each object; give columns latitude and longitude, "
                "or --at for all."
            )
        return mapped_ground(shakemap, *place)

    return ground


def _of_station(
    options: argparse.Namespace, records: Sequence[str], about: dict[str, Any]
) -> "tuple[GroundShaking, tuple[Motion, ...]]":
    """Shaking that a station recorded, and its motions."""
    from rockfrag.aftermath.shaken_ground import recorded_ground

    away = options.station_km or 0.0
    if not 0 <= away < math.inf:
        raise InputError(f"--station-km: expected kilometres, got {away}.")
    return recorded_ground(records, away, **about)


def _typed(options: argparse.Namespace, typed: dict[str, Any]) -> "GroundShaking":
    """Shaking that the command line states in numbers."""
    from rockfrag.aftermath.shaken_ground import GroundShaking
    from rockfrag.assess.request import make_request
    from rockfrag.words.findings import finding

    spread = options.sd_ln or 0.0
    if not 0 <= spread < 3:
        raise InputError(f"--sd-ln: expected a number from 0 to 3, got {spread}.")
    # read and checked as those of one object are
    about = {"width": "1 m", "height": "2 m", **typed}
    level = make_request(about, "rockfrag after").level
    assert level is not None
    source = finding("after_typed")
    found = GroundShaking(math.nan, math.nan, spread, spread, source=source)
    if "pga" not in typed:
        return replace(found, pgv=level.value)
    return replace(found, pga=level.value, pgv=level.pgv)
