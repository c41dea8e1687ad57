"""The step protocol as far as a shaker's limits allow, beside the one without limits."""

from collections.abc import Iterable, Sequence

import pandas as pd

from rockfrag.records.motion import Motion
from rockfrag.shaketable.protocols import Protocol
from rockfrag.shaketable.swept import Swept
from rockfrag.study.study import Study

LIMITED = "step_protocol_shaker"
"""Reading of the step protocol that stops at the shaker's limit."""


def limits_table(study: Study, motions: Sequence[Motion]) -> pd.DataFrame:
    """What each motion asks of the study's shaker, see :func:`rockfrag.shaketable.shaker.shaker_table`."""
    from rockfrag.shaketable.shaker import shaker_table

    if study.shaker is None:
        raise ValueError("the study has no shaker")
    payload = max(configuration.mass for configuration in study.configurations)
    return shaker_table(study.shaker, motions, payload)


def limited_tests(
    ida_curves: Iterable[Swept], protocol: Protocol, limits: pd.DataFrame
) -> pd.DataFrame:
    """Read the step protocol with the shaker's limits, as :func:`limits_table` returns them.

    Returns tests whose reading is ``LIMITED``; the remark of a test that the shaker ended says so.
    """
    from rockfrag.shaketable.definitions import DEFINITION, tests_from_swept

    known = limits.set_index("motion").to_dict("index")
    largest = dict(zip(limits["motion"], limits["limit_g"].astype(float), strict=True))
    tests = tests_from_swept(ida_curves, protocol, definitions=[DEFINITION], limits_g=largest)
    remarks = []
    for test in tests.to_dict("records"):
        limit = known[test["motion"]]
        ended = test["censored"] == "right" and limit["limit_g"] < protocol.limit_g
        remarks.append(
            f"shaker's {limit['limited_by']} reached at {limit['limit_g']:.3f} g"
            if ended
            else test["remark"]
        )
    return tests.assign(remark=remarks, definition=LIMITED)
