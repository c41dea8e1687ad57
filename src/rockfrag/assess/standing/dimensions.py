"""Sizes of an object and of what it stands on, as they were given, with what was assumed of the rest.

In: lengths and a mass, some of them unknown. Out: all of them [m, kg]. Docs: ``docs/defaults.md``.
"""

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from rockfrag.assess.assumed import Assumption, assume, tolerances_in
from rockfrag.assess.core.bodies import solid_mass
from rockfrag.assess.standing.contract import OF_A_TILT_TEST, TOLERANCES, Foundation
from rockfrag.assess.standing.holders import holders_of
from rockfrag.assess.texts import Text
from rockfrag.base.errors import InputError, errors_of
from rockfrag.base.plausible import DENSITIES, STONE, check_density, size_warning
from rockfrag.base.units import GRAVITY, quantity
from rockfrag.system.blocks import Block, stacked
from rockfrag.system.system import round_inertia
from rockfrag.words.findings import (
    Finding,
    Form,
    Number,
    Value,
    finding,
    three,
    whole,
)

# Usual densities of the box around an object, from wood to bronze [kg/m³]
COMMON = (150.0, 9000.0)


@dataclass(frozen=True)
class Sizes:
    """An object of which sizes were given."""

    block: Block  # In the plane across its narrower side
    plane: Finding  # Which that is
    depth: float  # The other side [m]
    # Of the plane, from first to second component of records [degrees]
    facing_deg: float
    assumed: tuple[Assumption, ...]
    quality_flags: tuple[Value, ...]


def foundation_of(
    settings: Mapping[str, Any], tolerances: Mapping[str, float] = TOLERANCES
) -> Foundation:
    """What an object stands on, and what is said of all its contacts, of checked keys of ``statue.yaml``.

    Parameters
    ----------
    settings : checked keys
    tolerances : relative standard deviations of what is not stated

    Returns
    -------
    The foundation, with what was assumed of it.
    """
    pedestals, assumed = _pedestals(settings)
    tilted = "tilt_angle_deg" in settings or "tilt_force" in settings
    if tilted:
        tolerances = {**tolerances, "width": OF_A_TILT_TEST}
    return Foundation(
        pedestals=pedestals,
        restitution=settings.get("restitution"),
        friction=settings.get("friction"),
        pad_friction=settings.get("pad_friction"),
        tolerances=tolerances_in(settings, tolerances),
        tilted=tilted,
        holders=holders_of(settings),
        assumed=assumed,
    )


def on_foundation(
    under: Foundation,
    block: Block,
    first: tuple[Assumption, ...],
    flags: tuple[Value, ...] = (),
) -> Foundation:
    """The foundation under an object, with all that was assumed and looks wrong, that of the object first."""
    with errors_of("key pedestal"):
        stacked((*under.pedestals, block))
    warnings = (
        size_warning(each.width, each.height) for each in (block, *under.pedestals)
    )
    unusual = tuple(f"{warning}." for warning in warnings if warning)
    assumed = (*first, *under.assumed)
    return replace(under, assumed=assumed, quality_flags=(*flags, *unusual))


def conserves_momentum(settings: Mapping[str, Any]) -> tuple[Assumption, ...]:
    """What is assumed of impacts whose restitution was not measured."""
    if "restitution" in settings:
        return ()
    return (assume("restitution", "restitution"),)


def _centimetres(metres: float) -> Number:
    return Number(100 * metres, Form.FOUR)


def _across(text: Text, side: float) -> Finding:
    return finding(text, width=_centimetres(side))


def sizes_of(settings: Mapping[str, Any]) -> Sizes:
    """Sizes of an object that was not scanned, of checked keys of ``statue.yaml``.

    Parameters
    ----------
    settings : checked keys

    Returns
    -------
    The object in the plane across its narrower side, and what was assumed of it.
    """
    assumed: list[Assumption] = []
    quality_flags: list[Value] = []
    width, height = float(settings["width_m"]), float(settings["height_m"])
    is_round = settings.get("round", False)
    if is_round and settings.get("depth_m", width) != width:
        raise InputError(
            "key depth: a round base has one width, its diameter; leave the depth out, or round."
        )
    depth = float(settings.get("depth_m", width))
    plane, across = _across(Text.ROCKS_ACROSS, width), depth < width
    if across:
        plane = _across(Text.ROCKS_ACROSS_NARROWER, depth)
        width, depth = depth, width
    elif "depth_m" not in settings and not is_round:
        # the mass that follows counts only on a pedestal
        assumed.append(assume("depth", depth=_centimetres(depth)))
    mass = settings.get("mass_kg")
    if mass is None:
        mass = solid_mass(width, depth, height, is_round)
        solid = "cylinder" if is_round else "box"
        about = {"mass": three(mass), "density": whole(STONE)}
        assumed.append(assume(f"mass_of_{solid}", "mass", **about))
    mass = float(mass)
    check_density(width, height, mass)
    if "depth_m" in settings:
        quality_flags += _density_flags(mass, width * depth * height)
    if "cg_height_m" not in settings:
        assumed.append(assume("cg_height", "cg_height"))
    cg_height = settings.get("cg_height_m")
    if cg_height is not None and cg_height >= height:
        raise InputError(
            f"key cg_height: {cg_height:g} m is not below the top, at {height:g} m; check the unit."
        )
    usual = round_inertia(width, height, mass) if is_round else None
    inertia = settings.get("inertia_kg_m2", usual)
    offset = float(settings.get("cg_offset_m", 0.0))
    block = Block(width, height, mass, inertia, cg_height=cg_height, cg_offset=offset)
    block = _as_it_rocks(_as_it_tips(block, settings), settings)
    facing = float(settings.get("facing_deg", 0.0)) + 90.0 * across
    return Sizes(block, plane, depth, facing, tuple(assumed), tuple(quality_flags))


