"""The kernels: compiled functions that integrate bodies through motions.

The life of a case, and where a change belongs: ``docs/kernels.md``.
"""
