"""A small study on synthetic motions that needs no network."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml

CONFIG = Path(__file__).resolve().parents[2] / "config"

CATALOGUE = (
    "name,earthquake,date,station,component,magnitude,distance_km,source,file,sha256,unit,licence\n"
)

SPECIMENS = (
    "name,width_cm,height_cm,mass_g\nT1,12.4,37.2,2172\nT2,12.4,49.6,2790\nP,18.4,20.8,2300\n"
)

CONFIGURATIONS = "name,object,pedestal\nT1,T1,\nT2,T2,\nP&T1,T1,P\nP&T2,T2,P\n"


def study_content() -> dict:
    return {
        "study": "tiny",
        "title": "Two objects under made-up motions",
        "seed": 3,
        "motions": {"catalogue": "motions.csv"},
        "bodies": {"specimens": "specimens.csv", "configurations": "configurations.csv"},
        "amplitudes": {"lowest_g": 0.2, "highest_g": 1.6, "step_percent": 8},
        "protocol": {"step_percent": 16},
        "fragility": {"measures": ["pga_g"], "confidence": 0.9},
    }


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
    folder.mkdir()
    rows = [CATALOGUE]
    for number, earthquake in enumerate(("First", "First", "Second", "Second", "Third", "Fourth")):
        write_record(folder / f"record{number}.txt", seed=number)
        rows.append(f"motion {number},{earthquake},,,,,,folder,record{number}.txt,,g,made up\n")
    (folder / "motions.csv").write_text("".join(rows))
    (folder / "specimens.csv").write_text(SPECIMENS)
    (folder / "configurations.csv").write_text(CONFIGURATIONS)
    write_study(folder, study_content())
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
