"""The finite quotient of a drift within a place."""

import math
from itertools import pairwise

import pytest
import shapely
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from physical import (
    Face,
    GeometryError,
    box,
    centroid,
    circle,
    contains,
    drift_faces,
    face_at,
    point,
    polygon,
    translate_to,
)
from physical.drift import plane_of, quotient

POINT = point(0, 0)
SQUARE = box((10, 10), (10.0004, 10.0004))
homes = st.tuples(st.sampled_from([0.0, 37.0, -52.9, 80.0]), st.sampled_from([0.0, 5.4, 179.999, -180.0]))
movers = st.sampled_from([POINT, circle((10, 20), 15, 12), SQUARE])


def wrapped(longitude):
    return (longitude + 180) % 360 - 180


def at(home, north, east):
    """A position some grid steps of about 50 m from home."""
    return (home[0] + north * 5e-4, wrapped(home[1] + east * 5e-4 / math.cos(math.radians(home[0]))))


@st.composite
def stars(draw, home):
    n = draw(st.integers(3, 7))
    north, east = draw(st.integers(-8, 8)), draw(st.integers(-8, 8))
    radii = draw(st.lists(st.floats(2, 9), min_size=n, max_size=n))
    turns = [(i + 0.4) * 2 * math.pi / n for i in range(n)]
    return polygon(
        at(home, north + r * math.sin(a), east + r * math.cos(a)) for r, a in zip(radii, turns, strict=True)
    )


@st.composite
def boxes(draw, home):
    """Boxes on the grid, whose borders often meet, cross and coincide."""
    north, east = draw(st.integers(-8, 7)), draw(st.integers(-8, 7))
    return box(
        at(home, north, east), at(home, north + draw(st.integers(1, 9)), east + draw(st.integers(1, 9)))
    )


@st.composite
def drifts(draw):
    home = draw(homes)
    within = draw(
        st.sampled_from(
            [
                box(at(home, -8, -8), at(home, 8, 8)),
                polygon([at(home, -8, 0), at(home, 0, 8), at(home, 8, 0), at(home, 0, -8)]),
            ]
        )
    )
    shapes = draw(st.lists(boxes(home) | stars(home), max_size=5))
    return draw(movers), within, {"within": within} | {f"p{i}": shape for i, shape in enumerate(shapes)}


def relations(mover, places):
    return tuple(sorted(name for name, place in places.items() if contains(place, mover)))


@settings(deadline=None)
@given(drifts(), st.lists(st.tuples(st.floats(0, 1), st.floats(0, 1)), min_size=8, max_size=8))
def test_placements_in_one_face_satisfy_the_same_relations_as_its_representative(drift, spots):
    mover, within, places = drift
    found = quotient(mover, within, places)
    plane = plane_of(mover, within)
    for cell, face in zip(found.cells, found.face_of, strict=True):
        west, south, east, north = cell.shape.bounds
        core = cell.shape.buffer(-0.05)
        for u, v in spots:
            x, y = west + u * (east - west), south + v * (north - south)
            if core.contains(shapely.Point(x, y)):
                assert relations(plane.put(x, y), places) == found.faces[face].inside


@settings(deadline=None)
@given(drifts(), st.tuples(st.floats(-1, 1), st.floats(-1, 1)))
def test_every_placement_is_in_a_face_that_has_its_relations(drift, spot):
    mover, within, places = drift
    plane = plane_of(mover, within)
    west, south, east, north = plane.room(within, mover).bounds
    moved = plane.put(
        (west + east) / 2 + spot[0] * (east - west) / 2, (south + north) / 2 + spot[1] * (north - south) / 2
    )
    face = face_at(moved, within, places)
    if contains(within, moved):
        # Within 5 cm of a border there may be a sliver that is no face.
        assume(face is not None)
        assert drift_faces(mover, within, places)[face].inside == relations(moved, places)
    else:
        assert face is None


