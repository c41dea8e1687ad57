"""Studies: what is to be computed, read from a configuration file and checked first."""

from rockfrag.studies.study import Study, load_study, study_from

__all__ = ["Study", "load_study", "study_from"]
