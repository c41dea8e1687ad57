"""Random objects as they are typed into the page of ``rockfrag app``, and as ``rockfrag assess`` takes them."""

import random
from collections.abc import Mapping, Sequence
from typing import Any


def some_form(rng: random.Random) -> dict[str, str]:
    """A random object at a random place, as it is typed."""
    width = rng.uniform(0.05, 0.8)
    height = width * rng.uniform(2, 6)
    form = {"width": f"{100 * width:.3g} cm", "height": f"{height:.3g} m"}
    some = {
        "mass": f"{rng.uniform(300, 5000) * width * width * height:.4g} kg",
        "cg_height": f"{rng.uniform(0.35, 0.6) * height:.3g} m",
        "cg_offset": f"{rng.uniform(-5, 5) * width:.3g} cm",
        "restitution": f"{rng.uniform(0.6, 0.9):.2f}",
    }
    form |= {key: value for key, value in some.items() if rng.random() < 0.35}
    if rng.random() < 0.35:
        form["pedestal_width"] = f"{100 * width * rng.uniform(0.9, 2):.3g} cm"
        form["pedestal_height"] = f"{rng.uniform(0.1, 1.2):.3g} m"
        if rng.random() < 0.5:
            form["pedestal_mass"] = f"{rng.uniform(100, 900):.4g} kg"
    if rng.random() < 0.4:
        storeys = rng.randint(1, 6)
        form["floor"] = f"{rng.randint(0, storeys)}/{storeys}"
    measure, level = rng.choice(
        [
            ("PGA", f"{rng.uniform(0.05, 0.8):.3g} g"),
            ("PGV", f"{rng.uniform(5, 90):.3g} cm/s"),
        ]
    )
    form |= {"measure": measure, "level": level}
    if rng.random() < 0.7:
        form["years"] = rng.choice(["475", "975", "72"])
    return form


def some_form_in_space(rng: random.Random) -> dict[str, str]:
    """A random box or round object, without a measured restitution, on pedestals too."""
    form = some_form(rng)
    form.pop("restitution", None)
    if rng.random() < 0.3:
        return form | {"round": True}
    form["depth"] = f"{float(form['width'].split()[0]) * rng.uniform(0.6, 2):.3g} cm"
    if rng.random() < 0.5:
        form["facing"] = f"{rng.uniform(0, 360):.1f}"
    return form


def some_form_of_any_kind(rng: random.Random, kinds: Sequence[str]) -> dict[str, str]:
    """A random object that rocks in a plane or in space, or stands as a kind of one's own does."""
    draw = rng.random()
    if draw < 0.4:
        return some_form_in_space(rng)
    form = some_form(rng)
    if kinds and draw < 0.55:
        form["stands"] = rng.choice(kinds)
    return form


def settings_of(form: Mapping[str, str]) -> dict[str, Any]:
    """What ``rockfrag assess`` is told of a form."""
    plain = (
        "width",
        "height",
        "mass",
        "cg_height",
        "cg_offset",
        "floor",
        "depth",
        "round",
        "stands",
    )
    settings: dict[str, Any] = {key: form[key] for key in plain if key in form}
    for key, name in (("restitution", "restitution"), ("facing", "facing_deg")):
        if key in form:
            settings[name] = float(form[key])
    pedestal = {
        key: form[f"pedestal_{key}"]
        for key in ("width", "height", "mass")
        if f"pedestal_{key}" in form
    }
    settings |= {"pedestal": pedestal} if pedestal else {}
    settings |= {form["measure"].lower(): form["level"]}
    return settings | ({"return_period": form["years"]} if "years" in form else {})


def options_of(form: Mapping[str, str]) -> list[str]:
    """Options of the command line for a form."""
    settings = {
        # the option has its unit in its help
        key.removesuffix("_deg"): value
        for key, value in settings_of(form).items()
        if key != "pedestal"
    }
    options = [
        f"--{key.replace('_', '-')}" + ("" if value is True else f"={value}")
        for key, value in settings.items()
    ]
    pedestal = settings_of(form).get("pedestal", {})
    return options + (["--pedestal", *pedestal.values()] if pedestal else [])
