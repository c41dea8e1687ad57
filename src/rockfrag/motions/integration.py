"""Velocity and displacement of a motion: those of :mod:`rockfrag.records.integration`, which records need too."""

from rockfrag.records.integration import integrate as integrate
from rockfrag.records.integration import peak_displacement as peak_displacement
from rockfrag.records.integration import peak_velocity as peak_velocity
