"""The fields of the page's form, from the schema that makes the command line's options.

A key of ``statue.yaml`` with ``form`` in the schema has a field, in the group that it names.

In: ``schema.json``. Out: fields, as the page draws and reads them. Docs: ``docs/app.md``.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from rockfrag.assess import standing
from rockfrag.base.units import dimension_of, split_name
from rockfrag.config.schema import read_schema
from rockfrag.motions.intensity import IntensityMeasure

GROUPS = ("object", "more", "pedestal", "place", "shaking")
"""Groups of fields, in the order in which they stand."""


@dataclass(frozen=True)
class Field:
    """A field of the form.

    Attributes
    ----------
    name : its name, which is that of its text
    group : the group in which it stands
    kind : ``text``, ``lines``, ``flag``, ``choice``, ``number`` or ``quantity``
    key : where ``statue.yaml`` has it; empty where other keys follow from it
    dimension : of a quantity
    positive : whether a quantity is above 0
    limits : of a number
    options : of a choice
    """

    name: str
    group: str
    kind: str
    key: tuple[str, ...] = ()
    dimension: str = ""
    positive: bool = False
    limits: tuple[float, float] | None = None
    options: tuple[str, ...] = ()


def form_fields(measures: Iterable[IntensityMeasure]) -> list[Field]:
    """Return the fields of the form in their order.

    Parameters
    ----------
    measures : in which a level or a hazard may be given

    Returns
    -------
    The fields.
    """
    names = tuple(measure.imt for measure in measures)
    measure = Field("measure", "shaking", "choice", options=names)
    found = [*_of_schema(), measure, Field("level", "shaking", "text")]
    found.append(Field("hazard", "shaking", "lines"))
    order = ("measure", "level", "years", "hazard")
    places = {name: place for place, name in enumerate(order)}
    return sorted(
        found, key=lambda one: (GROUPS.index(one.group), places.get(one.name, 0))
    )


def _of_schema() -> Iterator[Field]:
    """The fields that keys of the schema have, as they come."""
    statue = read_schema("statue")["properties"]
    homes = {
        (): statue,
        ("pedestal",): statue["pedestal"]["properties"],
        ("building",): read_schema("known_of_building")["properties"],
    }
    for home, properties in homes.items():
        for key, about in properties.items():
            if "form" in about:
                yield _field(home, key, about)


def _field(home: tuple[str, ...], key: str, about: Mapping[str, Any]) -> Field:
    """The field of a key.

    Parameters
    ----------
    home : keys of the mapping in which the key stands
    key, about : the key, and what the schema says of it

    Returns
    -------
    The field.
    """
    form, dimension = about["form"], about["form"].get("dimension", "")
    plain = key
    if about.get("quantity"):
        plain, unit = split_name(key)
        dimension = dimension_of(unit)
    prefix = "pedestal_" if home == ("pedestal",) else ""
    name, group = form.get("name", f"{prefix}{plain}"), form["group"]
    whole = (*home, form.get("key", plain))
    if dimension:
        positive = about.get("minimum", about.get("exclusiveMinimum", -1)) >= 0
        return Field(
            name, group, "quantity", whole, dimension=dimension, positive=positive
        )
    if whole == ("stands",):
        return Field(name, group, "choice", whole, options=("", *standing.options()))
    if "enum" in about:
        return Field(name, group, "choice", whole, options=tuple(about["enum"]))
    if about["type"] == "boolean":
        return Field(name, group, "flag", whole)
    if about["type"] == "number":
        # just below a least value that is allowed itself
        least = about.get("exclusiveMinimum", about.get("minimum", 0) - 1e-300)
        return Field(name, group, "number", whole, limits=(least, about["maximum"]))
    return Field(name, group, "text", whole)
