"""Formats of strong-motion records, one module a format."""
