"""Seismic hazard of a site, as its makers write it: a module for each kind of file."""
