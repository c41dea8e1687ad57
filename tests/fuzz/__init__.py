"""Damaged inputs and random requests, each of which is to be used or refused: `make fuzz`."""
