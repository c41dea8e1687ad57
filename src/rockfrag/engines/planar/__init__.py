"""Columns of planar bodies that stick, slide, rock, fly and land, event by contact event (``docs/contact.md``)."""
