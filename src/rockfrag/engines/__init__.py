"""Engines: who computes how a system moves, behind one contract (``rockfrag.engines.contract``)."""
