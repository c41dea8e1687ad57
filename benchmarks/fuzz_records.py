"""Read damaged records: every format, archives and catalogues, cut, flipped, doubled and mixed.

    python benchmarks/fuzz_records.py --mutations 10000 --seed 1

Each damaged input must be read or refused with an :class:`InputError` of at most 500 characters, within
two seconds of processor time (those of the clock depend on what else the machine does). Prints the
number of inputs and what went wrong; exit status 1 if anything did.
"""

import argparse
import gzip
import importlib.util
import io
import random
import sys
import tempfile
import time
import traceback
import warnings
import zipfile
from collections import Counter
from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np
from obspy import Stream, Trace, UTCDateTime

from rockfrag.errors import LONGEST_MESSAGE, InputError
from rockfrag.records.catalogue import load_motions
from rockfrag.records.make_catalogue import make_catalogue
from rockfrag.records.read import motion_of, read_record

MOST_SECONDS = 2.0
BUILDERS = Path(__file__).resolve().parents[1] / "tests/records/built_records.py"
WORDS = (
    b"NPTS=", b"1e308", b"1e-308", b"-1", b"0", b"999999999999", b"nan", b"inf", b"\n", b"\n\n", b";",
    b",", b"\t", b"\x00", b"\xff", b"\xef\xbb\xbf", b"{", b"}", b"/&", b"*****", b"1.2.3", b"E+99",
    b"DT= 1e-30", b"units=", b"#", b"|", b"-32768", b"\r", b"a" * 9000, b"9" * 400,
)  # fmt: skip


