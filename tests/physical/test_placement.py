"""Where movers are put."""

import math

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from physical import (
    GeometryError,
    area,
    box,
    centroid,
    circle,
    contains,
    distance,
    nearest_placement,
    point,
    polygon,
    translate_to,
)
from physical.frame import local_frame
from physical.placement import outline, placed, room, swallows
from physical.shape import planar

HARBOUR = box((52.981, 5.451), (52.971, 5.431))
QUAY = polygon([(52.979, 5.431), (52.979, 5.449), (52.9785, 5.449), (52.9785, 5.431)])
HOOK = polygon([(0, 0), (0, 0.001), (0.0002, 0.001), (0.0002, 0.0002), (0.001, 0.0002), (0.001, 0)])

homes = st.tuples(st.sampled_from([0.0, 37.0, -52.9, 80.0]), st.sampled_from([0.0, 5.4, 179.9999, -180.0]))
sizes = st.floats(0.0005, 0.02)


def wrapped(longitude):
    return (longitude + 180) % 360 - 180


@st.composite
def stars(draw, home):
    """A simple polygon of some 50 m to 2 km about a place."""
    n = draw(st.integers(3, 8))
    reach = draw(sizes)
    radii = draw(st.lists(st.floats(0.3, 1.0), min_size=n, max_size=n))
    return polygon(
        (
            home[0] + reach * r * math.sin((i + 0.4) * 2 * math.pi / n),
            wrapped(
                home[1] + reach * r * math.cos((i + 0.4) * 2 * math.pi / n) / math.cos(math.radians(home[0]))
            ),
        )
        for i, r in enumerate(radii)
    )


@st.composite
def tasks(draw):
    """A target, some holes about it, and a mover from elsewhere."""
    home = draw(homes)
    target = draw(stars(home))
    holes = draw(st.lists(stars((home[0] + 0.001, home[1])), max_size=3))
    mover = draw(st.sampled_from([point(1, 2), circle((10, 20), 15), translate_to(HOOK, point(3, 4))]))
    return mover, target, holes


@settings(deadline=None)
@given(tasks())
def test_the_nearest_placement_is_inside_the_target_and_swallowed_by_no_hole(task):
    mover, target, holes = task
    found = nearest_placement(mover, target, holes)
    assume(found is not None)
    assert contains(target, found)
    assert not any(swallows(hole, found) for hole in holes)
    assert found is nearest_placement(mover, target, holes[::-1])


@settings(deadline=None)
@given(tasks(), st.lists(st.tuples(st.floats(-1, 1), st.floats(-1, 1)), min_size=20, max_size=20))
def test_no_placement_with_room_around_it_is_nearer(task, offsets):
    mover, target, holes = task
    found = nearest_placement(mover, target, holes)
    frame = local_frame(centroid(target).ring[0])
    nearest = math.inf if found is None else distance(centroid(found), centroid(target))
    for x, y in offsets:
        x, y = 3000 * x**3, 3000 * y**3  # noqa: PLW2901  # more of them near the centroid
        if math.hypot(x, y) > nearest - 1:
            continue
        roomy = [placed(mover, frame, x + dx, y + dy) for dx in (-0.5, 0, 0.5) for dy in (-0.5, 0, 0.5)]
        assert not all(contains(target, at) and not any(swallows(hole, at) for hole in holes) for at in roomy)


def test_a_free_centroid_is_the_placement():
    assert nearest_placement(point(0, 0), HARBOUR) is centroid(HARBOUR)
    ship = circle((52, 5), 40)
    assert nearest_placement(ship, HARBOUR) is translate_to(ship, centroid(HARBOUR))


def test_a_hole_about_the_centroid_is_evaded_by_the_nearest_way():
    hole = box((52.9765, 5.4395), (52.9755, 5.4425))
    found = nearest_placement(point(0, 0), HARBOUR, [hole])
    assert found.vertices[0][0] == pytest.approx(52.9765, abs=1e-6)
    assert found.vertices[0][1] == pytest.approx(5.441, abs=1e-6)
    assert 0.04 < distance(found, hole) < 0.07


