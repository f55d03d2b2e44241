import pytest
from hypothesis import given
from hypothesis import strategies as st

from physical.ais_recording import AISRecording
from physical.ais_reports import AisError, PositionReport, StaticReport
from physical.ais_world import (
    COARSE,
    KNOT,
    TIME_TO_LIVE,
    UNDATED,
    Finest,
    check_time,
    physical_property,
    seen_at,
    world_at,
)
from physical.altitude import Band
from physical.geometry import box, point
from physical.physical_property import Velocity

VESSEL, BUOY, STATION = 244660274, 992446001, 2442103


def at(time, lat=52.97, lon=5.41, mmsi=VESSEL, msg_type=1):
    return PositionReport(time, msg_type, mmsi, lat, lon)


def recording(*reports):
    return AISRecording(tuple(reports))


def places(world):
    return {known.entity: known.geometry for known in world}


def test_a_position_becomes_the_property_of_its_sender():
    report = PositionReport(7.0, 1, VESSEL, 52.97, 5.41, sog_kn=4.5, cog_deg=90.0, heading_deg=88.0)
    known = physical_property(report)
    assert (known.entity, known.kind) == ("mmsi244660274", "Vessel")
    assert known.geometry is point(52.97, 5.41)
    assert (known.time, known.source, known.velocity) == (7.0, "ais", Velocity(4.5 * KNOT, 90.0))


@pytest.mark.parametrize("motion", [{"sog_kn": 4.5}, {"cog_deg": 90.0}, {}])
def test_without_speed_or_course_there_is_no_velocity(motion):
    assert physical_property(PositionReport(7.0, 1, VESSEL, 52.97, 5.41, **motion)).velocity is None


@pytest.mark.parametrize(
    ("times", "asked", "counts"),
    [
        pytest.param((1.0, 2.0, 3.0), 2.0, 2.0, id="at the time"),
        pytest.param((1.0, 2.0, 3.0), 2.9, 2.0, id="before the time"),
        pytest.param((1.0, 2.0, 3.0), 0.5, None, id="none so early"),
        pytest.param((1.0, 2.0), None, 2.0, id="at the end"),
        pytest.param((2.0, 1.0), None, 1.0, id="by time, whatever the order of arrival"),
        pytest.param((1.0, 1.0), None, 2.0, id="of one time the last to arrive"),
        pytest.param((None, None), None, 2.0, id="without times the last to arrive"),
    ],
)
def test_the_newest_position_counts(times, asked, counts):
    """The latitude of each is its place in the order of arrival, from 1."""
    heard = recording(*(at(time, lat=float(place)) for place, time in enumerate(times, 1)))
    expected = {} if counts is None else {"mmsi244660274": point(counts, 5.41)}
    assert places(world_at(heard, asked)) == expected


def test_a_position_older_than_its_time_to_live_is_left_out():
    heard = recording(at(0.0), at(TIME_TO_LIVE, mmsi=BUOY))
    assert len(world_at(heard)) == 2
    assert len(world_at(heard, TIME_TO_LIVE + 1)) == 1
    assert world_at(heard, TIME_TO_LIVE + 31, time_to_live=30) == ()


def test_a_time_cannot_be_asked_of_a_recording_without_times():
    with pytest.raises(AisError, match="no times"):
        world_at(recording(at(None)), 5.0)


def test_a_position_without_a_time_is_as_old_as_its_neighbour_and_that_is_said():
    read = seen_at(recording(at(None, lat=1.0), at(1.0, mmsi=BUOY), at(None, lat=2.0), at(0.5, lat=3.0)))
    assert places(read.properties) == {"mmsi244660274": point(2.0, 5.41), "mmsi992446001": point(52.97, 5.41)}
    assert read.tallies[1].asides == ((UNDATED, 2),)


def test_positions_without_a_time_are_too_old_when_their_neighbours_are():
    heard = recording(at(None, lat=1.0), at(1.0, mmsi=BUOY), at(TIME_TO_LIVE + 2, mmsi=STATION))
    assert [known.entity for known in world_at(heard)] == ["mmsi002442103"]


