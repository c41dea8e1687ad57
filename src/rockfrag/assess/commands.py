"""The commands ``rockfrag assess`` and ``rockfrag rules-of-thumb``."""

import argparse
import shutil
import sys
import textwrap
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rockfrag.errors import InputError

_INVENTORY = ".csv"
_KEYS = ("width", "height", "depth", "mass", "cg_height", "pga", "pgv")


def add_assess_commands(commands: Any) -> None:
    """Add ``assess`` and ``rules-of-thumb`` to the parsers of a command line."""
    parser = commands.add_parser(
        "assess",
        help="say whether one object topples, how probably, and what helps",
        description="One object at one place. Lengths and masses are written with their unit: 35cm, 180kg. "
        "All but width and height has a default, which is stated.",
    )
    parser.add_argument(
        "file",
        nargs="?",
        help="statue.yaml that says all this, or inventory.csv with an object a row",
    )
    about = parser.add_argument_group("the object")
    about.add_argument("--name", help="what it is called")
    for name, words in (
        ("width", "of the base"),
        ("height", "of the whole"),
        ("depth", "of the base, as the width if not given"),
        ("mass", "of stone if not given"),
        ("cg-height", "of the centre of gravity, half the height if not given"),
    ):
        about.add_argument(f"--{name}", metavar="SIZE" if name != "mass" else "MASS", help=words)
    about.add_argument(
        "--mesh", metavar="FILE", help="closed mesh of it (OBJ, PLY, STL; z up) instead"
    )
    about.add_argument("--restitution", type=float, help="measured ratio of angular velocities")
    about.add_argument("--friction", type=float, help="coefficient: it may slide at that level")
    about.add_argument(
        "--pedestal",
        nargs="+",
        metavar="SIZE",
        help="width, height and, if known, mass of the block it stands on",
    )
    place = parser.add_argument_group("the place")
    place.add_argument(
        "--floor", metavar="LEVEL/STOREYS", help="such as 2/4; the ground if not given"
    )
    place.add_argument("--building", metavar="FILE", help="YAML file with the building")
    place.add_argument("--pga", metavar="ACCELERATION", help="of the ground: 0.25g")
    place.add_argument("--pgv", metavar="VELOCITY", help="of the ground: 20cm/s")
    place.add_argument("--sa", nargs=2, metavar=("PERIOD", "ACCELERATION"), help="0.3s 0.6g")
    place.add_argument("--return-period", type=float, metavar="YEARS", help="of that level")
    place.add_argument("--hazard", nargs="+", metavar="FILE", help="hazard curves of the site")
    place.add_argument("--years", type=float, help="time of the probability, 50 if not given")
    place.add_argument("--magnitude", type=float, help="of the earthquakes that matter most there")
    place.add_argument("--distance", type=float, metavar="KM", help="of these earthquakes")
    motions = parser.add_argument_group("the motions")
    motions.add_argument(
        "--record",
        nargs="+",
        metavar="PATH",
        help="own records, folders or catalogues instead of the default set",
    )
    motions.add_argument("--on-floor", action="store_true", help="they were recorded on that floor")
    motions.add_argument("--unit", help="unit of records that do not state theirs: g, m/s2, cm/s2")
    motions.add_argument(
        "--records", metavar="FOLDER", default="resources/records", help="folder of fetched records"
    )
    out = parser.add_argument_group("the answer")
    out.add_argument(
        "--output", metavar="FOLDER", default="assessment", help="where page and JSON are written"
    )
    out.add_argument("--pdf", action="store_true", help="print the page too, by Chromium or Chrome")
    out.add_argument("--json", action="store_true", help="print the answer as JSON")
    out.add_argument("--pages", action="store_true", help="of an inventory: write a page for each")
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


# imported when it runs: `rockfrag --help` should not wait for numba
def _assess(options: argparse.Namespace) -> int:
    if options.file and Path(options.file).suffix.lower() == _INVENTORY:
        return _inventory(options)
    from rockfrag.assess.answer import assess
    from rockfrag.assess.as_json import as_json
    from rockfrag.assess.page import write_answer
    from rockfrag.assess.words import doubts, five_lines

    found = assess(_request(options), options.records)
    for doubt in doubts(found):
        print(f"warning: {doubt}", file=sys.stderr)
    place = write_answer(found, options.output)
    if options.pdf:
        from rockfrag.report.pdf import print_page

        place = print_page(place)
    if options.json:
        print(as_json(found), end="")
    else:
        print("\n".join(_fitted(line) for line in five_lines(found)))
        print(f"{place}", file=sys.stderr)
    return 0


def _fitted(line: str) -> str:
    """Break a line where a terminal ends; what goes into a file or a pipe stays whole."""
    if not sys.stdout.isatty():
        return line
    width = max(shutil.get_terminal_size().columns, 40)
    return textwrap.fill(line, width, subsequent_indent="    ")


def _request(options: argparse.Namespace) -> Any:
    from rockfrag.assess.request import make_request
    from rockfrag.yaml_file import read_yaml

    settings = read_yaml(options.file) if options.file else {}
    folder = Path(options.file).parent if options.file else Path()
    given = _settings(options)
    if options.file:
        for key in ("mesh", "building", "hazard", "records"):
            if key in given:
                raise InputError(
                    f"--{key}: give it in {options.file}, from whose folder paths are read."
                )
    return make_request(settings | given, options.file or "rockfrag assess", folder)


def _settings(options: argparse.Namespace) -> dict[str, Any]:
    """What the command line says, with the keys of ``statue.yaml``."""
    plain = {key: getattr(options, key) for key in _KEYS}
    plain |= {
        "name": options.name,
        "restitution": options.restitution,
        "friction": options.friction,
        "mesh": {"file": options.mesh} if options.mesh else None,
        "pedestal": _pedestal(options.pedestal),
        "floor": options.floor,
        "building": options.building,
        "sa": options.sa,
        "return_period_years": options.return_period,
        "hazard": options.hazard,
        "years": options.years,
        "magnitude": options.magnitude,
        "distance_km": options.distance,
    }
    if options.record:
        plain["records"] = {
            "paths": options.record,
            "recorded_on": "floor" if options.on_floor else "ground",
            **({"unit": options.unit} if options.unit else {}),
        }
    return {key: value for key, value in plain.items() if value is not None}


def _pedestal(given: Sequence[str] | None) -> dict[str, str] | None:
    if given is None:
        return None
    if len(given) not in (2, 3):
        raise InputError(
            "--pedestal: expected width, height and, if known, mass, such as 50cm 90cm 400kg; got "
            f"{' '.join(given)}."
        )
    return dict(zip(("width", "height", "mass"), given, strict=False))


def _inventory(options: argparse.Namespace) -> int:
    from rockfrag.assess.inventory import assess_inventory, inventory_lines, write_inventory

    shared = _settings(options)
    unfit = [key for key in ("name", "width", "height", "mesh") if key in shared]
    if unfit:
        raise InputError(f"--{unfit[0]}: is of one object; put it into {options.file}.")
    found = assess_inventory(options.file, shared, options.records)
    print("\n".join(inventory_lines(found)))
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
