"""A gallery: many objects, one line each, the one most at risk first, and what they risk together.

All objects are shaken by the same ground motions, scaled to the same level, so that what topples together in an
earthquake is counted and not assumed.  Rates follow from fractions of motions and the hazard as those of one
object do (:mod:`rockfrag.assess.risk`).

In: a table of objects and motions. Out: a line an object, and what topples together.
Docs: ``docs/assess.md``, "A gallery".
"""

import math
import os
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import pandas as pd

from rockfrag.assess.answer import (
    RECORDS,
    Assessment,
    assessed,
    check_motions,
    plan_for,
    shake_all,
)
from rockfrag.assess.core.decisions import Action
from rockfrag.assess.core.likelihood import likelihood_of
from rockfrag.assess.findings import (
    estimate_of,
    few_earthquakes,
    many_lean,
    mitigation,
)
from rockfrag.assess.joint_risk import JointRisk, joint_risk
from rockfrag.assess.mitigations import Mitigation
from rockfrag.assess.motions import MotionSet, motion_set
from rockfrag.assess.page_list import KEYS_OF_SHAKING, is_page_list, read_page_list
from rockfrag.assess.request import Request, make_request
from rockfrag.assess.texts import Text
from rockfrag.base.errors import InputError
from rockfrag.base.files import check_name, file_name
from rockfrag.base.plausible import LARGEST_SIZE
from rockfrag.base.tabular import Row, read_rows
from rockfrag.collections.exported_table import (
    inventory_cells,
    is_export,
    read_export,
)
from rockfrag.runtime.progress import Progress
from rockfrag.words.catalogue import FIRST, catalogue
from rockfrag.words.findings import (
    Finding,
    Value,
    finding,
    limit,
    listed,
    percent,
    three,
    two,
    whole,
)

SIZES = ("width_m", "height_m", "depth_m", "mass_kg", "cg_height_m")
HELD_BY = (
    *("wall_m", "wall_height_m", "putty_n", "bracket_n", "bracket_slack_m"),
    *("cord_n", "cord_slack_m", "isolator_m", "isolator_radius_m"),
    *("isolator_stiffness_n_m", "isolator_strength_n", "isolator_yield_m"),
)
"""Lengths, strengths and stiffness of what holds it."""
PEDESTAL = (
    "pedestal_width_m",
    "pedestal_height_m",
    "pedestal_depth_m",
    "pedestal_mass_kg",
)
COORDINATES = {"latitude": 90, "longitude": 360}
"""Columns of coordinates [degrees], with the largest that they hold."""

# What says whether a base is round
YES, NO = ("yes", "true", "1", "x"), ("no", "false", "0")

MOST_OBJECTS = 10_000  # Rows of an inventory
SMALLEST_SIZE = 0.005  # Of an object in a list [m]
AT_ONCE = 50  # Objects that are shaken before it is said how many are done
# Rows up to which what may hold an object is tried, which takes seconds for each
MOST_HELD = 5


@dataclass(frozen=True, eq=False)
class Inventory:
    """Objects of an inventory, assessed."""

    found: Sequence[Assessment]  # Assessments, the one most at risk first
    motions: MotionSet  # The motions on the ground that they share
    joint: JointRisk | None = None  # What topples together; None without a hazard
    # What is wrong with the rows that were left out, a sentence each
    faults: Sequence[str] = ()


class FaultyRows(InputError):
    """Rows of an inventory that cannot be used, with what is wrong with each, a sentence."""

    def __init__(self, faults: Sequence[str]) -> None:
        more = f" ({len(faults)} rows are wrong in all)" if len(faults) > 1 else ""
        super().__init__(f"{faults[0].rstrip('.')}{more}.")
        self.faults = tuple(faults)


