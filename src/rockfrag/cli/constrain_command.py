"""The command ``rockfrag constrain``: hazard by what still stands, and shaking by what fell and what stands."""

import argparse
import math
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rockfrag.base.errors import InputError, errors_of
from rockfrag.cli.assess_commands import add_records_option

if TYPE_CHECKING:
    from rockfrag.survival.shaking_posterior import Prior


def add_constrain_command(commands: Any) -> None:
    """Add ``constrain`` to the parsers of a command line."""
    parser = commands.add_parser(
        "constrain",
        help="hazard by objects that still stand, or shaking by what fell and what stands",
        description="site.yaml: branches of a hazard, and objects that have stood for known times. fallen.csv: "
        "objects or groups after an earthquake, with how many fell.",
    )
    words = "the site, such as site.yaml, or what fell and stands, such as fallen.csv"
    parser.add_argument("file", help=words)
    words = "where page, JSON and tables are written"
    parser.add_argument("--output", metavar="FOLDER", default="constrained", help=words)
    add_records_option(
        parser, "folder of fetched records, for objects that are simulated"
    )
    parser.add_argument("--json", action="store_true", help="print the answer as JSON")
    words = "of page and lines, such as it"
    parser.add_argument("--language", default="en", help=words)
    fell = parser.add_argument_group("of fallen.csv")
    words = "grid.xml of a ShakeMap, what was known of the shaking before"
    fell.add_argument("--shakemap", metavar="GRID", help=words)
    words = "uncertainty.xml of the same map"
    fell.add_argument("--map-uncertainty", metavar="GRID", help=words)
    words = "place of the objects on the map [degrees]"
    fell.add_argument(
        "--at", metavar=("LATITUDE", "LONGITUDE"), nargs=2, type=float, help=words
    )
    words = "median of what was known of PGV before, with its unit, and the standard deviation of its logarithm"
    fell.add_argument("--prior-pgv", metavar=("LEVEL", "SD"), nargs=2, help=words)
    words = "the same of PGA"
    fell.add_argument("--prior-pga", metavar=("LEVEL", "SD"), nargs=2, help=words)
    words = "relative standard deviation of the slenderness that all objects share, such as 0.2"
    fell.add_argument("--slenderness-sd", metavar="S", type=float, help=words)
    words = (
        "standard deviation of ln level that all share, in place of that of the model"
    )
    fell.add_argument("--shared-sd", metavar="S", type=float, help=words)
    words = "standard deviation of ln level from one of like objects to the next"
    fell.add_argument("--own-sd", metavar="S", type=float, help=words)
    parser.set_defaults(run=_constrain)


OF_FALLEN = (
    *("shakemap", "map_uncertainty", "at", "prior_pgv", "prior_pga"),
    *("slenderness_sd", "shared_sd", "own_sd"),
)
"""Options that say something of ``fallen.csv`` only."""


# imported when it runs: `rockfrag --help` should not wait for numba
def _constrain(options: argparse.Namespace) -> int:
    """Run ``constrain``: weigh hazard branches by what stands, or shaking by what fell."""
    from rockfrag.words.catalogue import catalogue

    # an unknown language is refused before anything is written
    catalogue(options.language)
    if Path(options.file).suffix.lower() == ".csv":
        return _shaking(options)
    for name in OF_FALLEN:
        if getattr(options, name) is not None:
            raise InputError(
                f"--{name.replace('_', '-')} needs a table of what fell, a .csv file; leave it out."
            )
    from rockfrag.survival.constrained_page import json_of, lines_of, write_constrained
    from rockfrag.survival.reweight import constrain
    from rockfrag.survival.site import read_site

    found = constrain(read_site(options.file, options.records))
    place = write_constrained(found, options.output, options.language)
    lines = lines_of(found, options.language)
    print(json_of(found) if options.json else "\n".join(lines))
    print(place, file=sys.stderr)
    return 0


