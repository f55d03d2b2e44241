"""Regions as GeoJSON, held to RFC 7946 and to the regions."""

import json

import numpy as np
import pytest
import shapely
from drawing_regions import rings
from oracles.sampled_geodesics import away

from physical import Band, Region, RegionKind, RegionPart, box, circle, point
from physical.geodesic_areas import area_of
from physical.geojson_regions import NamedRegion, write_regions
from physical.regions import FaceCover


def written(*parts, **more):
    named = NamedRegion("uav0", "UAV", Region(parts), **more)
    collection = json.loads(write_regions([named]))
    assert collection["type"] == "FeatureCollection"
    return collection["features"]


def leg(*sources, margin=0.0, altitude=None):
    return RegionPart(tuple(sorted(sources)), True, margin, altitude, RegionKind.LEG, ("", "east"))


def polygons(geometry):
    """Return the polygons of a geometry, each valid by RFC 7946: closed, counterclockwise, within the longitudes."""
    kind, coordinates = geometry["type"], geometry["coordinates"]
    found = []
    for part in coordinates if kind == "MultiPolygon" else [coordinates]:
        shell, *holes = (np.array(ring) for ring in part)
        assert (np.abs(shell[:, 0]) <= 180).all()
        assert (np.abs(shell[:, 1]) <= 90).all()
        for ring, sign in ((shell, 1), *((hole, -1) for hole in holes)):
            assert len(ring) >= 4
            assert (ring[0] == ring[-1]).all()
            area = np.sum(ring[:-1, 0] * ring[1:, 1] - ring[1:, 0] * ring[:-1, 1])
            assert np.sign(area) == sign
        found.append(shapely.Polygon(shell, holes))
        assert found[-1].is_valid
    return found


def test_a_part_is_a_feature_with_what_is_known_of_it():
    [found] = written(
        leg(point(37.0, -9.0), box((37.0, -8.9), (37.1, -8.8)), altitude=Band(30, 60)), flight="to east"
    )
    assert found["type"] == "Feature"
    assert found["properties"] == {
        "name": "uav0",
        "kind": "UAV",
        "region": "leg",
        "altitude": [30.0, 60.0],
        "between": ["", "east"],
        "flight": "to east",
    }
    [polygon] = polygons(found["geometry"])
    assert polygon.contains(shapely.Point(-8.95, 37.02))


@pytest.mark.parametrize("margin", [0.0, 250.0])
def test_the_drawn_border_is_that_of_the_part(margin):
    part = leg(box((60.0, 5.0), (60.2, 5.3)), point(61.5, 9.0), margin=margin)
    [polygon] = polygons(written(part)[0]["geometry"])
    border = np.array(polygon.exterior.coords)
    middles = (border[1:] + border[:-1]) / 2  # straight in longitude and latitude
    for spots in (border, middles):
        off = away(spots, rings(area_of(part))) - margin
        assert off.max() <= 1.0
        assert off.min() >= -1.0 or margin == 0.0
    corners = np.array(rings(area_of(part))[0])
    assert all(polygon.buffer(1e-5).contains(shapely.Point(*corner)) for corner in corners)


def test_a_region_across_the_antimeridian_is_cut_there():
    [found] = written(leg(circle((10.0, 179.9), 3000), circle((10.2, -179.8), 3000)))
    assert found["geometry"]["type"] == "MultiPolygon"
    west, east = polygons(found["geometry"])
    assert {west.bounds[0], east.bounds[2], west.bounds[2], east.bounds[0]} >= {-180.0, 180.0}
    assert shapely.intersection(west, east).area == 0.0
    [line] = written(leg(point(10.0, 179.9), point(10.2, -179.8)))
    assert line["geometry"]["type"] == "MultiLineString"
    assert {abs(position[0]) for part in line["geometry"]["coordinates"] for position in part} >= {180.0}


def test_a_point_and_a_line_have_their_own_types():
    [found] = written(RegionPart((point(37.0, -9.0),)))
    assert found["geometry"] == {"type": "Point", "coordinates": [-9.0, 37.0]}
    [found] = written(leg(point(37.0, -9.0), point(37.1, -9.0)))
    assert found["geometry"]["type"] == "LineString"
    [disc] = polygons(written(leg(point(37.0, -9.0), margin=100.0))[0]["geometry"])
    assert disc.contains(shapely.Point(-9.0, 37.0))


def test_a_face_keeps_its_hole_and_each_part_is_written_once():
    cover = FaceCover(box((37.0, -9.0), (37.1, -8.9)).ring, (box((37.04, -8.96), (37.06, -8.94)).ring,))
    part = RegionPart((cover,), kind=RegionKind.FACE)
    [found] = written(part, part)
    [polygon] = polygons(found["geometry"])
    assert len(polygon.interiors) == 1
    assert found["properties"]["region"] == "face"
