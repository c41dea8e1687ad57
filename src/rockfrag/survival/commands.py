"""The command ``rockfrag constrain``."""

import argparse
import sys
from typing import Any


def add_survival_commands(commands: Any) -> None:
    """Add ``constrain`` to the parsers of a command line."""
    parser = commands.add_parser(
        "constrain",
        help="reweight hazard branches by objects that still stand",
        description="A site with the branches of its hazard, and objects that have stood there for "
        "known times.",
    )
    parser.add_argument("file", help="the site, such as site.yaml")
    parser.add_argument(
        "--output",
        metavar="FOLDER",
        default="constrained",
        help="where page, JSON and tables are written",
    )
    parser.add_argument(
        "--records",
        metavar="FOLDER",
        default="resources/records",
        help="folder of fetched records, for objects that are simulated",
    )
    parser.add_argument("--json", action="store_true", help="print the answer as JSON")
    parser.set_defaults(run=_constrain)


# imported when it runs: `rockfrag --help` should not wait for pandas
def _constrain(options: argparse.Namespace) -> int:
    from rockfrag.survival.page import json_of, lines_of, write_constrained
    from rockfrag.survival.reweight import constrain
    from rockfrag.survival.site import read_site

    found = constrain(read_site(options.file, options.records))
    place = write_constrained(found, options.output)
    if options.json:
        print(json_of(found), end="")
    else:
        print("\n".join(lines_of(found)))
    print(place, file=sys.stderr)
    return 0
