"""What every public name says about itself (numpydoc)."""

import importlib
import inspect
import pkgutil
import re
import warnings

import pytest

import rockfrag
import rockfrag_thesis

with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    validate = pytest.importorskip("numpydoc.validate", reason="numpydoc is not installed").validate

SUBPACKAGES = (
    *("", ".assess", ".rocking", ".motions", ".building", ".shaketable", ".fragility"),
    *(".pedestal", ".records"),
)
FORM = {"GL05", "GL06", "GL07", "GL08", "PR02", "PR03", "YD01"}
PARAMETERS = "PR01"


def public() -> list[str]:
    """Full names of the functions and classes that the package and its rooms export."""
    names = set()
    for subpackage in SUBPACKAGES:
        package = importlib.import_module(f"rockfrag{subpackage}")
        for name in getattr(package, "__all__", ()):
            value = getattr(package, name)
            if inspect.isfunction(value) or (
                inspect.isclass(value) and not issubclass(value, Exception)
            ):
                names.add(f"{value.__module__}.{value.__qualname__}")
    return sorted(names)


@pytest.mark.parametrize("name", public())
def test_public_name_is_documented(name):
    found = validate(name)
    wrong = [f"{code}: {words}" for code, words in found["errors"] if code in FORM]
    # the fields of a class are described as its attributes
    home, _, own = name.rpartition(".")
    value = getattr(importlib.import_module(home), own)
    if inspect.isfunction(value):
        wrong += [f"{code}: {words}" for code, words in found["errors"] if code == PARAMETERS]
        returned = inspect.signature(value).return_annotation
        if returned not in (None, "None") and "Returns\n-------" not in inspect.getdoc(value):
            wrong += ["it does not say what it returns"]
    elif inspect.signature(value).parameters and not re.search(
        r"(Attributes|Parameters)\n", found["docstring"]
    ):
        wrong += ["neither attributes nor parameters are described"]
    assert not wrong


def test_help_shows_the_public_names():
    shown = dir(rockfrag)
    assert set(rockfrag.__all__) <= set(shown)


def test_every_module_says_what_it_is_for():
    modules = [
        item.name
        for package in (rockfrag, rockfrag_thesis)
        for item in pkgutil.walk_packages(package.__path__, f"{package.__name__}.")
    ]
    silent = [name for name in modules if not importlib.import_module(name).__doc__]
    assert not silent
