"""Mutants: the library with one line changed, and whether the quick tests notice.

``changes`` finds what may be changed, ``plain`` runs kernels without compiling them, ``trials`` asks the tests;
``python -m tests.mutants`` puts them together.
"""
