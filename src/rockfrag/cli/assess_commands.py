"""The commands ``rockfrag assess``, ``rockfrag rules-of-thumb`` and ``rockfrag app``."""

import argparse
import re
import shutil
import sys
import textwrap
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from functools import partial
from itertools import groupby
from operator import attrgetter
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from rockfrag.base.errors import InputError, errors_of
from rockfrag.base.units import convert, quantity
from rockfrag.config.schema import read_schema

if TYPE_CHECKING:
    from rockfrag.assess.inventory import FaultyRows

_INVENTORY = ".csv"
_UNITS = re.compile("_(kg_m2|n_m|years|km|kg|deg|m|n|s)$")


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
    words = "statue.yaml that says all this, or inventory.csv with an object a row"
    parser.add_argument("file", nargs="?", help=words)
    add_request_options(parser)
    out = parser.add_argument_group("the answer")
    words = "where page and JSON are written"
    out.add_argument("--output", metavar="FOLDER", default="assessment", help=words)
    out.add_argument(
        "--pdf", action="store_true", help="print the page too, by Chromium or Chrome"
    )
    out.add_argument("--json", action="store_true", help="print the answer as JSON")
    out.add_argument(
        "--details", action="store_true", help="print what stands behind it too"
    )
    out.add_argument(
        "--language", default="en", help="of the answer and its page, such as it"
    )
    out.add_argument(
        "--pages", action="store_true", help="of an inventory: write a page for each"
    )
    words = "of an inventory: rank the rows that are right, and list what is wrong with the others"
    out.add_argument("--keep-going", action="store_true", help=words)
    words = "of a museum's table: order of lengths that it does not name, such as HWD"
    out.add_argument("--order", default="", help=words)
    words = "of a large inventory, .csv or .parquet: between simulated blocks, then the worst simulated"
    out.add_argument("--coarse", action="store_true", help=words)
    words = "of --coarse: how many of the worst are simulated"
    out.add_argument("--worst", metavar="N", type=int, default=1000, help=words)
    words = "of --coarse: how many others, drawn at random, are simulated, to say how true it is"
    out.add_argument("--at-random", metavar="N", type=int, default=0, help=words)
    parser.set_defaults(run=_assess)
    words = "hold engineers' rules against simulations of objects"
    rules = commands.add_parser("rules-of-thumb", help=words)
    rules.add_argument("file", help="objects, such as config/rules-of-thumb.yaml")
    add_records_option(rules)
    rules.add_argument(
        "--output", metavar="FILE", help="write the table as .csv or .parquet"
    )
    rules.set_defaults(run=_rules)


class _Option(NamedTuple):
    """An option that tells of an object, its place or its motions."""

    name: str
    key: str  # of ``statue.yaml``, whose unit may stand beside the number
    group: str
    arguments: Mapping[str, Any]  # how a parser shows and reads it


def _options(keys: Mapping[str, Any], above: str = "") -> Iterator[_Option]:
    """Yield the options of the keys of a schema, and of the keys in them."""
    for key, about in keys.items():
        if option := about.get("option"):
            plain = _UNITS.sub("", key)
            reads = option.get("reads", _reading(about)) | {"help": option["help"]}
            if word := option.get("metavar"):
                reads["metavar"] = tuple(word) if isinstance(word, list) else word
            whole = above + (plain if about.get("quantity") else key)
            yield _Option(
                option.get("name", plain.replace("_", "-")),
                whole,
                option["group"],
                reads,
            )
        known = read_schema("known_of_building") if key == "building" else about
        yield from _options(known.get("properties", {}), f"{key}.")


def _reading(about: Mapping[str, Any]) -> dict[str, Any]:
    """How a parser reads the value of a key."""
    kind = about.get("type")
    if kind == "boolean":
        return {"action": "store_true"}
    if kind == "array":
        return {
            "nargs": about["minItems"]
            if about["minItems"] == about.get("maxItems")
            else "+"
        }
    if "enum" in about:
        return {"choices": about["enum"]}
    return {"type": float} if kind == "number" and not about.get("quantity") else {}


