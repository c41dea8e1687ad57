"""Fixtures of the library's tests that these use too."""

from tests.conftest import four_records, record_folder

__all__ = ["four_records", "record_folder"]
