"""Arithmetic that engines share: vectors of three, rotations and small linear systems."""
