"""Rocking and overturning of free-standing objects in earthquakes."""
