"""Parts of regions as geometries of GeoJSON, held to RFC 7946 and to the regions."""

import numpy as np
import pytest
import shapely
from drawing_regions import rings
from oracles.sampled_geodesics import away

from physical import RegionKind, RegionPart, box, circle, point
from physical.geodesic_areas import area_of
from physical.region_geojson import part_geometry
from physical.regions import FaceCover


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


@pytest.mark.parametrize("margin", [0.0, 250.0])
def test_the_drawn_border_is_that_of_the_part(margin):
    part = leg(box((60.0, 5.0), (60.2, 5.3)), point(61.5, 9.0), margin=margin)
    [polygon] = polygons(part_geometry(part))
    border = np.array(polygon.exterior.coords)
    middles = (border[1:] + border[:-1]) / 2  # straight in longitude and latitude
    for spots in (border, middles):
        off = away(spots, rings(area_of(part))) - margin
        assert off.max() <= 1.0
        assert off.min() >= -1.0 or margin == 0.0
    corners = np.array(rings(area_of(part))[0])
    assert all(polygon.buffer(1e-5).contains(shapely.Point(*corner)) for corner in corners)


def test_a_region_across_the_antimeridian_is_cut_there():
    found = part_geometry(leg(circle((10.0, 179.9), 3000), circle((10.2, -179.8), 3000)))
    assert found["type"] == "MultiPolygon"
    west, east = polygons(found)
    assert {west.bounds[0], east.bounds[2], west.bounds[2], east.bounds[0]} >= {-180.0, 180.0}
    assert shapely.intersection(west, east).area == 0.0
    line = part_geometry(leg(point(10.0, 179.9), point(10.2, -179.8)))
    assert line["type"] == "MultiLineString"
    assert {abs(position[0]) for part in line["coordinates"] for position in part} >= {180.0}


def test_a_point_and_a_line_have_their_own_types():
    assert part_geometry(RegionPart((point(37.0, -9.0),))) == {"type": "Point", "coordinates": [-9.0, 37.0]}
    assert part_geometry(leg(point(37.0, -9.0), point(37.1, -9.0)))["type"] == "LineString"
    [disc] = polygons(part_geometry(leg(point(37.0, -9.0), margin=100.0)))
    assert disc.contains(shapely.Point(-9.0, 37.0))


def test_a_face_keeps_its_hole():
    cover = FaceCover(box((37.0, -9.0), (37.1, -8.9)).ring, (box((37.04, -8.96), (37.06, -8.94)).ring,))
    [polygon] = polygons(part_geometry(RegionPart((cover,), kind=RegionKind.FACE)))
    assert len(polygon.interiors) == 1
