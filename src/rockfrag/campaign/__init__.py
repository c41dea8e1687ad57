"""Shake-table campaigns: simulate what a laboratory did, test by test, and compare.

A campaign is a table of tests with the motion that the table made in each, and what the object did.  Data
flow through the modules in this order: ``tests`` (the table), ``table_motions`` (what the table did,
conditioned), ``trials`` (what nobody measured, such as the direction of shaking, as ranges), ``outcomes``
(every trial × test simulated), ``validation`` (trials chosen by some motions and judged by others),
``comparison`` (against the measurement, thresholds on intensity measures and other codes).
"""
