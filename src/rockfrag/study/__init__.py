"""Studies: what is to be computed, read from a configuration file and checked first.

:func:`rockfrag.study.loading.load_study` reads and checks; the workflow's jobs use
:func:`rockfrag.study.study.study_from`, which loads less.
"""
