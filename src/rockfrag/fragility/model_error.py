"""The model error: how far simulated medians are from measured or published ones, by kind of body.

In: nothing, as the numbers are computed elsewhere and stand here; of scans by
``python -m rockfrag.stages.model_error`` from campaigns on shaking tables, of cut blocks by
``python -m rockfrag.stages.toppling_velocity`` beside published medians of furniture. Out: standard deviations and
biases of ln median [-], which curves, answers and exports add to their own as squares.

Theory: ``docs/campaigns.md``, "Blind: the model error"; of cut blocks ``docs/toppling-velocity.md``.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass

SCAN, CUT = "scan", "cut block"
"""Kinds of bodies: a scanned one stands on a few points, a cut one on the edges that were measured."""


@dataclass(frozen=True)
class ModelError:
    """Error of the model for one kind of body."""

    # standard deviation of ln median of a blind answer, all that is not known of the body included
    # [-]
    blind: float
    # what of it is left where the ways in which the body may stand are sources of their own [-]
    beyond: float
    words: str  # what the numbers rest on


@dataclass(frozen=True)
class Bias:
    """Bias of ln median (simulated over published) and its standard error [-]."""

    bias: float
    error: float

    @property
    def square(self) -> float:
        """Mean square of what is wrong with a median from which the bias is not taken off."""
        return self.bias**2 + self.error**2


BIASES: Mapping[str, Bias] = {"plane": Bias(0.31, 0.12), "square": Bias(0.19, 0.12)}
"""Biases of cut blocks in the plane and on a square base in space, over Kaneko's curve and FEMA P-58."""

_OF_CUT = round(math.sqrt(sum(each.square for each in BIASES.values()) / 2), 3)

MODEL_ERRORS: Mapping[str, ModelError] = {
    SCAN: ModelError(
        0.322,
        0.252,
        "blind on one campaign, a granite rock in 490 tests under 56 motions, in space, computed 2026-11-28",
    ),
    # published medians are no measurements, and the bias is not taken off
    CUT: ModelError(
        _OF_CUT,
        _OF_CUT,
        "bias beside Kaneko's curve and FEMA P-58 for furniture, in the plane and in space, computed 2026-11-26",
    ),
}
"""Errors of the model by the kind of body."""
