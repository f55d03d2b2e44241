"""Mobility commands."""

import pytest

from physical import (
    Band,
    JoinChannel,
    LeaveChannel,
    PhysicalError,
    PhysicalProperty,
    Waypoint,
    box,
    centroid,
    go_to,
    rechannel,
)


def test_figure_6_a_move_to_the_oil_spill_is_a_waypoint_at_the_centroid_of_its_polygon():
    spill = PhysicalProperty("oilSpill0", "OilSpill", box((37.01, -8.66), (36.99, -8.7)), Band(0, 0))
    assert go_to("uav0", spill) == Waypoint("uav0", centroid(spill.geometry), Band(0, 0))
    assert go_to("uav0", spill).point.vertices[0] == pytest.approx((37.0, -8.68), abs=1e-5)


def test_a_waypoint_is_a_point():
    with pytest.raises(PhysicalError, match="is no point"):
        Waypoint("uav0", box((0, 0), (1, 1)))


def test_a_change_of_channels_leaves_before_it_joins():
    assert rechannel("uav0", ("control:gcs0", "wifi"), ("wifi", "control:gcs1", "ais")) == (
        LeaveChannel("uav0", "control:gcs0"),
        JoinChannel("uav0", "ais"),
        JoinChannel("uav0", "control:gcs1"),
    )
    assert rechannel("uav0", ("wifi",), ("wifi",)) == ()
