"""Waypoint files."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from physical import Band, PhysicalError, box, point, read_waypoints, waypoint_places, write_waypoints

PORTIMAO = """QGC WPL 110
0\t1\t0\t16\t0.000000\t0.000000\t0.000000\t0.000000\t37.000000\t-8.600000\t12.000000\t1
1\t0\t3\t22\t15.000000\t0.000000\t0.000000\t0.000000\t37.004000\t-8.600000\t60.000000\t1
2\t0\t3\t16\t0.000000\t0.000000\t0.000000\t0.000000\t37.006000\t-8.610000\t100.000000\t1
3\t0\t10\t17\t0.000000\t0.000000\t0.000000\t0.000000\t36.998000\t-8.612000\t100.000000\t1
4\t0\t3\t20\t0.000000\t0.000000\t0.000000\t0.000000\t0.000000\t0.000000\t0.000000\t1
5\t0\t2\t183\t9.000000\t1500.000000\t0.000000\t0.000000\t0.000000\t0.000000\t0.000000\t1
"""

positions = st.builds(point, st.floats(-90, 90), st.floats(-180, 180))


def test_a_waypoint_file_is_read_as_places():
    places = waypoint_places(read_waypoints(PORTIMAO))
    assert [(place.entity, place.kind, place.geometry, place.altitude) for place in places] == [
        ("waypoint0", "Waypoint", point(37, -8.6), Band(12, 12)),
        ("waypoint1", "Waypoint", point(37.004, -8.6), Band(72, 72)),
        ("waypoint2", "Waypoint", point(37.006, -8.61), Band(112, 112)),
        ("waypoint3", "Waypoint", point(36.998, -8.612), None),
    ]


def test_items_that_go_nowhere_are_read_as_such():
    items = read_waypoints(PORTIMAO)
    assert [item.index for item in items if item.point is None] == [4, 5]
    assert items[5].parameters == (9.0, 1500.0, 0.0, 0.0)


@settings(deadline=None)
@given(st.lists(positions, min_size=1, max_size=5), st.integers(-1000, 10_000), positions)
def test_written_waypoints_are_read_back(points, altitude, home):
    items = read_waypoints(write_waypoints(points, altitude, home))
    assert items[0].point is home
    # A waypoint at latitude 0 and longitude 0 means "here" to an autopilot.
    null = point(0, 0)
    assert [item.point for item in items[1:]] == [None if at is null else at for at in points]
    assert all(item.altitude == altitude for item in items[1:])


def test_home_is_the_first_point_unless_given():
    first, second = read_waypoints(write_waypoints([point(1, 2)], 50))
    assert first.point is second.point is point(1, 2)
    assert (first.altitude, second.altitude) == (0.0, 50.0)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "the file does not begin with 'QGC WPL 110'"),
        ("QGC WPL 120\n", "the file does not begin with 'QGC WPL 110'"),
        ("QGC WPL 110\n1 2 3\n", "line 2: 3 columns where 12 were expected"),
        (PORTIMAO.replace("-8.612000", "west"), "line 5: a column is not a number"),
        (PORTIMAO.replace("-8.612000", "nan"), "line 5: the longitude nan is not between -180 and 180"),
        (
            PORTIMAO.replace("36.998000", "136.998000"),
            "line 5: the latitude 136.998 is not between -90 and 90",
        ),
        (
            PORTIMAO.replace("60.000000", "inf"),
            "line 3: an altitude is not between -1,000,000 m and 1,000,000 m",
        ),
        (PORTIMAO.replace("\n3\t", "\n7\t"), "line 5: item 7 where item 3 was expected"),
        ("x" * 1_000_001, "the waypoint file is over 1,000,000 characters"),
        ("QGC WPL 110\n" + "1\n" * 10_001, "the waypoint file has over 10,000 items"),
    ],
)
def test_what_is_no_waypoint_file_is_refused_with_its_line(text, message):
    with pytest.raises(PhysicalError) as caught:
        read_waypoints(text)
    assert str(caught.value).splitlines()[0] == message


@pytest.mark.parametrize("points", [[], [box((0, 0), (1, 1))]])
def test_only_points_are_written(points):
    with pytest.raises(PhysicalError, match="a waypoint file visits points"):
        write_waypoints(points, 10)


def test_only_finite_altitudes_are_written():
    with pytest.raises(PhysicalError, match="an altitude is not between"):
        write_waypoints([point(1, 2)], float("nan"))
