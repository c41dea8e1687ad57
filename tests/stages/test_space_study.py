"""A study of bodies in space: medians under both components over those of planar rocking."""

import base64
import json
import math
from pathlib import Path

import numpy as np
import pytest

from rockfrag.base.errors import InputError
from rockfrag.report.space_page import _live
from rockfrag.stages import space_study as stage
from rockfrag.stages.space_study import PLANAR, median
from rockfrag.study.loading import any_study, load_any
from rockfrag.study.space import SpaceStudy

from ..case_tables import case_tables
from ..stages_in_process import files_read, run_stages
from ..workflow.conftest import CATALOGUE, write_record, write_study

SMALL = case_tables(__file__)


def test_a_median_lies_between_the_levels_where_half_is_passed():
    levels = np.array([1.0, 2.0, 4.0])
    assert median(np.array([0.0, 0.25, 0.75]), levels) == pytest.approx(
        2 * math.sqrt(2)
    )
    # where more shaking topples fewer, the first half counts
    assert median(np.array([0.4, 0.6, 0.2]), levels) == pytest.approx(math.sqrt(2))
    assert math.isnan(median(np.array([0.6, 0.7, 0.8]), levels))
    assert math.isnan(median(np.array([0.1, 0.2, 0.3]), levels))


def test_a_study_of_bodies_in_space_gives_medians_and_a_report(
    tmp_path, monkeypatch, made_motions
):
    motions = made_motions(12)
    pairs = list(zip(motions[::2], motions[1::2], strict=True))
    names = [str(first.metadata["earthquake"]) for first, _ in pairs]
    monkeypatch.setattr(
        stage, "wide_set", lambda every: (pairs[::every], names[::every])
    )
    study = any_study(SMALL, "space.yaml")
    assert isinstance(study, SpaceStudy)
    folder = run_stages(study, tmp_path)
    medians = stage.pd.read_parquet(folder / "medians.parquet")
    assert list(medians["base"]) == ["square", "round", "round"]
    assert list(medians["planar_impacts"]) == ["momentum", "momentum", "none"]
    assert (medians["flip_rate"].between(0, 1)).all()
    for name in PLANAR:
        assert (medians[f"{name}_lower"] <= medians[f"{name}_upper"]).all()
    fractions = stage.pd.read_parquet(folder / "fractions.parquet")
    assert len(fractions) == 3 * 8
    # every direction that topples is among those of which the worst is taken
    assert (fractions["worst_direction"] >= fractions["mean_direction"]).all()
    # planar impacts that lose nothing change the planar answers only
    lossless = fractions["planar_impacts"] == "none"
    rolls = fractions[(fractions["base"] == "round") & ~lossless]
    np.testing.assert_array_equal(fractions[lossless]["space"], rolls["space"])
    page = (folder / "report.html").read_text(encoding="utf-8")
    assert "Base round: in space" in page
    live = json.loads(page.split('id="live-data">')[1].split("</script>")[0])
    names = [body["name"] for body in live["bodies"]]
    assert names == [
        f"{base}, height over width 4, 1 m" for base in ("square", "round")
    ]
    for text, component in zip(live["motions"][0]["samples"], pairs[0], strict=True):
        samples = np.frombuffer(base64.b64decode(text))
        np.testing.assert_array_equal(samples, component.acceleration)


def test_all_files_that_a_study_in_space_reads_make_it_run_again(tmp_path):
    rows = [CATALOGUE.replace(",file,", ",file,second,")]
    for number in range(3):
        names = f"x{number}.txt", f"y{number}.txt"
        for seed, name in enumerate(names):
            write_record(tmp_path / name, 10 * number + seed, samples=250, dt=0.02)
        files = ",".join(names)
        rows.append(f"m{number},E{number},,,,,,folder,{files},,g,made up\n")
    (tmp_path / "motions.csv").write_text("".join(rows))
    space = {key: value for key, value in SMALL["space"].items() if key != "every"}
    content = SMALL | {"space": space | {"catalogue": "motions.csv"}}
    path = write_study(tmp_path, content)
    study = load_any(path)
    assert isinstance(study, SpaceStudy)

    def reads(job):
        stage.own_pairs(job.study)
        return iter(())

    read = files_read(path, [reads])
    assert {*map(str, read)} == {*study.files, str(path)}


def test_bodies_whose_base_differs_from_record_to_record_are_not_shown_live(
    made_motions,
):
    study = any_study(
        SMALL | {"space": SMALL["space"] | {"base_spread": 0.01}}, "space.yaml"
    )
    assert _live(study, made_motions(2)) == ""


@pytest.fixture
def pairs_of_a_catalogue(tmp_path, made_motions):
    """A catalogue of two pairs of components, of which one stands there once more in another direction."""
    rows = ["name,earthquake,file,second,unit,direction,scale_factor"]
    for i, motion in enumerate(made_motions(4)):
        table = np.column_stack([motion.time, motion.acceleration / 9.81])
        np.savetxt(tmp_path / f"{i}.txt", table, "%.7f")
    rows += ["a,first,0.txt,1.txt,g,,2", "a stronger,first,1.txt,0.txt,g,stronger,2"]
    rows += ["b,second,2.txt,3.txt,g,,"]
    (tmp_path / "mine.csv").write_text("\n".join(rows) + "\n")
    return tmp_path


def of_a_catalogue(folder):
    space = SMALL["space"] | {"catalogue": "mine.csv"}
    del space["every"]
    return any_study(SMALL | {"space": space}, folder / "space.yaml")


def test_the_pairs_of_a_catalogue_shake_bodies_in_space(
    pairs_of_a_catalogue, made_motions
):
    study = of_a_catalogue(pairs_of_a_catalogue)
    named = {Path(file).name for file in study.files}
    assert named == {"mine.csv", *(f"{i}.txt" for i in range(4))}
    pairs, earthquakes = stage.own_pairs(study)
    assert earthquakes == ["first", "second"]
    for factor, pair, first in zip((2, 1), pairs, (0, 2), strict=True):
        for motion, made in zip(pair, made_motions(4)[first : first + 2], strict=True):
            np.testing.assert_allclose(
                motion.acceleration, factor * made.acceleration, atol=1e-5
            )
    folder = run_stages(study, pairs_of_a_catalogue / "results")
    assert "the records of mine.csv" in (folder / "report.html").read_text(
        encoding="utf-8"
    )
    with (pairs_of_a_catalogue / "mine.csv").open("a") as catalogue:
        catalogue.write("c,third,0.txt,,g,,\n")
    with pytest.raises(InputError, match="motion c has no second component"):
        of_a_catalogue(pairs_of_a_catalogue)
