"""Sections of the report that only a study with the keys of the thesis has; `parts` puts them in order."""