def _all_options() -> list[_Option]:
    return list(_options(read_schema("statue")["properties"]))


def add_request_options(parser: argparse.ArgumentParser) -> None:
    """Add what an object, its place and its motions are stated by."""
    for title, options in groupby(_all_options(), key=attrgetter("group")):
        group = parser.add_argument_group(title)
        for option in options:
            group.add_argument(
                f"--{option.name}", **{"action": _Once, **option.arguments}
            )
    add_records_option(group)


def add_records_option(parser: Any, words: str = "folder of fetched records") -> None:
    """Add the option that names the folder of records."""
    parser.add_argument(
        "--records", metavar="FOLDER", default="resources/records", help=words
    )


_STILL = "still trying what may hold it, and writing the page"


# imported when it runs: `rockfrag --help` should not wait for numba
def _assess(options: argparse.Namespace) -> int:
    """Run ``assess`` on one object, an inventory, or a large table."""
    from rockfrag.assess.inventory import FaultyRows

    given = settings_of(options)
    _refuse_unused(options)
    try:
        if options.coarse:
            return _coarse(options, given)
        if _is_inventory(options):
            return _inventory(options, given)
        return _one(options, given)
    except FaultyRows as error:
        return print_faults(
            error,
            given,
            "nothing was assessed; --keep-going ranks the rows that are right.",
        )
    except InputError as error:
        # a message about a file names its keys, one about an option the option
        words = on_command_line(str(error), given if options.file else None)
        raise InputError(words) from error


def print_faults(error: "FaultyRows", given: Mapping[str, Any], outcome: str) -> int:
    """Say what is wrong with the rows of an inventory, and what that leaves undone.

    Parameters
    ----------
    error : names the rows
    given : keys of ``statue.yaml`` that options state
    outcome : sentence that ends it

    Returns
    -------
    Status of the command.
    """
    for fault in error.faults:
        print(on_command_line(fault, given), file=sys.stderr)
    print(outcome, file=sys.stderr)
    return 2


def _is_inventory(options: argparse.Namespace) -> bool:
    return bool(options.file) and Path(options.file).suffix.lower() == _INVENTORY


def _refuse_unused(options: argparse.Namespace) -> None:
    """Refuse options that would have no effect."""
    listed = _is_inventory(options) or bool(options.coarse and options.file)
    if options.coarse and not options.file:
        raise InputError("--coarse needs an inventory, a .csv or .parquet file.")
    for name in ("pages", "keep_going") if not listed else ("pdf", "json", "details"):
        if getattr(options, name):
            needed = (
                "one object, not an inventory"
                if listed
                else "an inventory, a .csv file"
            )
            raise InputError(
                f"--{name.replace('_', '-')} needs {needed}; leave it out."
            )


def _one(options: argparse.Namespace, given: dict[str, Any]) -> int:
    """Answer for one object: print it, and write what was asked for."""
    from rockfrag.assess.answer import assess, seconds_of_holders
    from rockfrag.assess.export import as_json
    from rockfrag.assess.findings import quality_flags
    from rockfrag.runtime.progress import SILENT, progress_line, sign_of_life
    from rockfrag.words.catalogue import catalogue

    texts = catalogue(options.language)
    request = _request(options, given)
    say = progress_line("of the simulations", in_percent=True)
    found = assess(
        request,
        options.records,
        announce=partial(print, file=sys.stderr),
        progress=lambda part: say(part, 1.0),
    )
    if not options.json:
        _print_lines(found, options)
    if options.kind:
        print(_usual_words(options.kind, given), file=sys.stderr)
    # what looks wrong stands behind the answer, and what a page alone shows is computed after both
    for quality_flag in texts.lines(quality_flags(found)):
        print(f"warning: {quality_flag}", file=sys.stderr)
    from rockfrag.assess.page import write_answer

    seconds = seconds_of_holders(request, found.plan)
    with sign_of_life(_STILL, expected=seconds if seconds > SILENT else None):
        place = write_answer(found, options.output, options.language)
    if options.pdf:
        from rockfrag.report.pdf import print_page

        place = print_page(place)
    if options.json:
        print(as_json(found), end="")
    else:
        print(f"{place}", file=sys.stderr)
    return 0