def _shaking(options: argparse.Namespace) -> int:
    """Say what shaking a table of fallen and standing objects tells."""
    from rockfrag.runtime.progress import progress_line
    from rockfrag.survival.fallen import (
        FROM_ONE_TO_THE_NEXT,
        Knowledge,
        constrain_shaking,
        read_fallen,
    )
    from rockfrag.survival.fallen_page import fallen_json, fallen_lines, write_fallen

    for name in ("slenderness_sd", "shared_sd", "own_sd"):
        _spread(name, getattr(options, name))
    knowledge = Knowledge(
        prior=_prior(options),
        own_spread=FROM_ONE_TO_THE_NEXT if options.own_sd is None else options.own_sd,
        slenderness_spread=options.slenderness_sd or 0.0,
        shared_spread=options.shared_sd,
    )
    found = constrain_shaking(
        read_fallen(options.file),
        knowledge,
        options.records,
        progress_line("groups"),
    )
    place = write_fallen(found, options.output, options.language)
    lines = fallen_lines(found, options.language)
    print(fallen_json(found) if options.json else "\n".join(lines))
    print(place, file=sys.stderr)
    return 0


def _spread(name: str, value: float | None) -> None:
    """Refuse a standard deviation of ln that is none."""
    if value is not None and not 0 <= value <= 2:
        raise InputError(
            f"--{name.replace('_', '-')}: expected a number from 0 to 2, got {value}."
        )


def _prior(options: argparse.Namespace) -> "Prior":
    """What was known of the shaking before: by a map, as typed, or nothing."""
    from rockfrag.aftermath.shaken_ground import CORRELATION
    from rockfrag.survival.shaking_posterior import Prior

    typed = [name for name in ("prior_pgv", "prior_pga") if getattr(options, name)]
    if options.shakemap is None:
        if options.at or options.map_uncertainty:
            raise InputError("--at and --map-uncertainty need --shakemap.")
        pgv, pgv_spread = _typed(options.prior_pgv, "PGV")
        pga, pga_spread = _typed(options.prior_pga, "PGA")
        both = CORRELATION if len(typed) == 2 else 0.0
        return Prior(pgv, pgv_spread, pga, pga_spread, both)
    if typed:
        raise InputError(
            f"--{typed[0].replace('_', '-')} and --shakemap both say what was known before; give one."
        )
    return _mapped(options)


def _mapped(options: argparse.Namespace) -> "Prior":
    """What a ShakeMap says of the shaking before any object is looked at."""
    from rockfrag.aftermath.shakemap import read_shakemap
    from rockfrag.aftermath.shaken_ground import CORRELATION, mapped_ground
    from rockfrag.survival.shaking_posterior import Prior

    if options.at is None:
        raise InputError("--shakemap needs --at LATITUDE LONGITUDE of the objects.")
    shakemap = read_shakemap(options.shakemap, options.map_uncertainty)
    ground = mapped_ground(shakemap, *options.at)
    if ground is None:
        raise InputError(f"--at: the place lies beyond the map of {options.shakemap}.")
    both = CORRELATION if math.isfinite(ground.pga + ground.pgv) else 0.0
    return Prior(
        pgv=ground.pgv,
        pgv_spread=ground.pgv_spread,
        pga=ground.pga,
        pga_spread=ground.pga_spread,
        correlation=both,
    )


def _typed(given: list[str] | None, measure: str) -> tuple[float, float]:
    """Level and standard deviation that were typed for a measure; NaN and NaN where nothing was.

    ``given``: two words, a level with its unit and the standard deviation of ln. Returned is the level, a median
    [cm/s for PGV, g for PGA], and that standard deviation [-].
    """
    from rockfrag.assess.hazard.curve import read_level, read_measure

    if given is None:
        return math.nan, math.nan
    option = f"--prior-{measure.lower()}"
    with errors_of(option):
        level = read_level(given[0], read_measure(measure, option))
    try:
        spread = float(given[1])
    except ValueError:
        spread = math.nan
    if not (level > 0 and 0.01 <= spread <= 3):
        raise InputError(
            f"{option}: expected a level above 0 and a standard deviation from 0.01 to 3 such as 40cm/s 0.6, got "
            f"{' '.join(given)}."
        )
    return level, spread
