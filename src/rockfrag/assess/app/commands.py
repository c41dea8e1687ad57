"""The command ``rockfrag app``."""

import argparse
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rockfrag.assess import commands as assess
from rockfrag.errors import InputError

if TYPE_CHECKING:
    from rockfrag.assess.request import Request

_OBJECT = {"width": "35 cm", "height": "1.2 m"}
_SHAKING = {"pga": "0.4 g", "return_period": "475"}
"""What stands in the form where no object, and no shaking, is given."""

_FORM = (
    *("name", "width", "height", "mass", "cg_height", "cg_offset"),
    *("restitution", "floor", "depth"),
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
    assess.add_request_options(parser)
    parser.add_argument("--output", metavar="FILE", default="assess.html", help="the page")
    parser.set_defaults(run=_app)


# imported when it runs: `rockfrag --help` should not wait for numba
def _app(options: argparse.Namespace) -> int:
    from rockfrag.assess.app.writing import write_app
    from rockfrag.assess.motions import motion_set
    from rockfrag.assess.place import Place
    from rockfrag.assess.request import make_request
    from rockfrag.yaml_file import read_yaml

    given = assess.settings_of(options)
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


def form_of(settings: Mapping[str, Any], request: "Request") -> dict[str, str]:
    """What stands in the form at first."""
    form = {key: str(settings[key]) for key in _FORM if key in settings}
    form |= {"facing": str(settings["facing_deg"])} if "facing_deg" in settings else {}
    form |= {"round": "true"} if settings.get("round") else {}
    pedestal, building = settings.get("pedestal") or {}, settings.get("building") or {}
    if isinstance(pedestal, list):
        raise InputError("key pedestal: the page has one; rockfrag assess takes several.")
    form |= {f"pedestal_{key}": str(value) for key, value in pedestal.items()}
    if isinstance(building, Mapping):
        told = ("storey_height", "material")
        form |= {key: str(building[key]) for key in told if key in building}
        if "first_period_s" in building:
            form["period"] = f"{building['first_period_s']} s"
    return form | _shaking(settings, request) | {"years": str(settings.get("return_period", ""))}


def _shaking(settings: Mapping[str, Any], request: "Request") -> dict[str, str]:
    """The level and the hazard curve as they stand in the form."""
    given = [key for key in _LEVELS if key in settings]
    if len(given) > 1:
        raise InputError(f"key {given[1]}: the page takes one level; rockfrag assess takes both.")
    level = settings[given[0]] if given else ""
    form = {
        "measure": request.level.measure.imt if request.level else "PGA",
        "level": str(level[1] if given == ["sa"] else level),
    }
    if "hazard" not in settings:
        return form
    (curve, *others) = request.hazard
    if others:
        raise InputError("key hazard: the page takes one measure; leave the others out.")
    rows = zip(curve.levels.tolist(), curve.rates.tolist(), strict=True)
    lines = "\n".join(f"{x!r} {rate!r}" for x, rate in rows)
    return form | {"measure": curve.measure.imt, "hazard": lines}