def _print_lines(found: Any, options: argparse.Namespace) -> None:
    """Print the first screen, and what stands behind it where that is asked for."""
    from rockfrag.assess.findings import details_of, lines_of

    lines = lines_of(found, options.language)
    if options.details:
        lines += ["", *details_of(found, options.language)]
    if sys.stdout.isatty():
        # broken where a terminal ends; what goes into a file or a pipe stays whole
        width = max(shutil.get_terminal_size().columns, 40)
        lines = [textwrap.fill(line, width, subsequent_indent="    ") for line in lines]
    print("\n".join(lines), flush=True)


def _usual_words(kind: str, given: Mapping[str, Any]) -> str:
    """Say what a usual thing of a kind is, and that measures make the answer one about the thing at hand."""
    from rockfrag.system.kinds import kind_named

    usual = kind_named(kind)
    sizes = {"width": usual.width_m, "height": usual.height_m}
    taken = [
        f"{name} {100 * size:g} cm" for name, size in sizes.items() if name not in given
    ]
    if "mass" not in given:
        taken.append(f"{usual.density:g} kg/m³")
    if "cg_height" not in given:
        taken.append(
            f"a centre of gravity at {100 * usual.cg_fraction:g} % of its height"
        )
    words = f"a usual {usual.title} is taken: {', '.join(taken)}"
    return f"{words}; give what you measured." if taken else f"a {usual.title}."


def _request(options: argparse.Namespace, given: dict[str, Any]) -> Any:
    """What the command line asks, with the file of the object if there is one."""
    from rockfrag.assess.request import make_request
    from rockfrag.base.yaml_file import read_yaml

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
    """What the command line says, with the keys of ``statue.yaml``; options without effect are refused."""
    found: dict[str, Any] = {}
    for name, key, *_ in _all_options():
        value = getattr(options, name.replace("-", "_"))
        if value is None or value is False:
            continue
        whole, _, part = key.partition(".")
        if not part:
            found[key] = _pedestals(value) if key == "pedestal" else value
            continue
        if whole in _WHOLE and whole not in found and name != _WHOLE[whole]:
            raise InputError(f"--{name} needs --{_WHOLE[whole]}; leave it out.")
        if options.building and whole == "building":
            raise InputError(
                "--building: the file says all of the building; leave out --storey-height, --period "
                "and --material."
            )
        if name == "storey-height":
            # one height is that of every storey
            is_list = len(value) > 1
            part, value = ("storey_heights", value) if is_list else (part, value[0])
        if name in _MADE:
            value = _MADE[name](value)
        found.setdefault(whole, {})[part] = value
    return found


_WHOLE = {"mesh": "mesh", "records": "record"}
"""The option that each of these keys needs before its other options say anything."""


def _seconds(period: str) -> float:
    with errors_of("--period"):
        return quantity(period, "s", None)


_MADE: dict[str, Callable[[Any], Any]] = {
    "mesh-unit": lambda unit: convert(1.0, unit, "m"),
    "on-floor": lambda _: "floor",
    "period": _seconds,
}
"""What turns the value of an option into that of a file, where they differ."""


def _pedestals(given: Sequence[Sequence[str]]) -> Any:
    """The pedestal as a file would have it, or several from above."""
    for numbers in given:
        if len(numbers) not in (2, 3):
            raise InputError(
                "--pedestal: expected width, height and, if known, mass, such as 50cm 90cm 400kg; got "
                f"{' '.join(numbers)}."
            )
    found = [
        dict(zip(("width", "height", "mass"), numbers, strict=False))
        for numbers in given
    ]
    return found if len(found) > 1 else found[0]


