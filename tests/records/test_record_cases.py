"""Small record files of all kinds that were once read wrongly, where the reference material is present.

A table beside the files says of each what must come out: values (``read``), values or a sentence that names the
way out (``read_or_hint``), a refusal (``refuse``), one of both (``refuse_or``), a folder (``catalogue``).
"""

import json
import re

import pytest

from rockfrag.base.errors import InputError
from rockfrag.records.make_catalogue import make_catalogue
from rockfrag.records.read import read_motion

from ..conftest import SHARED

FOLDER = SHARED / "record_cases"
ROW = re.compile(r"^\| `([^`]+)` \| (\w+) \| `([^`]*)` \| `([^`]*)` \|", re.MULTILINE)


def table() -> list[tuple[str, str, dict, object]]:
    """Rows of the table: file, kind of check, arguments, and what is expected."""
    page = FOLDER / "README.md"
    text = page.read_text(encoding="utf-8") if page.is_file() else ""
    return [
        (file, kind, json.loads(call), json.loads(wanted))
        for file, kind, call, wanted in ROW.findall(text)
    ]


CASES = table()


def arguments(call: dict) -> dict:
    """Arguments of a motion's reader; those of the command line without it."""
    return {key: value for key, value in call.items() if key != "args"}


def check_motion(file: str, call: dict, wanted: dict) -> None:
    motion = read_motion(FOLDER / file, **arguments(call))
    counts = wanted["n"] if isinstance(wanted["n"], list) else [wanted["n"]]
    assert motion.acceleration.size in counts
    assert motion.dt == pytest.approx(wanted["dt"], rel=1e-5)
    if "peak" in wanted:
        assert motion.pga == pytest.approx(wanted["peak"], rel=1e-3)
    start = str(motion.metadata["start_time"])
    assert start.startswith(wanted.get("start", ""))


def check_catalogue(file: str, call: dict, wanted: dict) -> None:
    args = call.get("args", [])
    words = dict(zip(args[::2], args[1::2], strict=True))
    asked = {name.lstrip("-"): value for name, value in words.items()}
    if "dt" in asked:
        asked["dt"] = float(asked["dt"])
    try:
        draft = make_catalogue([FOLDER / file], **asked, folder=FOLDER)
    except InputError as error:
        assert re.search(wanted["or_words"], str(error), re.IGNORECASE)
        return
    rows = draft.table
    assert len(rows) == wanted["motions"]
    assert (rows["second"] != "").sum() == wanted.get(
        "paired", 0
    ) or "paired" not in wanted
    verticals = set(rows["vertical"]) - {""}
    assert len(verticals) == wanted.get("vertical", len(verticals))
    for ending in wanted.get("forbid", ()):
        assert not rows["file"].str.contains(ending, regex=False).any()


@pytest.mark.skipif(
    not CASES, reason="the reference material beside the repository is absent"
)
@pytest.mark.parametrize(
    ("file", "kind", "call", "wanted"),
    CASES or [("", "", {}, None)],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_a_record_is_read_as_it_is_or_refused(file, kind, call, wanted):
    if kind == "catalogue":
        check_catalogue(file, call, wanted)
    elif kind == "read":
        check_motion(file, call, wanted)
    elif kind == "refuse":
        with pytest.raises(InputError, match=f"(?i){wanted}"):
            read_motion(FOLDER / file, **arguments(call))
    else:
        try:
            check_motion(file, call, wanted)
        except InputError as error:
            hint = wanted.get("hint", "") if kind == "read_or_hint" else ""
            assert re.search(hint, str(error), re.IGNORECASE)


def test_every_row_of_the_table_is_a_case():
    if not CASES:
        pytest.skip("the reference material beside the repository is absent")
    rows = (FOLDER / "README.md").read_text(encoding="utf-8").count("\n| `")
    assert len(CASES) == rows
    assert {kind for _, kind, _, _ in CASES} <= {
        *("read", "read_or_hint", "refuse", "refuse_or", "catalogue")
    }  # fmt: skip
