"""What a user measured and says beside the sizes: tilt tests, free rocking, spectra and the ground of the site."""

import math
from dataclasses import replace

import numpy as np
import pytest

from rockfrag.assess.assumed import assume
from rockfrag.assess.conversion import (
    OF_THE_SITE,
    PRIOR,
    UNKNOWN,
    Conversion,
    Site,
    VelocityBySpectrum,
    VelocityRelation,
    find_conversion,
    published_velocity,
    usual_distance,
)
from rockfrag.assess.core.velocity import spread_of_mean
from rockfrag.assess.hazard.curve import PGA, SA_1S, VELOCITY_PER_G
from rockfrag.assess.motions import MotionSet
from rockfrag.assess.request import Records
from rockfrag.assess.standing.scanned import ON_POINTS
from rockfrag.base.errors import InputError
from rockfrag.base.units import GRAVITY
from rockfrag.campaign.standing import unknowns_of
from rockfrag.fragility.model_error import SCAN
from rockfrag.motions.conditional_velocity import BY_PGA

from .conftest import asked, outcomes_of

SIZES = {"width": "35 cm", "height": "1.2 m", "mass": "200 kg", "pga": "0.3 g"}


def test_an_angle_and_a_force_say_from_which_acceleration_it_rocks():
    angle = math.degrees(math.atan(0.27))
    tilted = asked(**SIZES, tilt_angle_deg=angle).objects
    assert tilted.least_uplift == pytest.approx(0.27)
    # of a force F at the height z: F z = m g b
    force = 200 * GRAVITY * 0.27 * 0.6 / 1.1
    pulled = asked(**SIZES, tilt_force=f"{force:.6f} N @ 1.1 m").objects
    assert pulled.least_uplift == pytest.approx(0.27, rel=1e-5)
    # which is known better than sizes are, and stays where only the centre is higher
    (width, *_), moved = tilted.variants(), tilted.moves()["cg_height"](1.1)
    assert width.spread == 0.01 and moved.least_uplift == pytest.approx(0.27)


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ({"tilt_angle_deg": 30}, "it would stand on"),
        ({"tilt_force": "85"}, "expected a force at a height such as 85N@1.1m"),
        ({"tilt_force": "85N@1.1"}, "without a unit"),
        ({"tilt_angle_deg": 10, "tilt_force": "85N@1.1m"}, "both given"),
        ({"frequency_parameter": 9.0}, "more than a body of this size can have"),
    ],
)
def test_what_cannot_be_is_refused(more, words):
    with pytest.raises(InputError, match=words):
        asked(**SIZES, **more)


def test_a_force_needs_the_mass():
    sizes = {key: value for key, value in SIZES.items() if key != "mass"}
    with pytest.raises(InputError, match="give key mass too"):
        asked(**sizes, tilt_force="85N@1.1m")


def test_free_rocking_says_the_inertia():
    usual = asked(**SIZES).objects.block
    arm = math.hypot(0.175, 0.6)
    p = math.sqrt(3 * GRAVITY / (4 * arm))
    assert asked(**SIZES, frequency_parameter=p).objects.block.centroidal_inertia == (
        pytest.approx(usual.centroidal_inertia)
    )


def test_impacts_are_assumed_to_conserve_momentum_unless_they_were_measured():
    assumed = assume("restitution", "restitution")
    assert assumed in asked(**SIZES).objects.under.assumed
    assert assumed not in asked(**SIZES, restitution=0.9).objects.under.assumed


def test_the_velocity_is_that_of_the_prior_unless_something_is_said():
    levels, given = np.array([0.1, 0.2, 0.4]), Records()
    for records, magnitude, distance, vs30 in (
        (
            Records(magnitude=6.0, distance_km=20.0),
            6.0,
            20.0,
            math.exp(PRIOR["ln_vs30"]),
        ),
        (Records(distance_km=9.0, vs30=760.0), PRIOR["magnitude"], 9.0, 760.0),
    ):
        found = published_velocity(PGA, records)
        exact = BY_PGA.log_velocity(levels, magnitude, distance, vs30)
        exact -= np.log(levels * VELOCITY_PER_G)
        line = found.lines(records)[0]
        assert line[0] + line[1] * np.log(levels) == pytest.approx(exact)
    # what is said is known, what is not leaves the mean open
    assert (
        not published_velocity(PGA, Records(vs30=760.0))
        .lines(Records(vs30=760.0))[3]
        .any()
    )
    assert published_velocity(PGA, given).lines(given)[1:].any(axis=1).all()
    # motions that a user chose have the velocity of the site
    own = Records(paths=("own.csv",))
    assert published_velocity(PGA, own) is None
    assert published_velocity(PGA, Records(paths=("own.csv",), magnitude=6.0))


