"""The simulation in the page: the kernel that `rockfrag.simulate` runs, its data, and frames without scripts."""

import math
import warnings
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
from markupsafe import Markup

from rockfrag.base.arrays import Floats
from rockfrag.base.units import GRAVITY
from rockfrag.motions.processing import factors_to_pga, scale_to_pga
from rockfrag.outcomes.response import Response
from rockfrag.records.motion import Motion
from rockfrag.report.page import TEMPLATES, base64_text, json_text, scripts_of
from rockfrag.simulation import overturns, simulate
from rockfrag.simulation.ensemble import LightBodies
from rockfrag.system import geometry
from rockfrag.system.body import RigidBody
from rockfrag.system.contact import Contact
from rockfrag.system.system import System
from rockfrag.web import driver_text, in_page, module_bytes
from rockfrag.words.catalogue import Catalogue, catalogue
from rockfrag.words.findings import listed
from rockfrag.words.sentences import number

# samples of all motions that a page carries: three quarters of a megabyte
MOST_SAMPLES = 70_000

AMPLITUDES_G = tuple(np.geomspace(0.05, 2.0, 150).tolist())
"""Amplitudes [g] of a body that no study has swept."""


def live_kernel(
    bodies: Mapping[str, System],
    motions: Sequence[Motion],
    outcomes: pd.DataFrame | None = None,
    texts: Catalogue | None = None,
) -> Markup:
    """Return the element of a page in which bodies rock under motions, live; one to a page.

    It is empty if no body is left. Of bodies that the page's kernel does not know only the names are shown; of
    the motions no more than carry ``MOST_SAMPLES`` samples are taken, the first ones. ``outcomes`` is a table of
    a study (``configuration``, ``motion``, ``amplitude_g``, ``overturned``, the same amplitudes for all); without
    it ``AMPLITUDES_G`` are tried here. One of two bodies and a motion that overturns it are shown first. ``texts``
    are those of the page's language, the first one if None.
    """
    known = {name: system for name, system in bodies.items() if in_page(system)}
    if not known:
        return Markup()
    with warnings.catch_warnings():
        # the page shows pure rocking; where that may be wrong is said in the report's own words
        warnings.simplefilter("ignore", LightBodies)
        used = texts or catalogue()
        return _element(known, bodies, carried(motions), outcomes, used)


def live_texts(texts: Catalogue) -> dict[str, str]:
    """Texts of the live part of a page in a language, by the ids that its scripts have.

    Parameters
    ----------
    texts : of the language

    Returns
    -------
    The texts, and the sign of decimals.
    """
    own = {
        id.removeprefix(_LIVE): str(text)
        for id, text in texts.texts.items()
        if id.startswith(_LIVE)
    }
    return {**own, "decimal": str(texts.texts["decimal"])}


_LIVE = "live_"


