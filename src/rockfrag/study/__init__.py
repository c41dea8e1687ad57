"""Studies: what is to be computed, read from a configuration file and checked first.

:func:`rockfrag.study.loading.load_any` reads and checks.
"""
