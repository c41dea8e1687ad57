"""The page of ``rockfrag app``: one file that holds motions, modules, scripts and texts.

In: the contents of the page, and a language. Out: one HTML file. Docs: ``docs/app.md``.
"""

import os
import zlib
from collections.abc import Mapping, Sequence
from importlib.resources import files
from typing import Any

import numpy as np
from markupsafe import Markup

from rockfrag.assess.app.contents import computing, data_of, script
from rockfrag.assess.motions import MotionSet
from rockfrag.assess.request import Request
from rockfrag.base.errors import InputError
from rockfrag.base.files import write_text
from rockfrag.base.units import GRAVITY
from rockfrag.records.motion import Motion
from rockfrag.report.page import (
    TEMPLATES,
    base64_text,
    json_text,
    scripts_of,
    zipped_text,
)
from rockfrag.web import driver_text, module_bytes
from rockfrag.words.catalogue import catalogue, formatter, languages

MOST_BYTES = 6_000_000  # Largest page [bytes], which a memory stick and a mail take

# Factors of units in which records state decimals [m/s²]
_FACTORS = (GRAVITY, 0.01, 1.0)

_MOST_DIGITS = 9


def write_app(
    motions: MotionSet,
    form: Mapping[str, str],
    path: str | os.PathLike[str],
    *,
    request: Request | None = None,
    made: bool = False,
) -> None:
    """Write the page of motions of the ground; too many for a page are an InputError.

    Parameters
    ----------
    motions : that the page computes with
    form : what stands in the form at first, by the names of its fields
    path : of the page
    request : where the motions were recorded, and the building and hazard that the form does not tell
    made : whether motions were made by formulas, which the page says
    """
    page = page_of(motions, form, request, made=made)
    if (size := len(page.encode())) > MOST_BYTES:
        raise InputError(
            f"--record: with these motions the page has {size / 1e6:.1f} MB, more than {MOST_BYTES / 1e6:g}; give "
            "fewer or shorter records."
        )
    write_text(page, path)


def page_of(
    motions: MotionSet,
    form: Mapping[str, str],
    request: Request | None = None,
    *,
    made: bool,
) -> str:
    """Return the page as HTML, which loads nothing."""
    packed, about = packed_samples(motions.ground)
    modules = {"fused": "ensemble-fused", "plain": "ensemble"}
    modules |= {"history": "integrate", "space": "space", "plane": "plane"}
    data = {
        **data_of(motions, request),
        "form": dict(form),
        "made": made,
        "texts": {language: catalogue(language).texts for language in languages()},
        "modules": {
            **{name: zipped_text(module_bytes(of)) for name, of in modules.items()},
            "core": zipped_text((files(__package__) / "core.wasm").read_bytes()),
        },
        "samples": about,
        "packed": base64_text(packed),
    }
    style = TEMPLATES.get_template("style.css").render() + script("app.css")
    parts = ("core", "floors", "space", "objects", "lists", "scene", "page")
    scripts = [driver_text("integrate", "space"), scripts_of("view"), formatter()]
    scripts += [script(f"{name}.js") for name in parts]
    return TEMPLATES.from_string(script("app.html.j2")).render(
        title=data["texts"]["en"]["title"],
        style=Markup(style),
        data=json_text(data),
        computing=Markup(f"{computing()}\n{script('worker.js')}"),
        scripts=Markup("\n".join(scripts)),
    )


def packed_samples(motions: Sequence[Motion]) -> tuple[bytes, dict[str, Any]]:
    """Pack the samples of motions, so that a page gets every bit of them again.

    Records state decimals of few digits: these are packed as whole numbers (four bytes each) and, behind all of
    them, the powers of ten (a byte each) by which they are divided before the factor of the unit multiplies them.
    Where no unit makes them so they are packed as they are.

    Parameters
    ----------
    motions : accelerations [m/s²]

    Returns
    -------
    The packed bytes, and what a script needs to unpack them: ``counts`` and ``dts`` by motion, ``factor`` of the
    unit, and whether they are ``decimal``.
    """
    samples = np.concatenate([motion.acceleration for motion in motions])
    about: dict[str, Any] = {
        "counts": [motion.acceleration.size for motion in motions],
        "dts": [motion.dt for motion in motions],
        "factor": 1.0,
        "decimal": False,
    }
    for factor in _FACTORS:
        whole, power = _decimals(samples, factor)
        if (power >= 0).all():
            content = _bytes_by_rank(whole.astype("<i4"))
            content += power.astype(np.uint8).tobytes()
            about |= {"factor": factor, "decimal": True}
            return zlib.compress(content, 9), about
    return zlib.compress(_bytes_by_rank(samples.astype("<f8")), 9), about


def _bytes_by_rank(values: np.ndarray) -> bytes:
    """Bytes of numbers, the first of all, then the second of all, and so on: these pack better."""
    return values.view(np.uint8).reshape(values.size, -1).T.tobytes()


def _decimals(samples: np.ndarray, factor: float) -> tuple[np.ndarray, np.ndarray]:
    """Whole numbers and powers of ten that give each sample to the bit; power -1 where none of few digits do.

    The fewest digits are taken: sample = number / 10^power × factor, computed in this order.
    """
    plain = samples / factor
    # power of ten of the first digit
    size = np.floor(np.log10(np.abs(plain), out=np.zeros(plain.size), where=plain != 0))
    whole, power = np.zeros(plain.size), np.full(plain.size, -1.0)
    for digits in range(1, _MOST_DIGITS + 1):
        # powers of ten up to 22 are exact numbers
        tried = np.clip(digits - 1 - size, 0, 22)
        number = np.round(plain * 10.0**tried)
        is_same = number / 10.0**tried * factor == samples
        fits = np.abs(number) < 2**31
        found = (power < 0) & is_same & fits
        whole[found], power[found] = number[found], tried[found]
    return whole, power