def test_of_equally_near_placements_the_northern_most_is_taken():
    home = centroid(HARBOUR)
    found = nearest_placement(point(0, 0), HARBOUR, [circle(home.vertices[0], 200, 8)])
    assert found.vertices[0][0] > home.vertices[0][0]


def test_a_polygon_may_straddle_a_hole_that_it_is_too_big_for():
    hole = circle(centroid(HARBOUR).vertices[0], 30)
    ship = circle((52, 5), 40)
    assert nearest_placement(ship, HARBOUR, [hole]) is nearest_placement(ship, HARBOUR)
    dinghy = nearest_placement(circle((52, 5), 5), HARBOUR, [hole])
    assert not contains(hole, dinghy)
    assert distance(centroid(dinghy), centroid(HARBOUR)) == pytest.approx(25, abs=0.5)


def test_what_fits_nowhere_has_no_placement():
    assert nearest_placement(circle((52, 5), 60), QUAY) is None
    assert nearest_placement(point(0, 0), QUAY, [HARBOUR]) is None
    assert nearest_placement(point(0, 0), QUAY, [QUAY]) is None
    assert nearest_placement(point(0, 0), point(1, 1)) is None
    assert nearest_placement(HARBOUR, HARBOUR) is None


def test_a_hole_elsewhere_or_of_no_extent_does_not_matter():
    ship = circle((52, 5), 40)
    holes = [centroid(HARBOUR), box((0, 0), (1, 1))]
    assert nearest_placement(point(0, 0), HARBOUR, holes) is centroid(HARBOUR)
    assert nearest_placement(ship, HARBOUR, holes) is nearest_placement(ship, HARBOUR)


@settings(deadline=None)
@given(st.floats(-85, 85), st.floats(-180, 180))
def test_translation_preserves_the_metric_shape(latitude, longitude):
    there = translate_to(HOOK, point(latitude, longitude))
    assert area(there) == pytest.approx(area(HOOK), rel=2e-3)
    assert centroid(there) is point(latitude, longitude)
    assert there.template is HOOK


def test_moving_there_and_back_gives_the_same_value():
    here = HOOK
    for at in ((80, 179.999), (-52, 5), (0, 0), (80, 179.999)):
        here = translate_to(here, point(*at))
        assert here is translate_to(HOOK, point(*at))
    assert translate_to(here, centroid(HOOK)) is HOOK


def test_nothing_is_moved_over_a_pole():
    with pytest.raises(GeometryError, match="the polygon encloses a pole"):
        translate_to(circle((0, 0), 1000), point(89.999, 0))


def test_a_long_edge_is_divided_to_keep_its_shape():
    assert len(outline(box((37.5, -8), (37, -9)))) > 8
    assert len(outline(box((37.001, -8), (37, -8.001)))) == 4


def test_a_border_too_detailed_for_a_mover_is_refused():
    def ragged(lat, n, size):
        ring = [(i / n * 2 * math.pi, size * (1 + 0.1 * (i % 2))) for i in range(n)]
        return polygon((lat + r * math.sin(a), r * math.cos(a)) for a, r in ring)

    space = local_frame((0, 0)).project(planar(ragged(0, 4000, 0.1)))
    with pytest.raises(GeometryError, match="is too detailed for a mover of 100 vertices"):
        room(space, ragged(10, 100, 0.0001))


def test_a_far_border_does_not_slow_or_change_a_placement():
    def coast(n):
        ring = [(i / n * 2 * math.pi, 1 + 0.01 * (i % 2)) for i in range(n)]
        return polygon((40 + r * math.sin(a), 5 + r * math.cos(a)) for a, r in ring)

    hole, ship = circle((40, 5), 1000), circle((1, 1), 20)
    found = nearest_placement(ship, coast(10_000), [hole])
    assert contains(coast(10_000), found)
    assert not contains(hole, found)
    assert distance(centroid(found), point(40, 5)) == pytest.approx(980, abs=3)
