"""From a system to the record of numbers that the kernels read."""

from types import SimpleNamespace

import numpy as np

from rockfrag.engines.kernels.equations import BODY
from rockfrag.input_checks import positive_number
from rockfrag.laws import Told, law_named, momentum, ratio
from rockfrag.system import geometry
from rockfrag.system.contact import ImpactLaw
from rockfrag.system.system import System
from rockfrag.units import GRAVITY

BY_MOMENTUM: Told = (momentum.NUMBER, 1.0)
FIELDS = ("after1r", "after1l", "after2r", "after2l")


def body_record(system: System, linear: bool = False, g: float = GRAVITY) -> np.void:
    """Return the record of a system of one or two bodies that the kernels read (``kernels.equations.BODY``).

    ``linear`` uses the linearised equations: eq. 2.9 for one body, eq. 2.60-2.65 for two.
    """
    positive_number("g", g, "m/s²")
    p: np.void = np.zeros(1, BODY)[0]
    found = afters(system)
    for name, after in zip(FIELDS, found, strict=True):
        p[name] = after
    p["gravity"] = g
    # its fields are attributes, as those of records are in kernels
    named = SimpleNamespace()
    if system.count == 1:
        geometry.fill_block(named, system.shapes[0])
        p["linear"] = 2 if linear else 0
    else:
        geometry.fill_pile(named, system.pile)
        p["linear"] = 1 if linear else 0
    for name, value in vars(named).items():
        p[name] = value
    p["measured"] = any(after != BY_MOMENTUM for after in found)
    return p


def afters(system: System) -> tuple[Told, ...]:
    """Return how ground and interface come off impacts that end on their right and left pivots.

    Of a lone body, which the interface stands for, all laws are the same.
    """
    if system.count == 1:
        law = system.contacts[0].law
        if law.name == "momentum":
            return (BY_MOMENTUM,) * 4
        return BY_MOMENTUM, BY_MOMENTUM, (ratio.NUMBER, law.right), (ratio.NUMBER, law.left)
    return tuple(
        after_impact(contact.law, shape, pivot)
        for contact, shape in zip(system.contacts, system.carried, strict=True)
        for pivot in (+1, -1)
    )


def after_impact(law: ImpactLaw, shape: geometry.Shape, pivot: int) -> Told:
    """What the kernels are told of the impacts of a contact that end on a pivot of the body above it."""
    return law_named(law.name).tell(shape, law.right if pivot > 0 else law.left, pivot)
