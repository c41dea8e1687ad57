"""The commands ``rockfrag assess`` and ``rockfrag rules-of-thumb``."""

import argparse
import re
import shutil
import sys
import textwrap
from collections.abc import Collection, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from rockfrag.errors import InputError

_INVENTORY = ".csv"
_KEYS = (
    *("width", "height", "depth", "mass", "cg_height", "cg_offset", "pga", "pgv", "return_period"),
    *("name", "facing_deg", "base_spread", "restitution", "friction", "pad_friction", "floor"),
    *("sa", "hazard", "years", "magnitude", "distance_km"),
)
"""Keys of ``statue.yaml`` that are options as they are."""
_METRES = {"m": 1.0, "cm": 0.01, "mm": 0.001, "in": 0.0254, "ft": 0.3048}


class _Once(argparse.Action):
    """An option that is given at most once: of two the first would be dropped without a word."""

    def __call__(
        self,
        parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,
        values: Any,
        option_string: str | None = None,
    ) -> None:
        """Keep the value, or end with a sentence where there is one already."""
        if getattr(namespace, self.dest, None) not in (None, self.default):
            raise InputError(f"{option_string} is given twice; give it once.")
        setattr(namespace, self.dest, values)


def add_assess_commands(commands: Any) -> None:
    """Add ``assess`` and ``rules-of-thumb`` to the parsers of a command line."""
    parser = commands.add_parser(
        "assess",
        help="say whether one object topples, how probably, and what helps",
        # the whole list of options would bury what was wrong with one of them
        usage="rockfrag assess [FILE] [--width SIZE --height SIZE …]; rockfrag assess --help lists all options",
        description="One object at one place. Lengths and masses are written with their unit: 35cm, 180kg. "
        "All but width and height has a default, which is stated.",
    )
    parser.add_argument(
        "file",
        nargs="?",
        help="statue.yaml that says all this, or inventory.csv with an object a row",
    )
    add_request_options(parser)
    out = parser.add_argument_group("the answer")
    out.add_argument(
        "--output", metavar="FOLDER", default="assessment", help="where page and JSON are written"
    )
    out.add_argument("--pdf", action="store_true", help="print the page too, by Chromium or Chrome")
    out.add_argument("--json", action="store_true", help="print the answer as JSON")
    out.add_argument("--pages", action="store_true", help="of an inventory: write a page for each")
    out.add_argument(
        "--keep-going",
        action="store_true",
        help="of an inventory: rank the rows that are right, and list what is wrong with the others",
    )
    parser.set_defaults(run=_assess)
    rules = commands.add_parser(
        "rules-of-thumb", help="hold engineers' rules against simulations of objects"
    )
    rules.add_argument("file", help="objects, such as config/rules-of-thumb.yaml")
    rules.add_argument(
        "--records", metavar="FOLDER", default="resources/records", help="folder of fetched records"
    )
    rules.add_argument("--output", metavar="FILE", help="write the table as .csv or .parquet")
    rules.set_defaults(run=_rules)


def add_request_options(parser: argparse.ArgumentParser) -> None:
    """Add what an object, its place and its motions are told by."""
    _add_object(parser.add_argument_group("the object"))
    _add_place(parser.add_argument_group("the place"))
    _add_motions(parser.add_argument_group("the motions"))


