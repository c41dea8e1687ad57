"""Outcomes and histories written to a file: the numbers of overturns() and simulate(), however they are cut."""

import tracemalloc

import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest

from rockfrag.base.errors import InputError
from rockfrag.simulation import overturns, parquet, simulate
from rockfrag.simulation.parquet import stream_histories, stream_overturns
from rockfrag.system import Block, Stack

DT = 0.01
TIME = np.arange(600) * DT
MOTIONS = [
    9.81 * np.exp(-(((TIME - 3) / 1.5) ** 2)) * np.sin(2 * np.pi * f * TIME)
    for f in (0.8, 1.5, 3.0)
]
BLOCK = Block(width=0.3, height=1.2, mass=200.0)
BODIES = [BLOCK, Stack(Block(width=0.4, height=0.3, mass=100.0), BLOCK)]
TWO = [motion[100:500] for motion in MOTIONS[:2]]
THREE = np.array([0.2, 0.5, 0.9])


@pytest.mark.parametrize(
    ("stream", "rows"),
    [(stream_overturns, 2), (stream_overturns, 5), (stream_histories, 300), (stream_histories, 3000)],
)  # fmt: skip
def test_neither_row_groups_nor_threads_change_a_number_and_a_failure_leaves_what_was_there(
    tmp_path, monkeypatch, stream, rows
):
    case, cut = (BODIES, TWO, DT, THREE), tmp_path / "cut"
    stream(*case, tmp_path / "whole")
    monkeypatch.setattr(parquet, "ROWS", rows)
    stream(*case, cut, threads=1)
    file = pq.ParquetFile(cut)
    groups = [file.metadata.row_group(i).num_rows for i in range(file.num_row_groups)]
    assert max(groups) <= rows and len(groups) > 1
    whole = pd.read_parquet(tmp_path / "whole")
    pd.testing.assert_frame_equal(whole, pd.read_parquet(cut), check_exact=True)
    stream(*case, tmp_path / "threads", threads=5)
    assert (tmp_path / "threads").read_bytes() == cut.read_bytes()

    def stop(done: int, total: int) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        stream(*case, cut, progress=stop)
    assert (tmp_path / "threads").read_bytes() == cut.read_bytes()
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "cut",
        "threads",
        "whole",
    ]


@pytest.mark.parametrize("which", ["cases", "bodies", "contacts"])
def test_the_file_is_the_table_of_the_outcomes(tmp_path, monkeypatch, which):
    monkeypatch.setattr(parquet, "ROWS", 2)
    path, seen = tmp_path / "ensemble.parquet", []
    # scales and intervals go with their motion, restitutions with their body
    case = (
        BODIES,
        MOTIONS,
        [DT, DT, 2 * DT],
        np.array([[0.5, 1.0], [0.8, 1.6], [0.3, 0.6]]),
    )
    restitution = [0.8, (0.4, 0.9)]
    columns = ("overturned", "certain_time", "impacts") if which == "cases" else None
    more = {"columns": columns, "progress": lambda *n: seen.append(n)}
    count = stream_overturns(*case, path, table=which, restitution=restitution, **more)
    result = overturns(*case, restitution=restitution)
    assert (
        seen[-1] == (count, count) == (result.overturned.size, result.overturned.size)
    )
    expected = result.table(which, columns).drop(
        columns=["engine", "system_name", "motion_name"], errors="ignore"
    )
    pd.testing.assert_frame_equal(
        pd.read_parquet(path), expected, check_dtype=False, check_exact=True
    )
    assert 0 < result.overturned.mean() < 1
    # outcomes alone take no other columns
    stream_overturns(*case, path)
    columns = pq.read_schema(path).names
    assert columns == ["system", "motion", "scale", "overturned", "overturned_body"]


@pytest.mark.filterwarnings("ignore::rockfrag.simulation.ensemble.LightBodies")
def test_the_file_holds_the_history_of_every_case_in_order(tmp_path):
    path, seen, fallen = tmp_path / "histories.parquet", [], 0
    scales, dts = np.array([THREE, 1.1 * THREE]), [DT, 2 * DT]
    restitution = [0.9, (0.5, None)]
    count = stream_histories(
        BODIES,
        TWO,
        dts,
        scales,
        path,
        restitution=restitution,
        progress=lambda *n: seen.append(n),
    )
    assert count == 12 and seen[-1] == (12, 12)
    expected = []
    for b, m, s in np.ndindex(2, *scales.shape):
        response = simulate(
            BODIES[b], scales[m, s] * TWO[m], dts[m], restitution=restitution[b]
        )
        fallen += response.overturned
        samples, bodies = response.theta.shape
        columns = {
            "system": b,
            "motion": m,
            "scale": scales[m, s],
            "time_s": np.repeat(response.time, bodies),
            "body": np.tile(np.arange(bodies) + 1, samples),
            "theta_rad": response.theta.ravel(),
            "omega_rad_s": response.omega.ravel(),
            "state": response.state.ravel(),
        }
        expected.append(pd.DataFrame(columns))
    pd.testing.assert_frame_equal(
        pd.read_parquet(path),
        pd.concat(expected, ignore_index=True),
        check_dtype=False,
        check_exact=True,
    )
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


def test_wrong_arguments_leave_no_file_and_no_case_one_without_rows(tmp_path):
    path = tmp_path / "h.parquet"
    with pytest.raises(InputError, match="is too long for a block"):
        stream_histories(BODIES, TWO, [DT, 1e6], THREE, path)
    assert not list(tmp_path.iterdir())
    for motions, scales in ((TWO, []), ([], [1.0])):
        assert stream_histories(BODIES, motions, DT, scales, path) == 0
        assert len(pd.read_parquet(path)) == 0
