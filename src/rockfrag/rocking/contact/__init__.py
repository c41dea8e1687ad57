"""Blocks that slide, rock and fly: planar contact with Coulomb's friction (``docs/contact.md``)."""

from rockfrag.rocking.contact.ensemble import ContactEnsemble, overturns_with_friction
from rockfrag.rocking.contact.response import ContactResponse
from rockfrag.rocking.contact.simulation import simulate_with_friction

__all__ = [
    "ContactEnsemble",
    "ContactResponse",
    "overturns_with_friction",
    "simulate_with_friction",
]