def _add_object(about: Any) -> None:
    once = partial(about.add_argument, action=_Once)
    once("--name", help="what it is called")
    once("--width", metavar="SIZE", help="of the base, or the diameter of a round one")
    once("--height", metavar="SIZE", help="of the whole")
    once("--depth", metavar="SIZE", help="of the base, as the width if not given")
    once("--mass", metavar="MASS", help="of stone if not given")
    words = "of the centre of gravity"
    once("--cg-height", metavar="SIZE", help=f"{words}, half the height if not given")
    once("--cg-offset", metavar="SIZE", help=f"{words} from the middle of the base")
    once(
        "--facing",
        dest="facing_deg",
        type=float,
        metavar="DEGREES",
        help="direction of the width, or of a mesh's x axis, from the first component of each record",
    )
    once(
        "--base-spread",
        type=float,
        metavar="FRACTION",
        help="by how much corners of the base lie elsewhere in space, over its size, and it is turned: 0.001",
    )
    about.add_argument("--round", action="store_true", help="the base is round")
    once("--mesh", metavar="FILE", help="mesh of it (OBJ, PLY, STL, GLB) instead")
    once("--up", choices="xyz", help="axis of the mesh that points up")
    about.add_argument(
        "--hull", action="store_true", help="take the convex hull of a mesh that is not closed"
    )
    once("--mesh-unit", choices=list(_METRES), help="unit of the mesh, m if not given")
    once(
        "--contact-tolerance",
        metavar="SIZE",
        help="height up to which points of the mesh carry, 2mm if not given",
    )
    once("--restitution", type=float, help="measured ratio of angular velocities")
    once("--friction", type=float, help="coefficient: it may slide at that level")
    once(
        "--pad-friction",
        type=float,
        help="coefficient of a pad under the object, tried as a mitigation",
    )
    about.add_argument(
        "--pedestal",
        action="append",
        nargs="+",
        metavar="SIZE",
        help="width, height and, if known, mass of the block it stands on; again for what that stands on",
    )


def _add_place(place: Any) -> None:
    once = partial(place.add_argument, action=_Once)
    once(
        "--floor",
        metavar="LEVEL/STOREYS",
        help="such as 2/4, with 0 for the ground: level 2 is the second floor in Europe, the third in America",
    )
    once("--building", metavar="FILE", help="YAML file with the building")
    once(
        "--storey-height",
        nargs="+",
        metavar="SIZE",
        help="of every storey, or of each from below; 3.5m if not given",
    )
    once("--period", metavar="TIME", help="first period of the building: 0.4s")
    once(
        "--material",
        choices=["masonry", "concrete", "steel"],
        help="of the building: its period follows from that and its height",
    )
    once("--pga", metavar="ACCELERATION", help="of the ground: 0.25g")
    once("--pgv", metavar="VELOCITY", help="of the ground, alone or beside the other: 20cm/s")
    once("--sa", nargs=2, metavar=("PERIOD", "ACCELERATION"), help="0.3s 0.6g")
    once("--return-period", metavar="YEARS", help="of that level")
    once("--hazard", nargs="+", metavar="FILE", help="hazard curves of the site")
    once("--years", type=float, help="time of the probability, 50 if not given")
    once("--magnitude", type=float, help="of the earthquakes that matter most there")
    once("--distance", dest="distance_km", type=float, metavar="KM", help="of these earthquakes")


def _add_motions(motions: Any) -> None:
    once = partial(motions.add_argument, action=_Once)
    once(
        "--record",
        nargs="+",
        metavar="PATH",
        help="own records, folders or catalogues instead of the default set",
    )
    motions.add_argument("--on-floor", action="store_true", help="they were recorded on that floor")
    once("--unit", help="unit of records that do not state theirs: g, m/s2, cm/s2")
    once("--dt", type=float, metavar="S", help="sampling interval of records without one")
    motions.add_argument(
        "--records", metavar="FOLDER", default="resources/records", help="folder of fetched records"
    )


# imported when it runs: `rockfrag --help` should not wait for numba
def _assess(options: argparse.Namespace) -> int:
    from rockfrag.assess.inventory import FaultyRows

    given = settings_of(options)
    _refuse_unused(options)
    try:
        if _is_inventory(options):
            return _inventory(options, given)
        return _one(options, given)
    except FaultyRows as error:
        for fault in error.faults:
            print(on_command_line(fault, given), file=sys.stderr)
        print("nothing was assessed; --keep-going ranks the rows that are right.", file=sys.stderr)
        return 2
    except InputError as error:
        # a message about a file names its keys, one about an option the option
        words = on_command_line(str(error), given if options.file else None)
        raise InputError(words) from error


