"""Ensembles written to a file: the numbers of overturns(), whatever the row groups and threads."""

import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest

from rockfrag.errors import InputError
from rockfrag.rocking import parquet
from rockfrag.rocking.ensemble import overturns
from rockfrag.rocking.parquet import stream_overturns
from rockfrag.system.blocks import Block, Stack

DT = 0.01
TIME = np.arange(600) * DT
MOTIONS = [
    9.81 * np.exp(-(((TIME - 3) / 1.5) ** 2)) * np.sin(2 * np.pi * f * TIME)
    for f in (0.8, 1.5, 3.0)
]
BLOCK = Block(width=0.3, height=1.2, mass=200.0)
BODIES = [BLOCK, Stack(Block(width=0.4, height=0.3, mass=100.0), BLOCK)]
SCALES = np.linspace(0.2, 1.4, 7)


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


@pytest.mark.parametrize("rows", [2, 5, 7, 20, 30])
def test_row_groups_change_no_number(tmp_path, monkeypatch, rows):
    stream_overturns(BODIES, MOTIONS, DT, SCALES, tmp_path / "whole.parquet", table="bodies")
    monkeypatch.setattr(parquet, "ROWS", rows)
    stream_overturns(BODIES, MOTIONS, DT, SCALES, tmp_path / "cut.parquet", table="bodies")
    file = pq.ParquetFile(tmp_path / "cut.parquet")
    groups = [file.metadata.row_group(i).num_rows for i in range(file.num_row_groups)]
    assert max(groups) <= rows
    pd.testing.assert_frame_equal(
        pd.read_parquet(tmp_path / "whole.parquet"),
        pd.read_parquet(tmp_path / "cut.parquet"),
        check_exact=True,
    )


def test_threads_change_no_byte(tmp_path, monkeypatch):
    monkeypatch.setattr(parquet, "ROWS", 9)
    for threads in (1, 2):
        stream_overturns(
            BODIES, MOTIONS, DT, SCALES, tmp_path / f"{threads}.parquet", threads=threads
        )
    assert (tmp_path / "1.parquet").read_bytes() == (tmp_path / "2.parquet").read_bytes()


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


def test_a_run_that_fails_leaves_the_file_that_was_there(tmp_path, monkeypatch):
    path = tmp_path / "e.parquet"
    path.write_bytes(b"earlier")
    monkeypatch.setattr(parquet, "ROWS", 5)

    def stop(done: int, total: int) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        stream_overturns(BODIES, MOTIONS, DT, SCALES, path, progress=stop)
    assert path.read_bytes() == b"earlier"
    assert list(tmp_path.iterdir()) == [path]


def test_wrong_columns_are_named(tmp_path):
    with pytest.raises(InputError, match="columns: 'a' is no column of 'cases'"):
        stream_overturns(BODIES, MOTIONS, DT, SCALES, tmp_path / "x", columns="all")
