"""Waypoint files."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from physical import (
    Band,
    PhysicalError,
    band_contains,
    box,
    point,
    read_plan,
    read_waypoints,
    waypoint_places,
    write_plan,
    write_waypoints,
)
from physical.waypoints import read_mission

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
    # Latitude 0 and longitude 0 mean "here" to an autopilot: it is written 1 cm beside.
    written = [point(1e-7, 0) if at is point(0, 0) else at for at in (home, *points)]
    assert [item.point for item in items] == written
    assert all(item.altitude == altitude for item in items[1:])


bands = st.tuples(st.floats(-500, 9000), st.floats(0, 500)).map(lambda each: Band(each[0], each[0] + each[1]))


@settings(deadline=None)
@given(
    st.lists(st.tuples(positions, st.none() | bands), min_size=1, max_size=5),
    st.sampled_from([write_waypoints, write_plan]),
)
def test_what_is_written_within_a_band_is_read_back_within_it(stops, write):
    points, wanted = zip(*stops, strict=True)
    text = write(points, 100.0, None, 12.0, wanted)
    read = read_waypoints if write is write_waypoints else read_plan
    home, *places = waypoint_places(read(text))
    assert home.altitude == Band(12, 12)
    for place, band in zip(places, wanted, strict=True):
        assert band_contains(band, place.altitude)
        assert band is not None or place.altitude == Band(112, 112)


def made(*lines):
    rows = (f"{index}\t0\t" + "\t".join(map(str, line)) + "\t1" for index, line in enumerate(lines))
    return "\n".join(["QGC WPL 110", *rows]) + "\n"


def line(command=16, frame=3, latitude=47.4, longitude=8.5, altitude=50):
    return (frame, command, 0, 0, 0, 0, latitude, longitude, altitude)


def places_of(*lines):
    return {place.entity: place for place in waypoint_places(read_waypoints(made(*lines)))}


def account(*lines):
    return read_mission(read_waypoints(made(*lines))).tallies[0]


HOME = line(frame=0, altitude=400)


@pytest.mark.parametrize(
    ("frame", "band"),
    [
        (0, Band(50, 50)), (5, Band(50, 50)), (3, Band(450, 450)), (6, Band(450, 450)), (10, None), (11, None),
    ],
)  # fmt: skip
def test_altitudes_are_above_the_sea_above_home_or_above_the_terrain(frame, band):
    assert places_of(HOME, line(frame=frame))["waypoint1"].altitude == band
    asides = account(HOME, line(frame=frame)).asides
    assert bool(asides) == (band is None)
    assert all("terrain" in kind for kind, _ in asides)


@pytest.mark.parametrize("frame", [1, 2, 4, 7, 8, 9, 12, 20, 99])
def test_in_other_frames_there_is_no_latitude_and_longitude(frame):
    assert places_of(HOME, line(frame=frame)).keys() == {"waypoint0"}
    assert account(HOME, line(frame=frame)).left_out == (
        (f"WAYPOINT in frame {frame}, which has no latitude and longitude", 1),
    )


@pytest.mark.parametrize("command", [16, 17, 18, 19, 21, 22, 31, 34, 36, 82, 84, 85, 94, 192, 31000])
def test_every_command_that_goes_to_a_position_is_a_place(command):
    assert places_of(HOME, line(command)).keys() == {"waypoint0", "waypoint1"}
    assert account(HOME, line(command)).missing() == ()


@pytest.mark.parametrize(
    ("command", "kind"),
    [
        (80, "NAV_ROI"), (195, "DO_SET_ROI_LOCATION"), (201, "DO_SET_ROI"), (189, "DO_LAND_START"),
        (179, "DO_SET_HOME"), (5000, "fence return point"), (5001, "fence vertex (to stay in)"),
        (5002, "fence vertex (to stay out)"), (5003, "fence circle (to stay in)"),
        (5004, "fence circle (to stay out)"), (5100, "rally point"), (177, "DO_JUMP"), (43210, "command 43210"),
    ],
)  # fmt: skip
def test_whatever_else_has_a_position_is_no_place_and_is_named(command, kind):
    assert places_of(HOME, line(command)).keys() == {"waypoint0"}
    assert account(HOME, line(command)).left_out == ((kind, 1),)


@pytest.mark.parametrize("first", [line(22), line(16), line(84, frame=6), line(16, frame=10)])
def test_an_item_0_that_is_not_above_the_sea_is_no_home_and_altitudes_above_home_are_not_known(first):
    places = places_of(first, line(altitude=30))
    assert places.keys() == {"waypoint0", "waypoint1"}
    assert (places["waypoint0"].altitude, places["waypoint1"].altitude) == (None, None)
    assert dict(account(first, line(altitude=30)).taken) == {"waypoint": 2}


@pytest.mark.parametrize("command", [0, 16])
def test_a_home_at_latitude_0_and_longitude_0_is_none(command):
    first = line(command, frame=0, latitude=0, longitude=0, altitude=0)
    assert places_of(first, line())["waypoint1"].altitude is None
    assert places_of(first, line()).keys() == {"waypoint1"}
    assert account(first, line()).left_out == (("home at latitude 0 and longitude 0", 1),)


def test_home_may_have_no_command():
    assert places_of(line(0, frame=0, altitude=400), line())["waypoint1"].altitude == Band(450, 450)


commands = st.sampled_from([0, 16, 17, 21, 22, 31, 80, 84, 177, 201, 5001, 5100]) | st.integers(0, 65_535)
lines = st.builds(
    line,
    commands,
    st.integers(0, 21),
    st.sampled_from([0, 47.4]),
    st.sampled_from([0, 8.5]),
    st.integers(-9, 9000),
)


@given(st.lists(lines, max_size=12))
def test_the_account_adds_up_to_the_items(items):
    read = read_mission(read_waypoints(made(*items)))
    assert read.tallies[0].adds_up
    assert read.tallies[0].total == len(items)
    assert sum(count for _, count in read.tallies[0].taken) == len(read.properties)


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
