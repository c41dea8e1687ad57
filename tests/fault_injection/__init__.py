"""Interrupting, starving and misusing studies: `make torture`."""
