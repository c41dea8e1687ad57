"""Planar columns that stick, slide, rock, fly, contact event by contact event (``docs/contact.md``)."""
