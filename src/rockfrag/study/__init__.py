"""Studies: what is to be computed, read from a configuration file and checked by ``loading`` first."""
