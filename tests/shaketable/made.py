"""Made incremental dynamic analyses."""

import numpy as np
import pandas as pd


def ida_table(overturned, amplitudes, name="vase", side="NP", earthquake="Kobe", floor="ground"):
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
    curve = {"amplitude_g": amplitudes, "overturned": overturned, "overturned_body": body}
    return pd.DataFrame(about | curve)
