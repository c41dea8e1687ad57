"""The example of a study of a measured table, with a synthetic table."""

from pathlib import Path

import numpy as np
import pandas as pd
import yaml

from .running import ROOT


def write_example(folder: Path, table: str, **changes: object) -> Path:
    """Write the example's configuration beside a table of that name."""
    content = yaml.safe_load((ROOT / "config" / "measured-example.yaml").read_text())
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
