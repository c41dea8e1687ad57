"""Blocks that slide, rock and fly: planar contact with Coulomb's friction (``docs/contact.md``)."""
