"""The bodies of a study: a table of blocks and a table of which block stands on which."""

import os
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from rockfrag.errors import InputError
from rockfrag.files import distinct_file_names, file_name
from rockfrag.plausibility import check_density
from rockfrag.rocking.measured_restitution import (
    Law,
    Measured,
    MeasuredRestitution,
    Restitution,
)
from rockfrag.rocking.options import FrictionInput, system_of
from rockfrag.system.blocks import Block, Body, stacked
from rockfrag.system.system import System
from rockfrag.tabular import Row, read_rows


@dataclass(frozen=True)
class Configuration:
    """One arrangement to be tested: an object alone, or an object on a pedestal.

    Attributes
    ----------
    name
        Its name in tables, for example ``P&T1``.
    object, pedestal
        Names of the blocks; ``pedestal`` is empty where the object stands on the ground, and names all blocks
        under it, from above, as ``base|plinth``.
    body
        What the mechanics see.
    restitution
        What was measured of its impacts, as :func:`rockfrag.rocking.simulate` takes it; None conserves momentum.
    friction
        Coefficients of friction, as :func:`rockfrag.rocking.simulate` takes them; None where nothing slides.
    counterpart
        Name of the arrangement that it is compared with; empty for its object alone on the floor.
    """

    name: str
    object: str
    pedestal: str
    body: Body
    restitution: Restitution = None
    friction: FrictionInput | None = None
    counterpart: str = ""

    @property
    def label(self) -> str:
        """``P`` with and ``NP`` without a pedestal."""
        return "P" if self.pedestal else "NP"

    @property
    def statue(self) -> Block:
        """The object's block."""
        return self.body.blocks[-1]

    @property
    def system(self) -> System:
        """What is shaken: the body with its contacts."""
        return system_of(self.body, self.friction, self.restitution)

    @property
    def fallen_names(self) -> tuple[str, ...]:
        """What tables call the body that fell, by its number in outcomes."""
        if len(self.below) > 1:
            return ("", *reversed(self.below), self.object)
        return ("", "pedestal", "statue") if self.pedestal else ("", "statue")

    @property
    def below(self) -> tuple[str, ...]:
        """Names of the blocks under the object, from above."""
        return names_from_above(self.pedestal)

    @property
    def slug(self) -> str:
        """The name as a file name."""
        return file_name(self.name)


def read_specimens(path: str | os.PathLike[str]) -> dict[str, Block]:
    """Read a table of blocks.

    Columns: ``name``, ``width_m``, ``height_m``, ``mass_kg`` and, where the block is not a uniform
    rectangle, ``inertia_kg_m2`` (about the centre of gravity), ``cg_height_m`` and ``cg_offset_m``.
    Any other unit may stand in the name of a column (``width_cm``, ``mass_g``), or beside each number
    where the name has none.

    Raises
    ------
    InputError
        If the file, a column or a cell is not as expected, a name is given twice, or a block cannot
        be of any solid.
    """
    shape = ("inertia_kg_m2", "cg_height_m", "cg_offset_m")
    needed = ("width_m", "height_m", "mass_kg")
    rows = read_rows(path, ["name", *needed], shape, quantities=(*needed, *shape))
    blocks: dict[str, Block] = {}
    checked: dict[str, str] = {}
    for row in rows:
        name = row.text("name")
        if name in blocks:
            raise row.error("name", f"{name} is given twice")
        try:
            distinct_file_names([name], checked)
        except InputError as error:
            raise row.error("name", str(error)) from None
        blocks[name] = _block(row)
    return blocks


def _block(row: Row) -> Block:
    values: dict[str, Any] = {
        "width": row.positive_quantity("width_m"),
        "height": row.positive_quantity("height_m"),
        "mass": row.positive_quantity("mass_kg"),
    }
    if row.has("inertia_kg_m2"):
        values["inertia"] = row.positive_quantity("inertia_kg_m2")
    if row.has("cg_height_m"):
        values["cg_height"] = row.positive_quantity("cg_height_m")
    if row.has("cg_offset_m"):
        values["cg_offset"] = row.quantity("cg_offset_m")
    try:
        check_density(values["width"], values["height"], values["mass"])
        return Block(**values)
    except InputError as error:
        raise InputError(f"{row.path}, line {row.line}: {error}") from error


