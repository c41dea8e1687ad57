"""The list of objects after an earthquake, to be printed and ticked off: lines, a page, a table and JSON.

In: :class:`rockfrag.aftermath.shaken_objects.ShakenCollection`. Words are those of the catalogue of a language.
"""

import json
import math
import os
from collections.abc import Sequence
from pathlib import Path

from jinja2 import Environment, PackageLoader, StrictUndefined, select_autoescape
from markupsafe import Markup

from rockfrag import __version__
from rockfrag.aftermath.shaken_ground import GroundShaking
from rockfrag.aftermath.shaken_objects import (
    ShakenCollection,
    ShakenObject,
    shaken_table,
)
from rockfrag.base.files import write_table, write_text
from rockfrag.report.page import TEMPLATES, framed, in_a_page
from rockfrag.words.catalogue import FIRST, Catalogue, catalogue
from rockfrag.words.findings import Finding, finding, percent, two

_TEMPLATES = Environment(
    loader=PackageLoader("rockfrag.aftermath", ""),
    autoescape=select_autoescape(default=True),
    undefined=StrictUndefined,
    trim_blocks=True,
    lstrip_blocks=True,
    finalize=in_a_page,
)


def write_after(
    collection: ShakenCollection,
    folder: str | os.PathLike[str],
    language: str = FIRST,
) -> Path:
    """Write ``after.html``, ``after.csv`` and ``after.json`` into a folder.

    Parameters
    ----------
    collection : the objects after the earthquake
    folder, language : where files go, and the language of the page

    Returns
    -------
    Path of the page.
    """
    place = Path(folder) / "after.html"
    write_table(shaken_table(collection), place.with_suffix(".csv"))
    write_text(after_json(collection), place.with_suffix(".json"))
    write_text(after_page(collection, language), place)
    return place


def after_lines(collection: ShakenCollection, language: str = FIRST) -> list[str]:
    """Say the answer, then a line an object.

    Parameters
    ----------
    collection, language : the objects after the earthquake, and the language

    Returns
    -------
    The lines.
    """
    texts = catalogue(language)
    longest = max(len(each.request.name) for each in collection.objects)
    lines = texts.lines(_answer(collection))
    for rank, each in enumerate(collection.objects, start=1):
        said = finding(
            "after_line",
            fell=percent(each.fell),
            moved=percent(each.moved),
            look=finding(each.what_to_do),
            where=each.request.where,
        )
        lines.append(f"{rank:4d}  {each.request.name:<{longest}}  {texts.say(said)}")
    return lines


