"""ShakeMap grids are read as they are written, in their units, or refused in one sentence."""

import math
import re
import zipfile

import numpy as np
import pytest

from rockfrag.aftermath.shakemap import LARGER_OF_TWO, read_shakemap
from rockfrag.aftermath.shaken_ground import (
    distance_km,
    level_of,
    mapped_ground,
    recorded_ground,
)
from rockfrag.assess.hazard.curve import PGA, PGV
from rockfrag.base.errors import InputError
from rockfrag.base.units import GRAVITY

from .grids import (
    FIELDS,
    LATITUDES,
    LONGITUDES,
    grid_text,
    logs,
    of_grid,
    write_grids,
)

PLACE = 35.123, 135.456


@pytest.fixture
def grids(tmp_path):
    return write_grids(tmp_path)


def test_shaking_between_points_is_that_of_the_formula_in_g_and_cm_s(grids):
    shakemap = read_shakemap(grids[0])
    found = shakemap.at(*PLACE)
    pga, pgv = np.exp(logs(PLACE[1], PLACE[0]))
    assert found.values["PGA"] == pytest.approx(pga / 100 / LARGER_OF_TWO, rel=1e-4)
    assert found.values["PGV"] == pytest.approx(pgv / LARGER_OF_TWO, rel=1e-4)
    assert found.values["PSA10"] == pytest.approx(found.values["PGA"])
    assert shakemap.magnitude == 6.6 and shakemap.epicentre == (35.0, 135.0)
    assert shakemap.title == "ShakeMap 5 km N of A & B (made1, version 3)"


def test_each_point_of_the_grid_is_read_back(grids):
    shakemap = read_shakemap(grids[0])
    for latitude in LATITUDES:
        for longitude in LONGITUDES:
            pga, _ = logs(longitude, latitude)
            found = shakemap.at(latitude, longitude).values["PGA"]
            assert math.log(100 * LARGER_OF_TWO * found) == pytest.approx(pga, abs=1e-4)


def test_spreads_are_those_of_the_point_else_of_the_event_else_usual_ones(grids):
    alone, both = read_shakemap(grids[0]), read_shakemap(*grids)
    assert alone.at(*PLACE).spreads["PGA"] == pytest.approx(0.4)
    assert alone.at(*PLACE).spreads["PGV"] == pytest.approx(0.5)
    assert alone.at(*PLACE).spreads["PSA03"] > 0.5
    assert alone.at(*PLACE).stated == {"PGA"}
    assert both.at(*PLACE).spreads["PGA"] == pytest.approx(0.3 + 0.1 * 0.456)
    assert both.at(*PLACE).spreads["PGV"] == pytest.approx(0.35)
    # older maps state none of the whole map as zero
    text = (
        grids[0]
        .read_text()
        .replace('value="0.5" numsta="12"', 'value="0.000" numsta=""')
    )
    grids[0].write_text(text)
    assert read_shakemap(grids[0]).at(*PLACE).spreads["PGV"] == 0.65


def test_nothing_is_known_beyond_the_map_and_longitudes_may_count_round(grids):
    shakemap = read_shakemap(grids[0])
    assert shakemap.at(36.0, 135.2) is None and shakemap.at(35.0, 133.0) is None
    assert mapped_ground(shakemap, 36.0, 135.2) is None
    assert shakemap.at(PLACE[0], PLACE[1] - 360).values == shakemap.at(*PLACE).values


def test_a_zip_file_an_order_from_south_and_columns_in_another_order_say_the_same(
    grids, tmp_path
):
    usual = read_shakemap(grids[0]).at(*PLACE).values
    packed = tmp_path / "grid.xml.zip"
    with zipfile.ZipFile(packed, "w") as archive:
        archive.write(grids[0], "grid.xml")
    assert read_shakemap(packed).at(*PLACE).values == usual
    head, _, rest = grid_text().partition("<grid_data>\n")
    rows, _, end = rest.partition("\n</grid_data>")
    lines = rows.splitlines()
    width = LONGITUDES.size
    bands = [lines[i : i + width] for i in range(0, len(lines), width)]
    southward = [line for band in reversed(bands) for line in band]
    swapped = []
    for line in southward:
        longitude, latitude, pga, pgv, *others = line.split()
        swapped.append(" ".join([longitude, latitude, pgv, pga, *others]))
    head = head.replace('index="3" name="PGA"', 'index="4" name="PGA"')
    head = head.replace('index="4" name="PGV"', 'index="3" name="PGV"')
    other = tmp_path / "other.xml"
    other.write_text(
        f"{head}<grid_data>\n" + "\n".join(swapped) + f"\n</grid_data>{end}"
    )
    assert read_shakemap(other).at(*PLACE).values == pytest.approx(usual)