def _inventory(options: argparse.Namespace, shared: dict[str, Any]) -> int:
    """Answer for all objects of an inventory."""
    from rockfrag.assess.gallery import write_inventory
    from rockfrag.assess.inventory import assess_inventory, inventory_lines, joint_lines
    from rockfrag.runtime.progress import progress_line

    unfit = [key for key in ("name", "width", "height", "mesh") if key in shared]
    if unfit:
        raise InputError(f"--{unfit[0]}: is of one object; put it into {options.file}.")
    found = assess_inventory(
        options.file,
        shared,
        options.records,
        keep_going=options.keep_going,
        order=options.order,
        progress=progress_line("objects"),
    )
    for fault in found.faults:
        print(f"warning: left out: {fault}", file=sys.stderr)
    language = options.language
    print("\n".join([*inventory_lines(found, language), *joint_lines(found, language)]))
    place = write_inventory(
        found, options.output, pages=options.pages, language=language
    )
    print(f"{place}", file=sys.stderr)
    return 0


def _coarse(options: argparse.Namespace, shared: dict[str, Any]) -> int:
    """Answer for a large table, most objects by a surface through simulated ones."""
    from rockfrag.assess.coarse import Simulated, coarse_inventory, coarse_lines
    from rockfrag.base.files import write_table
    from rockfrag.runtime.progress import progress_line

    unfit = [key for key in ("name", "width", "height", "mesh") if key in shared]
    if unfit:
        raise InputError(f"--{unfit[0]}: is of one object; put it into {options.file}.")
    for name in ("worst", "at_random"):
        if getattr(options, name) < 0:
            option = f"--{name.replace('_', '-')}"
            raise InputError(
                f"{option}: expected 0 or more, got {getattr(options, name)}."
            )
    found = coarse_inventory(
        options.file,
        shared,
        options.records,
        simulated=Simulated(options.worst, options.at_random),
        order=options.order,
        progress=progress_line("blocks and objects"),
    )
    place = Path(options.output) / "coarse.parquet"
    write_table(found.table, place)
    print("\n".join(coarse_lines(found)))
    print(f"{place}", file=sys.stderr)
    return 0


def _rules(options: argparse.Namespace) -> int:
    """Print how rules of thumb do on the objects of an inventory."""
    from rockfrag.assess.rules import rules_study
    from rockfrag.base.files import write_table
    from rockfrag.runtime.progress import progress_line

    table = rules_study(options.file, options.records, progress_line("objects"))
    print(table.to_string(index=False, float_format=lambda value: f"{value:.2f}"))
    if options.output:
        write_table(table, options.output)
    return 0


_KEY = re.compile(
    r"(?<!\w)key ([a-z_][a-z0-9_.]*[a-z0-9_])(\[\d+\](?:\.[a-z_]+)?)?(: true\b|: (?=[xyz]\b))?"
)


def on_command_line(words: str, given: Collection[str] | None = None) -> str:
    """A message about ``statue.yaml``, with the option ``--pga`` wherever it has the key, as in ``key pga``.

    Parameters
    ----------
    words : of the message
    given : keys that the command line gave, which alone become options; None for all keys
    """
    names = {_UNITS.sub("", key): name for name, key, *_ in _all_options()}
    names |= {"records": "record", "building.storey_heights": "storey-height"}
    replaced = None if given is None else {_UNITS.sub("", key) for key in given}

    def option(found: re.Match[str]) -> str:
        """The option that stands for a key in a message."""
        key = _UNITS.sub("", found[1])
        whole = key.split(".")[0]
        if replaced is not None and whole not in replaced:
            return found[0]
        name = names.get(key, whole.replace("_", "-"))
        # a flag takes no value, and an axis stands beside its option
        return f"--{name}" + (" " if found[3] == ": " else "")

    return _KEY.sub(
        option, words.replace(_METRES_PER_UNIT, "key mesh.metres_per_unit mm")
    )


_METRES_PER_UNIT = "key mesh.metres_per_unit (0.001 for millimetres, 0.3048 for feet)"

_OBJECT = {"width": "35 cm", "height": "1.2 m"}
_SHAKING = {"pga": "0.4 g", "return_period": "475"}  # In the form where none is given

