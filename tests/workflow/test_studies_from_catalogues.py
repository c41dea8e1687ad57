"""A folder of records, or a download, becomes a study in two commands: a catalogue, and the run."""

import itertools
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from rockfrag.cli.main import main
from rockfrag.stages import motions
from rockfrag.study.loading import load_any

from ..records.built_records import peer_download
from ..stages_in_process import run_stages
from .conftest import write_record


def far_field_set(folder: Path) -> Path:
    """22 pairs named as those of FEMA P-695: ``120111.txt`` and ``120112.txt`` are one record.

    One pair has no time column, another one whose times are those of a clock that trembles.
    """
    folder.mkdir()
    for pair, component in itertools.product(range(22), (1, 2)):
        path = folder / f"12{pair:02d}1{component}.txt"
        write_record(path, seed=2 * pair + component)
        values = np.loadtxt(path)[:, 1]
        if pair == 7:
            np.savetxt(path, values, "%.6f")
        if pair == 9:
            steps = np.arange(values.size)
            times = 0.01 * steps + 2e-4 * np.sin(steps)
            np.savetxt(path, np.column_stack([times, values]), "%.4f %.6f")
    return folder


def run_motions(study_folder: Path, monkeypatch: pytest.MonkeyPatch) -> pd.DataFrame:
    """Run the stage of the motions as ``make run`` does, and return its table of measures."""
    monkeypatch.chdir(study_folder)
    study = load_any("study.yaml")
    return pd.read_csv(
        run_stages(study, Path("results"), [motions.run]) / "measures.csv"
    )


def test_44_text_files_become_a_study(study_folder, monkeypatch, capsys):
    folder = far_field_set(study_folder / "records")
    catalogue = str(study_folder / "motions.csv")
    about = ("--unit", "g", "--dt", "0.01")
    assert main(["catalogue", str(folder), *about, "--output", catalogue]) == 0
    table = pd.read_csv(catalogue, dtype=str, keep_default_na=False)
    assert len(table) == 44
    assert (table["second"] != "").all()
    assert table.groupby("earthquake").size().tolist() == [2] * 22
    # of the pair without times; the others state their own
    assert sorted(table["dt"][table["dt"] != ""]) == ["0.01"] * 2
    assert "its earthquake is not stated" in capsys.readouterr().err
    measures = run_motions(study_folder, monkeypatch)
    assert len(measures) == 44
    assert (measures["rotd100_pga_g"] >= measures["pga_g"] * (1 - 1e-3)).all()
    assert (measures["rotd50_pga_g"] <= measures["rotd100_pga_g"]).all()
    # both components of a record have the measures that no direction decides
    assert measures.groupby("earthquake")["rotd50_pga_g"].nunique().eq(1).all()


def test_a_row_may_ask_for_a_direction_of_both_components(study_folder, monkeypatch):
    folder = peer_download(study_folder / "download", 2)
    catalogue = study_folder / "motions.csv"
    main(["catalogue", str(folder), "--output", str(catalogue)])
    table = pd.read_csv(catalogue, dtype=str, keep_default_na=False)
    table = table.iloc[[0, 0, 0]].assign(name=["a", "b", "c"])
    table["direction"] = ["stronger", "90", "fault-normal 0"]
    table.to_csv(catalogue, index=False)
    measures = run_motions(study_folder, monkeypatch).set_index("name")
    peaks, (strongest, *_) = measures["pga_g"], measures["rotd100_pga_g"]
    assert peaks["a_ground"] >= strongest * (1 - 1e-9)
    assert peaks["b_ground"] == pytest.approx(peaks["c_ground"])
