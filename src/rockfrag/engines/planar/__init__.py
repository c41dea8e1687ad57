"""Columns of planar bodies that stick, slide, rock, fly and land, contact contact event by contact contact event (``docs/contact.md``)."""
