"""Counterparts of the thesis's figures, from the tables of a study."""
