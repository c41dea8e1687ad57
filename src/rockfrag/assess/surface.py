"""Messages in the words of the surface that a user is on: keys in a file, options on the command line."""

import re
from collections.abc import Collection

_OPTIONS = {
    "distance": "distance",
    "records": "record",
    "records.unit": "unit",
    "records.dt": "dt",
    "mesh.file": "mesh",
    "mesh.metres_per_unit": "mesh-unit",
    "mesh.up": "up",
    "mesh.hull": "hull",
    "mesh.contact_tolerance": "contact-tolerance",
    "building.storey_height": "storey-height",
    "building.storey_heights": "storey-height",
    "building.first_period": "period",
    "building.material": "material",
    "building.damping_ratio": "damping",
}
"""Options that are not called as their keys are."""

_UNITS = ("_kg_m2", "_years", "_km", "_kg", "_deg", "_m", "_s")
_KEY = re.compile(
    r"(?<!\w)key ([a-z_][a-z0-9_.]*[a-z0-9_])(\[\d+\](?:\.[a-z_]+)?)?(: true\b|: (?=[xyz]\b))?"
)


def on_command_line(words: str, given: Collection[str] | None = None) -> str:
    """A message that names keys of ``statue.yaml`` as ``key pga``, with options in place of those that were given.

    All of them are taken as given if None.
    """

    def option(found: re.Match[str]) -> str:
        key = _without_unit(found[1])
        if given is not None and key.split(".")[0] not in {_without_unit(other) for other in given}:
            return found[0]
        name = _OPTIONS.get(key, key.split(".")[0].replace("_", "-"))
        # a flag takes no value, and an axis stands beside its option
        return f"--{name}" + (" " if found[3] == ": " else "")

    return _KEY.sub(option, words.replace(_METRES_PER_UNIT, "key mesh.metres_per_unit mm"))


_METRES_PER_UNIT = "key mesh.metres_per_unit (0.001 for millimetres, 0.3048 for feet)"


def _without_unit(key: str) -> str:
    for unit in _UNITS:
        if key.endswith(unit):
            return key.removesuffix(unit)
    return key
