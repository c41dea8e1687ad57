"""Which motions shake an object: pairs of components, what a set says of itself, and what shakes nothing."""

from dataclasses import replace

import numpy as np
import pytest

from rockfrag.assess import motions as motions_of
from rockfrag.assess.hazard.curve import PGA
from rockfrag.assess.motions import MotionSet, motion_set
from rockfrag.assess.outcomes import find_directions, make_intensity_levels
from rockfrag.assess.place import Place
from rockfrag.assess.request import Records
from rockfrag.assess.rules import RULES, check_rules
from rockfrag.assess.standing.planar import Planar
from rockfrag.base.errors import InputError

from .conftest import asked, outcomes_of

STATUE = {"width": "30 cm", "height": "1.2 m", "mass": "100 kg", "pga": "0.4 g"}


def test_both_components_of_a_record_of_the_default_set_are_a_pair(few, monkeypatch):
    sets = ["farfield", "nearfield_pulse", "farfield", "farfield"]
    for k, name in enumerate(sets):
        monkeypatch.setitem(few.ground[2 * k].metadata, "set", name)
    pairs = [few.ground[2 * k : 2 * k + 2] for k in range(len(sets))]
    monkeypatch.setattr(motions_of, "_default_pairs", lambda folder: pairs)
    found = motion_set(Records(), Place(), ".")
    assert [tuple(found.ground[i] for i in pair) for pair in found.pairs] == pairs
    assert found.about_set["n"] == 8
    assert found.about_set["pulses"] == 2


def test_a_record_that_is_zero_throughout_is_refused(tmp_path):
    path = tmp_path / "still.txt"
    path.write_text("".join(f"{0.01 * k:.2f} 0.0\n" for k in range(200)))
    with pytest.raises(InputError, match="zero throughout and shakes nothing"):
        motion_set(Records(paths=(path,), unit="g"), Place(), tmp_path)


def test_of_directions_no_fraction_is_told_where_no_level_is_asked(few: MotionSet):
    objects = asked(**STATUE).objects
    of_none = find_directions(objects, few, PGA, None)
    assert np.isnan([of_none.fraction, of_none.worst_fraction]).all()
    at = find_directions(objects, few, PGA, 0.4)
    assert 0 < at.fraction <= at.worst_fraction <= 1
    assert at.records == len(few.pairs)


class Aside(Planar):
    """An object that stands 3 cm off the middle of its pedestal."""

    def system_of(self, body):
        system = super().system_of(body)
        *below, top = system.contacts
        return replace(system, contacts=(*below, replace(top, offset=(0.03, 0.0))))


def test_records_turned_round_come_from_the_same_directions(few: MotionSet):
    """Of all directions together nothing changes, for what is not alike on both sides either."""
    pedestal = {"width": "36 cm", "height": "90 cm", "mass": "100 kg"}
    made = asked(**STATUE, pedestal=pedestal).objects
    off_the_middle = Aside(made.block, made.plane, made.under)
    one_sided = asked(**STATUE, pedestal=pedestal, cg_offset="3 cm").objects
    two = replace(few, ground=few.ground[:4], base=few.base[:4], pairs=few.pairs[:2])
    turned_round = [
        replace(motion, acceleration=-motion.acceleration) for motion in two.base
    ]
    for objects in (off_the_middle, one_sided):
        found, other = (
            find_directions(objects, each, PGA, 0.4)
            for each in (two, replace(two, base=tuple(turned_round)))
        )
        assert found == other and 0 < found.fraction < 1


def test_what_is_round_falls_in_the_worst_direction_of_a_record(few: MotionSet):
    """Fixed to its pedestal it rocks in a plane, any; both components of a record have what becomes of it."""
    pedestal = {"width": "36 cm", "height": "90 cm", "mass": "100 kg"}
    objects = asked(**STATUE, round=True, pedestal=pedestal).objects
    levels = make_intensity_levels(few.with_both_components(), PGA, count=6)
    bodies = {"fixed": objects.body.rigidly_joined()}
    found, one_way = (
        levels.outcomes_of_each([each], [bodies])[0]["fixed"]
        for each in (objects, objects.in_plane())
    )
    for pair in few.pairs:
        first, second = found.overturned[list(pair)]
        assert (first == second).all()
    assert (found.overturned >= one_way.overturned).all()
    assert found.overturned.sum() > one_way.overturned.sum()


def test_a_rule_takes_the_weaker_of_a_statue_and_of_what_it_is_fixed_to(few: MotionSet):
    pedestal = {"width": "40 cm", "height": "80 cm", "mass": "200 kg"}
    objects = asked(**STATUE, pedestal=pedestal).objects
    levels = np.array([0.1, 0.2, 0.4])
    fell = np.tile([False, True, True], (len(few.base), 1))
    outcomes = outcomes_of(fell, levels, ["a"] * len(few.base))
    models = objects.body.blocks[-1], objects.body.rigidly_joined()
    found = check_rules(objects, few, outcomes)
    assert [rule.motions for rule in found] == [len(few.base)] * len(RULES)
    for rule, check in zip(RULES.values(), found, strict=True):
        of_each = [
            np.median([np.log(rule(block, motion) / 0.2) for motion in few.base])
            for block in models
        ]
        assert np.log(check.bias) <= min(of_each) + 1e-12


def test_an_object_whose_records_are_of_its_floor_asks_for_no_building(tmp_path):
    records = {"recorded_on": "floor", "paths": [str(tmp_path / "floor.txt")]}
    place = asked(**STATUE, floor=3, records=records).place
    assert place.recorded and place.label == "3"