def _density_flags(mass: float, volume: float) -> list[Value]:
    """Flag an unusual density of a mass [kg] in a box of a volume [m³], and refuse one that no solid has."""
    density = mass / volume
    words = f"{mass:g} kg in a box of {volume:.3g} m³ are {density:.3g} kg/m³"
    if not DENSITIES[0] <= density <= DENSITIES[1]:
        raise InputError(
            f"key mass: {words}, a density that no solid has; check the units."
        )
    if COMMON[0] <= density <= COMMON[1]:
        return []
    return [
        finding(
            Text.FLAG_DENSITY,
            mass=three(mass),
            volume=three(volume),
            density=three(density),
        )
    ]


_FORCE = re.compile(r"\s*(\d+(?:\.\d+)?)\s*(k?N)\s*(?:@|at)\s*(.+)", re.IGNORECASE)

WIDEST_TIPPED = 1.05
"""Width that a tilt test gives over the measured one, above which both cannot be of one object [-]."""


def _as_it_tips(block: Block, settings: Mapping[str, Any]) -> Block:
    """The block as wide as a tilt test says that it carries.

    On a base tilted by α it tips where tan α = b/h; pulled by a force F at the height z where F z = m g b, with b
    half of the width and h the height of the centre of gravity.
    """
    if "tilt_angle_deg" in settings:
        key = "tilt_angle"
        half = block.h * math.tan(math.radians(settings["tilt_angle_deg"]))
    elif "tilt_force" in settings:
        key = "tilt_force"
        half = _moment(settings["tilt_force"]) / (block.mass * GRAVITY)
    else:
        return block
    if 2 * half > WIDEST_TIPPED * block.width:
        raise InputError(
            f"key {key}: it would stand on {200 * half:.3g} cm, and its width is {100 * block.width:.3g} cm; "
            "check both, and the height of the centre of gravity."
        )
    return replace(block, width=2 * half, inertia=block.centroidal_inertia)


def _moment(given: str) -> float:
    """Moment of a force at a height, such as 85N@1.1m [N m]."""
    found = _FORCE.fullmatch(given)
    if found is None:
        raise InputError(
            f"key tilt_force: expected a force at a height such as 85N@1.1m, found {given[:40]!r}."
        )
    force = float(found[1]) * (1000.0 if found[2].lower() == "kn" else 1.0)
    with errors_of("key tilt_force"):
        height = quantity(found[3], "m", None)
    if not force * height > 0:
        raise InputError("key tilt_force: force and height must be above 0.")
    return force * height


def _as_it_rocks(block: Block, settings: Mapping[str, Any]) -> Block:
    """The block with the inertia of which its free rocking tells: p² = m g R / (I + m R²)."""
    p = settings.get("frequency_parameter")
    if p is None:
        return block
    arm = math.hypot(block.width / 2, block.h)
    inertia = block.mass * arm * (GRAVITY / p**2 - arm)
    if inertia <= 0:
        raise InputError(
            f"key frequency_parameter: {p:g} 1/s is more than a body of this size can have, which is "
            f"{math.sqrt(GRAVITY / arm):.3g}; check the sizes and p."
        )
    return replace(block, inertia=inertia)


def _pedestals(
    settings: Mapping[str, Any],
) -> tuple[tuple[Block, ...], tuple[Assumption, ...]]:
    """What the object stands on, from below, in the plane in which it rocks, and what was assumed of it."""
    assumed: list[Assumption] = []
    found, given = [], settings.get("pedestal", [])
    given = [given] if isinstance(given, Mapping) else given
    across = settings.get("depth_m", math.inf) < settings.get("width_m", math.inf)
    for i, block in enumerate(given, start=1):
        width, height = float(block["width_m"]), float(block["height_m"])
        depth = float(block.get("depth_m", width))
        if across:
            width, depth = depth, width
        mass = block.get("mass_kg")
        if mass is None:
            mass = solid_mass(width, depth, height, False)
            about: dict[str, Value] = {"mass": three(mass), "density": whole(STONE)}
            what = "pedestal"
            if len(given) > 1:
                what, about["number"] = "pedestal_of_several", i
            assumed.append(assume(what, "mass", **about))
        with errors_of("key pedestal"):
            check_density(width, height, float(mass))
        found.append(Block(width, height, float(mass)))
    return tuple(reversed(found)), tuple(assumed)
