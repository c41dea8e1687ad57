"""Stages of a study, one file a rule of the workflow: inputs to tables."""