def _rows_changed(change) -> str:
    """A grid whose points are changed as a list of lists of words."""
    head, _, rest = grid_text().partition("<grid_data>\n")
    rows, _, end = rest.partition("\n</grid_data>")
    changed = change([line.split() for line in rows.splitlines()])
    lines = "\n".join(" ".join(words) for words in changed)
    return f"{head}<grid_data>\n{lines}\n</grid_data>{end}"


def test_points_in_any_order_round_180_degrees_and_without_a_stated_number_say_the_same(
    grids, tmp_path
):
    usual = read_shakemap(grids[0]).at(*PLACE).values
    path = tmp_path / "other.xml"
    by_column = _rows_changed(
        lambda rows: sorted(rows, key=lambda row: (float(row[0]), float(row[1])))
    )
    rng = np.random.default_rng(58)
    shuffled = _rows_changed(lambda rows: rng.permutation(rows).tolist())
    unstated = grid_text().replace('nlon="16"', "").replace('nlat="11"', "")
    marked = "\ufeff" + grid_text()
    for text in (by_column, shuffled, unstated, marked):
        path.write_text(text, encoding="utf-8")
        assert read_shakemap(path).at(*PLACE).values == pytest.approx(usual)
    # 44.7 degrees further east the map crosses 180 degrees

    def eastward(rows):
        east = [(float(row[0]) + 44.7 + 180) % 360 - 180 for row in rows]
        return [[f"{x:.4f}", *row[1:]] for x, row in zip(east, rows, strict=True)]

    path.write_text(_rows_changed(eastward))
    found = read_shakemap(path)
    for longitude in (PLACE[1] + 44.7, PLACE[1] + 44.7 - 360):
        assert found.at(PLACE[0], longitude).values == pytest.approx(usual)


@pytest.mark.parametrize(
    ("unit", "factor"), [("g", 1.0), ("%g", 0.01), ("Gal", 0.01 / GRAVITY)]
)
def test_accelerations_are_read_in_the_unit_that_the_grid_states(
    unit, factor, tmp_path
):
    path = tmp_path / "grid.xml"

    def values(longitude: float, latitude: float) -> list[float]:
        first, *others = of_grid(longitude, latitude)
        return [0.01 * first / factor, *others]

    text = grid_text(values=values)
    path.write_text(text.replace('"PGA" units="pctg"', f'"PGA" units="{unit}"'))
    pga, _ = logs(PLACE[1], PLACE[0])
    found = read_shakemap(path).at(*PLACE).values["PGA"]
    assert found == pytest.approx(math.exp(pga) / 100 / LARGER_OF_TWO, rel=1e-4)


def test_a_grid_that_states_no_unit_at_all_is_in_those_of_every_map(tmp_path):
    """As maps are that were cut for other programs; one in g is refused all the same."""
    path = tmp_path / "grid.xml"
    bare = re.sub(r'units="[^"]*"', 'units=""', grid_text())
    path.write_text(bare)
    pga, pgv = logs(PLACE[1], PLACE[0])
    found = read_shakemap(path).at(*PLACE).values
    assert found["PGA"] == pytest.approx(math.exp(pga) / 100 / LARGER_OF_TWO, rel=1e-4)
    assert found["PGV"] == pytest.approx(math.exp(pgv) / LARGER_OF_TWO, rel=1e-4)

    def in_g(longitude: float, latitude: float) -> list[float]:
        first, *others = of_grid(longitude, latitude)
        return [first / 100, *others]

    path.write_text(re.sub(r'units="[^"]*"', 'units=""', grid_text(values=in_g)))
    with pytest.raises(InputError, match="no earthquake has"):
        read_shakemap(path)


def test_a_map_far_from_a_large_earthquake_is_believed(tmp_path):
    """There PGA has died out, and PGV has not: 0.1 % g with more than 1 cm/s."""
    path = tmp_path / "grid.xml"

    def values(longitude: float, latitude: float) -> list[float]:
        return [0.1, 1.3, 3.5, 0.4, 1.4, 0.7, 0.5, 1.0, 300.0]

    path.write_text(grid_text(values=values))
    found = read_shakemap(path).at(*PLACE).values
    assert found["PGV"] == pytest.approx(1.3 / LARGER_OF_TWO)


def test_points_without_shaking_do_not_count(tmp_path):
    path = tmp_path / "grid.xml"
    lines = grid_text().splitlines()
    first = lines.index("<grid_data>") + 1
    # of the four points about a place in the corner one is under water
    lines[first] = " ".join([*lines[first].split()[:2], *["nan"] * (len(FIELDS) - 2)])
    path.write_text("\n".join(lines))
    found = read_shakemap(path).at(LATITUDES[0] - 0.05, LONGITUDES[0] + 0.05)
    assert found is not None and 0 < found.values["PGA"] < 1


