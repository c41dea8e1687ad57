"""How planar bodies stand on each other, beside rigid bodies that complex numbers place from the ground up."""

import cmath
from collections.abc import Callable

import numpy as np
import pytest

from rockfrag.engines.planar.records import system_record
from rockfrag.system.body import Interval, RigidBody
from rockfrag.system.contact import Contact
from rockfrag.system.system import (
    System,
    common_centre,
    corners,
    rocking_shapes,
    standing_centres,
    standing_points,
    stands,
    uplift_ratios,
)

Placed = Callable[[complex], complex]  # from the frame of a body to where it stands


def outline(rng: np.random.Generator, low: float, high: float) -> Interval:
    """An outline whose middle is not the origin."""
    return Interval(-rng.uniform(low, high), rng.uniform(low, high))


def drawn(seed: int, count: int, most_tilt: float = 0.06) -> System:
    """Bodies on uneven bases, each with a base and a face that lie anywhere about its origin."""
    rng = np.random.default_rng(seed)
    bodies, contacts = [], []
    for k in range(count):
        mass, inertia = rng.uniform(5, 80), rng.uniform(0.5, 9)
        centre = rng.uniform(-0.03, 0.03), 0.0, rng.uniform(0.1, 0.4)
        base, face = outline(rng, 0.15, 0.4), outline(rng, 0.1, 0.3)
        height = rng.uniform(0.3, 0.9)
        bodies.append(RigidBody(mass, inertia, centre, base, height, face))
        tilt = rng.uniform(-most_tilt, most_tilt)
        offset = rng.uniform(-0.05, 0.05) if k else 0.0
        contacts.append(Contact(tilt=tilt, offset=(offset, 0.0)))
    return System(tuple(bodies), tuple(contacts))


def placed(system: System) -> list[Placed]:
    """Where each body's points are: its base lies on the face below, on which its uneven base turns it."""
    found: list[Placed] = []
    origin, along = 0j, 1 + 0j  # of the face below
    for body, contact in zip(system.bodies, system.contacts, strict=True):
        assert isinstance(body.base, Interval)
        middle = (body.base.left + body.base.right) / 2
        if found:
            origin += along * contact.offset[0]
        turn = along * cmath.exp(-1j * contact.tilt)

        def place(
            at: complex,
            base: complex = origin + along * middle,
            turn: complex = turn,
            middle: float = middle,
        ) -> complex:
            return base + turn * (at - middle)

        found.append(place)
        origin, along = place(1j * body.height), turn
    return found


def contact_ends(system: System, k: int) -> tuple[complex, complex]:
    """Left and right end of what base k shares with the face below, where they stand."""
    contact, base = system.contacts[k], system.bodies[k].base
    assert isinstance(base, Interval)
    if k == 0:
        return complex(base.left), complex(base.right)
    below, face = system.bodies[k - 1], system.bodies[k - 1].face
    assert isinstance(face, Interval)
    left = max(face.left, base.left + contact.offset[0])
    right = min(face.right, base.right + contact.offset[0])
    place = placed(system)[k - 1]
    return place(left + 1j * below.height), place(right + 1j * below.height)


def centres(system: System) -> list[complex]:
    """Centres of gravity where they stand."""
    return [
        place(body.centre[0] + 1j * body.centre[2])
        for place, body in zip(placed(system), system.bodies, strict=True)
    ]


def centre_above(system: System, k: int) -> complex:
    """Common centre of gravity of body k and all above."""
    masses = np.array([body.mass for body in system.bodies])
    return complex(np.average(centres(system)[k:], weights=masses[k:]))


def numbers(pairs: object) -> np.ndarray:
    """Pairs (x, z) as complex numbers."""
    return np.asarray(pairs) @ [1, 1j]


