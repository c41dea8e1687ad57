"""The stages of the workflow that only a study of the thesis has."""
