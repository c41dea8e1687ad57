"""Hazard files of every kind are read, and what is wrong with one is said in a sentence."""

from pathlib import Path

import numpy as np
import pytest

from rockfrag.assess import read_hazard
from rockfrag.assess.hazard.curve import PGA, PGV, curve_of_one_level, read_measure
from rockfrag.errors import InputError
from rockfrag.motions.intensity import intensity_measures

from . import samples


def write(folder: Path, name: str, text: str) -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize("name", samples.SAMPLES)
def test_every_kind_of_file_gives_the_rates_it_was_made_of(name, tmp_path):
    (curve,) = read_hazard([write(tmp_path, name, samples.SAMPLES[name])])
    at = np.array([0.03, 0.1, 0.7])
    assert curve.rate(at) == pytest.approx([samples.rate(x) for x in at], rel=1e-4)
    assert curve.level(samples.rate(0.3)) == pytest.approx(0.3, rel=1e-4)


def test_measures_are_known_by_all_their_names():
    for text in ("SA(0.2)", "SA0P2", "sa_0.2s", "PSA-0.2s", "SA[0.2]"):
        assert read_measure(text, "here").imt == "SA(0.2)"
    assert read_measure("pga", "here") == PGA
    # they are those of tables and curves
    known = intensity_measures([0.2])
    assert {PGA, PGV, read_measure("SA(0.2)", "here")} <= set(known)
    with pytest.raises(InputError, match="MMI"):
        read_measure("MMI", "here")


def test_quantiles_belong_to_the_mean(tmp_path):
    (curve,) = read_hazard(samples.quantile_files(tmp_path, "PGA"))
    assert list(curve.quantiles) == [0.16, 0.84]
    assert curve.quantiles[0.84].rate(0.1) == pytest.approx(0.015, rel=1e-4)


def test_without_a_mean_the_median_stands_in(tmp_path):
    path = write(tmp_path, "q.xml", samples.efehr_xml('statistics="quantile" quantileValue="0.5"'))
    (curve,) = read_hazard([path])
    assert curve.rate(0.1) == pytest.approx(0.01, rel=1e-4)


def test_several_measures_are_several_curves(tmp_path):
    files = [
        write(tmp_path, f"{i}.csv", samples.openquake_csv(imt=imt))
        for i, imt in enumerate(("PGA", "SA(0.3)"))
    ]
    assert [curve.measure.imt for curve in read_hazard(files)] == ["PGA", "SA(0.3)"]


def test_one_level_passes_through_its_return_period():
    curve = curve_of_one_level(PGA, 0.25, 475)
    assert curve.rate(0.25) == pytest.approx(1 / 475)
    assert curve.rate(0.5) == pytest.approx(1 / 475 / 8)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "header"),
        ("pga_g,annual_rate\n0.1,0.01\n0.2,0.02\n", "rises"),
        ("pga_g,annual_rate\n0.1,0.01\n0.1,0.005\n", "rise from above 0"),
        ("pga_g,annual_rate\n0.1,-0.01\n0.2,-0.02\n", "rates of exceedance"),
        ("pga_g,annual_rate\n0.1,x\n0.2,0.02\n", "line 2"),
        ("pga_g,annual_rate\n10,0.01\n250,0.001\n", "check the unit"),
        ("pga_g,annual_rate\n0.0001,0.01\n0.0002,0.001\n", "check the unit"),
        ("pgv_g,annual_rate\n10,0.01\n20,0.001\n", "no unit"),
        ("pga_g,percent\n0.1,0.01\n0.2,0.001\n", "percent"),
        ("mmi,annual_rate\n7,0.01\n8,0.001\n", "expected a column"),
        ("pga_g,poe_50_years\n0.1,0.4\n0.2,1.2\n", "1.2"),
        ("pga_g,return_period_years\n0.1,0\n0.2,475\n", "return period"),
        ("pga_g,poe_50_years\n0.1,1\n0.2,0\n", "0 usable point"),
        (samples.openquake_csv(kind="rlz-003"), "rlz-003"),
        (samples.openquake_csv() + "9" * 140_000, "damaged as a table"),
        (samples.efehr_xml().replace('Span="50.0"', 'Span="50 0"'), "time is 2 numbers"),
        (samples.openquake_csv(imt="MMI"), "MMI"),
        (samples.openquake_csv().replace("investigation_time=50.0, ", ""), "investigation_time"),
        (samples.openquake_csv() + samples.openquake_csv().splitlines()[-1] + "\n", "2 sites"),
        (samples.usgs_json()[:-20], "JSON"),
        (samples.usgs_json().replace("Total", "Grid"), "Total"),
        ('{"status": "error", "message": "no"}', "USGS"),
        (samples.efehr_xml()[:-20], "XML"),
        (samples.efehr_xml().replace("investigationTimeSpan", "time"), "investigation time"),
        ("<!DOCTYPE x [<!ENTITY a 'b'>]><x>&a;</x>", "document type"),
        ("<errors><error>no model</error></errors>", "hazard curves"),
        ("PK\x03\x04", "spreadsheet"),
    ],
)
def test_what_is_wrong_is_said_in_a_sentence(text, words, tmp_path):
    with pytest.raises(InputError, match=words):
        read_hazard([write(tmp_path, "hazard", text)])


def test_a_curve_given_twice_is_refused(tmp_path):
    path = write(tmp_path, "a.csv", samples.table_csv())
    with pytest.raises(InputError, match="twice"):
        read_hazard([path, path])


def test_a_file_that_is_absent_or_no_text_is_refused(tmp_path):
    binary = tmp_path / "x.csv"
    binary.write_bytes(b"\xff\xfe\x00\x01")
    for path in (tmp_path / "absent.csv", tmp_path, binary):
        with pytest.raises(InputError):
            read_hazard([path])
