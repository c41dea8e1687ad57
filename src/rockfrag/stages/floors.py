"""Motions of a study without a building."""

from dataclasses import replace

from rockfrag.records.motion import Motion

GROUND = "GF"
"""Label of the ground floor."""


def on_the_ground(motion: Motion) -> Motion:
    """Return a ground motion labelled as the floors of a building are: ``<name>_GF``."""
    metadata = {**motion.metadata, "floor": GROUND, "level": 0, "ground_motion": motion.name}
    return replace(motion, name=f"{motion.name}_{GROUND}", metadata=metadata)
