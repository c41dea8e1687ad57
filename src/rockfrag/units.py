"""Physical constants and the few units that data enter or leave with; everything inside is SI."""

STANDARD_GRAVITY = 9.81
"""Acceleration of gravity [m/s²] of the thesis; its tables follow from it to the printed digit."""

CENTIMETRES_PER_METRE = 100.0
