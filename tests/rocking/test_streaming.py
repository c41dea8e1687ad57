"""Outcomes and histories written to a file: the numbers of overturns() and simulate(), however they are cut."""

import tracemalloc

import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest

from rockfrag.errors import InputError
from rockfrag.rocking import overturns, parquet, simulate
from rockfrag.rocking.parquet import stream_histories, stream_overturns
from rockfrag.system import Block, Stack

DT = 0.01
TIME = np.arange(600) * DT
MOTIONS = [
    9.81 * np.exp(-(((TIME - 3) / 1.5) ** 2)) * np.sin(2 * np.pi * f * TIME)
    for f in (0.8, 1.5, 3.0)
]
BLOCK = Block(width=0.3, height=1.2, mass=200.0)
BODIES = [BLOCK, Stack(Block(width=0.4, height=0.3, mass=100.0), BLOCK)]
SCALES = np.linspace(0.2, 1.4, 7)
TWO = [motion[100:500] for motion in MOTIONS[:2]]
THREE = np.array([0.2, 0.5, 0.9])


@pytest.mark.parametrize(
    ("stream", "rows"),
    [(stream_overturns, rows) for rows in (2, 5, 7)]
    + [(stream_histories, rows) for rows in (300, 1000, 3000)],
)
def test_row_groups_are_bounded_and_change_no_number(tmp_path, monkeypatch, stream, rows):
    stream(BODIES, TWO, DT, THREE, tmp_path / "whole")
    monkeypatch.setattr(parquet, "ROWS", rows)
    stream(BODIES, TWO, DT, THREE, tmp_path / "cut")
    file = pq.ParquetFile(tmp_path / "cut")
    groups = [file.metadata.row_group(i).num_rows for i in range(file.num_row_groups)]
    assert max(groups) <= rows
    assert len(groups) > 1
    pd.testing.assert_frame_equal(
        pd.read_parquet(tmp_path / "whole"), pd.read_parquet(tmp_path / "cut"), check_exact=True
    )


@pytest.mark.parametrize(("stream", "rows"), [(stream_overturns, 5), (stream_histories, 1000)])
def test_threads_change_no_byte(tmp_path, monkeypatch, stream, rows):
    monkeypatch.setattr(parquet, "ROWS", rows)
    for threads in (1, 2, 5):
        stream(BODIES, TWO, DT, THREE, tmp_path / f"{threads}", threads=threads)
    assert (tmp_path / "1").read_bytes() == (tmp_path / "2").read_bytes()
    assert (tmp_path / "1").read_bytes() == (tmp_path / "5").read_bytes()


@pytest.mark.parametrize(("stream", "rows"), [(stream_overturns, 5), (stream_histories, 1000)])
def test_a_run_that_fails_leaves_the_file_that_was_there(tmp_path, monkeypatch, stream, rows):
    path = tmp_path / "e.parquet"
    path.write_bytes(b"earlier")
    monkeypatch.setattr(parquet, "ROWS", rows)

    def stop(done: int, total: int) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        stream(BODIES, TWO, DT, THREE, path, progress=stop)
    assert path.read_bytes() == b"earlier"
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("which", ["cases", "bodies", "contacts"])
def test_the_file_is_the_table_of_the_outcomes(tmp_path, which):
    path = tmp_path / "ensemble.parquet"
    seen = []
    columns = ("overturned", "certain_time", "impacts") if which == "cases" else None
    count = stream_overturns(
        BODIES, MOTIONS, DT, SCALES, path,
        table=which, columns=columns, progress=lambda *n: seen.append(n),
    )  # fmt: skip
    result = overturns(BODIES, MOTIONS, DT, SCALES)
    assert count == result.overturned.size
    assert seen[-1] == (count, count)
    expected = result.table(which, columns).drop(columns="engine", errors="ignore")
    pd.testing.assert_frame_equal(
        pd.read_parquet(path), expected, check_dtype=False, check_exact=True
    )
    assert 0 < result.overturned.mean() < 1


def test_outcomes_alone_take_no_other_columns(tmp_path):
    stream_overturns(BODIES, MOTIONS, DT, SCALES, tmp_path / "v.parquet")
    columns = pq.read_schema(tmp_path / "v.parquet").names
    assert columns == ["system", "motion", "scale", "overturned", "overturned_body"]


def test_scales_and_restitutions_go_with_their_motion_and_body(tmp_path, monkeypatch):
    monkeypatch.setattr(parquet, "ROWS", 2)
    scales = np.array([[0.5, 1.0], [0.8, 1.6], [1.1, 2.2]])
    restitution = [0.8, (0.4, 0.9)]
    path = tmp_path / "s.parquet"
    stream_overturns(
        BODIES, MOTIONS, [DT, DT, 2 * DT], scales, path, table="bodies", restitution=restitution
    )
    result = overturns(BODIES, MOTIONS, [DT, DT, 2 * DT], scales, restitution=restitution)
    table = pd.read_parquet(path)
    pd.testing.assert_frame_equal(table, result.table("bodies"), check_dtype=False)


