"""Motions of the table: read from an archive or files, conditioned, refused where they cannot be right."""

from pathlib import Path

import numpy as np
import pytest

from rockfrag.campaign.table_motions import table_motions
from rockfrag.errors import InputError
from rockfrag.units import GRAVITY

TIME = np.arange(0, 4, 0.005)
SHAKING = 0.3 * np.sin(2 * np.pi * 2 * TIME) * np.hanning(len(TIME))


def archive(folder, **motions: np.ndarray) -> Path:
    path = folder / "motions.npz"
    np.savez(path, **motions)
    return path


def test_an_archive_is_read_in_its_unit(tmp_path):
    (motion,) = table_motions(archive(tmp_path, a=SHAKING), ["a"], unit="g", dt=0.005)
    assert motion.dt == 0.005
    np.testing.assert_allclose(motion.acceleration, SHAKING * GRAVITY)


def test_files_are_named_by_their_motion(tmp_path):
    for name, factor in (("a", 1.0), ("b", 2.0)):
        np.savetxt(tmp_path / f"Run_{name}.txt", np.column_stack([TIME, factor * SHAKING]))
    a, b = table_motions(tmp_path / "Run_{motion}.txt", ["a", "b"], unit="g")
    np.testing.assert_allclose(b.acceleration, 2 * a.acceleration, atol=1e-6)
    assert (a.name, b.name) == ("a", "b")


def test_conditioning_takes_away_offset_and_spikes(tmp_path):
    rng = np.random.default_rng(0)
    noisy = SHAKING + 0.001 * rng.standard_normal(len(TIME)) + 0.015
    noisy[300] = 4.0
    steps = [{"step": "remove_median"}, {"step": "despike"}]
    (motion,) = table_motions(
        archive(tmp_path, a=noisy), ["a"], unit="g", dt=0.005, conditioning=steps
    )
    # where the spike was stands a neighbour, which the slope of the motion sets apart
    slope = np.abs(np.diff(SHAKING)).max()
    np.testing.assert_allclose(motion.acceleration / GRAVITY, SHAKING, atol=slope)
    assert motion.provenance[-1]["replaced"] == 1


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"names": ["a", "b"]}, "no motion for 1 of 2 tests, b first"),
        ({"unit": None}, "states neither unit nor interval"),
        ({"unit": "V"}, "not a unit of acceleration"),
        ({"unit": "volt"}, "not a unit of acceleration"),
    ],
)
def test_what_is_missing_is_asked_for(tmp_path, options, sentence):
    path = archive(tmp_path, a=SHAKING)
    given = {"names": ["a"], "unit": "g", "dt": 0.005, **options}
    with pytest.raises(InputError, match=sentence) as caught:
        table_motions(path, **given)
    assert "\n" not in str(caught.value)


def test_a_motion_in_volts_is_too_large_for_any_table(tmp_path):
    with pytest.raises(InputError, match=r"peaks at 19.* g, which no shake table reaches"):
        table_motions(archive(tmp_path, a=65 * SHAKING), ["a"], unit="g", dt=0.005)


@pytest.mark.parametrize("content", [None, b"", b"PK\x03\x04 cut", b"no archive"])
def test_a_damaged_archive_or_one_with_python_objects_is_refused(tmp_path, content):
    path = archive(tmp_path, a=np.array([{"run": "code"}], dtype=object))
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(InputError, match="cannot be read"):
        table_motions(path, ["a"], unit="g", dt=0.005)
