"""Columns of planar bodies that stick, slide, rock, fly and land, event by event (``docs/contact.md``)."""
