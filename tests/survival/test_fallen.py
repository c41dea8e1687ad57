"""What fell and what stands, from a table to an answer: stones that are simulated by the motions of assess."""

import json
import math

import numpy as np
import pytest

from rockfrag.assess.hazard.curve import PGA, PGV
from rockfrag.assess.inventory import FaultyRows
from rockfrag.assess.motions import motion_set
from rockfrag.assess.outcomes import make_intensity_levels
from rockfrag.assess.request import make_request
from rockfrag.base.errors import InputError
from rockfrag.cli.main import main
from rockfrag.survival import fallen
from rockfrag.survival.fallen import Knowledge, constrain_shaking, read_fallen
from rockfrag.survival.fallen_page import LIMITS, fallen_lines, fallen_page
from rockfrag.survival.shaking_posterior import Falls, Prior, shaking_posterior
from rockfrag.words.catalogue import catalogue

from ..aftermath.grids import write_grids

TABLE = """\
name,width,height,fell,azimuths
stones,30 cm,90 cm,31 of 60,30|45|20|35|50|10
low,40 cm,70 cm,0 of 12,
urn,20 cm,70 cm,yes,40
"""


@pytest.fixture
def table(tmp_path):
    path = tmp_path / "fallen.csv"
    path.write_text(TABLE)
    return path


@pytest.fixture
def own(own_records):
    return {"records": {"paths": [str(own_records / "catalogue.csv")]}}


def found_of(tmp_path, own, rows: str, knowledge=None):
    path = tmp_path / "rows.csv"
    path.write_text(f"name,width,height,fell\n{rows}\n")
    return constrain_shaking(read_fallen(path, own), knowledge)


def test_a_table_says_counts_of_groups_and_of_single_objects(table, own):
    groups = read_fallen(table, own)
    assert [(each.fallen, each.count) for each in groups] == [(31, 60), (0, 12), (1, 1)]
    assert groups[0].azimuths[:2] == (30.0, 45.0)
    assert groups[0].request.objects.block.height == pytest.approx(0.9)


def test_the_more_fell_the_stronger_it_shook(tmp_path, own):
    medians = [
        found_of(tmp_path, own, f"stones,20 cm,90 cm,{fell} of 60").posterior.pgv()[0]
        for fell in (3, 30, 57)
    ]
    assert medians == sorted(medians) and medians[-1] > 1.3 * medians[0]


def test_stouter_stones_that_fell_say_that_it_shook_more(tmp_path, own):
    slender, stout = (
        found_of(tmp_path, own, f"stones,{width},90 cm,30 of 60").posterior.pgv()[0]
        for width in ("12 cm", "20 cm")
    )
    assert 1.3 < stout / slender < 2.5


def test_errors_that_all_share_widen_the_interval_and_those_of_each_hardly_do(
    tmp_path, own
):
    rows = "stones,30 cm,90 cm,150 of 300"

    def width(**about: float) -> float:
        _, low, high = found_of(tmp_path, own, rows, Knowledge(**about)).posterior.pgv()
        return math.log(high / low)

    usual = width(shared_spread=0.05)
    assert width(shared_spread=0.05, slenderness_spread=0.3) > usual + 0.15
    assert width(shared_spread=0.05, own_spread=0.4) < usual + 0.15


def test_the_command_writes_page_json_and_table_and_takes_a_map_as_prior(
    table, tmp_path, capsys, monkeypatch, own_records
):
    monkeypatch.chdir(tmp_path)
    write_grids(tmp_path)
    usual = fallen.read_fallen
    own = {"records": {"paths": [str(own_records / "catalogue.csv")]}}
    monkeypatch.setattr(fallen, "read_fallen", lambda path: usual(path, own))
    place = ["--shakemap", "grid.xml", "--at", "35.0", "135.1"]
    assert main(["constrain", str(table), *place, "--output", "out"]) == 0
    said = capsys.readouterr().out
    assert "32 of 73 objects fell" in said and "PGV was about" in said
    assert "from north" in said and catalogue().text(LIMITS[0]) in said
    answer = json.loads((tmp_path / "out" / "shaking.json").read_text())
    limits = answer["pgv_cm_s"]
    assert limits["lower"] < limits["median"] < limits["upper"]
    assert answer["direction"]["count"] == 7
    # the made motions have one component each
    assert answer["axis"] is None
    page = (tmp_path / "out" / "shaking.html").read_text()
    assert "http" not in page.replace("http-equiv", "").replace("http://www.w3.org", "")
    assert (tmp_path / "out" / "shaking.csv").read_text().startswith("pgv_cm_s,")


def test_lines_and_page_speak_italian(table, own, tmp_path):
    found = fallen.constrain_shaking(fallen.read_fallen(table, own))
    lines = fallen_lines(found, "it")
    assert lines[0].startswith("Velocità") and "La PGV è stata" in lines[0]
    page = fallen_page(found, "it")
    assert '<html lang="it"' in page and "Dove puntano le cadute" in page
    for english in ("What fell", "It hangs on", "per unit of", "at least"):
        assert english not in page
    with pytest.raises(InputError, match="xx"):
        fallen_lines(found, "xx")