@pytest.mark.parametrize("count", [1, 2, 3, 4])
def test_bodies_stand_where_each_carries_the_next_on_its_face(count):
    for seed in range(4):
        system = drawn(seed, count)
        found = numbers(standing_centres(system))
        np.testing.assert_allclose(found, centres(system), atol=1e-14)
        of_engine = system_record(system, 9.81)["standing"][: 3 * count].reshape(-1, 3)
        middle = system.bodies[0].ends[0].middle
        np.testing.assert_allclose(
            middle + numbers(of_engine[:, :2]), found, atol=1e-14
        )
        for k, place in enumerate(placed(system)):
            at = [(0.1, 0.2), (-0.3, 0.5)]
            np.testing.assert_allclose(
                numbers(standing_points(system, k, at)),
                [place(x + 1j * z) for x, z in at],
                atol=1e-14,
            )
            assert complex(*common_centre(system, k)) == pytest.approx(
                centre_above(system, k), abs=1e-14
            )


@pytest.mark.parametrize("count", [1, 2, 3])
def test_each_base_lies_on_the_face_below(count):
    for seed in range(4):
        system = drawn(10 + seed, count)
        found = numbers(corners(system)).reshape(count, 2, 2)
        assert np.abs(found[0, :, 0].imag).max() == 0.0
        for k in range(1, count):
            left, right = found[k - 1, :, 1]
            along = (right - left) / abs(right - left)
            across = ((found[k, :, 0] - left) / along).imag
            np.testing.assert_allclose(across, 0.0, atol=1e-14)
        for body, place, (left, right) in zip(
            system.bodies, placed(system), found, strict=True
        ):
            base, face = body.ends
            assert abs(right[0] - left[0]) == pytest.approx(base.right - base.left)
            expected = [place(end + 1j * body.height) for end in face]
            np.testing.assert_allclose([left[1], right[1]], expected, atol=1e-14)


@pytest.mark.parametrize("count", [1, 2, 3, 4])
def test_a_contact_opens_where_the_moment_about_an_end_exceeds_that_of_the_weight(
    count,
):
    stood = 0
    for seed in range(12):
        system = drawn(20 + seed, count)
        ratios, inside = [], True
        for k in range(count):
            centre, ends = centre_above(system, k), contact_ends(system, k)
            arms = [centre - end for end in ends]
            ratios.append(min(abs(arm.real) / arm.imag for arm in arms))
            inside = inside and ends[0].real < centre.real < ends[1].real
        assert uplift_ratios(system) == pytest.approx(ratios, rel=1e-12)
        assert stands(system) == inside
        stood += inside
    assert stood > 0


@pytest.mark.parametrize("count", [2, 3, 4])
def test_a_body_rocks_on_what_its_base_shares_with_the_face(count):
    for seed in range(8):
        system = drawn(40 + seed, count)
        for k, shape in enumerate(system.carried):
            left, right = contact_ends(system, k)
            along = (right - left) / abs(right - left)
            # of the centre of gravity from the middle of the contact, along it and across
            arm = (centres(system)[k] - (left + right) / 2) / along
            assert shape.b == pytest.approx(abs(right - left) / 2)
            assert shape.x + 1j * shape.y == pytest.approx(arm, abs=1e-14)


def test_two_that_rock_as_one_have_the_centre_and_the_inertia_of_both():
    for seed in range(4):
        system = drawn(60 + seed, 2)
        whole, upper = rocking_shapes(system)
        assert upper == system.carried[1]
        centre, base = centre_above(system, 0), system.bodies[0].ends[0]
        ends = base.middle + numbers([system.pile.left, system.pile.right])
        np.testing.assert_allclose(ends, contact_ends(system, 1), atol=1e-14)
        assert complex(*common_centre(system)) == pytest.approx(centre, abs=1e-14)
        assert whole.x + base.middle + 1j * whole.y == pytest.approx(centre, abs=1e-14)
        inertia = sum(
            body.inertia + body.mass * abs(at - centre) ** 2
            for body, at in zip(system.bodies, centres(system), strict=True)
        )
        assert (whole.mass, whole.inertia) == pytest.approx((system.mass, inertia))
        assert whole.b == pytest.approx((base.right - base.left) / 2)
