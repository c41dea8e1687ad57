"""The command about collections: a museum's export made an inventory."""

import argparse
import sys
from typing import Any


def add_collection_command(commands: Any) -> None:
    """Add ``collection`` to the parsers of a command line."""
    words = "make an inventory of a museum's export, with its dimensions in words"
    command = commands.add_parser("collection", help=words)
    command.add_argument(
        "file", metavar="EXPORT.csv", help="table with a title and dimensions a row"
    )
    words = "order of lengths that the table does not name, such as HWD"
    command.add_argument("--order", default="", help=words)
    words = "inventory to write, which assess reads"
    command.add_argument("--output", metavar="FILE", required=True, help=words)
    words = (
        "table to write of what was understood of each row, and what has to be asked"
    )
    command.add_argument("--understood", metavar="FILE", help=words)
    command.set_defaults(run=_collection)


def _collection(options: argparse.Namespace) -> int:
    """Run ``collection``: write an inventory, and say what has to be asked."""
    import pandas as pd

    from rockfrag.base.files import csv_text, write_text
    from rockfrag.collections.exported_table import inventory_table, read_export

    objects = read_export(options.file, options.order)
    table = inventory_table(objects)
    write_text(csv_text(table), options.output)
    asked = [collected for collected in objects if collected.question]
    if options.understood:
        understood = pd.DataFrame(
            {
                "name": [collected.name for collected in objects],
                "line": [collected.line for collected in objects],
                "dimensions": [collected.text for collected in objects],
                "material": [collected.material for collected in objects],
                "understood": [collected.understood for collected in objects],
                "others": [
                    "; ".join(collected.dimensions.others) for collected in objects
                ],
                "question": [collected.question for collected in objects],
            }
        )
        write_text(csv_text(understood), options.understood)
    print(f"{len(table)} of {len(objects)} objects in {options.output}")
    shown = asked[:MOST_QUESTIONS]
    for collected in shown:
        place = f"{options.file}, line {collected.line}, {collected.name}"
        print(f"{place}: {collected.question}.", file=sys.stderr)
    if len(asked) > len(shown):
        more = f"{len(asked) - len(shown)} more rows have to be asked about"
        print(f"{more}; --understood FILE lists them.", file=sys.stderr)
    return int(bool(asked))


MOST_QUESTIONS = 20  # questions on the screen; all stand in the file of --understood