def test_the_velocity_of_pga_alone_is_the_mean_over_earthquakes_that_have_it():
    """Beside a mixture drawn from the relation itself: magnitudes 5.5 to 8, distances of the level, ground."""
    random, count = np.random.default_rng(5), 4000
    given = Records()
    line, *_ = lines = published_velocity(PGA, given).lines(given)
    for level in (0.1, 0.25, 0.45):
        ratios = []
        for magnitude, away, ground, rest in zip(
            random.uniform(5.5, 8.0, count),
            *random.standard_normal((3, count)),
            strict=True,
        ):
            distance = usual_distance(level, magnitude) * math.exp(0.7 * away)
            vs30 = 400.0 * math.exp(0.45 * ground)
            (log,) = BY_PGA.log_velocity(np.array([level]), magnitude, distance, vs30)
            spread = math.hypot(*BY_PGA.spreads(magnitude))
            ratios.append(float(log) + spread * rest - math.log(level))
        ours = line[0] + line[1] * math.log(level) + math.log(VELOCITY_PER_G)
        assert ours == pytest.approx(np.mean(ratios), abs=0.06)
        spread = math.hypot(
            published_velocity(PGA, given).within,
            spread_of_mean(level, published_velocity(PGA, given).of_site, lines),
        )
        assert spread == pytest.approx(np.std(ratios), rel=0.1)


def test_the_velocity_of_pga_alone_lies_among_published_ratios():
    """PGV/PGA [cm/s per g]: 61 of rock to 122 of alluvium (Mohraz 1976; Newmark and Hall 1982: 91 and 122).

    Of intensities: where PGA and PGV say the same one, 88 to 95 in California (Wald et al. 1999).
    """
    given = Records()
    at_one, slope = published_velocity(PGA, given).lines(given)[0]
    for level in (0.1, 0.25, 0.45):
        ratio = VELOCITY_PER_G * math.exp(at_one + slope * math.log(level))
        of_intensity = 10 ** ((3.66 * math.log10(981 * level) - 1.66 - 2.35) / 3.47)
        assert 61 < ratio < 122
        assert ratio == pytest.approx(of_intensity / level, rel=0.2)


def test_the_usual_distance_gives_the_level_back():
    for magnitude, level in ((6.5, 0.25), (7.5, 0.1), (7.0, 0.3)):
        slant = math.hypot(usual_distance(level, magnitude), 7.3)
        log = -1.02 + 0.249 * magnitude - math.log10(slant) - 0.00255 * slant
        assert 10**log == pytest.approx(level)
    assert usual_distance(3.0, 5.5) == 1.0


def test_a_spectral_acceleration_beside_pga_narrows_the_velocity(motions: MotionSet):
    found = VelocityBySpectrum.of(motions, PGA)
    assert found.scatter < motions.log_ratios(PGA).std()
    # the line goes through the means
    mean = motions.log_over(SA_1S, PGA).mean()
    assert found.mean(math.exp(mean)) == pytest.approx(motions.log_ratios(PGA).mean())
    # of one motion alone its own ratio is all that is known
    alone = motions.ground[:1]
    one = replace(motions, ground=alone, base=alone, pairs=())
    found = VelocityBySpectrum.of(one, PGA)
    assert (found.mean(0.3), found.scatter) == (one.log_ratios(PGA)[0], 0.0)
    level = asked(**SIZES, sa=["1 s", "0.2 g"]).level
    assert (level.measure, level.value, level.sa_1s) == (PGA, 0.3, 0.2)
    with pytest.raises(InputError, match="period of 1 s"):
        asked(**SIZES, sa=["0.3 s", "0.2 g"])