def assess_inventory(
    path: str | os.PathLike[str],
    shared: Mapping[str, Any] | None = None,
    records: str | Path = RECORDS,
    *,
    keep_going: bool = False,
    order: str = "",
    progress: Progress | None = None,
) -> Inventory:
    """Assess every object of a table, whose columns ``docs/assess.md`` lists.

    Parameters
    ----------
    path : of the table, which may be a museum's
    shared : what holds for all, with the keys of ``statue.yaml``
    records : folder of fetched records
    keep_going : whether :class:`FaultyRows` is raised only if no row can be used
    order : of lengths that a museum's table does not name, such as ``HWD``
    progress : called with the number of objects done and of all

    Returns
    -------
    The objects with their answers, and what is wrong with the other rows.
    """
    requests, faults = read_inventory(path, shared or {}, order=order)
    check_rows(requests, faults, keep_going)
    motions = motion_set(requests[0].records, requests[0].place, Path(records))
    requests = _held_as_simulated(requests, motions, faults)
    check_rows(requests, faults, keep_going)
    found = assess_each(requests, motions, progress)
    joint = joint_risk(found)
    losses: dict[Any, float] = {}
    if joint is not None:
        losses = joint.objects.set_index("name")["annual_loss"].to_dict()

    def risk(each: Assessment) -> tuple[float, ...]:
        """Loss, probability, fraction, and how little topples half of the motions."""
        estimates = (each.probability, each.fraction)
        known = [estimate.value if estimate else 0.0 for estimate in estimates]
        return losses.get(each.request.name, 0.0), *known, -each.amplitudes[0.5].value

    found.sort(key=risk, reverse=True)
    return Inventory(found, motions, joint, faults)


def check_rows(
    requests: Sequence[Request], faults: Sequence[str], keep_going: bool
) -> None:
    """Raise what is wrong with rows of an inventory, unless the others are listed without them.

    Parameters
    ----------
    requests, faults : what can be used, and what is wrong with the other rows, a sentence each
    keep_going : whether the others are listed without them

    Raises
    ------
    FaultyRows
        If rows are wrong and they are not left out, or nothing can be used.
    """
    if faults and not (keep_going and requests):
        raise FaultyRows(faults)


def _held_as_simulated(
    requests: Sequence[Request], motions: MotionSet, faults: list[str]
) -> list[Request]:
    """Leave out objects that are not simulated under the motions as they are held; why goes to ``faults``."""
    kept: list[Request] = []
    for request in requests:
        try:
            check_motions(request.objects, motions)
            kept.append(request)
        except InputError as error:
            faults.append(f"{request.name}: {error}")
    return kept


def assess_each(
    requests: Sequence[Request],
    motions: MotionSet,
    progress: Progress | None = None,
) -> list[Assessment]:
    """Assess objects, those in places that shake alike at once, each at its own level.

    One object at two levels is shaken once.

    Parameters
    ----------
    requests, motions : the objects, and the ground motions by which they are shaken
    progress : called with the number of objects done and of all

    Returns
    -------
    An assessment each, in their order.

    Raises
    ------
    FaultyRows
        If an object is not simulated under the motions as it is held.
    """
    faults: list[str] = []
    _held_as_simulated(requests, motions, faults)
    check_rows(requests, faults, keep_going=False)
    groups: dict[object, list[int]] = {}
    for i, request in enumerate(requests):
        about, level = request.objects, request.level
        kind = request.place.key, type(about), about.in_space, about.many
        # of several curves the one that counts may differ from object to object
        alone = request.name if len(request.hazard) > 2 else ""
        measure = level and level.measure
        groups.setdefault((*kind, alone, measure), []).append(i)
    found: dict[int, Assessment] = {}
    holds = len(requests) <= MOST_HELD and any(each.costs for each in requests)
    for rows in groups.values():
        first = requests[rows[0]]
        plan = plan_for(first, motions.at(first.place), brief=True, holds=holds)
        at_levels: dict[int, list[int]] = {}
        for i in rows:
            at_levels.setdefault(id(requests[i].objects), []).append(i)
        each = list(at_levels.values())
        for start in range(0, len(each), AT_ONCE):
            part = each[start : start + AT_ONCE]
            said = None
            if progress is not None:
                counts = (len(found), sum(map(len, part)), len(requests))
                said = partial(_say_part, progress, counts)
            shaken = shake_all([requests[places[0]] for places in part], plan, said)
            for places, outcome in zip(part, shaken, strict=True):
                for i in places:
                    # a level between those that were tried lies between their fractions
                    level = requests[i].level
                    own = plan if level is None else replace(plan, level=level)
                    found[i] = assessed(requests[i], own, outcome)
    return [found[i] for i in range(len(requests))]


def _say_part(progress: Progress, counts: tuple[int, int, int], part: float) -> None:
    """Say how many objects are done of all, where a part of those that are shaken at once is."""
    before, now, total = counts
    progress(before + part * now, total)