def test_all_positions_are_accounted_for():
    heard = recording(
        at(0.0), at(TIME_TO_LIVE + 1), at(TIME_TO_LIVE + 2), at(TIME_TO_LIVE + 2, mmsi=BUOY, lat=1.0),
        at(TIME_TO_LIVE + 2, msg_type=27), at(TIME_TO_LIVE + 9), at(TIME_TO_LIVE + 2, mmsi=STATION, msg_type=4),
    )  # fmt: skip
    kinds = {"Vessel", "AidToNavigation"}
    tally = seen_at(heard, TIME_TO_LIVE + 2, box((52, 5), (53, 6)), kinds).tallies[1]
    assert dict(tally.taken) == {"station": 1}
    assert dict(tally.left_out) == {
        "position older than 600 s": 1,
        "position of a station with a newer one": 1,
        COARSE: 1,
        "position after the time": 1,
        "BaseStation not asked for": 1,
        "station outside the area": 1,
    }
    assert tally.adds_up


def test_a_time_outside_of_the_recording_is_refused_with_its_span():
    heard = recording(at(1772596000.0), at(1772596600.0))
    for time in (1772596000.0, 1772596600.0 + TIME_TO_LIVE):
        check_time(heard, time)
    for time in (1772595999.0, 1772596601.0 + TIME_TO_LIVE):
        with pytest.raises(AisError, match="from 2026-03-04T03:46:40Z to 2026-03-04T03:56:40Z"):
            check_time(heard, time)


def test_an_aircraft_has_the_altitude_that_it_reports_and_one_beyond_its_scale_has_no_upper_end():
    def band(altitude):
        return physical_property(PositionReport(7.0, 9, 111232512, 53.0, 5.0, altitude=altitude)).altitude

    assert band(600.0) == Band(600, 600)
    assert band(4094.0) == Band(4094, 20_000)
    assert band(None) is None


def test_a_finer_position_supersedes_coarse_ones_while_it_counts():
    finest = Finest(time_to_live=10.0)
    heard = [(0.0, 27), (1.0, 1), (2.0, 27), (11.0, 17), (12.0, 27), (13.0, 1), (14.0, 27)]
    coarse = [finest.supersedes(at(time, msg_type=kind), time) for time, kind in heard]
    assert coarse == [False, False, True, True, False, False, True]
    assert not finest.supersedes(at(14.0, mmsi=BUOY, msg_type=27), 14.0)


def test_only_what_is_inside_the_area_is_kept():
    heard = recording(at(1.0), at(1.0, lat=53.5, mmsi=BUOY))
    assert [known.entity for known in world_at(heard, area=box((52, 5), (53, 6)))] == ["mmsi244660274"]


def test_a_vessel_that_left_the_area_is_not_in_it_any_more():
    assert world_at(recording(at(1.0), at(2.0, lat=53.5)), area=box((52, 5), (53, 6))) == ()


def test_an_area_may_lie_across_the_antimeridian():
    heard = recording(at(1.0, lon=179.95), at(1.0, lon=-179.95, mmsi=BUOY), at(1.0, lon=0.0, mmsi=STATION))
    assert len(world_at(heard, area=box((52, 179.9), (53, -179.9)))) == 2


def test_only_the_kinds_asked_for_are_kept_sorted_by_name():
    heard = recording(at(1.0, mmsi=BUOY), at(1.0), at(1.0, mmsi=STATION, msg_type=4))
    assert [known.kind for known in world_at(heard)] == ["BaseStation", "Vessel", "AidToNavigation"]
    assert [known.kind for known in world_at(heard, kinds={"Vessel"})] == ["Vessel"]
    assert world_at(heard, kinds=()) == ()


def test_an_unknown_kind_is_refused_by_name():
    with pytest.raises(AisError, match="'Submarine'") as caught:
        world_at(recording(), kinds=["Submarine"])
    assert "DistressBeacon" in caught.value.hint


def test_static_reports_place_nothing():
    assert world_at(recording(StaticReport(1.0, 5, VESSEL, "KOKMEEUW", 52))) == ()


moments = st.integers(0, 50).map(float)


@given(st.lists(st.builds(at, moments, st.floats(-89, 89), mmsi=st.sampled_from([VESSEL, BUOY]))), moments)
def test_later_arrivals_do_not_change_the_world_of_before(reports, time):
    before = tuple(report for report in reports if report.time <= time)
    if reports:
        assert world_at(recording(*reports), time) == world_at(recording(*before), time)
