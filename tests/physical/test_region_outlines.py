"""The outlines of regions contain what they outline, and no more than a metre more."""

import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from pyproj import Geod

from physical import RegionPart, circle, point
from physical.region_outlines import aligned, outline_of, rings_of

WGS84 = Geod(ellps="WGS84")
LATITUDES, LONGITUDES = st.floats(-75, 75), st.floats(-180, 179.9)


@settings(max_examples=60, deadline=None)
@given(LATITUDES, LONGITUDES, st.floats(0, 360), st.floats(100, 400_000), st.floats(1, 5_000))
def test_an_outline_is_a_margin_around_the_shortest_line(north, east, azimuth, metres, margin):
    to_east, to_north, _ = WGS84.fwd(east, north, azimuth, metres)
    if abs(to_north) > 80:
        return
    part = RegionPart((point(north, east), point(to_north, to_east)), spanned=True, margin=margin)
    outline = outline_of(part)
    assert outline.is_valid
    for share in (0.0, 0.3, 1.0):
        at_east, at_north, _ = WGS84.fwd(east, north, azimuth, share * metres)
        for way in range(0, 360, 45):
            far_east, far_north, _ = WGS84.fwd(at_east, at_north, way, margin - 1.0)
            spot = aligned(shapely.Point(far_east, far_north), outline)
            assert outline.contains(spot)
    for side in (90, 270):
        at_east, at_north, back = WGS84.fwd(east, north, azimuth, metres / 2)
        far_east, far_north, _ = WGS84.fwd(at_east, at_north, back + side, margin * 1.01 + 1.0)
        assert not outline.contains(aligned(shapely.Point(far_east, far_north), outline))


def test_a_line_without_a_margin_has_no_rings():
    part = RegionPart((point(37, -8), point(37, -7)), spanned=True)
    assert rings_of(outline_of(part)) == ()


def test_an_outline_across_the_antimeridian_is_in_one_piece():
    part = RegionPart((circle((10, 179.9), 5_000), circle((10, -179.9), 5_000)), spanned=True, margin=100.0)
    outline = outline_of(part)
    assert outline.geom_type == "Polygon"
    west, _, east, _ = outline.bounds
    assert 0.2 < east - west < 0.5