def after_json(collection: ShakenCollection) -> str:
    """Return all numbers as JSON; what is not known is null.

    Parameters
    ----------
    collection : the objects after the earthquake

    Returns
    -------
    JSON.
    """
    table = shaken_table(collection)
    answer = {
        "rockfrag": __version__,
        "expected_falls": collection.expected_falls,
        "ground": [_ground_data(each.ground) for each in collection.objects],
        "ground_then": [_ground_data(each.ground_then) for each in collection.objects],
        "objects": json.loads(table.to_json(orient="records", double_precision=15)),
        "beyond_the_map": list(collection.beyond),
        "beyond_the_second_map": list(collection.then_beyond),
        "faults": list(collection.faults),
        "said": catalogue().lines(_answer(collection)),
    }
    return json.dumps(answer, indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def _ground_data(ground: GroundShaking | None) -> dict[str, object] | None:
    """The shaking of a place as JSON writes it: a number that is not known is null; null where none is known."""
    if ground is None:
        return None
    numbers = {
        name: None if math.isnan(value) else value
        for name, value in vars(ground).items()
        if name != "source"
    }
    return {**numbers, "source": catalogue().say(ground.source)}


def _answer(collection: ShakenCollection) -> list[Finding]:
    """What is said first: whom to look at, how many fell, by what shaking."""
    objects = collection.objects
    first = [each for each in objects if each.what_to_do == "after_look_first"]
    said = [finding("after_none_first")]
    if first:
        said = [finding("after_first", name=first[0].request.name, n=len(first))]
    expected, count = two(collection.expected_falls), len(objects)
    said.append(finding("after_expected", expected=expected, count=count))
    said.append(_ground_said([each.ground for each in objects]))
    again = [each.ground_then for each in objects if each.ground_then is not None]
    if again:
        said.append(finding("after_then", shaking=_ground_said(again)))
    if collection.beyond:
        said.append(_beyond_said("after_beyond", collection.beyond))
    if collection.then_beyond:
        said.append(_beyond_said("after_then_beyond", collection.then_beyond))
    if collection.faults:
        said.append(finding("after_faults", n=len(collection.faults)))
    return said


def _beyond_said(text: str, names: Sequence[str]) -> Finding:
    return finding(text, n=len(names), names=", ".join(names[:5]))


def _ground_said(grounds: Sequence[GroundShaking]) -> Finding:
    """The shaking of places, from the weakest to the strongest, in the measure that is known of most."""
    measures = {
        "PGA": ("g", [(each.pga, each.pga_spread) for each in grounds]),
        "PGV": ("cm/s", [(each.pgv, each.pgv_spread) for each in grounds]),
    }
    known = {
        name: [each for each in places if math.isfinite(each[0])]
        for name, (_, places) in measures.items()
    }
    name = max(known, key=lambda each: len(known[each]))
    values, spreads = zip(*known[name], strict=True)
    text = "after_shaking" if max(values) > min(values) else "after_shaking_one"
    if text == "after_shaking_one" and not max(spreads):
        text = "after_shaking_exact"
    return finding(
        text,
        source=grounds[0].source,
        measure=name,
        unit=measures[name][0],
        low=two(min(values)),
        high=two(max(values)),
        # one standard deviation of ln as a factor up and down, where it is known least
        factor=two(math.exp(max(spreads))),
    )


def after_page(collection: ShakenCollection, language: str = FIRST) -> str:
    """Return the page as HTML, which loads nothing from outside.

    Parameters
    ----------
    collection, language : the objects after the earthquake, and the language

    Returns
    -------
    HTML.
    """
    texts = catalogue(language)
    count = len(collection.objects)
    recorded = any(each.under_record for each in collection.objects)
    head = [
        (texts.text("after_column_done"), "short"),
        (texts.text("after_column_object"), "short"),
        (texts.text("after_column_fell"), "number"),
        (texts.text("after_column_moved"), "number"),
        (texts.text("after_column_look"), "short"),
        (texts.text("after_column_seen"), "short"),
    ]
    rows = [
        _row(rank, each, texts) for rank, each in enumerate(collection.objects, start=1)
    ]
    if recorded:
        head.insert(4, (texts.text("after_column_record"), "short"))
        for row, each in zip(rows, collection.objects, strict=True):
            row.insert(4, texts.say(_under_record(each)))
    return _TEMPLATES.get_template("check_list.html.j2").render(
        language=texts.language,
        title=texts.say(finding("after_title", n=count)),
        answer=texts.lines(_answer(collection)),
        left_out=collection.faults,
        how=[texts.text("after_how"), texts.text(_left_out(collection))],
        style=Markup(TEMPLATES.get_template("style.css").render()),
        table=framed(texts.text("after_caption"), head, rows, 5),
        note=texts.text("after_note"),
        made=f"rockfrag {__version__}",
    )


def _left_out(collection: ShakenCollection) -> str:
    """Text of what the list says nothing about; of aftershocks only where none was given."""
    then = any(each.then is not None for each in collection.objects)
    return "after_without_then" if then else "after_without"


def _under_record(each: ShakenObject) -> Finding:
    """What the record does to an object, and where it leaves one that rocked."""
    if each.left is None:
        return finding(each.under_record)
    return finding(
        "after_record_left",
        turned=two(each.left.turned_deg),
        moved=two(each.left.moved_cm),
    )


_BOX = Markup('<input type="checkbox" aria-label="{}">')
_ROW_NAME = Markup("<div><strong>{}</strong><br><small>{}</small></div>")


def _row(rank: int, each: ShakenObject, texts: Catalogue) -> list[str | Markup]:
    """Cells of an object, with boxes to tick."""
    name = each.request.name
    seen = ("after_seen_fell", "after_seen_moved", "after_seen_stands")
    boxes = Markup(" ").join(
        Markup("<label>{} {}</label>").format(_BOX.format(name), texts.text(id))
        for id in seen
    )
    return [
        Markup("<div>{} {}</div>").format(_BOX.format(name), rank),
        _ROW_NAME.format(name, texts.say(each.request.where)),
        texts.say(percent(each.fell)),
        texts.say(percent(each.moved)),
        texts.text(each.what_to_do),
        Markup("<div>{}</div>").format(boxes),
    ]