@pytest.mark.parametrize(
    ("damage", "words"),
    [
        (lambda text: text[: len(text) // 2], "no well-formed XML"),
        (lambda text: text.replace('nlon="16"', 'nlon="17"'), "downloaded whole"),
        (lambda text: text.replace(" 300\n", "\n", 1), "downloaded whole"),
        (lambda text: text.replace(" 300\n", " stone\n", 1), "no number"),
        (lambda text: text.replace('units="pctg"', 'units="furlongs"'), "furlongs"),
        # an acceleration in g that says % g, and the other way round
        (
            lambda text: text.replace('"PGA" units="pctg"', '"PGA" units="g"'),
            "no earth",
        ),
        (
            lambda text: text.replace('"PGA" units="pctg"', '"PGA" units="cms"'),
            "in cms",
        ),
        (
            lambda text: text.replace('"PGV" units="cms"', '"PGV" units="m/s"'),
            "no earth",
        ),
        (lambda text: text.replace('"PGV" units="cms"', '"PGV" units=""'), "no unit"),
        # a projected place, a point that stands twice, a decimal comma
        (
            lambda text: text.replace("134.5 35.5 ", "384000.5 3929000 ", 1),
            "no degrees",
        ),
        (
            lambda text: text.replace("134.5 35.5 ", "134.6 35.5 ", 1),
            "rows and columns",
        ),
        (lambda text: text.replace("134.5 35.5 ", "134,5 35.5 ", 1), "no number"),
        (lambda text: text.replace("shakemap_grid", "grid"), "no grid of a ShakeMap"),
        (lambda text: text.replace('name="LON"', 'name="X"'), "no columns LON"),
        (lambda text: text.replace('index="3"', 'index="4"'), "numbered from 1"),
        (
            lambda text: text.replace(
                "<shakemap_grid", "<!DOCTYPE x><shakemap_grid", 1
            ),
            "document type",
        ),
        (
            lambda text: text.replace('name="PGA"', 'name="A"').replace(
                'name="PGV"', 'name="B"'
            ),
            "neither PGA nor PGV",
        ),
    ],
)
def test_a_damaged_grid_is_refused_in_one_sentence(damage, words, tmp_path):
    path = tmp_path / "grid.xml"
    path.write_text(damage(grid_text()))
    with pytest.raises(InputError, match=words):
        read_shakemap(path)


def test_an_uncertainty_of_another_map_is_refused(grids, tmp_path):
    other = tmp_path / "other.xml"
    other.write_text(grid_text(event="another"))
    with pytest.raises(InputError, match="not of the map"):
        read_shakemap(grids[0], other)
    with pytest.raises(InputError, match="cannot be read"):
        read_shakemap(tmp_path / "nowhere.xml")


def test_a_scenario_says_that_it_is_one(tmp_path):
    path = tmp_path / "grid.xml"
    path.write_text(grid_text(kind="SCENARIO"))
    assert read_shakemap(path).title.startswith("ShakeMap scenario")


def test_the_level_of_a_place_has_both_measures_with_their_spreads(grids):
    ground = mapped_ground(read_shakemap(*grids), *PLACE)
    level = level_of(ground)
    assert level.measure == PGA and level.pgv == ground.pgv
    assert 0 < level.spread.correlation < 1
    # a degree of latitude is 111 km
    assert distance_km((35.0, 135.0), (36.0, 135.0)) == pytest.approx(111.2, abs=0.1)
    assert ground.distance_km == pytest.approx(
        math.hypot(0.123 * 111.2, 0.456 * 91.1), rel=0.01
    )


def test_a_record_at_the_place_is_known_exactly_and_one_far_away_is_not(
    own_records, made_motions
):
    pair = made_motions(12)[:2]
    files = [own_records / f"{motion.name.replace(' ', '')}.txt" for motion in pair]
    here, motions = recorded_ground(files, unit="g")
    assert len(motions) == 2
    values = [PGA.of_motion(motion) for motion in pair]
    assert here.pga == pytest.approx(math.sqrt(values[0] * values[1]), rel=1e-3)
    assert here.pga_spread == here.pgv_spread == 0
    spreads = [recorded_ground(files, km, unit="g")[0].pgv_spread for km in (1, 10, 99)]
    assert spreads == sorted(spreads) and 0 < spreads[0] < 0.3
    # of places far from each other in one earthquake both differ
    assert spreads[-1] == pytest.approx(0.552 * math.sqrt(2), rel=0.01)
    assert level_of(here).measure == PGA and PGV.imt == "PGV"
    with pytest.raises(InputError, match="one or two horizontal components"):
        recorded_ground([*files, *files], unit="g")