def read_configurations(
    path: str | os.PathLike[str], blocks: dict[str, Block]
) -> list[Configuration]:
    """Read which block stands on which.

    Columns: ``name``, ``object`` and ``pedestal``, which is empty or absent where there is none. Several
    blocks under an object are named from above, ``base|plinth``; they may stand behind the object too,
    ``venus|base|plinth``. ``counterpart`` names the arrangement with which one is compared, where that is not its
    object alone.

    Raises
    ------
    InputError
        If the file or a cell is not as expected, a name is given twice, a block is not known, or
        the object does not fit on the pedestal, or a counterpart is no other arrangement of the table.
    """
    found: dict[str, Configuration] = {}
    checked: dict[str, str] = {}
    rows = read_rows(path, ["name", "object"], ["pedestal", "counterpart"])
    names = {row.cells["name"] for row in rows}
    for row in rows:
        name = row.text("name")
        object_name, *behind = names_from_above(row.text("object")) or ("",)
        under = names_from_above(row.cells.get("pedestal", ""))
        if behind and under:
            raise row.error("pedestal", "what stands under the object is named behind it already")
        below = tuple(behind) or under
        for column, block in (("object", object_name), *(("pedestal", one) for one in below)):
            if block not in blocks:
                known = ", ".join(blocks)
                raise row.error(column, f"expected one of the specimens {known}, found {block}")
        if name in found:
            raise row.error("name", f"{name} is given twice")
        try:
            body = stacked([blocks[one] for one in (*reversed(below), object_name)])
            distinct_file_names([name], checked)
        except InputError as error:
            raise InputError(f"{row.path}, line {row.line}: {error}") from error
        counterpart = row.cells.get("counterpart", "")
        if counterpart and counterpart not in names - {name}:
            raise row.error("counterpart", f"expected another arrangement, found {counterpart}")
        pedestal = "|".join(below)
        found[name] = Configuration(name, object_name, pedestal, body, counterpart=counterpart)
    return list(found.values())


def names_from_above(text: str) -> tuple[str, ...]:
    """Names in a cell that are separated by upright bars."""
    return tuple(name.strip() for name in text.split("|")) if text.strip() else ()


def each_alone(blocks: dict[str, Block]) -> list[Configuration]:
    """Every block as an object that stands alone."""
    return [Configuration(name, name, "", block) for name, block in blocks.items()]


def with_restitution(
    configuration: Configuration, measured: Mapping[str, Measured], law: Law
) -> Configuration:
    """Return a configuration whose blocks come off impacts as was measured of each alone.

    Parameters
    ----------
    measured
        Ratio of angular velocities [-], or two of impacts that end on the right and on the left corner, by block;
        a block that is not named conserves momentum.
    law
        How a stack follows it.

    Raises
    ------
    InputError
        If a block would gain energy.
    """
    each = [measured.get(name) for name in (*reversed(configuration.below), configuration.object)]
    if all(one is None for one in each):
        return configuration
    value = tuple(each) if configuration.pedestal else each[0]
    restitution = MeasuredRestitution(value, law)  # type: ignore[arg-type]
    system_of(configuration.body, restitution=restitution)
    return replace(configuration, restitution=restitution)


def with_friction(
    configuration: Configuration, content: float | Mapping[str, Any]
) -> Configuration:
    """Return a configuration whose contacts have the friction that a study states.

    Parameters
    ----------
    content
        A coefficient [-] of all contacts, or a mapping with ``ground`` and ``interface``, each a coefficient or
        a mapping with ``static`` and ``kinetic``; a lone object has the friction of the ground.

    Raises
    ------
    InputError
        If a static coefficient is less than the kinetic one.
    """
    each = (
        [content["ground"], content["interface"]] if isinstance(content, Mapping) else [content] * 2
    )
    ground, interface = (
        (one["static"], one["kinetic"]) if isinstance(one, Mapping) else one for one in each
    )
    friction: dict[str, Any] = {"ground": ground}
    if configuration.pedestal:
        friction["interface"] = interface
    system_of(configuration.body, friction)
    return replace(configuration, friction=friction)
