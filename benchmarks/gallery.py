"""The time of a gallery: 300 objects on two floors under the default motions, in wall seconds of one process."""

import csv
import tempfile
import time
from pathlib import Path

import numpy as np

from rockfrag.assess.inventory import Inventory, assess_inventory

OBJECTS, FLOORS = 300, ("0/3", "2/3")
RECORDS = Path(__file__).resolve().parents[1] / "resources" / "records"
SHARED = {"pga": "0.25 g", "return_period": "475 years"}


def write_gallery(path: Path, objects: int = OBJECTS) -> None:
    """Made objects of 25 cm to 2.5 m, every third on a pedestal, on alternate floors."""
    rng = np.random.default_rng(32)
    with path.open("w", newline="") as file:
        table = csv.writer(file)
        table.writerow(
            [
                "name",
                "width_m",
                "height_m",
                "pedestal_width_m",
                "pedestal_height_m",
                "floor",
                "value",
            ]
        )
        for i in range(objects):
            height = 0.25 * 10 ** rng.uniform()
            width = height / rng.uniform(2.2, 6)
            pedestal = (
                [f"{1.3 * width:.3f}", f"{rng.uniform(0.3, 1):.3f}"]
                if i % 3 == 0
                else ["", ""]
            )
            sizes = [f"{width:.3f}", f"{height:.3f}", *pedestal]
            table.writerow(
                [f"object {i}", *sizes, FLOORS[i % 2], f"{rng.lognormal(9, 1):.0f}"]
            )


def gallery_seconds(objects: int = OBJECTS) -> tuple[float, Inventory]:
    """Seconds to assess a gallery with warm kernels, and what was found."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "gallery.csv"
        write_gallery(path, 6)
        assess_inventory(path, SHARED, RECORDS)
        write_gallery(path, objects)
        start = time.perf_counter()
        found = assess_inventory(path, SHARED, RECORDS)
        return time.perf_counter() - start, found


if __name__ == "__main__":
    seconds, found = gallery_seconds()
    print(
        f"{len(found.found)} objects, {len(found.motions.ground)} motions: {seconds:.3g} s"
    )