def read_inventory(
    path: str | os.PathLike[str],
    shared: Mapping[str, Any],
    *,
    also: Sequence[str] = (),
    order: str = "",
    cells: dict[str, Mapping[str, str]] | None = None,
) -> tuple[list[Request], list[str]]:
    """Read the objects of a table: those that can be used, and what is wrong with the others.

    Parameters
    ----------
    path : the table
    shared : keys of ``statue.yaml`` that hold for all
    also : columns that it may have beside those of an inventory
    order : of lengths that a museum's table does not name, such as ``HWD``
    cells : takes the cells of each row, by the name of its object

    Returns
    -------
    The objects, and a sentence on each row that was left out.
    """
    if "friction" in shared:
        raise InputError("key friction: sliding takes long; assess the object alone.")
    faults: list[str] = []
    if is_page_list(path):
        return _of_the_page(path, shared, faults), faults
    if is_export(path):
        rows = _exported_rows(path, order, faults)
    else:
        others = [*SIZES[2:], *PEDESTAL, *HELD_BY, *OTHERS, *also]
        needed, quantities = ["name", *SIZES[:2]], (*SIZES, *PEDESTAL, *HELD_BY)
        rows = read_rows(path, needed, others, quantities=quantities, faults=faults)
    if len(rows) > MOST_OBJECTS:
        raise InputError(
            f"{path}: {len(rows)} objects are more than the {MOST_OBJECTS} allowed; --coarse takes them all."
        )
    requests: list[Request] = []
    taken = dict(NAMES_TAKEN)
    for row in rows:
        try:
            name = _own_name(row, taken)
            requests.append(_request(row, name, shared))
            if cells is not None:
                cells[name] = row.cells
        except InputError as error:
            faults.append(str(error))
    without = [request.name for request in requests if math.isnan(request.value)]
    if without and len(without) < len(requests):
        raise InputError(
            f"{path}: {without[0]} has no value; give that of all objects or of none."
        )
    return requests, faults


NAMES_TAKEN = {"inventory": "the page of the gallery"}
"""Names of files that no object may have, and what they are of."""


def _of_the_page(
    path: str | os.PathLike[str], shared: Mapping[str, Any], faults: list[str]
) -> list[Request]:
    """Requests of a list that the page saved; what is wrong with other rows goes to ``faults``."""
    listed = read_page_list(path)
    stated = {*KEYS_OF_SHAKING} & {*shared}
    if stated:
        raise InputError(
            f"key {min(stated)}: {path} was saved by the page and says its shaking itself; leave it out."
        )
    requests: list[Request] = []
    taken = dict(NAMES_TAKEN)
    for each in listed.objects:
        row = Row(str(path), each.line, {"name": each.name})
        try:
            own = {**each.settings, "name": _own_name(row, taken)}
            request = _request_of(own, shared, f"{path}, line {each.line}")
        except InputError as error:
            faults.append(str(error))
            continue
        if listed.hazard is not None:
            request = replace(request, hazard=(listed.hazard,))
        requests.append(request)
    return requests


def _exported_rows(
    path: str | os.PathLike[str], order: str, faults: list[str]
) -> list[Row]:
    """Rows of a museum's table that say all that is needed; what has to be asked of others goes to ``faults``."""
    rows = []
    for collected in read_export(path, order):
        if collected.question:
            where = f"{path}, line {collected.line}, {collected.name}"
            faults.append(f"{where}: {collected.question}.")
            continue
        rows.append(Row(str(path), collected.line, inventory_cells(collected)))
    return rows


def _own_name(row: Row, taken: dict[str, str]) -> str:
    """The name of a row's object, which no row above bears and which gives a file name of its own."""
    name = row.text("name")
    try:
        check_name(name)
    except InputError as error:
        raise row.error("name", str(error)) from None
    # where case is ignored too
    place = file_name(name).casefold()
    if place in taken:
        same = (
            "is there twice"
            if taken[place] == name
            else f"and {taken[place]!r} give one file name"
        )
        raise row.error("name", f"object {name!r} {same}; give each its own name")
    taken[place] = name
    return name


def _request(row: Row, name: str, shared: Mapping[str, Any]) -> Request:
    """What a row of an inventory asks, with what all rows share."""
    own: dict[str, Any] = {"name": name}
    own |= {key: row.quantity(key, above=0) for key in SIZES if row.has(key)}
    own |= {key: row.quantity(key) for key in HELD_BY if row.has(key)}
    pedestals = _pedestals(row)
    if pedestals:
        own["pedestal"] = pedestals if len(pedestals) > 1 else pedestals[0]
    own |= {key: read(row, key) for key, read in OTHERS.items() if row.has(key)}
    worth, place = own.pop("value", math.nan), _coordinates(row, own)
    request = _request_of(own, shared, f"{row.path}, line {row.line}")
    return replace(request, value=worth, coordinates=place)