def _element(
    bodies: Mapping[str, System],
    asked: Mapping[str, System],
    motions: Sequence[Motion],
    outcomes: pd.DataFrame | None,
    texts: Catalogue,
) -> Markup:
    """The page's part that simulates, with its data and scripts.

    Parameters
    ----------
    bodies : that can be shown, by name
    asked : those that were asked for, by name; what of them cannot be shown is named
    motions : of the ground
    outcomes : a row a case that is known already; None to simulate them
    texts : of the page's language
    """
    say = live_texts(texts)
    of_study = outcomes is not None
    if outcomes is None:
        outcomes = swept(bodies, motions)
    amplitudes, rows = _outcomes_by_case(outcomes, list(bodies), motions)
    body, motion = _first_shown(bodies, rows)
    first = rows[body][motion].find("1")
    shown = first if first >= 0 else len(amplitudes) - 1
    data = {
        "source": "source_study" if of_study else "source_package",
        "texts": say,
        "gravity": GRAVITY,
        "module": base64_text(module_bytes()),
        "bodies": [_body(name, body) for name, body in bodies.items()],
        "motions": [_motion(motion) for motion in motions],
        "amplitudes": amplitudes.tolist(),
        "outcomes": rows,
        "start": {
            "body": body,
            "motion": motion,
            "amplitude": float(amplitudes[shown]),
        },
    }
    three = (shown // 2, shown - 1, shown) if first > 0 else (0, shown // 2, shown)
    drawn, peaks = list(bodies.values())[body], amplitudes[np.unique(three)].tolist()
    frames, words = frames_svg(drawn, motions[motion], peaks, texts)
    about = {"body": list(bodies)[body], "motion": motions[motion].name}
    missing = [name for name in asked if name not in bodies]
    left_out = say["left_out"].format(names=", ".join(missing)) if missing else ""
    return Markup(
        TEMPLATES.get_template("live.html.j2").render(
            say=say,
            left_out=left_out,
            frames=frames,
            words=say["frames_of"].format(**about, words=words),
            data=json_text(data),
            driver=Markup(driver_text()),
            script=scripts_of("canvas", "live"),
        )
    )


def _outcomes_by_case(
    outcomes: pd.DataFrame, names: Sequence[str], motions: Sequence[Motion]
) -> tuple[Floats, list[list[str]]]:
    """Amplitudes [g], and for each body and motion a text with a digit an amplitude: 1 where it overturned."""
    by_case = outcomes.pivot_table(
        "overturned", ["configuration", "motion"], "amplitude_g", aggfunc="first"
    )
    fell = by_case.astype(int).astype(str).agg("".join, axis=1)
    rows = [[str(fell[name, motion.name]) for motion in motions] for name in names]
    return by_case.columns.to_numpy(), rows


def carried(motions: Sequence[Motion]) -> list[Motion]:
    """Motions that a page has room for: the first ones, and at least one."""
    total = np.cumsum([motion.acceleration.size for motion in motions])
    return list(motions[: max(1, int((total <= MOST_SAMPLES).sum()))])


def swept(bodies: Mapping[str, System], motions: Sequence[Motion]) -> pd.DataFrame:
    """Outcomes of all bodies under all motions at ``AMPLITUDES_G``."""
    values = np.array(AMPLITUDES_G)
    scales = np.array([factors_to_pga(motion, values) for motion in motions])
    fell = overturns(list(bodies.values()), motions, scales=scales).overturned
    index = pd.MultiIndex.from_product(
        [list(bodies), [motion.name for motion in motions], values],
        names=["configuration", "motion", "amplitude_g"],
    )
    return pd.DataFrame({"overturned": fell.ravel()}, index=index).reset_index()


def _first_shown(
    bodies: Mapping[str, System], rows: list[list[str]]
) -> tuple[int, int]:
    """Numbers of the body and of the motion that a page shows first.

    They are the first ones of which the body survives weak shaking and falls in stronger one, bodies on pedestals
    before others; the first body and motion if there are none.

    Parameters
    ----------
    bodies : by their names
    rows : of each body and motion the outcomes at rising levels, a letter each, 1 where it falls
    """
    counts = [body.count for body in bodies.values()]
    order = sorted(range(len(counts)), key=lambda number: counts[number], reverse=True)
    for body in order:
        for motion, outcomes in enumerate(rows[body]):
            if outcomes.find("1") > 0:
                return body, motion
    return order[0], 0


def _motion(motion: Motion) -> dict[str, Any]:
    """A motion as a page holds it."""
    peaks = {"pga": motion.pga, "pga_g": motion.pga / GRAVITY}
    return {
        "name": motion.name,
        "dt": motion.dt,
        **peaks,
        "samples": samples_text(motion),
    }


def samples_text(motion: Motion) -> str:
    """Return the samples of a motion as text of a page."""
    return base64_text(np.asarray(motion.acceleration, "<f8").tobytes())


def _body(name: str, system: System) -> dict[str, Any]:
    """A system of one body or two as the script of the page takes it [m, kg]."""
    *below, upper = map(_block, system.in_plane().bodies, system.contacts)
    about = {"name": name, "statue": upper, "pedestal": below[0] if below else None}
    return {**about, "offset": system.contacts[-1].offset[0]}


def _block(body: RigidBody, contact: Contact) -> dict[str, float]:
    """Dimensions in SI as the driver takes them; what is that of a uniform block follows from them there too."""
    width, height, mass = body.width, body.height, body.mass
    x, _, z = body.centre
    given = {"width": width, "height": height, "mass": mass}
    uniform = geometry.shape_of(width, height, mass, math.nan, math.nan, 0.0, 0.0)
    if body.inertia != uniform.inertia:
        given["inertia"] = float(body.inertia)  # type: ignore[arg-type]
    if z != uniform.y:
        given["cgHeight"] = z
    return {**given, "cgOffset": x, "lean": contact.tilt}


_WIDTH, _GROUND = 200, 150

_FALLING = 0.7  # rotation at which a falling body is drawn [rad]


def outlines(
    system: System, position: Floats, theta: Floats
) -> list[list[tuple[float, float]]]:
    """Corners of the box around each body, in one sample of a response.

    Parameters
    ----------
    system : in the plane
    position : of the centres of gravity, x and y [m], shape (bodies, 2)
    theta : rotations, clockwise [rad], shape (bodies,)

    Returns
    -------
    Of each body, from below, four corners (x, y) [m].
    """
    lean, found = 0.0, []
    each = zip(system.in_plane().bodies, system.contacts, system.shapes, strict=True)
    for k, (body, contact, shape) in enumerate(each):
        half, tall, corners = body.width / 2, body.height, []
        for corner in ((-half, 0.0), (half, 0.0), (half, tall), (-half, tall)):
            x, y = geometry.turned(*corner, contact.tilt)
            arm = geometry.turned(x - shape.x, y - shape.y, lean + float(theta[k]))
            corners.append(tuple((position[k] + arm).tolist()))
        found.append(corners)
        lean += contact.tilt
    return found


def frames_svg(
    system: System,
    motion: Motion,
    amplitudes_g: Sequence[float],
    texts: Catalogue | None = None,
) -> tuple[Markup, str]:
    """Draw a system at its largest rotation under a motion of each peak [g]; return the drawing and its words."""
    used = texts or catalogue()
    say = live_texts(used)
    tall = system.height
    scale = min(120 / tall, 170 / (1.6 * tall))
    frames, words = [], []
    for place, peak in enumerate(amplitudes_g):
        response = simulate(system, scale_to_pga(motion, peak))
        k, outcome = _moment(response, say)
        shown = number(peak, 3).replace(".", say["decimal"])
        shift = (place + 0.5) * _WIDTH
        blocks = [
            " ".join(
                f"{shift + scale * x:.1f},{_GROUND - scale * y:.1f}" for x, y in block
            )
            for block in outlines(system, response.position[k], response.theta[k])
        ]
        frames.append((f"{shift:.0f}", shown, outcome, blocks))
        words.append(say["frame_at"].format(peak=shown, outcome=outcome))
    said = used.say(listed(words)) + "."
    drawing = TEMPLATES.get_template("frames.svg.j2")
    about = {
        "width": _WIDTH * len(amplitudes_g),
        "ground": _GROUND,
        "said": said,
        "frames": frames,
    }
    return Markup(drawing.render(about).strip()), said


def _moment(response: Response, say: Mapping[str, str]) -> tuple[int, str]:
    """Sample of the moment that says most, and what becomes of the body."""
    turned = np.abs(response.theta).max(axis=1)
    if response.overturned:
        k = int(np.argmax(turned > _FALLING))
        time = number(response.overturning_time, 1).replace(".", say["decimal"])
        return k, say["frame_overturns"].format(time=time)
    k = int(turned.argmax())
    angle = number(math.degrees(float(turned[k])), 1).replace(".", say["decimal"])
    rocks = say["frame_rocks"].format(angle=angle)
    return k, rocks if turned[k] > 0 else say["frame_rests"]
