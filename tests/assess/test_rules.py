"""What the documentation says of rules of thumb is what they give."""

import re
from pathlib import Path

import pytest

from rockfrag.assess.rules import rules_study

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.slow
def test_the_documented_bias_of_rules_is_the_computed_one(default_records):
    table = rules_study(ROOT / "config" / "rules-of-thumb.yaml", default_records)
    text = (ROOT / "docs" / "rules-of-thumb.md").read_text(encoding="utf-8")
    header, _, *rows = re.findall(r"^\|(.*)\|$", text, re.MULTILINE)
    rules = [cell.strip() for cell in header.split("|")][1:]
    documented = {}
    for row in rows:
        name, *cells = (cell.strip() for cell in row.split("|"))
        documented |= {(name, rule): cell for rule, cell in zip(rules, cells, strict=True)}
    computed = {
        (row.object, row.rule): f"{row.bias:.2f} ± {row.scatter:.2f}, {100 * row.unsafe:.0f} %"
        for row in table.itertuples()
    }
    assert documented == computed