def test_wrong_columns_are_named(tmp_path):
    with pytest.raises(InputError, match="columns: 'a' is no column of 'cases'"):
        stream_overturns(BODIES, MOTIONS, DT, SCALES, tmp_path / "x", columns="all")


# --------------------------------------------------------------------------- histories


@pytest.mark.filterwarnings("ignore::rockfrag.rocking.ensemble.LightBodies")
def test_the_file_holds_the_history_of_every_case_in_order(tmp_path):
    path = tmp_path / "histories.parquet"
    seen = []
    scales = np.array([THREE, 1.1 * THREE])
    dts = [DT, 2 * DT]
    restitution = [0.9, (0.5, None)]
    count = stream_histories(
        BODIES, TWO, dts, scales, path, restitution=restitution, progress=lambda *n: seen.append(n)
    )
    assert count == 12
    assert seen[-1] == (12, 12)
    table = pd.read_parquet(path)
    first, fallen = 0, 0
    for b, m, s in np.ndindex(2, *scales.shape):
        response = simulate(BODIES[b], scales[m, s] * TWO[m], dts[m], restitution=restitution[b])
        bodies = response.theta.shape[1]
        n = bodies * len(response.time)
        rows = table.iloc[first : first + n]
        first += n
        fallen += response.overturned
        assert (rows["system"] == b).all()
        assert (rows["motion"] == m).all()
        assert (rows["scale"] == scales[m, s]).all()
        for i in range(bodies):
            own = rows[rows["body"] == i + 1]
            np.testing.assert_array_equal(own["time_s"], response.time)
            np.testing.assert_array_equal(own["theta_rad"], response.theta[:, i])
            np.testing.assert_array_equal(own["omega_rad_s"], response.omega[:, i])
            np.testing.assert_array_equal(own["state"], response.state[:, i])
    assert first == len(table)
    assert 0 < fallen < 12


def test_a_shorter_step_and_another_gravity_are_used(tmp_path):
    for name, arguments in {"a": {}, "b": {"step": 0.02}, "c": {"g": 1.62}}.items():
        stream_histories(BLOCK, TWO[0], DT, [0.5], tmp_path / name, **arguments)
    item, finer, moon = (pd.read_parquet(tmp_path / name) for name in "abc")
    assert len(finer) == len(item)
    assert 0 < np.abs(finer["theta_rad"] - item["theta_rad"]).max() < 1e-8
    expected = simulate(BLOCK, 0.5 * TWO[0], DT, g=1.62)
    np.testing.assert_array_equal(moon["theta_rad"], expected.theta[:, 0])


def test_memory_is_flat_in_the_number_of_cases(tmp_path, monkeypatch):
    monkeypatch.setattr(parquet, "ROWS", 5000)
    most = []
    tracemalloc.start()
    for count in (1, 10, 200):  # the first loads the kernel
        scales = np.linspace(0.3, 0.4, count)
        tracemalloc.reset_peak()
        before = tracemalloc.get_traced_memory()[0]
        stream_histories(BLOCK, TWO, DT, scales, tmp_path / "h", threads=1)
        most.append(tracemalloc.get_traced_memory()[1] - before)
    tracemalloc.stop()
    # 0.8 MB, where the longest run has 15 MB of rows
    assert most[2] < most[1] + 1e6


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        (
            {"bodies": [BLOCK, "T2"]},
            r"bodies\[1\]: expected a Block, a Stack, a Column or a System, got 'T2'",
        ),
        ({"dt": [DT, 1e6]}, "is too long for a block"),
        ({"restitution": [0.9, 0.9]}, "a pair"),
    ],
)
def test_wrong_arguments_are_named_before_anything_is_written(tmp_path, changed, message):
    arguments = {"bodies": BODIES, "motions": TWO, "dt": DT, "scales": THREE} | changed
    with pytest.raises(InputError, match=message) as caught:
        stream_histories(**arguments, path=tmp_path / "h.parquet")
    assert str(caught.value).count(". ") == 0
    assert not list(tmp_path.iterdir())


def test_no_case_is_a_file_without_rows(tmp_path):
    assert stream_histories(BODIES, TWO, DT, [], tmp_path / "none") == 0
    assert stream_histories(BODIES, [], DT, [1.0], tmp_path / "none") == 0
    table = pq.read_table(tmp_path / "none")
    assert len(table) == 0
    assert table.schema.names == [
        "system", "motion", "scale", "time_s", "body", "theta_rad", "omega_rad_s", "state",
    ]  # fmt: skip
