"""The bodies of a study: a table of blocks and a table of which block stands on which.

In: two CSV files, sizes in any unit. Out: blocks [m, kg] by name, systems, and with what each is compared. Docs:
``config/README.md``; the mechanics: ``docs/rocking.md``.
"""

import os
from collections.abc import Container, Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType
from typing import Any

from rockfrag.base.errors import InputError, errors_of
from rockfrag.base.files import distinct_file_names
from rockfrag.base.plausible import check_density
from rockfrag.base.tabular import Row, read_rows
from rockfrag.laws import law_names
from rockfrag.simulation.options import MeasuredRestitution, system_of
from rockfrag.study import holding
from rockfrag.system.blocks import Block, stacked
from rockfrag.system.support import Support
from rockfrag.system.system import System


def read_specimens(path: str | os.PathLike[str]) -> dict[str, Block]:
    """Read a table of blocks.

    Columns: ``name``, ``width_m``, ``height_m``, ``mass_kg`` and, where the block is not a uniform rectangle,
    ``inertia_kg_m2`` (about the centre of gravity), ``cg_height_m`` and ``cg_offset_m``. Any other unit may stand
    in the name of a column (``width_cm``, ``mass_g``), or beside each number where the name has none.
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
    """The block of a row of specimens."""
    columns = {"width": "width_m", "height": "height_m", "mass": "mass_kg"}
    stated = {"inertia": "inertia_kg_m2", "cg_height": "cg_height_m"}
    columns |= {name: column for name, column in stated.items() if row.has(column)}
    values: dict[str, Any] = {
        key: row.quantity(name, above=0) for key, name in columns.items()
    }
    if row.has("cg_offset_m"):
        values["cg_offset"] = row.quantity("cg_offset_m")
    with errors_of(f"{row.path}, line {row.line}"):
        check_density(values["width"], values["height"], values["mass"])
        return Block(**values)


def read_configurations(
    path: str | os.PathLike[str],
    blocks: Mapping[str, Block],
    isolators: Mapping[str, Support] = MappingProxyType({}),
) -> tuple[list[System], dict[str, str]]:
    """Read which block stands on which; systems have the configurations' names, their bodies those of the blocks.

    Columns: ``name``, ``object`` and ``pedestal``, which is empty or absent where there is none. Several blocks
    under an object are named from above, ``base|plinth``; they may stand behind the object too,
    ``venus|base|plinth``, and the lowest may be an isolator. What holds it stands in the columns of
    :mod:`rockfrag.study.holding`: ``wall_m``, ``putty_n``, ``cord_n_m`` and others. ``counterpart`` is the
    arrangement with which one is compared, where that is not its object alone on the floor.

    Parameters
    ----------
    path : table, a row a configuration
    blocks, isolators : of the study, by name

    Returns
    -------
    The systems, and the name of the counterpart by that of the configuration.
    """
    found: dict[str, System] = {}
    checked: dict[str, str] = {}
    counterparts: dict[str, str] = {}
    rows = read_rows(
        path,
        ["name", "object"],
        ["pedestal", "counterpart", *holding.COLUMNS],
        quantities=holding.QUANTITIES,
    )
    for row in rows:
        name = row.text("name")
        object_name, *behind = names_from_above(row.text("object")) or ("",)
        under = names_from_above(row.cells.get("pedestal", ""))
        if behind and under:
            raise row.error(
                "pedestal", "what stands under the object is named behind it already"
            )
        below = tuple(behind) or under
        isolator = below[-1] if below and below[-1] in isolators else ""
        below = below[:-1] if isolator else below
        known = (*blocks, *isolators)
        _check_block(row, "object", object_name, blocks, known)
        for block in below:
            _check_block(row, "pedestal", block, blocks, known)
        if name in found:
            raise row.error("name", f"{name} is given twice")
        with errors_of(f"{row.path}, line {row.line}"):
            system = configuration_of(name, (*reversed(below), object_name), blocks)
            support = isolators[isolator] if isolator else None
            stated = holding.read_holders(row)
            found[name] = holding.held_as_stated(system, stated, support)
            distinct_file_names([name], checked)
        if row.has("counterpart"):
            other = row.text("counterpart")
            counterparts[name] = other
            if other == name or all(other != row.cells["name"] for row in rows):
                raise row.error(
                    "counterpart", f"expected another arrangement, found {other}"
                )
    return list(found.values()), counterparts


def against_nothing(
    systems: Sequence[System], counterparts: Mapping[str, str]
) -> dict[str, str]:
    """Return counterparts, where something is held each arrangement's: its object alone, which nothing holds.

    Without it several arrangements of one object would be the same test.

    Parameters
    ----------
    systems : of the study, before they have its friction
    counterparts : that are stated, by the name of the arrangement

    Returns
    -------
    The counterparts; where nothing is held those that are stated.
    """
    found = dict(counterparts)
    if not any(map(_is_held, systems)):
        return found
    alone: dict[str, str] = {}
    for system in systems:
        if system.count == 1 and not _is_held(system):
            alone.setdefault(system.names[-1], system.name)
    for system in systems:
        other = alone.get(system.names[-1], system.name)
        if other != system.name:
            found.setdefault(system.name, other)
    return found


def _is_held(system: System) -> bool:
    """Whether anything holds an arrangement, or it stands on casters."""
    return bool(system.holding) or system.loose


def _check_block(
    row: Row, column: str, name: str, blocks: Container[str], known: Sequence[str]
) -> None:
    """Refuse the ``name`` in a column of a row that no block has; ``known`` are those of all specimens."""
    if name not in blocks:
        raise row.error(
            column, f"expected one of the specimens {', '.join(known)}, found {name}"
        )


def names_from_above(text: str) -> tuple[str, ...]:
    """Names in a cell that are separated by upright bars."""
    return tuple(name.strip() for name in text.split("|")) if text.strip() else ()


def configuration_of(
    name: str, names: Sequence[str], blocks: Mapping[str, Block]
) -> System:
    """Return the system of the blocks of these names, from below, whose bodies have these names too."""
    system = stacked([blocks[name] for name in names]).system()
    bodies = (
        replace(body, name=name)
        for body, name in zip(system.bodies, names, strict=True)
    )
    return replace(system, bodies=tuple(bodies), name=name)


def each_alone(blocks: Mapping[str, Block]) -> list[System]:
    """Every block as an object that stands alone."""
    return [configuration_of(name, [name], blocks) for name in blocks]


def with_contacts(
    systems: Sequence[System],
    blocks: Mapping[str, Block],
    content: Mapping[str, Any],
    source: str,
) -> tuple[System, ...]:
    """Return systems whose contacts are as a study's configuration states, which was read from ``source``.

    A block that ``bodies.restitution`` does not name, measured alone, conserves momentum; a stack follows a law.
    """
    found = tuple(systems)
    if (restitution := content["bodies"].get("restitution")) is not None:
        key, measured = f"{source}: key bodies.restitution", restitution["blocks"]
        for name in measured:
            if name not in blocks:
                raise InputError(
                    f"{key}.blocks: expected names of the specimens {', '.join(blocks)}, found {name}."
                )
        law = restitution.get("law", law_names()[0])
        with errors_of(key):
            found = tuple(_with_restitution(system, measured, law) for system in found)
    if (friction := content.get("friction")) is not None:
        with errors_of(f"{source}: key friction"):
            found = tuple(_with_friction(system, friction) for system in found)
    return found


def _with_friction(system: System, friction: Any) -> System:
    """System with the friction of a study; what rolls on free casters goes on rolling."""
    rolling = system.contacts[0].friction
    rubs = system_of(system, _friction(system, friction))
    return rubs if rolling is None else rubs.with_friction(rolling)


def _with_restitution(system: System, measured: Mapping[str, Any], law: str) -> System:
    """System with the measured restitution of its bodies by name, as far as it was measured."""
    each = [measured.get(name) for name in system.names]
    value = each if system.count > 1 else each[0]
    return system_of(system, restitution=MeasuredRestitution(value, law))  # type: ignore[arg-type]


def _friction(system: System, friction: Any) -> Any:
    """Friction of all contacts, or of each; a lone object has that of the ground."""
    if not isinstance(friction, Mapping):
        return friction
    return {
        place: (mu["static"], mu["kinetic"]) if isinstance(mu, Mapping) else mu
        for place, mu in friction.items()
        if place == "ground" or system.count > 1
    }