def _is_inventory(options: argparse.Namespace) -> bool:
    return bool(options.file) and Path(options.file).suffix.lower() == _INVENTORY


def _refuse_unused(options: argparse.Namespace) -> None:
    """Refuse options that would have no effect."""
    without = [
        (bool(options.record), "--record", ("on_floor", "unit", "dt")),
        (bool(options.mesh), "--mesh", ("up", "hull", "mesh_unit", "contact_tolerance")),
        (_is_inventory(options), "an inventory, a .csv file", ("pages", "keep_going")),
        (not _is_inventory(options), "one object, not an inventory", ("pdf", "json")),
    ]
    for there, needed, names in without:
        for name in names:
            if getattr(options, name) not in (None, False) and not there:
                raise InputError(f"--{name.replace('_', '-')} needs {needed}; leave it out.")
    if options.building and (options.storey_height or options.period or options.material):
        raise InputError(
            "--building: the file says all of the building; leave out --storey-height, --period and --material."
        )


def _one(options: argparse.Namespace, given: dict[str, Any]) -> int:
    from rockfrag.assess.answer import assess
    from rockfrag.assess.export import as_json
    from rockfrag.assess.page import write_answer
    from rockfrag.assess.words import five_lines, quality_flags

    found = assess(_request(options, given), options.records)
    for quality_flag in quality_flags(found):
        print(f"warning: {quality_flag}", file=sys.stderr)
    place = write_answer(found, options.output)
    if options.pdf:
        from rockfrag.report.pdf import print_page

        place = print_page(place)
    if options.json:
        print(as_json(found), end="")
    else:
        lines = five_lines(found)
        if sys.stdout.isatty():
            # broken where a terminal ends; what goes into a file or a pipe stays whole
            width = max(shutil.get_terminal_size().columns, 40)
            lines = [textwrap.fill(line, width, subsequent_indent="    ") for line in lines]
        print("\n".join(lines))
        print(f"{place}", file=sys.stderr)
    return 0


def _request(options: argparse.Namespace, given: dict[str, Any]) -> Any:
    from rockfrag.assess.request import make_request
    from rockfrag.yaml_file import read_yaml

    if not options.file:
        return make_request(given, "rockfrag assess", Path())
    settings = read_yaml(options.file)
    for key in ("mesh", "building", "hazard", "records"):
        if key in given:
            raise InputError(
                f"key {key}: give it in {options.file}, which says the rest of it and from whose folder "
                "paths are read."
            )
    return make_request(settings | given, options.file, Path(options.file).parent)


def settings_of(options: argparse.Namespace) -> dict[str, Any]:
    """What the command line says, with the keys of ``statue.yaml``."""
    plain = {key: getattr(options, key) for key in _KEYS}
    plain |= {
        "round": options.round or None,
        "mesh": _mesh(options),
        "pedestal": _pedestals(options.pedestal),
        "building": options.building or _building(options),
    }
    if options.record:
        plain["records"] = {
            "paths": options.record,
            "recorded_on": "floor" if options.on_floor else "ground",
            **({"unit": options.unit} if options.unit else {}),
            **({"dt_s": options.dt} if options.dt is not None else {}),
        }
    return {key: value for key, value in plain.items() if value is not None}


def _mesh(options: argparse.Namespace) -> dict[str, Any] | None:
    if options.mesh is None:
        return None
    known = {
        "file": options.mesh,
        "up": options.up,
        "hull": options.hull or None,
        "metres_per_unit": _METRES[options.mesh_unit] if options.mesh_unit else None,
        "contact_tolerance": options.contact_tolerance,
    }
    return {key: value for key, value in known.items() if value is not None}


