"""Small records of every format, written here from the formats' definitions in ``built_records.yaml``."""

import io
import re
import tarfile
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from jinja2 import DictLoader, Environment
from numpy.typing import NDArray
from obspy.core.inventory import Channel, Inventory, Network, Response, Station
from obspy.core.inventory.response import InstrumentSensitivity, ResponseStage

from ..case_tables import case_tables

# samples of a built record: no multiple of any row length, so that last rows are short
N = 43

Samples = NDArray[np.float64]
RECORDS: dict[str, Any] = case_tables(__file__)
PARTS: dict[str, Any] = RECORDS.pop("parts")
KINDS = sorted(RECORDS)


@dataclass(frozen=True)
class Built:
    """A built file and what must be read from it, samples in the unit of the file."""

    path: Path
    samples: Samples
    format: str
    dt: float
    unit: str
    station: str = ""
    start_time: str | None = None
    components: tuple[str, ...] = ("",)
    tolerance: float = 0.0
    stated_dt: bool = True

    @property
    def dt_to_give(self) -> float | None:
        """The interval that a user has to name, None where the file states it."""
        return None if self.stated_dt else self.dt


def build(kind: str, folder: Path) -> Built:
    """Write a record of a kind into a folder."""
    about = RECORDS[kind]
    dt = about["read"]["dt"]
    if "line" in about:
        times, waves, samples = straight_line(dt, **about["line"])
    else:
        times = np.arange(N) * dt
        waves = waves_of(**about["waves"])
        samples = (
            about.get("factor", 1.0)
            * waves[: len(about["read"].get("components", [""]))]
        )
    text = written(kind, times=times, waves=waves, peak=f"{np.abs(waves).max():.5f}")
    path = folder / about["file"]
    encoding = about.get("encoding", "utf-8")
    path.write_bytes(text.replace("\n", about.get("newline", "\n")).encode(encoding))
    return Built(path, samples, **about["read"])


def wave(
    seed: int, scale: float = 0.3, form: str = ".5f", shift: float = 0.0
) -> Samples:
    """Return samples that fields of a form hold exactly."""
    noise = np.random.default_rng(seed).normal(size=N)
    values = scale * (np.sin(np.arange(N) * 0.2) + 0.3 * noise) + shift
    return np.array([float(format(value, form)) for value in values])


def waves_of(seeds: list[int], **made: Any) -> Samples:
    """Return the samples of each channel."""
    return np.array([wave(seed, **made) for seed in seeds])


def straight_line(
    dt: float, steps: list[float], start: float, slope: float
) -> tuple[Samples, Samples, Samples]:
    """Return uneven times, values on a line there, and those that interpolation to even times gives again."""
    times = np.cumsum(np.resize(steps, N)) - steps[0]
    even = np.arange(int(times[-1] / dt + 1e-9) + 1) * dt
    return times, start + slope * times[None, :], start + slope * even[None, :]


def written(kind: str, **facts: Any) -> str:
    """Return the text of a kind of record, or of a part that records share."""
    return _TEMPLATES.get_template(kind).render(facts)


def rows(form: str, *columns: Samples) -> str:
    """Numbers of columns side by side, in rows by a Fortran format such as ``8F10.3`` or ``5E15.7``."""
    match = re.fullmatch(
        r"(?P<each>\d+)(?P<kind>I|F|ES?)(?P<width>\d+)\.?(?P<digits>\d*)(E1)?", form
    )
    assert match is not None
    width, each = int(match["width"]), int(match["each"])
    fields = [_field(value, form, *match.group("kind", "digits")).rjust(width)
              for value in np.column_stack(columns).ravel()]  # fmt: skip
    return "\n".join("".join(fields[i : i + each]) for i in range(0, len(fields), each))