def _request_of(
    own: Mapping[str, Any], shared: Mapping[str, Any], where: str
) -> Request:
    """The request of keys of a row and of all rows; messages name columns."""
    try:
        request = make_request({**shared, **own}, where)
        _check_size(request, where)
        return request
    except InputError as error:
        # columns instead of keys, of what stands in the row
        words = re.sub(rf"\bkey ({'|'.join(own)})\b", r"column \1", str(error))
        words = re.sub(r"column pedestal(\[\d+\])?\.", "column pedestal_", words)
        raise InputError(words) from None


def _coordinates(row: Row, own: dict[str, Any]) -> tuple[float, float] | None:
    """Take latitude and longitude [degrees] of a row out of what is known of its object; None without them."""
    given = [key for key in COORDINATES if key in own]
    if not given:
        return None
    for key, largest in COORDINATES.items():
        if key not in own:
            raise row.error(key, "expected degrees, as the other coordinate is given")
        if abs(own[key]) > largest:
            raise row.error(key, f"expected degrees from -{largest} to {largest}")
    return own.pop("latitude"), own.pop("longitude")


def _check_size(request: Request, where: str) -> None:
    """Refuse a size of no object in a collection: one odd row among thousands is not seen."""
    block = request.objects.block
    sides = (block.width, block.height)
    if min(sides) < SMALLEST_SIZE or max(sides) > LARGEST_SIZE:
        raise InputError(
            f"{where}: {request.name} would be {block.width:g} m wide and {block.height:g} m high; check the unit "
            "of its columns, or assess it alone."
        )


def _pedestals(row: Row) -> list[dict[str, float]]:
    """What the object stands on, from above: a cell may hold as many quantities, with bars between them."""
    each = {key: row.cells[key].split("|") for key in PEDESTAL if row.has(key)}
    found: list[dict[str, float]] = [{} for _ in next(iter(each.values()), [])]
    for key, cells in each.items():
        if len(cells) != len(found):
            raise row.error(key, "expected as many pedestals as in the other columns")
        for block, cell in zip(found, cells, strict=True):
            if cell.strip():
                part = replace(row, cells={key: cell.strip()})
                block[key.removeprefix("pedestal_")] = part.quantity(key, above=0)
    return found


def _yes(row: Row, column: str) -> bool:
    """Whether a cell says yes."""
    said = row.text(column).lower()
    if said not in YES + NO:
        raise row.error(column, f"expected yes or no, found {said[:40]!r}")
    return said in YES


_above_0 = partial(Row.number, above=0)
OTHERS: Mapping[str, Callable[[Row, str], Any]] = {
    "floor": Row.text, "restitution": _above_0, "round": _yes, "value": _above_0,
    "latitude": Row.number, "longitude": Row.number,
    "casters": Row.text, "isolator_friction": Row.number,
}  # fmt: skip
"""What else a column may say, and how it is read."""


def inventory_table(inventory: Inventory) -> pd.DataFrame:
    """A row an object: what it is called, where it stands and how it fares."""
    rows = []
    for found in inventory.found:
        row: dict[str, Any] = {
            "name": found.request.name,
            "place": catalogue().say(found.request.where),
        }
        for name, estimate in (
            ("probability", found.probability),
            ("fraction", found.fraction),
            ("fraction_or_leaning", found.leans),
        ):
            if estimate is not None:
                row |= {name: estimate.value, f"{name}_lower": estimate.lower}
                row[f"{name}_upper"] = estimate.upper
        for name, p in (("tenth", 0.1), ("half", 0.5)):
            row[f"{found.measure.column}_{name}"] = found.amplitudes[p].value
        if found.rocking is not None:
            row["fraction_rocking"] = found.rocking.value
        best = best_change(found)
        if best is not None:
            row |= {"best_change": catalogue().say(best.change), "factor": best.factor}
            row |= {"factor_lower": best.lower, "factor_upper": best.upper}
        rows.append(row)
    table = pd.DataFrame(rows)
    return (
        table
        if inventory.joint is None
        else table.merge(inventory.joint.objects, on="name")
    )


def best_change(found: Assessment) -> Mitigation | None:
    """The change that helps an object most; None where none does or none is needed."""
    first = found.mitigations[0] if found.mitigations else None
    return first if first is not None and first.shown and found.main.value > 0 else None