def test_a_prior_pulls_and_open_ends_are_said(tmp_path, own):
    fell = "stones,30 cm,90 cm,6 of 6"
    loose = found_of(tmp_path, own, fell)
    assert loose.posterior.open_above
    assert "at least" in fallen_lines(loose)[0]
    weak = found_of(tmp_path, own, fell, Knowledge(prior=Prior(20.0, 0.3)))
    assert weak.posterior.pgv()[0] < loose.posterior.pgv()[0]


def test_falls_that_disagree_with_what_was_known_are_named_and_others_are_not(
    tmp_path, own
):
    fell = "stones,30 cm,90 cm,30 of 60"

    def evidence(**known: Prior) -> str:
        return fallen_lines(found_of(tmp_path, own, fell, Knowledge(**known)))[2]

    assert "Without them" not in evidence()
    middle = found_of(tmp_path, own, fell).posterior.pgv()[0]
    agreed = evidence(prior=Prior(middle, 0.3))
    assert f"would be {middle:.2g} cm/s" in agreed and "disagrees" not in agreed
    assert "disagrees with what fell" in evidence(prior=Prior(middle / 5, 0.3))


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        ("a,30 cm,90 cm,61 of 60", "31 of 60"),
        ("a,30 cm,90 cm,maybe", "yes, no"),
        ("a,30 cm,90 cm,", "found nothing"),
        ("a,30 cm,thick,yes", "height"),
    ],
)
def test_a_wrong_row_is_named(rows, words, tmp_path, own):
    with pytest.raises(FaultyRows, match=words):
        found_of(tmp_path, own, rows)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--prior-pgv", "40 cm/s", "much"], "--prior-pgv"),
        (["--prior-pga", "40 kg", "0.3"], "--prior-pga"),
        (["--at", "35", "135"], "need --shakemap"),
        (["--shakemap", "grid.xml"], "--at"),
        (["--own-sd", "-1"], "--own-sd"),
    ],
)
def test_a_wrong_option_is_refused(options, words, table, capsys):
    assert main(["constrain", str(table), *options]) == 2
    assert words in capsys.readouterr().err


def test_options_of_falls_do_not_go_with_a_site(tmp_path, capsys):
    assert main(["constrain", "site.yaml", "--slenderness-sd", "0.2"]) == 2
    assert "--slenderness-sd needs a table" in capsys.readouterr().err


@pytest.mark.slow
@pytest.mark.parametrize("stones", [5, 30, 300])
def test_coverage_under_recorded_motions_of_earthquakes_that_are_left_out(stones):
    """Stones under the default motions; each world shakes them by one whose earthquake the others do not know."""
    request = make_request({"width": "30 cm", "height": "90 cm"}, "test")
    motions = motion_set(request.records, request.place, "resources/records")
    shaking = make_intensity_levels(motions, PGV)
    (found,) = shaking.outcomes_of([request.objects])
    toppled = fallen.toppled_everywhere(found)
    x = np.log(shaking.levels)
    ratios = (motions.values(PGA) / motions.values(PGV))[:, np.newaxis]
    rng = np.random.default_rng(4)
    own, shared, held, worlds = 0.22, 0.29, 0, 300
    for _ in range(worlds):
        pgv, which = rng.normal(math.log(60), 0.5), rng.integers(len(toppled))
        felt = pgv - shared * rng.normal() - own * rng.normal(size=stones)
        place = np.rint(np.interp(felt, x, np.arange(x.size))).astype(int)
        fell = int(toppled[which][place].sum())
        others = motions.earthquakes != motions.earthquakes[which]
        posterior = shaking_posterior(
            shaking.levels,
            (ratios * shaking.levels)[others],
            [Falls(fell, stones, toppled[others], own)],
            shared_spread=shared,
            prior=Prior(60.0, 0.5),
            allowed=shaking.allowed[others].astype(float),
        )
        _, low, high = posterior.pgv()
        held += math.log(low) <= pgv <= math.log(high)
    assert 0.86 <= held / worlds <= 0.94


def test_the_axis_of_shaking_turns_with_the_azimuths_of_the_falls(
    own_records, tmp_path
):
    names = [f"motion{i}.txt" for i in range(8)]
    pairs = zip(names[::2], names[1::2], strict=True)
    rows = [
        f"pair {i},event {i},{own_records / a},{own_records / b},g"
        for i, (a, b) in enumerate(pairs)
    ]
    catalogue_path = tmp_path / "pairs.csv"
    catalogue_path.write_text("\n".join(["name,earthquake,file,second,unit", *rows]))
    own = {"records": {"paths": [str(catalogue_path)]}}
    found = []
    for turn in (0, 52):
        azimuths = "|".join(str(turn + angle) for angle in (10, 20, 30, 24, 16, 22))
        path = tmp_path / "rows.csv"
        row = f"stones,15 cm,90 cm,8 of 12,{azimuths}"
        path.write_text(f"name,width,height,fell,azimuths\n{row}\n")
        found.append(constrain_shaking(read_fallen(path, own)))
    first, turned = (place.axis for place in found)
    assert first.within == pytest.approx(turned.within)
    assert (turned.azimuth - first.azimuth) % 180 == pytest.approx(52)
    said = " ".join(fallen_lines(found[0]))
    assert ("most along" in said) == (first.within < 60)
