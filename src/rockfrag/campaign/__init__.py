"""Shake-table campaigns: simulate what a laboratory did, test by test, and compare.

Data flow through ``laboratory``, ``standing`` and ``comparison``.
"""
