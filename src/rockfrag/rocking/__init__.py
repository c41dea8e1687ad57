"""Rigid blocks rocking: bodies, contact states, impacts, histories and ensembles."""

from rockfrag.rocking.bodies import Block, Body, Stack
from rockfrag.rocking.ensemble import EnsembleResult, overturns
from rockfrag.rocking.response import Response
from rockfrag.rocking.simulation import simulate

__all__ = ["Block", "Body", "EnsembleResult", "Response", "Stack", "overturns", "simulate"]
