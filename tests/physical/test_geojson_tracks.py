"""Tracks as GeoJSON."""

import json
from itertools import pairwise

from hypothesis import given
from hypothesis import strategies as st
from shapely.geometry import shape

from physical.frame import E7
from physical.geojson_tracks import PositionFix, Track, write_tracks

HALF = 180 * E7


def written(*fixes):
    (feature,) = json.loads(write_tracks([Track("uav0", "UAV", fixes)]))["features"]
    return feature["geometry"], feature["properties"]


def test_a_track_is_a_line_with_the_time_of_each_position():
    geometry, properties = written(
        PositionFix((10 * E7, -E7), 0.0, 5.0), PositionFix((11 * E7, -E7), 1.5, 6.0)
    )
    assert geometry == {"type": "LineString", "coordinates": [[-1, 10, 5.0], [-1, 11, 6.0]]}
    assert properties == {
        "name": "uav0",
        "kind": "UAV",
        "coordTimes": ["1970-01-01T00:00:00.000Z", "1970-01-01T00:00:01.500Z"],
    }


def test_heights_and_times_are_written_where_all_are_known():
    geometry, properties = written(PositionFix((0, 0), 0.0, 5.0), PositionFix((1, 0), None, None))
    assert {len(position) for position in geometry["coordinates"]} == {2}
    assert "coordTimes" not in properties


def test_one_position_is_a_point():
    geometry, properties = written(PositionFix((0, E7), 1e300))
    assert geometry == {"type": "Point", "coordinates": [1, 0]}
    assert properties["time"] == "2106-02-07T06:28:16.000Z"


def test_what_crosses_the_antimeridian_is_cut_there():
    geometry, properties = written(
        PositionFix((0, HALF - 3 * E7), 0.0),
        PositionFix((4 * E7, E7 - HALF), 4.0),
        PositionFix((4 * E7, HALF - 1), 5.0),
    )
    assert geometry["type"] == "MultiLineString"
    assert geometry["coordinates"][:2] == [[[177, 0], [180, 3]], [[-180, 3], [-179, 4], [-180, 4]]]
    assert properties["coordTimes"][1][0] == "1970-01-01T00:00:03.000Z"


@given(
    st.lists(
        st.tuples(st.integers(-90 * E7, 90 * E7), st.integers(1 - HALF, HALF - 1)),
        min_size=2,
        max_size=9,
        unique=True,
    )
)
def test_no_part_of_a_track_goes_around_the_earth(positions):
    geometry, properties = written(*(PositionFix(position, float(k)) for k, position in enumerate(positions)))
    multi = geometry["type"] == "MultiLineString"
    parts = geometry["coordinates"] if multi else [geometry["coordinates"]]
    times = properties["coordTimes"] if multi else [properties["coordTimes"]]
    assert [len(part) for part in parts] == [len(part) for part in times]
    assert all(abs(a[0] - b[0]) <= 180 for part in parts for a, b in pairwise(part))
    assert all(len(part) >= 2 for part in parts)
    assert shape(geometry).is_valid
