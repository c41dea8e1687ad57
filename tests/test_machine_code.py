"""Machine code on disk may be half there; what is computed is not."""

import importlib.util
from pathlib import Path

import numba
import pytest

from rockfrag.stages import job

from .conftest import printed_alone

PROGRAM = """
from rockfrag.machine_code import cached_njit

@cached_njit()
def thrice(x):
    return 3 * x
"""


def fresh(path: Path):
    spec = importlib.util.spec_from_file_location("of_this_test", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.thrice


@pytest.mark.parametrize(("damaged", "left"), [("*.nbi", 20), ("*.nbc", 200), ("*.nb?", 0)])
def test_damaged_machine_code_is_made_anew(tmp_path, monkeypatch, damaged, left):
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path / "cache"))
    path = tmp_path / "of_this_test.py"
    path.write_text(PROGRAM)
    assert fresh(path)(2) == 6
    files = [*(tmp_path / "cache").rglob(damaged)]
    assert files
    for file in files:
        file.write_bytes(file.read_bytes()[:left])
    assert fresh(path)(2) == 6
    again = fresh(path)
    assert again(2) == 6
    assert sum(again.stats.cache_hits.values()) == 1


ALONE = """
import sys
from rockfrag.machine_code import cached_njit

@cached_njit(_nrt=False)
def thrice(x):
    return 3 * x

print(thrice(2), "numba.np.arraymath" in sys.modules)
"""


def test_machine_code_is_read_without_what_compiling_needs(tmp_path):
    path = tmp_path / "alone.py"
    path.write_text(ALONE)
    for compiles in (True, False):
        said = printed_alone(str(path), NUMBA_CACHE_DIR=str(tmp_path / "cache"))
        assert said == f"6 {compiles}"


def test_without_a_folder_for_it_the_function_is_compiled_all_the_same(tmp_path, monkeypatch):
    def nowhere(*given, **options):
        if options.pop("cache", False):
            raise RuntimeError("cannot cache function: no locator available")
        return numba.core.decorators.njit(*given, **options)

    monkeypatch.setattr("rockfrag.machine_code.numba.njit", nowhere)
    path = tmp_path / "of_this_test.py"
    path.write_text(PROGRAM)
    assert fresh(path)(2) == 6


def test_what_a_run_leaves_beside_the_source_does_not_change_its_digest(tmp_path, monkeypatch):
    monkeypatch.setattr(job, "PACKAGE", tmp_path)
    (tmp_path / "a.py").write_text("")
    before = job.package_digest.__wrapped__()
    (tmp_path / "__pycache__").mkdir()
    for name in ("a.cpython-311.pyc", "a.f-1.py311.nbi", "a.f-1.py311.1.nbc", "f.lock"):
        (tmp_path / "__pycache__" / name).write_text("x")
    assert job.package_digest.__wrapped__() == before
