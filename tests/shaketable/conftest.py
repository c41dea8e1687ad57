from dataclasses import replace

import numpy as np
import pandas as pd
import pytest


@pytest.fixture(scope="session")
def records(four_records):
    """The four records, each with its earthquake and floor."""
    return {
        name: replace(
            motion, name=name, metadata={"earthquake": name, "floor": "ground"}
        )
        for name, motion in four_records.items()
    }


def ida_table(
    overturned, amplitudes, name="vase", side="NP", earthquake="Kobe", floor="ground"
):
    """One IDA curve: whether an object, on its pedestal (P) or not, overturned at each amplitude [g]."""
    about = {
        "configuration": f"P&{name}" if side == "P" else name,
        "object": name,
        "pedestal": side,
        "motion": f"{earthquake}_{floor}",
        "earthquake": earthquake,
        "floor": floor,
    }
    body = np.where(overturned, "statue", "")
    curve = {
        "amplitude_g": amplitudes,
        "overturned": overturned,
        "overturned_body": body,
    }
    return pd.DataFrame(about | curve)