def main() -> int:
    """Run the harness; return 0 if nothing went wrong."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--mutations", type=int, default=10_000, help="how many damaged inputs")
    parser.add_argument("--seed", type=int, default=1, help="seed of the damage")
    options = parser.parse_args()
    rng = random.Random(options.seed)
    wrong: Counter[str] = Counter()
    fates: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        seeds = list(_seeds(folder))
        slowest = 0.0
        for number in range(options.mutations):
            name, content, read = seeds[number % len(seeds)]
            other = rng.choice(seeds)[1]
            damaged = damage(content, other, rng)
            fate, seconds = _outcome(folder, name, damaged, read)
            slowest = max(slowest, seconds)
            fates[fate.split(":")[0]] += 1
            if fate not in ("read", "refused"):
                wrong[f"{name}: {fate}"] += 1
                if wrong.total() <= 20:
                    kept = Path(tempfile.gettempdir()) / f"fuzz-{options.seed}-{number}-{name}"
                    kept.write_bytes(damaged)
                    print(f"{kept}: {fate}", file=sys.stderr)
    print(
        f"{options.mutations} damaged inputs of {len(seeds)} kinds (seed {options.seed}): "
        f"{fates['read']} read, {fates['refused']} refused, {wrong.total()} wrong; "
        f"slowest {slowest:.2f} s"
    )
    for what, count in wrong.most_common():
        print(f"{count:6d}  {what}")
    return 1 if wrong else 0


def damage(content: bytes, other: bytes, rng: random.Random) -> bytes:
    """Return a damaged copy: one to four cuts, flips, insertions, repetitions or exchanges."""
    data = bytearray(content)
    for _ in range(rng.randint(1, 4)):
        size = len(data)
        at = rng.randrange(size + 1)
        # headers decide how a file is read, so that half of the damage is done there
        if rng.random() < 0.5:
            at = min(at, rng.randrange(2000))
        kind = rng.randrange(8)
        if kind == 0:
            del data[at:]
        elif kind == 1 and size:
            data[min(at, size - 1)] = rng.randrange(256)
        elif kind == 2:
            data[at:at] = rng.choice(WORDS)
        elif kind == 3:
            del data[at : at + rng.randint(1, 200)]
        elif kind == 4:
            data[at:at] = data[at : at + rng.randint(1, 500)] * rng.randint(1, 3)
        elif kind == 5:
            _exchange_number(data, at, rng)
        elif kind == 6 and other:
            start = rng.randrange(len(other))
            data[at : at + rng.randint(0, 300)] = other[start : start + rng.randint(1, 300)]
        else:
            lines = bytes(data).split(b"\n")
            rng.shuffle(lines) if len(lines) < 3 else lines.insert(
                rng.randrange(len(lines)), lines[rng.randrange(len(lines))]
            )
            data = bytearray(b"\n".join(lines))
    return bytes(data)


def _exchange_number(data: bytearray, at: int, rng: random.Random) -> None:
    """Put another number where the next one stands."""
    start = at
    while start < len(data) and not chr(data[start]).isdigit():
        start += 1
    stop = start
    while stop < len(data) and chr(data[stop]) in "0123456789.":
        stop += 1
    choices = [b"0", b"-5", b"1e308", b"99999999999", b"3.7", b"1e-30", b"007", b"4294967296"]
    data[start:stop] = rng.choice(choices)


def _outcome(
    folder: Path, name: str, content: bytes, read: Callable[[Path], None]
) -> tuple[str, float]:
    path = folder / name
    path.write_bytes(content)
    start = time.process_time()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            read(path)
        fate = "read"
    except InputError as error:
        fate = "refused" if len(str(error)) <= LONGEST_MESSAGE else "message too long"
        if "\n" in str(error):
            fate = "message of several lines"
    except Exception as error:
        place = traceback.extract_tb(error.__traceback__)[-1]
        fate = f"uncaught: {type(error).__name__} in {Path(place.filename).name}:{place.lineno}"
    seconds = time.process_time() - start
    if seconds > MOST_SECONDS:
        fate = f"slow: {seconds:.1f} s"
    return fate, seconds


def _read_all(path: Path) -> None:
    for cut_short in (False, True):
        record = read_record(path, None, cut_short)
        for channel in record.channels:
            motion = motion_of(record, channel, None if channel.unit else "g")
            assert np.isfinite(motion.acceleration).all()


def _read_with_dt(path: Path) -> None:
    record = read_record(path, 0.02)
    for channel in record.channels:
        motion_of(record, channel, None if channel.unit else "g")


def _catalogue_of(path: Path) -> None:
    make_catalogue([path])


def _seeds(folder: Path) -> Iterable[tuple[str, bytes, Callable[[Path], None]]]:
    """Yield name, content and reader of every kind of input."""
    spec = importlib.util.spec_from_file_location("built_records", BUILDERS)
    assert spec is not None and spec.loader is not None
    built_records = importlib.util.module_from_spec(spec)
    sys.modules["built_records"] = built_records
    spec.loader.exec_module(built_records)
    inside = folder / "built"
    inside.mkdir()
    texts = {}
    for kind, build in built_records.BUILDERS.items():
        built = build(inside)
        texts[f"{kind}-{built.path.name}"] = built.path.read_bytes()
        reader = _read_all if built.stated_dt else _read_with_dt
        yield f"{kind}-{built.path.name}", built.path.read_bytes(), reader
    for name, content in _binary(inside):
        yield name, content, _read_all
    for name, content in _archives(texts):
        yield name, content, _read_all
        yield f"c-{name}", content, _catalogue_of
    (folder / "a.txt").write_bytes(texts["plain_csv-plain.csv"])
    row = "A,E,1976-05-06,S,090,6.5,20.1,folder,a.txt,,,\n"
    catalogue = (
        "name,event,date,station,component,magnitude,distance_km,source,file,sha256,unit,dt\n" + row
    )
    yield "motions.csv", catalogue.encode(), lambda path: load_motions(path) and None
    yield (
        "motions2.csv",
        catalogue.replace(",", ";").encode(),
        lambda path: load_motions(path) and None,
    )
    yield "_SearchResults.csv", built_records.search_results(4).encode(), _catalogue_of


def _binary(folder: Path) -> Iterable[tuple[str, bytes]]:
    """Yield records of the formats that ObsPy reads."""
    samples = np.round(1e4 * np.sin(np.arange(400) * 0.1)).astype(np.int32)
    header = {
        "station": "ABC",
        "channel": "HNE",
        "delta": 0.01,
        "starttime": UTCDateTime(2019, 7, 6),
    }
    for name, kind in (
        ("a.mseed", "MSEED"),
        ("a.sac", "SAC"),
        ("a.gse", "GSE2"),
        ("a.slist", "SLIST"),
    ):
        data = samples.astype(np.float32) if kind == "SAC" else samples
        buffer = io.BytesIO()
        trace = Trace(data.copy(), dict(header))
        try:
            Stream([trace]).write(buffer, format=kind)
        except TypeError:
            Stream([trace]).write(str(folder / name), format=kind)
            buffer.write((folder / name).read_bytes())
        yield name, buffer.getvalue()
    lines = [
        "Origin Time       2018/01/24 19:51:00", "Lat.              41.0", "Long.             142.5",
        "Depth. (km)       34", "Mag.              6.3", "Station Code      AOM001",
        "Station Lat.      41.5", "Station Long.     140.9", "Station Height(m) 10",
        "Record Time       2018/01/24 19:51:43", "Sampling Freq(Hz) 100Hz", "Duration Time(s)  4",
        "Dir.              E-W", "Scale Factor      7845(gal)/8223790", "Max. Acc. (gal)   4.1",
        "Last Correction   2018/01/24 19:51:27", "Memo.",
    ]  # fmt: skip
    body = "".join("".join(f"{v:9d}" for v in samples[i : i + 8]) + "\n" for i in range(0, 400, 8))
    yield "AOM001.EW", ("\n".join(lines) + "\n" + body).encode()


def _archives(texts: dict[str, bytes]) -> Iterable[tuple[str, bytes]]:
    some = {name: texts[name] for name in ("csmip_v2-csmip.V2", "at2_peer-peer.AT2")}
    for name, packing in (("stored.zip", zipfile.ZIP_STORED), ("packed.zip", zipfile.ZIP_DEFLATED)):
        buffer = io.BytesIO()
        with zipfile.ZipFile(buffer, "w", packing) as archive:
            for member, content in some.items():
                archive.writestr(member, content)
        yield name, buffer.getvalue()
    nested = io.BytesIO()
    with zipfile.ZipFile(nested, "w") as archive:
        archive.writestr("inner.zip", buffer.getvalue())
    yield "nested.zip", nested.getvalue()
    import tarfile

    for name, mode in (("some.tar", "w"), ("some.tar.gz", "w:gz")):
        buffer = io.BytesIO()
        with tarfile.open(fileobj=buffer, mode=mode) as archive:
            for member, content in some.items():
                info = tarfile.TarInfo(member)
                info.size = len(content)
                archive.addfile(info, io.BytesIO(content))
        yield name, buffer.getvalue()
    yield "peer.AT2.gz", gzip.compress(some["at2_peer-peer.AT2"])


if __name__ == "__main__":
    sys.exit(main())