@settings(deadline=None)
@given(drifts(), st.tuples(st.floats(0, 1), st.floats(0, 1), st.floats(0, 1), st.floats(0, 1)))
def test_a_straight_drift_passes_from_face_to_adjacent_face(drift, ends):
    mover, within, places = drift
    found = quotient(mover, within, places)
    if not found.cells:
        return
    west, south, east, north = shapely.union_all([cell.shape for cell in found.cells]).bounds
    (a, b, c, d) = ends
    path = shapely.LineString(
        [
            (west + a * (east - west), south + b * (north - south)),
            (west + c * (east - west), south + d * (north - south)),
        ]
    )
    stretches = [
        (path.project(shapely.Point(part.coords[0])), path.project(shapely.Point(part.coords[-1])), face)
        for cell, face in zip(found.cells, found.face_of, strict=True)
        for part in shapely.get_parts(cell.shape.intersection(path))
        if part.length > 0
    ]
    for (_, left, here), (entered, _, there) in pairwise(
        sorted((min(p, q), max(p, q), f) for p, q, f in stretches)
    ):
        # A gap is a stretch outside; what is passed in a hair's breadth may be a corner.
        if here != there and abs(entered - left) < 0.001:
            near = [
                cell.shape.buffer(0.5)
                for cell, face in zip(found.cells, found.face_of, strict=True)
                if face not in (here, there)
            ]
            crossing = path.interpolate(left)
            assert there in found.faces[here].adjacent or any(shape.contains(crossing) for shape in near)


@settings(deadline=None)
@given(drifts())
def test_faces_are_in_canonical_order_and_adjacency_is_symmetric_up_to_bisimilarity(drift):
    mover, within, places = drift
    faces = drift_faces(mover, within, places)
    assert list(faces) == sorted(faces, key=lambda face: face.representative)
    moved = mover if mover.is_point else translate_to(mover, centroid(within))
    assert drift_faces(moved, within, dict(reversed(places.items()))) == faces
    for i, face in enumerate(faces):
        assert "within" in face.inside
        assert face.inside == relations(face.representative, places)
        assert i not in face.adjacent
        assert all(faces[j].inside != face.inside for j in face.adjacent)
        assert face_at(face.representative, within, places) == i


def structure(faces):
    """What of the faces doesn't depend on where on the earth they are."""
    return sorted((face.inside, tuple(sorted(faces[j].inside for j in face.adjacent))) for face in faces)


GRID = {"pond": (0, 0, 8, 8), "west": (1, 1, 7, 3), "north": (5, 2, 7, 6), "islet": (1, 5, 2, 6)}


@pytest.mark.parametrize("mover", [POINT, SQUARE, circle((0, 0), 10)])
@pytest.mark.parametrize("latitude", [0, 37, -60, 80])
def test_a_world_shifted_around_the_earth_has_the_same_faces(mover, latitude):
    def faces(longitude):
        places = {
            name: box(at((latitude, longitude), a, b), at((latitude, longitude), c, d))
            for name, (a, b, c, d) in GRID.items()
        }
        return drift_faces(mover, places["pond"], places)

    here = structure(faces(0.0))
    assert len(here) == 5
    assert here == structure(faces(180.0)) == structure(faces(179.9995)) == structure(faces(-90.0))


def test_a_place_without_others_is_one_face():
    harbour = box((52.981, 5.451), (52.971, 5.431))
    assert drift_faces(POINT, harbour, {"harbour": harbour}) == (
        Face(centroid_of(harbour), (("harbour",),), ()),
    )


def centroid_of(place):
    (found,) = drift_faces(POINT, place, {})
    return found.representative


def test_the_two_sides_of_a_channel_are_one_face_where_nothing_tells_them_apart():
    sea, channel = box((0, 0), (1, 3)), box((-1, 1), (2, 2))
    faces = drift_faces(POINT, sea, {"channel": channel})
    assert [(face.inside, face.adjacent) for face in faces] == [((), (1,)), (("channel",), (0,))]


