"""Blocks that slide, rock and fly: planar contact with Coulomb's friction (``docs/contact.md``).

:func:`rockfrag.rocking.simulate` and :func:`rockfrag.rocking.overturns` come here when given ``friction``.
"""
