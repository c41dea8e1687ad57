"""What is shaken: bodies, the contacts between them, and the ways in which people write a system."""

from typing import TYPE_CHECKING

from rockfrag._lazy import loader

if TYPE_CHECKING:
    from rockfrag.system.blocks import Block, Body, Column, Stack, as_system
    from rockfrag.system.body import Circle, Interval, Polygon, RigidBody
    from rockfrag.system.contact import Contact, Friction, ImpactLaw
    from rockfrag.system.system import Start, System

__all__ = [
    "Block",
    "Body",
    "Circle",
    "Column",
    "Contact",
    "Friction",
    "ImpactLaw",
    "Interval",
    "Polygon",
    "RigidBody",
    "Stack",
    "Start",
    "System",
    "as_system",
]

_HOMES = {
    "blocks": ("Block", "Body", "Column", "Stack", "as_system"),
    "body": ("Circle", "Interval", "Polygon", "RigidBody"),
    "contact": ("Contact", "Friction", "ImpactLaw"),
    "system": ("Start", "System"),
}

__getattr__ = loader(
    __name__, {name: f"{__name__}.{home}" for home, names in _HOMES.items() for name in names}
)
