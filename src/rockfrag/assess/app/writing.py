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
    modules |= {"history": "integrate", "space": "space"}
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
    """Return the samples of motions, packed, and what a page needs to get every bit of them again.

    Of records, decimals of few digits, they are whole numbers over powers of ten times the factor of the unit.
    """
    samples = np.concatenate([motion.acceleration for motion in motions])
    about: dict[str, Any] = {
        "counts": [motion.acceleration.size for motion in motions],
        "dts": [motion.dt for motion in motions],
    }
    for factor in _FACTORS:
        whole, power = _decimals(samples, factor)
        if (power >= 0).all():
            content = _by_rank(whole.astype("<i4")) + power.astype(np.uint8).tobytes()
            return zlib.compress(content, 9), {
                **about,
                "factor": factor,
                "decimal": True,
            }
    content = _by_rank(samples.astype("<f8"))
    return zlib.compress(content, 9), {**about, "factor": 1.0, "decimal": False}


def _by_rank(values: np.ndarray) -> bytes:
    """Bytes of equal rank together, which pack better."""
    return values.view(np.uint8).reshape(values.size, -1).T.tobytes()


def _decimals(samples: np.ndarray, factor: float) -> tuple[np.ndarray, np.ndarray]:
    """Whole numbers and powers of ten that give each sample to the bit; power -1 where none of few digits do."""
    plain = samples / factor
    size = np.floor(np.log10(np.abs(plain), out=np.zeros(plain.size), where=plain != 0))
    whole, power = np.zeros(plain.size), np.full(plain.size, -1.0)
    for digits in range(1, _MOST_DIGITS + 1):
        tried = np.clip(digits - 1 - size, 0, 22)
        number = np.round(plain * 10.0**tried)
        hit = (
            (power < 0)
            & (number / 10.0**tried * factor == samples)
            & (np.abs(number) < 2**31)
        )
        whole[hit], power[hit] = number[hit], tried[hit]
    return whole, power