_FORM = (
    *("name", "width", "height", "mass", "cg_height", "cg_offset"),
    *("restitution", "floor", "depth", "stands"),
)
_LEVELS = ("pga", "pgv", "sa")
_KEYS = (
    *(*_FORM, *_LEVELS, "round", "facing_deg", "pedestal", "building"),
    *("return_period", "hazard", "records"),
)
"""Keys of ``statue.yaml`` that the page has a field for, or is written with."""


def add_app_command(commands: Any) -> None:
    """Add ``app`` to the parsers of a command line."""
    parser = commands.add_parser(
        "app",
        help="write the assessment as one page that needs no installation",
        description="One HTML file that computes what 'rockfrag assess' says of an object. "
        "What is given stands in its form at first; records are those that it computes with.",
    )
    parser.add_argument("file", nargs="?", help="statue.yaml that says all this")
    add_request_options(parser)
    parser.add_argument(
        "--output", metavar="FILE", default="assess.html", help="the page"
    )
    parser.set_defaults(run=_app)


# imported when it runs: `rockfrag --help` should not wait for numba
def _app(options: argparse.Namespace) -> int:
    """Run ``app``: write the page that computes by itself."""
    from rockfrag.assess.app.writing import write_app
    from rockfrag.assess.motions import motion_set
    from rockfrag.assess.place import Place
    from rockfrag.assess.request import make_request
    from rockfrag.base.yaml_file import read_yaml

    given = settings_of(options)
    if options.file:
        given = read_yaml(options.file) | given
    beyond = [key for key, value in given.items() if value and key not in _KEYS]
    if beyond:
        raise InputError(
            f"key {beyond[0]}: the page does not compute with it; rockfrag assess does."
        )
    shaken = given.keys() & {*_LEVELS, "hazard"}
    settings = _OBJECT | ({} if shaken else _SHAKING) | given
    folder = Path(options.file).parent if options.file else Path()
    request = make_request(settings, options.file or "rockfrag app", folder)
    motions = motion_set(request.records, Place(), Path(options.records))
    write_app(motions, form_of(settings, request), options.output, request=request)
    print(options.output)
    return 0


def form_of(settings: Mapping[str, Any], request: Any) -> dict[str, str]:
    """What stands in the form at first."""
    form = {key: str(settings[key]) for key in _FORM if key in settings}
    form |= {"facing": str(settings["facing_deg"])} if "facing_deg" in settings else {}
    form |= {"round": "true"} if settings.get("round") else {}
    pedestal, building = settings.get("pedestal") or {}, settings.get("building") or {}
    if isinstance(pedestal, list):
        raise InputError(
            "key pedestal: the page has one; rockfrag assess takes several."
        )
    form |= {f"pedestal_{key}": str(value) for key, value in pedestal.items()}
    if isinstance(building, Mapping):
        asked = {"storey_height": "storey_height", "material": "material"}
        asked |= {"first_period": "period"}
        form |= {asked[key]: str(building[key]) for key in asked if key in building}
        if "first_period_s" in building:
            form["period"] = f"{building['first_period_s']} s"
    return (
        form
        | _shaking(settings, request)
        | {"years": str(settings.get("return_period", ""))}
    )


def _shaking(settings: Mapping[str, Any], request: Any) -> dict[str, str]:
    """The level and the hazard curve as they stand in the form."""
    given = [key for key in _LEVELS if key in settings]
    if len(given) > 1:
        raise InputError(
            f"key {given[1]}: the page takes one level; rockfrag assess takes both."
        )
    level = settings[given[0]] if given else ""
    form = {
        "measure": request.level.measure.imt if request.level else "PGA",
        "level": str(level[1] if given == ["sa"] else level),
    }
    if "hazard" not in settings:
        return form
    (curve, *others) = request.hazard
    if others:
        raise InputError(
            "key hazard: the page takes one measure; leave the others out."
        )
    rows = zip(curve.levels.tolist(), curve.rates.tolist(), strict=True)
    lines = "\n".join(f"{x!r} {rate!r}" for x, rate in rows)
    return form | {"measure": curve.measure.imt, "hazard": lines}
