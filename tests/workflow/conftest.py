"""A small study on synthetic motions that needs no network."""

import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml

CONFIG = Path(__file__).resolve().parents[2] / "config"

CATALOGUE = "name,earthquake,date,station,component,magnitude,distance_km,source,file,sha256,unit,licence\n"

# files of the small study, but for its motions
STUDY = Path(__file__).with_name("study")


def study_content() -> dict:
    return yaml.safe_load((STUDY / "study.yaml").read_text())


def write_study(folder: Path, content: dict) -> Path:
    """Write a study's configuration and return its path."""
    path = folder / "study.yaml"
    path.write_text(yaml.safe_dump(content, sort_keys=False))
    return path


def write_record(path: Path, seed: int, samples: int = 800, dt: float = 0.01) -> None:
    """Two columns, seconds and g: a seeded burst of band-limited noise."""
    rng = np.random.default_rng(seed)
    time = np.arange(samples) * dt
    envelope = np.exp(-(((time - 2.5) / 1.2) ** 2))
    phases = rng.uniform(0, 2 * np.pi, 30)
    frequencies = rng.uniform(0.5, 5.0, 30)
    waves = np.sin(2 * np.pi * np.outer(time, frequencies) + phases).sum(axis=1)
    acceleration = 0.3 * envelope * waves / np.abs(envelope * waves).max()
    rows = [f"{t:.2f} {a:.6f}" for t, a in zip(time, acceleration, strict=True)]
    path.write_text("\n".join(rows) + "\n")


@pytest.fixture
def study_folder(tmp_path: Path) -> Path:
    """A folder with a space in its name, holding a whole small study."""
    return make_study(tmp_path / "a study")


def make_study(folder: Path) -> Path:
    """Write a whole small study into a new folder."""
    shutil.copytree(STUDY, folder)
    rows = [CATALOGUE]
    for number, earthquake in enumerate(
        ("First", "First", "Second", "Second", "Third", "Fourth")
    ):
        write_record(folder / f"record{number}.txt", seed=number)
        rows.append(
            f"motion {number},{earthquake},,,,,,folder,record{number}.txt,,g,made up\n"
        )
    (folder / "motions.csv").write_text("".join(rows))
    return folder


def write_example(folder: Path, table: str, **changes: object) -> Path:
    """Write the example's configuration beside a table of that name."""
    content = yaml.safe_load((CONFIG / "measured-example.yaml").read_text())
    path = folder / "study.yaml"
    path.write_text(yaml.safe_dump({**content, "table": table, **changes}))
    return path


def write_synthetic(folder: Path) -> Path:
    """150 synthetic tests that overturn above a PGV of about 40 cm/s, whatever their PGA."""
    rng = np.random.default_rng(5)
    pga = np.exp(rng.normal(np.log(0.4), 0.5, 150))
    ratio = np.exp(rng.normal(np.log(0.1), 0.5, 150))
    fell = pga * ratio * 980.665 > 40 * np.exp(rng.normal(0, 0.2, 150))
    table = pd.DataFrame(
        {
            "record": [f"synthetic {k % 30}" for k in range(150)],
            "pga_g": pga,
            "pgv_over_pga_s": ratio,
            "overturned": fell.astype(int),
        }
    )
    path = folder / "synthetic.csv"
    table.to_csv(path, index=False)
    return path