def test_the_two_sides_of_a_channel_are_two_faces_where_moves_tell_them_apart():
    """The counterexample to faces by relations alone: from d to e one has to pass the channel."""
    sea, channel = box((0, 0), (1, 3)), box((-1, 1), (2, 2))
    places = {"channel": channel, "d": box((0.2, 0.2), (0.8, 0.8)), "e": box((0.2, 2.2), (0.8, 2.8))}
    faces = drift_faces(POINT, sea, places)
    assert sorted((face.inside, sorted(faces[j].inside for j in face.adjacent)) for face in faces) == [
        ((), [("channel",), ("d",)]),
        ((), [("channel",), ("e",)]),
        (("channel",), [(), ()]),
        (("d",), [()]),
        (("e",), [()]),
    ]


def test_places_that_meet_in_a_corner_only_are_not_adjacent():
    sea = box((0, 0), (2, 2))
    places = {
        "a": box((0, 0), (1, 1)),
        "b": box((1, 1), (2, 2)),
        "c": box((0, 1), (1, 2)),
        "d": box((1, 0), (2, 1)),
    }
    faces = drift_faces(POINT, sea, places)
    moves = {face.inside[0]: sorted(faces[j].inside[0] for j in face.adjacent) for face in faces}
    assert moves == {"a": ["c", "d"], "b": ["c", "d"], "c": ["a", "b"], "d": ["a", "b"]}


def test_a_common_border_drawn_with_other_vertices_is_no_obstacle():
    sea = box((0, 0), (1, 1))
    west = polygon([(0, 0), (0, 0.5), (1 / 3, 0.5 + 1e-7), (0.77777, 0.5 - 1e-7), (1, 0.5), (1, 0)])
    east = polygon([(0, 0.5), (0, 1), (1, 1), (1, 0.5), (0.5, 0.5 + 1e-7)])
    faces = drift_faces(POINT, sea, {"west": west, "east": east})
    assert sorted((face.inside, sorted(faces[j].inside for j in face.adjacent)) for face in faces) == [
        (("east",), [("west",)]),
        (("west",), [("east",)]),
    ]


def test_a_ship_too_wide_for_a_strait_has_faces_on_both_sides_and_no_way_between():
    lakes = polygon(
        at((52, 5), *v)
        for v in [
            (0, 0),
            (0, 4),
            (1.9, 4),
            (1.9, 6),
            (0, 6),
            (0, 10),
            (4, 10),
            (4, 6),
            (2.1, 6),
            (2.1, 4),
            (4, 4),
            (4, 0),
        ]
    )
    west = box(at((52, 5), -1, -1), at((52, 5), 5, 4.5))
    places = {"lakes": lakes, "west": west}
    assert len(drift_faces(circle((0, 0), 2), lakes, places)[0].adjacent) == 1
    faces = drift_faces(circle((0, 0), 20), lakes, places)
    assert sorted((face.inside, face.adjacent) for face in faces) == [
        (("lakes",), ()),
        (("lakes", "west"), ()),
    ]


def test_what_does_not_fit_has_no_faces():
    islet = circle((52, 5), 30)
    assert drift_faces(circle((0, 0), 31), islet, {"islet": islet}) == ()
    assert face_at(circle((52, 5), 31), islet, {}) is None
    assert face_at(point(0, 0), islet, {}) is None


def test_points_among_the_places_cut_nothing():
    sea = box((0, 0), (1, 1))
    assert len(drift_faces(POINT, sea, {"buoy": point(0.5, 0.5)})) == 1


def test_a_drift_of_what_is_not_convex_is_refused_with_its_reason():
    hook = polygon([(0, 0), (0, 0.001), (0.0002, 0.001), (0.0002, 0.0002), (0.001, 0.0002), (0.001, 0)])
    with pytest.raises(GeometryError, match="and its cargo, is a point or convex") as caught:
        drift_faces(hook, box((0, 0), (1, 1)), {})
    assert caught.value.hint == "list its placements (drifts among), or give its convex hull"


def test_nothing_drifts_within_a_point():
    with pytest.raises(GeometryError, match="no entity can drift within point"):
        drift_faces(POINT, point(1, 1), {})
