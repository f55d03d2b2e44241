from importlib.resources import files as resources

import pytest
import shapely

from physical.land import ACCURACY, land_within


def is_land(latitude, longitude, reach=0.5):
    """Tell whether a position is on land, as a map around it shows it."""
    found = land_within((latitude - reach, longitude - reach), (latitude + reach, longitude + reach))
    at = shapely.Point(longitude, latitude)
    return any(
        shapely.Polygon(
            [(x, y) for y, x in rings[0]], [[(x, y) for y, x in ring] for ring in rings[1:]]
        ).contains(at)
        for rings in found
    )


@pytest.mark.parametrize("reach", [0.05, 0.5, 20.0])
def test_an_airfield_is_on_land_and_the_sea_off_it_is_not(reach):
    assert is_land(37.149, -8.584, reach)
    assert not is_land(36.8, -8.7, reach)


def test_a_lake_is_no_land():
    assert not is_land(52.7, 5.4)  # IJsselmeer
    assert not is_land(44.0, -87.0)  # Lake Michigan


def test_tiles_leave_no_seams():
    (mainland,) = land_within((39.5, -4.5), (40.5, -3.5))
    assert len(mainland) == 1
    assert shapely.Polygon(mainland[0]).area == pytest.approx(1.0)


def test_a_window_across_the_antimeridian_has_land_on_both_sides():
    spots = [spot for rings in land_within((-17.5, 178), (-16, 182)) for spot in rings[0]]
    assert min(x for _, x in spots) < 179.5
    assert max(x for _, x in spots) > 180.0


def test_a_window_beyond_the_antimeridian_is_the_same_window():
    here, there = (land_within((60, west), (61, west + 2)) for west in (10.0, 370.0))
    assert [[(y, pytest.approx(x + 360)) for y, x in ring] for ring in here[0]] == [
        list(ring) for ring in there[0]
    ]


def test_the_open_sea_has_no_land():
    assert land_within((30, -40), (31, -39)) == ()


def test_a_view_of_the_whole_earth_takes_the_overview():
    found = land_within((-90, -180), (90, 180))
    assert 100 < len(found) < 2_000
    assert sum(len(ring) for rings in found for ring in rings) < 50_000


@pytest.mark.parametrize(
    "cape",
    [(37.0225, -8.9964), (38.7804, -9.4989), (50.0657, -5.7148), (37.9956, -123.0231)],
    ids=["São Vicente", "Roca", "Land's End", "Point Reyes"],
)
def test_coasts_are_as_exact_as_is_said(cape):
    y, x = cape
    near = land_within((y - 0.4, x - 0.4), (y + 0.4, x + 0.4))
    coasts = [shapely.LinearRing([(b, a) for a, b in rings[0]]) for rings in near]
    assert min(coast.distance(shapely.Point(x, y)) for coast in coasts) * 111_000 < ACCURACY


def test_the_coasts_of_the_world_are_a_megabyte_at_most():
    assert len((resources("physical") / "land.zip").read_bytes()) < 1_000_000
