"""Sections of the report that only a study with the keys of the thesis has; `parts` puts them in order."""

from rockfrag.report.part import Says

says = Says("rockfrag_thesis.sections", "sections.j2")
