"""Sections of the report: table, figure, caption and words of one part each."""
