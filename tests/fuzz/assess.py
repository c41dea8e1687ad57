"""Damaged files of an assessment: hazard curves of every kind, statues, and inventories."""

import random
from collections.abc import Callable
from pathlib import Path
from typing import Any

import yaml

from rockfrag.assess.hazard.reading import read_hazard
from rockfrag.assess.inventory import read_inventory
from rockfrag.assess.request import read_request

from ..assess.samples import SAMPLES
from .damage import Attempt, changed, damage, damaged
from .inputs import DUMPER

ROOT = Path(__file__).resolve().parents[2]
STATUES: tuple[dict[str, Any], ...] = (
    {
        "name": "A saint", "width": "35 cm", "height": "1.6 m", "depth": "30 cm", "mass_kg": 310,
        "restitution": 0.9, "floor": "2/4", "pga": "0.25 g", "return_period_years": 475,
        "pedestal": {"width": "50 cm", "height": "90 cm", "mass_kg": 400},
        "tolerances": {"width": 0.02, "cg_height": 0.1}, "years": 50, "magnitude": 6.5,
        "distance_km": 12.0,
    },
    {
        "width_m": 0.3, "height_m": 1.1, "cg_height_m": 0.5, "cg_offset_m": 0.01, "friction": 0.6,
        "inertia_kg_m2": 20.0, "mass_kg": 200.0, "building": "building.yaml", "floor": 2,
        "hazard": ["table.csv"], "sa": ["0.3 s", "0.6 g"],
        "records": {"paths": ["records"], "recorded_on": "floor", "unit": "g", "dt_s": 0.01},
    },
)  # fmt: skip
INVENTORY = """name,width_cm,height_cm,depth,mass_kg,cg_height_cm,pedestal_width,pedestal_height,floor,restitution
saint,35,160,30 cm,310,70,50 cm,0.9 m,2/4,0.9
vase,20,55,,12,,,,,
Größe,12.5,90,0.12 m,,40,,,1/4,0.85
"""


def hazard_files(folder: Path) -> Callable[[random.Random], Attempt]:
    """Return what makes a hazard file with damaged bytes."""
    return damaged(
        folder,
        [(name, text.encode(), lambda path: read_hazard([path])) for name, text in SAMPLES.items()],
    )


def objects(folder: Path) -> Callable[[random.Random], Attempt]:
    """Return what makes a statue, with other values or damaged bytes, or an inventory."""
    (folder / "table.csv").write_text(SAMPLES["table.csv"])
    (folder / "building.yaml").write_bytes((ROOT / "config" / "building.yaml").read_bytes())
    texts = [yaml.dump(statue, Dumper=DUMPER, sort_keys=False).encode() for statue in STATUES]
    path, table = folder / "statue.yaml", folder / "inventory.csv"

    def one(rng: random.Random) -> Attempt:
        kind = rng.randrange(3)
        if kind == 0:
            content: Any = rng.choice(STATUES)
            for _ in range(rng.randint(1, 3)):
                content = changed(content, rng)
            path.write_text(yaml.dump(content, Dumper=DUMPER, allow_unicode=True, sort_keys=False))
            return path, lambda: read_request(path)
        if kind == 1:
            path.write_bytes(damage(rng.choice(texts), rng.choice(texts), rng))
            return path, lambda: read_request(path)
        table.write_bytes(damage(INVENTORY.encode(), texts[0], rng))
        return table, lambda: read_inventory(table, {"pga": "0.3 g"})

    return one
