"""Branches that OpenQuake computes: its weights return its mean curve, and new weights are read back."""

import csv
import math
import os
import re
import subprocess
import sys

import numpy as np
import pandas as pd
import pytest

from rockfrag.assess.hazard.measure import PGA, PGV
from rockfrag.cli import main
from rockfrag.errors import InputError
from rockfrag.survival.branches import read_branches

from ..assess.samples import openquake_csv

YEARS = 50.0
THETA, BETA, AGE = 0.25, 0.3, 4000.0
SITE = f"""
name: site
hazard: {{realizations: realizations_7.csv, curves: [%s]}}
objects: [{{name: rock, median: {THETA} g, beta: {BETA}, age_years: {AGE:g}}}]
"""

JOB = """
[general]
description = four branches
calculation_mode = classical
sites = 0.1 0.1
number_of_logic_tree_samples = 0
rupture_mesh_spacing = 5
width_of_mfd_bin = 0.2
reference_vs30_type = measured
reference_vs30_value = 600
reference_depth_to_2pt5km_per_sec = 5
reference_depth_to_1pt0km_per_sec = 100
source_model_logic_tree_file = sources.xml
gsim_logic_tree_file = ground.xml
investigation_time = 50
intensity_measure_types_and_levels = {"PGA": logscale(0.005, 2, 30), "PGV": logscale(0.5, 200, 30)}
truncation_level = 3
maximum_distance = 200
individual_rlzs = true
mean = true
"""

NRML = '<nrml xmlns:gml="http://www.opengis.net/gml" xmlns="http://openquake.org/xmlns/nrml/0.5">{}</nrml>'

SOURCE = """<sourceModel name="one"><sourceGroup tectonicRegion="Active Shallow Crust">
<pointSource id="1" name="p" tectonicRegion="Active Shallow Crust">
<pointGeometry><gml:Point><gml:pos>0 0</gml:pos></gml:Point>
<upperSeismoDepth>0</upperSeismoDepth><lowerSeismoDepth>15</lowerSeismoDepth></pointGeometry>
<magScaleRel>WC1994</magScaleRel><ruptAspectRatio>1</ruptAspectRatio>
<truncGutenbergRichterMFD aValue="3.5" bValue="1.0" minMag="5.0" maxMag="6.5"/>
<nodalPlaneDist><nodalPlane probability="1" strike="0" dip="90" rake="0"/></nodalPlaneDist>
<hypoDepthDist><hypoDepth probability="1" depth="7"/></hypoDepthDist>
</pointSource></sourceGroup></sourceModel>"""

BRANCH = """<logicTreeBranch branchID="{}"><uncertaintyModel>{}</uncertaintyModel>
<uncertaintyWeight>{}</uncertaintyWeight></logicTreeBranch>"""

RUN = """
from openquake.commonlib import logs
logs.dbcmd("upgrade_db")
from openquake.calculators import base
from openquake.calculators.export import export
with logs.init("job.ini") as log:
    oq = log.get_oqparam()
    oq.export_dir = "."
    calculator = base.calculators(oq, log.calc_id)
    calculator.run(export_dir=".")
    for what in ("realizations", "hcurves"):
        export((what, "csv"), calculator.datastore)
"""


def branch_set(number, kind, more, branches):
    inside = "".join(
        BRANCH.format(f"{number}{i}", model, weight) for i, (model, weight) in enumerate(branches)
    )
    return (
        f'<logicTreeBranchSet uncertaintyType="{kind}" branchSetID="{number}" {more}>{inside}'
        "</logicTreeBranchSet>"
    )


def write_job(folder):
    """One source with two rates of earthquakes, two ground motion models: four branches of unequal weight."""
    (folder / "job.ini").write_text(JOB)
    (folder / "source.xml").write_text(NRML.format(SOURCE))
    rates = [("3.2 1.0", 0.35), ("3.9 1.0", 0.65)]
    of_sources = [
        branch_set("a", "sourceModel", "", [("source.xml", 1.0)]),
        branch_set("b", "abGRAbsolute", 'applyToSources="1"', rates),
    ]
    of_ground = branch_set(
        "g",
        "gmpeModel",
        'applyToTectonicRegionType="Active Shallow Crust"',
        [("BooreAtkinson2008", 0.6), ("CampbellBozorgnia2008", 0.4)],
    )
    for name, sets in (("sources.xml", of_sources), ("ground.xml", [of_ground])):
        tree = f'<logicTree logicTreeID="t">{"".join(sets)}</logicTree>'
        (folder / name).write_text(NRML.format(tree))


