"""Physical properties."""

from physical import Band, PhysicalProperty, Velocity, point


def test_time_source_and_velocity_are_outside_equality():
    a = PhysicalProperty("uav0", "UAV", point(1, 2), time=1.0, source="gps", velocity=Velocity(20, 90))
    b = PhysicalProperty("uav0", "UAV", point(1, 2), time=2.0, source="ais")
    assert a == b
    assert hash(a) == hash(b)


def test_everything_else_is_within():
    a = PhysicalProperty("uav0", "UAV", point(1, 2))
    others = [
        PhysicalProperty("uav1", "UAV", point(1, 2)),
        PhysicalProperty("uav0", "Vessel", point(1, 2)),
        a.at(point(1, 3)),
        a.on(["wifi"]),
        PhysicalProperty("uav0", "UAV", point(1, 2), Band(0, 1)),
        PhysicalProperty("uav0", "UAV", point(1, 2), carried_by="vessel0"),
    ]
    assert all(other != a for other in others)


def test_channels_are_sorted_and_each_is_there_once():
    assert PhysicalProperty("a", "K", point(0, 0), channels=("w", "b", "w")).channels == ("b", "w")
    assert PhysicalProperty("a", "K", point(0, 0)).on({"w", "b"}).channels == ("b", "w")
