"""Small records of every format as files, archives and downloads; their texts stand in :mod:`.record_texts`."""

import io
import tarfile
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from obspy.core.inventory import Channel, Inventory, Network, Response, Station
from obspy.core.inventory.response import InstrumentSensitivity, ResponseStage

from .fields import N, Samples, straight_line, wave
from .record_texts import RECORDS, Made, peer_file, search_results

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
    recipe = RECORDS[kind]
    dt = recipe.read["dt"]
    if recipe.line is not None:
        times, waves, samples = straight_line(dt, **recipe.line)
    else:
        times = np.arange(N) * dt
        waves = np.array([wave(seed, **recipe.made) for seed in recipe.seeds])
        channels = len(recipe.read.get("components", [""]))
        samples = recipe.factor * waves[:channels]
    text = recipe.text(Made(times, waves)).replace("\n", recipe.newline)
    path = folder / recipe.file
    path.write_bytes(text.encode(recipe.encoding))
    return Built(path, samples, **recipe.read)


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


def peer_download(folder: Path, count: int) -> Path:
    """Make the folder that a download of ``count`` records of PEER's database unpacks to."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "_SearchResults.csv").write_text(search_results(count))
    kinds = {
        "AT2": "ACCELERATION TIME SERIES IN UNITS OF G",
        "VT2": "VELOCITY TIME SERIES IN UNITS OF CM/S",
    }
    for i in range(count):
        # every fourth record has no vertical component
        for number, component in enumerate(("000", "090", "-UP")[: 3 if i % 4 else 2]):
            second = f"Loma Prieta, 10/18/1989, Station {i}, {component.strip('-')}"
            name = f"RSN{700 + i}_LOMAP_S{i:02d}{component}"
            for ending, words in kinds.items():
                text = peer_file(second, words, wave(100 * i + number))
                (folder / f"{name}.{ending}").write_text(text)
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