def joint_lines(inventory: Inventory, language: str = FIRST) -> list[str]:
    """What topples together, what is lost, and what helps the object that adds most, a sentence each.

    Parameters
    ----------
    inventory : the objects, assessed
    language : of the texts

    Returns
    -------
    The lines; none where nothing topples together.
    """
    return catalogue(language).lines(joint_findings(inventory))


def joint_findings(inventory: Inventory) -> list[Finding]:
    """The same as findings; none without a hazard."""
    joint, first = inventory.joint, inventory.found[0]
    if joint is None:
        return []
    numbers = listed([_joint_number(row) for row in joint.numbers.to_dict("records")])
    years = three(first.request.years)
    said = [finding(Text.JOINT_NUMBERS, years=years, numbers=numbers)]
    top = joint.objects.iloc[0]
    if math.isfinite(first.request.value):
        loss = three(joint.objects["annual_loss"].sum())
        part = percent(top["contribution"])
        about: dict[str, Value] = {"part": part, "name": str(top["name"])}
        said.append(finding(Text.JOINT_LOSS, loss=loss, **about))
    if best := best_change(first):
        help = mitigation(first, best)
        said.append(finding(Text.JOINT_BEST, name=first.request.name, help=help))
    return said


def _joint_number(row: Mapping[Any, Any]) -> Finding:
    """How probably at least so many topple together."""
    ends = {"lower": "probability_lower", "upper": "probability_upper"}
    limits = {name: limit(row[column]) for name, column in ends.items()}
    p = percent(row["probability"])
    return finding(Text.JOINT_NUMBER, count=whole(row["at_least"]), p=p, **limits)


def inventory_lines(inventory: Inventory, language: str = FIRST) -> list[str]:
    """One line an object, the one most at risk first.

    Parameters
    ----------
    inventory : the objects, assessed
    language : of the texts

    Returns
    -------
    The lines.
    """
    texts = catalogue(language)
    longest = max(len(found.request.name) for found in inventory.found)
    fares = [texts.say(fares_of(found)) for found in inventory.found]
    widest = max(map(len, fares))
    lines = [texts.sentence(_head(inventory))]
    for i, (found, said) in enumerate(
        zip(inventory.found, fares, strict=True), start=1
    ):
        name, place = found.request.name, texts.say(found.request.where)
        half = texts.say(_half(found))
        lines.append(f"{i:4d}  {name:<{longest}}  {said:<{widest}}  {half}, {place}")
    return lines


def _head(inventory: Inventory) -> Finding:
    """First sentence on an inventory: how many objects, and what was asked."""
    first, faults = inventory.found[0], len(inventory.faults)
    left_out = (
        finding(Text.LEFT_OUT, n=faults) if faults else finding(Text.NONE_LEFT_OUT)
    )
    about: dict[str, Value] = {"n": len(inventory.found), "left_out": left_out}
    if first.probability is not None:
        years = three(first.request.years)
        return finding(Text.HEAD_PROBABILITY, years=years, **about)
    if first.level is not None:
        return finding(Text.HEAD_FRACTION, level=first.level.amount, **about)
    return finding(Text.HEAD_AMPLITUDE, **about)


_BRIEFLY = {
    Action.LEAVE: Text.BRIEF_LEAVE,
    Action.SECURE: Text.BRIEF_SECURE,
    Action.MEASURE: Text.BRIEF_MEASURE,
}


def fares_of(found: Assessment) -> Value:
    """How an object fares, for a line of a list: its estimate, and what to do or how likely that is."""
    if found.probability is not None:
        assert found.decision is not None
        advice = _BRIEFLY[found.decision.action]
        if few_earthquakes(found):
            advice = Text.BRIEF_NONE
        chance = estimate_of(found.probability)
        return finding(Text.FARES_YEARS, chance=chance, advice=finding(advice))
    if found.fraction is None:
        return ""
    if found.does_not_move:
        return finding(Text.DOES_NOT_MOVE)
    likelihood = finding(likelihood_of(found.fraction.value).value)
    chance = estimate_of(found.fraction)
    leans = many_lean(found)
    if leans is None:
        return finding(Text.FARES_LIKELY, likelihood=likelihood, chance=chance)
    part = percent(leans)
    return finding(Text.FARES_LEANING, likelihood=likelihood, chance=chance, part=part)


def _half(found: Assessment) -> Finding:
    """The level at which half of the motions topple an object, in words."""
    half = found.amplitudes[0.5].value
    if not math.isfinite(half):
        return finding(Text.HALF_BEYOND)
    amount = finding(Text.QUANTITY, value=two(half), unit=found.measure.unit)
    return finding(Text.HALF_AT, half=amount)
