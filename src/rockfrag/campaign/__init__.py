"""Shake-table campaigns: simulate what a laboratory did, test by test, and compare.

Data flow through ``tests``, ``table_motions``, ``trials`` and ``comparison``.
"""
