"""What the scripts of the one-file page make of forms in Node, beside what the command says."""

import json
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from rockfrag.assess.answer import Assessment, assess_with
from rockfrag.assess.app.contents import computing, script
from rockfrag.assess.app.writing import page_of
from rockfrag.assess.findings import details, first_screen
from rockfrag.assess.motions import MotionSet
from rockfrag.assess.request import make_request
from rockfrag.words.catalogue import formatter
from rockfrag.words.findings import as_data

NODE = shutil.which("node")
needs_node = pytest.mark.skipif(NODE is None, reason="Node is not installed")

RELAXED = "--experimental-wasm-relaxed-simd"
"""Option of Node for multiply-adds that fuse; those that need none have no such option."""

READING = Path(__file__).with_name("page_in_node.js").read_text(encoding="utf-8")


def in_node(folder, motions, forms, request=None):
    """What the scripts of a page, written for a request, make of forms."""
    page = page_of(motions, forms[0], request, made=True)
    data = json.loads(page.partition('id="data">')[2].partition("</script>")[0])
    (folder / "in.json").write_text(json.dumps({"data": data, "forms": forms}))
    parts = [
        "let onmessage;",
        computing(),
        script("worker.js"),
        formatter(),
        READING,
    ]
    (folder / "run.cjs").write_text("\n".join(parts))
    known = (
        subprocess.run([NODE, RELAXED, "-e", "0"], capture_output=True).returncode == 0
    )
    command = [
        NODE,
        *([RELAXED] if known else []),
        folder / "run.cjs",
        folder / "in.json",
    ]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def check_all(motions: MotionSet, settings, said) -> Assessment:
    """The page's figures and words are those of the package for the same object, which come back."""
    request = make_request(settings, "form")
    found = assess_with(request, motions.at(request.place), holders=False)
    assert "answer" in said, (settings, said)
    check_figures(found, said["answer"])
    assert (said["early"] is not None) == found.motions.both
    if early := said["early"]:  # the first counts are final, and no more than is known
        assert early["counts"] == said["answer"]["counts"]
        assert early["probabilityValue"] is None
    if said["fixed"] is not None:
        # what a slider or choice changes has the numbers of the answer
        (own, *others), name = found.by_arrangement.values(), "fraction"
        if found.probability is not None:
            name = "probability"
        # before other ways of a kind of its own
        assert [each[name] for each in said["fixed"]] == others[: len(said["fixed"])]
        assert own == said["answer"][name]["value"]
    # the first screen is the same, and what stands behind it, but for what the page leaves out
    assert same(said["first"], [as_data(each) for each in first_screen(found)])
    behind = {title.id: findings for title, findings in details(found).items()}
    told = {title["id"]: findings for title, findings in said["details"]}
    assert list(told) == list(behind)
    for title in ("title_level", "title_years", "title_position", "title_helps"):
        assert same(told[title], [as_data(each) for each in behind[title]]), title
    return found


def same(mine, his) -> bool:
    """Whether findings are the same, to the bit; a number that is none is null in a page."""
    if isinstance(mine, dict) and "number" in mine:
        number = his["number"] if np.isfinite(his["number"]) else None
        return mine["number"] == number and mine["form"] == his["form"]
    if isinstance(mine, dict):
        return mine.keys() == his.keys() and all(same(mine[k], his[k]) for k in mine)
    if isinstance(mine, list):
        return len(mine) == len(his) and all(map(same, mine, his))
    return mine == his


def check_figures(found: Assessment, answer) -> None:
    """The same fractions, estimates and effects of changes, to the bit."""
    assert answer["shares"] == found.outcomes.fractions().tolist()
    assert answer["counts"] == (None if found.counts is None else list(found.counts))
    for name in ("fraction", "rocking", "probability"):
        own, estimate = answer.get(name), getattr(found, name)
        assert (own is None) == (estimate is None)
        for key in ("value", "lower", "upper") if own else ():
            assert own[key] == getattr(estimate, key), (name, key)
        if own:
            assert own["sources"] == dict(estimate.sources)
    finite = [(item.value, item.factor) for item in found.mitigations]
    his = [
        [each if np.isfinite(each) else None for each in values] for values in finite
    ]
    mine = [[item["value"], item["factor"]] for item in answer["mitigations"]]
    assert mine == his
