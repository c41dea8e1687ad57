from dataclasses import replace

import pytest


@pytest.fixture(scope="session")
def records(four_records):
    """The four records, each with its earthquake and floor."""
    return {
        name: replace(motion, name=name, metadata={"earthquake": name, "floor": "ground"})
        for name, motion in four_records.items()
    }
