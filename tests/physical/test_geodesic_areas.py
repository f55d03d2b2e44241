"""Areas with geodesic borders: chords of straight edges, hulls, refusals."""

import numpy as np
import pytest
import shapely
from drawing_regions import geometry, hull, rings
from oracles.random_places import WORLDS, place
from oracles.sampled_geodesics import away, between, feet, is_in, metres, points_in
from scale import seeds

from physical import RegionError, box, circle, point, polygon
from physical.geodesic_areas import CHORD, area_of, circle_sagitta, disc_of, source_area
from physical.regions import FaceCover, RegionPart


@seeds(200, 12)
def test_chords_follow_a_place_to_two_centimetres(seed):
    rng = np.random.default_rng(seed)
    name = list(WORLDS)[seed % len(WORLDS)]
    vertices = place(rng, *WORLDS[name], kinds=("box", "star", "needle"))
    [ring] = rings(source_area(geometry(vertices)))
    border = points_in(vertices, 40, rng)
    at_border = [spot for spot in border if min_edge(vertices, spot) < 1e-9]
    assert len(at_border) > 10
    assert feet(np.array(at_border), ring).max() <= CHORD + 2e-3
    assert away(border[is_in(vertices, border)], [ring]).max(initial=0.0) <= CHORD


def min_edge(vertices, spot):
    """Return the least distance in degrees of a position from the straight edges of a place."""
    line = shapely.Polygon(np.column_stack([_beside(vertices[:, 0], spot[0]), vertices[:, 1]])).exterior
    return line.distance(shapely.Point(spot))


def _beside(easts, east):
    return east + (easts - east + 180.0) % 360.0 - 180.0


def test_a_shortest_line_leaves_a_box_along_its_northern_edge():
    """The figures of the calculus' page: at 37 degrees by 6 m in 20 km, 148 m in 100 km."""
    for kilometres, bulge in ((20, 5.9), (100, 148)):
        east = kilometres / 111.32 / np.cos(np.radians(37.0))
        found = area_of(hull(box((36.9, 0.0), (37.0, east))))
        top = between([0.0, 37.0], [east, 37.0], 0.5)[0]
        assert metres(top, [east / 2, 37.0])[0] == pytest.approx(bulge, rel=0.02)
        assert away(top, rings(found)) == pytest.approx(0.0, abs=1e-3)
        assert away([east / 2, 37.0 + 1.1 * (top[1] - 37.0)], rings(found)) > 0.05 * bulge


@seeds(3_000, 36)
def test_every_shortest_line_between_points_of_a_hull_is_in_it(seed):
    rng = np.random.default_rng(seed)
    name = list(WORLDS)[seed % len(WORLDS)]
    places = [place(rng, *WORLDS[name]) for _ in range(rng.integers(1, 4))]
    found = area_of(hull(*map(geometry, places)))
    ends = [np.concatenate([points_in(each, 12, rng) for each in places]) for _ in range(2)]
    for each in ends:
        rng.shuffle(each)
    on_the_way = between(*ends, rng.random(len(ends[0])))
    bound = 0.05 if WORLDS[name][2] < 500_000 else 1.5
    assert away(on_the_way, rings(found)).max() <= bound


@seeds(200, 18)
def test_no_corner_of_a_hull_is_a_point_between_others(seed):
    """It is the smallest such set: each of its corners is a point of a source."""
    rng = np.random.default_rng(seed)
    name = list(WORLDS)[seed % len(WORLDS)]
    places = [place(rng, *WORLDS[name]) for _ in range(2)]
    [corners] = rings(area_of(hull(*map(geometry, places))))
    own = [rings(source_area(geometry(each)))[0] for each in places]
    some = corners[rng.permutation(len(corners))[:30]]
    assert max(min(metres(spot, ring).min() for ring in own) for spot in some) <= 1e-3


def test_a_disc_holds_its_part_and_its_margin():
    part = hull(box((37.0, 179.9), (37.1, -179.9)), point(38.0, -179.0), margin=500.0)
    disc = disc_of(part)
    far = metres([[disc.longitude, disc.latitude]], rings(area_of(part))[0]).max()
    assert far + 500.0 == pytest.approx(disc.radius)
    assert disc.radius < 80_000


def test_the_hull_of_one_point_is_a_point_and_of_two_is_a_line():
    here, there = point(37.0, -8.0), point(37.1, -8.0)
    assert area_of(hull(here)).shape.geom_type == "Point"
    assert area_of(hull(here, there)).shape.geom_type == "LineString"


def test_the_border_of_a_face_has_its_holes():
    outer, inner = box((37.0, -9.0), (37.1, -8.9)), box((37.04, -8.96), (37.06, -8.94))
    cover = FaceCover(outer.ring, (inner.ring,))
    found = area_of(RegionPart((cover,)))
    assert away([-8.95, 37.05], rings(found)) > 500
    assert away([-8.99, 37.05], rings(found)) == 0.0
    assert found.border.shape.geom_type == "MultiLineString"


def test_a_region_over_a_pole_or_too_large_is_refused():
    for part in (
        hull(point(89.0, 10.0), point(89.0, -170.0)),
        hull(point(-89.0, 10.0), point(-89.0, 130.0), point(-89.0, -110.0)),
        hull(point(89.999, 10.0), margin=120.0),
    ):
        with pytest.raises(RegionError, match="a region covers a pole"):
            disc_of(part)
    disc_of(hull(point(89.0, 10.0), point(89.0, 130.0)))  # beside it
    disc_of(hull(point(89.999, 10.0), margin=100.0))
    with pytest.raises(RegionError, match="from its middle"):
        area_of(hull(point(37.0, -8.0), point(37.0, 20.0)))


def test_a_polygon_with_few_corners_or_with_unequal_radii_is_no_circle():
    drawn = circle((37.1, -8.6), 1_000.0)
    dented = polygon([(37.1, -8.6), *drawn.vertices[2:]])
    assert circle_sagitta(drawn) == pytest.approx(1.2, abs=0.01)
    for other in (
        circle((37.1, -8.6), 1_000.0, 8),
        dented,
        box((37.0, -8.7), (37.1, -8.6)),
        point(37.0, -8.6),
    ):
        assert circle_sagitta(other) == 0.0