def _building(options: argparse.Namespace) -> dict[str, Any] | None:
    from rockfrag.units import quantity

    known: dict[str, Any] = {}
    if heights := options.storey_height:
        known |= {"storey_heights": heights} if heights[1:] else {"storey_height": heights[0]}
    if options.period:
        try:
            known["first_period_s"] = quantity(options.period, "s", None)
        except InputError as error:
            raise InputError(f"--period: {error}") from None
    return known | ({"material": options.material} if options.material else {}) or None


def _pedestals(given: Sequence[Sequence[str]] | None) -> Any:
    """The pedestal as a file would have it, or several from above."""
    if given is None:
        return None
    for numbers in given:
        if len(numbers) not in (2, 3):
            raise InputError(
                "--pedestal: expected width, height and, if known, mass, such as 50cm 90cm 400kg; got "
                f"{' '.join(numbers)}."
            )
    found = [dict(zip(("width", "height", "mass"), numbers, strict=False)) for numbers in given]
    return found if len(found) > 1 else found[0]


def _inventory(options: argparse.Namespace, shared: dict[str, Any]) -> int:
    from rockfrag.assess.gallery import write_inventory
    from rockfrag.assess.inventory import assess_inventory, inventory_lines, joint_lines

    unfit = [key for key in ("name", "width", "height", "mesh") if key in shared]
    if unfit:
        raise InputError(f"--{unfit[0]}: is of one object; put it into {options.file}.")
    found = assess_inventory(options.file, shared, options.records, keep_going=options.keep_going)
    for fault in found.faults:
        print(f"warning: left out: {fault}", file=sys.stderr)
    print("\n".join([*inventory_lines(found), *joint_lines(found)]))
    place = write_inventory(found, options.output, pages=options.pages)
    print(f"{place}", file=sys.stderr)
    return 0


def _rules(options: argparse.Namespace) -> int:
    from rockfrag.assess.rules import rules_study
    from rockfrag.files import write_table

    table = rules_study(options.file, options.records)
    print(table.to_string(index=False, float_format=lambda value: f"{value:.2f}"))
    if options.output:
        write_table(table, options.output)
    return 0


_OPTIONS = {
    "distance": "distance",
    "records": "record",
    "records.unit": "unit",
    "records.dt": "dt",
    "mesh.file": "mesh",
    "mesh.metres_per_unit": "mesh-unit",
    "mesh.up": "up",
    "mesh.hull": "hull",
    "mesh.contact_tolerance": "contact-tolerance",
    "building.storey_height": "storey-height",
    "building.storey_heights": "storey-height",
    "building.first_period": "period",
    "building.material": "material",
    "building.damping_ratio": "damping",
}
"""Options that are not called as their keys are."""

_UNITS = ("_kg_m2", "_years", "_km", "_kg", "_deg", "_m", "_s")
_KEY = re.compile(
    r"(?<!\w)key ([a-z_][a-z0-9_.]*[a-z0-9_])(\[\d+\](?:\.[a-z_]+)?)?(: true\b|: (?=[xyz]\b))?"
)


def on_command_line(words: str, given: Collection[str] | None = None) -> str:
    """A message that names keys of ``statue.yaml`` as ``key pga``, with options in place of those that were given.

    All of them are taken as given if None.
    """

    def option(found: re.Match[str]) -> str:
        key = _without_unit(found[1])
        if given is not None and key.split(".")[0] not in {_without_unit(other) for other in given}:
            return found[0]
        name = _OPTIONS.get(key, key.split(".")[0].replace("_", "-"))
        # a flag takes no value, and an axis stands beside its option
        return f"--{name}" + (" " if found[3] == ": " else "")

    return _KEY.sub(option, words.replace(_METRES_PER_UNIT, "key mesh.metres_per_unit mm"))


_METRES_PER_UNIT = "key mesh.metres_per_unit (0.001 for millimetres, 0.3048 for feet)"


def _without_unit(key: str) -> str:
    for unit in _UNITS:
        if key.endswith(unit):
            return key.removesuffix(unit)
    return key