def _field(value: float, form: str, kind: str, digits: str) -> str:
    if kind in "IF":
        return f"{value:.{digits or 0}f}"
    if kind == "E":
        # Fortran's own has its first digit behind the point: -.1234567E-02
        whole, exponent = f"{abs(value):.{int(digits) - 1}E}".split("E")
        sign, power = "-" if value < 0 else "", int(exponent) + 1 if value else 0
        return f"{sign}.{whole.replace('.', '')}E{power:+03d}"
    mantissa, exponent = f"{value:.{digits}E}".split("E")
    # an exponent of one digit, so that -2.2223E-1 fills ten columns
    return (
        f"{mantissa}E{int(exponent):+d}"
        if form.endswith("E1")
        else f"{mantissa}E{exponent}"
    )


def lines(form: str, *columns: Samples) -> str:
    """Columns side by side, an instant a line."""
    return "\n".join(
        form.format(*row) for row in zip(*(c.tolist() for c in columns), strict=True)
    )


def numbers(
    count: int, fill: float = 0, places: Mapping[int, list[float]] | None = None
) -> Samples:
    """Numbers of a header, those from some places on."""
    found = np.full(count, float(fill))
    for place, values in (places or {}).items():
        found[place : place + len(values)] = values
    return found


def largest(samples: Samples) -> float:
    """The sample of the largest size, as headers state it."""
    return float(samples[np.abs(samples).argmax()])


_TEMPLATES = Environment(
    loader=DictLoader(
        {**PARTS, **{kind: about["text"] for kind, about in RECORDS.items()}}
    ),
    trim_blocks=True,
    lstrip_blocks=True,
    keep_trailing_newline=True,
)
_TEMPLATES.globals |= {
    "N": N,
    "rows": rows,
    "lines": lines,
    "numbers": numbers,
    "largest": largest,
    "zip": zip,
}


def pack(
    path: Path, members: Mapping[str, bytes], packing: int = zipfile.ZIP_STORED
) -> Path:
    """Pack files into a zip archive."""
    with zipfile.ZipFile(path, "w", packing) as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    return path


def pack_tar(path: Path, members: Mapping[str, bytes]) -> Path:
    """Pack files into a tar archive, compressed if its name says so."""
    with tarfile.open(path, "w:gz" if path.suffix == ".gz" else "w") as archive:
        for name, content in members.items():
            info = tarfile.TarInfo(name)
            info.size = len(content)
            archive.addfile(info, io.BytesIO(content))
    return path


def knet_text() -> str:
    """Return four seconds of K-NET at 100 Hz, which ObsPy reads."""
    return written("knet", samples=np.round(1e4 * np.sin(np.arange(400) * 0.1)))


def peer_download(folder: Path, count: int) -> Path:
    """Make the folder that a download of ``count`` records of PEER's database unpacks to."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "_SearchResults.csv").write_text(written("search_results", count=count))
    kinds = {
        "AT2": "ACCELERATION TIME SERIES IN UNITS OF G",
        "VT2": "VELOCITY TIME SERIES IN UNITS OF CM/S",
    }
    for i in range(count):
        # every fourth record has no vertical component
        for number, component in enumerate(("000", "090", "-UP")[: 3 if i % 4 else 2]):
            for ending, words in kinds.items():
                about = {
                    "station": i,
                    "component": component.strip("-"),
                    "words": words,
                }
                text = written("peer_file", **about, wave=wave(100 * i + number))
                (
                    folder / f"RSN{700 + i}_LOMAP_S{i:02d}{component}.{ending}"
                ).write_text(text)
    return folder


CMB = {"network": "BK", "station": "CMB", "location": "00", "delta": 0.01}


def inventory_of_cmb(sensitivity: float, *stages: ResponseStage) -> Inventory:
    """Return what StationXML says of two channels of a station, in counts per m/s²."""
    whole = InstrumentSensitivity(sensitivity, 1.0, "M/S**2", "COUNTS")
    response = Response(instrument_sensitivity=whole, response_stages=[*stages])
    channels = [
        Channel(code, CMB["location"], 0, 0, 0, 0, sample_rate=100, response=response)
        for code in ("HNE", "HNN")
    ]
    station = Station(CMB["station"], 0, 0, 0, channels=channels)
    return Inventory([Network(CMB["network"], [station])], "test")
