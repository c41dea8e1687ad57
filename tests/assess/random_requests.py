"""Random questions as ``rockfrag assess`` gets them: kinds of objects, places and what is known of the shaking."""

import random
from typing import Any

NAMES = (
    "Vase",
    "Server rack",
    "Tombstone",
    "Bust",
    "Bookshelf",
    "Column",
    "Instrument",
)


def some_request(rng: random.Random, *, in_space: float = 0.3) -> dict[str, Any]:
    """Keys of ``statue.yaml`` of a random question; a part is of objects that move in space."""
    width = rng.uniform(0.05, 0.8)
    height = width * rng.uniform(1.2, 6)
    found: dict[str, Any] = {
        "name": rng.choice(NAMES),
        "width": f"{100 * width:.3g} cm",
        "height": f"{height:.3g} m",
    }
    if rng.random() < in_space:
        found |= rng.choice([{"round": True}, {"depth": f"{80 * width:.3g} cm"}])
    elif rng.random() < 0.2:
        found["restitution"] = round(rng.uniform(0.6, 0.8), 2)
    if rng.random() < 0.3:
        found["mass"] = f"{rng.uniform(800, 3000) * width * width * height:.4g} kg"
    if rng.random() < 0.3:
        found["cg_height"] = f"{rng.uniform(0.4, 0.55) * height:.3g} m"
    if rng.random() < 0.2 and not found.get("round"):
        found["pedestal"] = {
            "width": f"{100 * width * rng.uniform(1, 2):.3g} cm",
            "height": f"{rng.uniform(0.2, 1.0):.3g} m",
        }
    if rng.random() < 0.3:
        storeys = rng.randint(1, 6)
        found["floor"] = f"{rng.randint(1, storeys)}/{storeys}"
    return found | _shaking(rng)


def _shaking(rng: random.Random) -> dict[str, Any]:
    """A level in PGA, beside it PGV or not, or in PGV alone; with a return period or without."""
    level = rng.uniform(0.05, 0.7)
    found: dict[str, Any] = {"pga": f"{level:.3g} g"}
    kind = rng.random()
    if kind < 0.2:
        found = {"pgv": f"{100 * level * rng.uniform(0.6, 1.4):.3g} cm/s"}
    elif kind < 0.4:
        found["pgv"] = f"{100 * level * rng.uniform(0.6, 1.4):.3g} cm/s"
    if rng.random() < 0.4:
        found["return_period"] = rng.choice([72, 475, 975])
    if kind > 0.8:
        found |= {"magnitude": round(rng.uniform(5.5, 7.5), 1)}
        found |= {"distance_km": round(rng.uniform(5, 60), 1)}
    return found