def rows_of(path):
    """Levels and probabilities of a file of curves, read without the package."""
    lines = [line for line in path.read_text().splitlines() if not line.startswith("#")]
    header, row = csv.reader(lines)
    levels = [float(re.sub("^poe-", "", title)) for title in header[3:]]
    return np.array(levels), np.array(row[3:], dtype=float)


@pytest.fixture(scope="module")
def calculated(tmp_path_factory):
    """What OpenQuake exported of a calculation of its own."""
    pytest.importorskip(
        "openquake.calculators.base", reason="openquake.engine is not installed, or cannot run here"
    )
    folder = tmp_path_factory.mktemp("openquake")
    write_job(folder)
    environment = os.environ | {"OQ_DISTRIBUTE": "no", "OQ_DATADIR": str(folder)}
    environment |= {"HOME": str(folder)}
    subprocess.run(
        [sys.executable, "-c", RUN], cwd=folder, check=True, capture_output=True, env=environment
    )
    return folder


@pytest.mark.peers
@pytest.mark.slow
@pytest.mark.parametrize("measure", [PGA, PGV])
def test_weights_of_openquake_return_its_mean_curve(calculated, measure):
    paths = sorted(calculated.glob(f"hazard_curve-rlz-*-{measure.name}_*.csv"))
    branches = read_branches(paths, calculated / "realizations_1.csv")
    weights = [0.35 * 0.6, 0.35 * 0.4, 0.65 * 0.6, 0.65 * 0.4]
    assert [branch.weight for branch in branches] == pytest.approx(weights)
    levels, mean = rows_of(calculated / f"hazard_curve-mean-{measure.name}_1.csv")
    curves = [branch.curves[measure] for branch in branches]
    # beyond the ends that all exports know the package continues a power law
    first, last = max(c.levels[0] for c in curves), min(c.levels[-1] for c in curves)
    known = (levels >= first) & (levels <= last)
    assert known.sum() >= 20
    # its mean is that of the probabilities
    poes = [-np.expm1(-YEARS * curve.rate(levels[known])) for curve in curves]
    assert np.array(weights) @ poes == pytest.approx(mean[known], rel=2e-5)


def exported(folder):
    """Exports of three branches at one site, whose rates at 0.1 g come back by their numbers."""
    rates = {0: 0.002, 1: 0.005, 2: 0.012}
    for number, rate in rates.items():
        path = folder / f"hazard_curve-rlz-{number:03d}-PGA_7.csv"
        path.write_text(openquake_csv("PGA", f"rlz-{number:03d}", rate))
    (folder / "realizations_7.csv").write_text(
        "#,,\"generated_by='OpenQuake engine 3.26.2', start_date='2026-01-01T00:00:00', checksum=1\"\n"
        "rlz_id,branch_path,weight\n"
        "0,AA~A,2.0000000e-01\n1,AB~A,5.0000000e-01\n2,AC~A,3.0000000e-01\n"
    )
    return rates


def test_exports_are_read_reweighted_and_read_back(tmp_path, monkeypatch):
    rates = exported(tmp_path)
    monkeypatch.chdir(tmp_path)
    names = sorted(path.name for path in tmp_path.glob("hazard_curve-*.csv"))
    (tmp_path / "site.yaml").write_text(SITE % ", ".join(names))
    assert main(["constrain", "site.yaml"]) == 0
    table = pd.read_csv("constrained/site-weights.csv")
    assert table["rlz_id"].tolist() == [0, 1, 2]
    assert table["branch_path"].tolist() == ["AA~A", "AB~A", "AC~A"]
    # λ = k0 θ^-k exp(k² β² / 2)
    of_each = np.array(list(rates.values()))
    toppling = of_each * (THETA / 0.1) ** -2.5 * math.exp((2.5 * BETA) ** 2 / 2)
    stands = np.array([0.2, 0.5, 0.3]) * np.exp(-AGE * toppling)
    assert table["weight"].to_numpy() == pytest.approx(stands / stands.sum(), rel=2e-3)
    again = read_branches(names, "constrained/site-weights.csv")
    assert [branch.weight for branch in again] == pytest.approx(table["weight"].tolist())
    for n, branch in enumerate(again):
        assert branch.curves[PGA].rate(0.1) == pytest.approx(rates[n], rel=1e-5)


def test_samples_of_a_logic_tree_keep_their_numbers(tmp_path):
    """Of a sampled tree the same path may come twice; the number of the realization tells them apart."""
    exported(tmp_path)
    path = tmp_path / "realizations_7.csv"
    path.write_text(path.read_text().replace("AB~A", "AA~A"))
    curves = sorted(tmp_path.glob("hazard_curve-*.csv"))
    assert len({branch.name for branch in read_branches(curves, path)}) == 3
    with pytest.raises(InputError, match="realization 2 is given twice"):
        read_branches([*curves, curves[-1]], path)
