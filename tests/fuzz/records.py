"""Damaged records: every format, archives and catalogues, cut, flipped, doubled and mixed."""

import gzip
import random
import zipfile
from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path

import numpy as np
from obspy import Stream, Trace, UTCDateTime

from rockfrag.base.errors import InputError
from rockfrag.motions.catalogued import read_motions
from rockfrag.records.make_catalogue import make_catalogue
from rockfrag.records.read import motion_of, read_record

from ..records.built_records import KINDS, build, pack, pack_tar
from ..records.record_texts import knet_text, search_results
from .damage import Attempt, Seed, damaged
from .inputs import CASES


def records(folder: Path) -> Callable[[random.Random], Attempt]:
    """Return what makes a damaged record and how it is read."""
    seeds = _seeds(folder)
    return damaged(
        folder,
        [(name, content, partial(_naming, read)) for name, content, read in seeds],
    )


def _naming(read: Callable[[Path], object], path: Path) -> None:
    """Read a file, and see that a refusal names it."""
    try:
        read(path)
    except InputError as error:
        assert path.name in str(error), f"{path.name} is not in {str(error)[:200]!r}"
        raise


def _read_all(path: Path, dt: float | None = None) -> None:
    for cut_short in (False, True):
        record = read_record(path, dt, cut_short)
        for channel in record.channels:
            motion = motion_of(record, channel, None if channel.unit else "g")
            assert np.isfinite(motion.acceleration).all()


def _catalogue_of(path: Path) -> None:
    make_catalogue([path])


def _load_all(path: Path) -> None:
    read_motions(path)


def _seeds(folder: Path) -> Iterable[Seed]:
    """Yield name, content and reader of every kind of input."""
    inside = folder / "built"
    inside.mkdir()
    for kind in KINDS:
        built = build(kind, inside)
        reader = partial(_read_all, dt=built.dt_to_give)
        yield f"{kind}-{built.path.name}", built.path.read_bytes(), reader
    for name, content in _binary(inside):
        yield name, content, _read_all
    for name, content in _archives(inside):
        yield name, content, _read_all
        yield f"c-{name}", content, _catalogue_of
    build("plain_csv", folder)
    for name, text in CASES["catalogues"].items():
        yield name, text.encode(), _load_all
    yield (
        "_SearchResults.csv",
        search_results(4).encode(),
        _catalogue_of,
    )


def _binary(folder: Path) -> Iterable[tuple[str, bytes]]:
    """Yield records of the formats that ObsPy reads."""
    samples = np.round(1e4 * np.sin(np.arange(400) * 0.1)).astype(np.int32)
    start = UTCDateTime(2019, 7, 6)
    header = {"station": "ABC", "channel": "HNE", "delta": 0.01, "starttime": start}
    kinds = {"a.mseed": "MSEED", "a.sac": "SAC", "a.gse": "GSE2", "a.slist": "SLIST"}
    for name, kind in kinds.items():
        data = samples.astype(np.float32) if kind == "SAC" else samples
        Stream([Trace(data.copy(), dict(header))]).write(
            str(folder / name), format=kind
        )
        yield name, (folder / name).read_bytes()
    yield "AOM001.EW", knet_text().encode()


def _archives(folder: Path) -> Iterable[tuple[str, bytes]]:
    some = {name: (folder / name).read_bytes() for name in ("csmip.V2", "peer.AT2")}
    stored = pack(folder / "stored.zip", some)
    packed = pack(folder / "packed.zip", some, zipfile.ZIP_DEFLATED)
    nested = pack(folder / "nested.zip", {"inner.zip": packed.read_bytes()})
    tars = [pack_tar(folder / name, some) for name in ("some.tar", "some.tar.gz")]
    yield from (
        (path.name, path.read_bytes()) for path in (stored, packed, nested, *tars)
    )
    yield "peer.AT2.gz", gzip.compress(some["peer.AT2"])