def test_of_chosen_motions_the_velocity_is_that_of_all_among_which_they_were_chosen(
    motions: MotionSet,
):
    """Whichever are chosen, the earthquakes of the site are those of the whole set."""
    rng = np.random.default_rng(5)
    known = [
        {"magnitude": m, "distance_km": math.exp(d), "vs30_m_s": math.exp(v)}
        for m, d, v in rng.uniform([6, 0, 5], [8, 4, 7], (40, 3)).tolist()
    ]
    library = tuple(
        replace(motions.ground[i % 24], name=f"{i}", metadata=each | {"station": i})
        for i, each in enumerate(known)
    )
    whole = replace(motions, ground=library, base=library, pairs=())
    relation = VelocityRelation.of(whole.about, whole.log_ratios(PGA))
    assert relation.middle
    of_floor = Site(Records(on_floor=True), asked(**SIZES).level, ())
    for kept in (slice(0, 8), slice(8, 24)):
        chosen = library[kept]
        few = replace(whole, ground=chosen, base=chosen, library=library)
        # it topples from a velocity on
        levels, ratios = np.geomspace(0.05, 5.0, 40), few.log_ratios(PGA)
        fell = levels * np.exp(ratios)[:, np.newaxis] >= 0.05
        outcomes = outcomes_of(fell, levels, few.earthquakes, all_rock=True)
        found = find_conversion(outcomes, few, of_floor, by_statics=True)
        assert found.spread == pytest.approx(relation.unknown(Records(), of_site=False))


def test_on_points_a_scan_loses_in_impacts_what_arrangements_of_scans_lose():
    """Middle and standard deviation of a uniform distribution."""
    drawn = unknowns_of(SCAN)["restitution_ratio"]
    low, high = drawn(0.0), drawn(1.0)
    middle = ON_POINTS["restitution_factor"]
    assert middle == pytest.approx((low + high) / 2)
    spread = (high - low) / math.sqrt(12) / middle
    assert ON_POINTS["restitution"] == pytest.approx(spread, abs=0.005)


def test_of_earthquakes_that_are_not_known_their_spread_counts_and_of_sites_what_they_share():
    relation = VelocityRelation((0.3, 0.2, -0.1, 0.4), (6.5, 3.0, 6.0), 0.5)
    slopes = dict(zip(UNKNOWN, relation.coefficients[1:], strict=True))
    open_ones = [(slopes[name] * spread) ** 2 for name, spread in UNKNOWN.items()]
    shared = OF_THE_SITE * 0.5**2
    known = Records(magnitude=6.0, distance_km=20.0, vs30=400.0)
    for given, parts in ((Records(), sum(open_ones)), (known, 0.0)):
        for of_site in (False, True):
            found = relation.unknown(given, of_site=of_site)
            assert found**2 == pytest.approx(parts + of_site * shared)
    # of too few records nothing says how the mean follows them
    few = VelocityRelation((0.3,), (), 0.5)
    assert few.unknown(known, of_site=False) ** 2 == pytest.approx(shared)


def test_a_set_says_the_velocity_that_its_motions_have_for_a_measure():
    logs = np.log([0.5, 1.0, 4.0])
    known = Conversion(PGA, (0.0, 0.0, 0.0), 1.0, 0.0, logs, None, 0.0, 0.0, True)
    assert known.of_set == pytest.approx(VELOCITY_PER_G)
    low, high = known.ends
    assert (low, high) == pytest.approx((0.5 * VELOCITY_PER_G, 4 * VELOCITY_PER_G))


def test_what_is_accepted_is_one_percent_in_fifty_years_and_ten_at_a_level():
    """docs/assess.md, "What to do"; in other years as often."""
    assert asked(**SIZES).accepted == 0.1
    with_hazard = asked(**SIZES, return_period="475 years")
    assert with_hazard.years == 50.0
    assert with_hazard.accepted == pytest.approx(0.01)
    twice = asked(**SIZES, return_period="475 years", years=100)
    assert 1 - twice.accepted == pytest.approx(0.99**2)
    assert asked(**SIZES, accept=0.3).accepted == 0.3
