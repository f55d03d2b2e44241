"""Premises of control, each by a mission in which it alone decides."""

import pytest
from checked_missions import WORLD, kinds, start, verdict

from semantics.control import Obstacle, obstacle
from semantics.state.requests import FLY
from semantics.successors import expand

INNER = """
signature {
  kind Sea contains Sea, UAV, Buoy
  kind UAV driven
  kind Buoy
  kind Station
}
rule enter(u: UAV, p: Sea) { u || p -> p.u }
world {
  sea0: Sea = box (0.0, 0.0) (0.1, 0.1)
  west0: Sea = box (0.01, 0.01) (0.04, 0.04)
  east0: Sea = box (0.06, 0.06) (0.09, 0.09)
  uav0: UAV = point (0.05, 0.05) linked control:g0, wifi
  uav1: UAV = point (0.05, 0.02) linked control:g0, wifi
  buoy0: Buoy = point (0.05, 0.08)
}
control timed
"""


def walked(c, *words):
    """Return where the steps lead whose labels have these words in them, one after the other."""
    for word in words:
        (step,) = [each for each in expand(c).transitions if word in str(each.label)]
        c = step.target
    return c


def labels(c):
    return {str(each.label) for each in expand(c).transitions}


def flight_of(c, agent):
    (flight,) = [each.request for each in c.eta.of(agent) if isinstance(each.request, FLY)]
    return flight


def test_what_both_ends_of_a_flight_are_in_still_shows_the_vehicle_and_yet_a_second_command_waits():
    text = """
    BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO west0) }
    BigActor b hosted_at uav0 with_behavior { control(MOVE_HOST_TO east0) }
    """
    c = walked(start(text, INNER), "req_ctr : a", "req_ctr : b")
    assert any("command : CTR(b" in each for each in labels(c))
    flying = walked(c, "command : CTR(a")
    assert flying.structure.physical.contains("sea0", "uav0")
    assert labels(flying) == {"⟨commit : FLY(a, MOVE_HOST_TO west0)⟩"}


LANDING = """
BigActor a hosted_at uav0 with_behavior { control(enter(uav0, west0)) }
BigActor b hosted_at uav1 with_behavior { observe(CHILDREN(west0)) }
environment { buoy0 drifts among point (0.05, 0.08), point (0.02, 0.02) }
"""
IN, OUT = "buoy0 drifts to point (0.02, 0.02)", "buoy0 drifts to point (0.05, 0.08)"


def test_a_flight_into_what_must_be_empty_commits_only_where_it_is_believed_empty():
    c = walked(
        start(LANDING, INNER), "req_ctr : a", "command : CTR(a", "req_obs : b", IN, "sense : OBS(b", OUT
    )
    assert not c.structure.physical.contains("west0", "buoy0")
    assert c.structure.logical.parent("buoy0") == "west0"
    assert obstacle(c, flight_of(c, "a")) is Obstacle.UNMATCHED
    assert not any("commit" in each for each in labels(c))


def test_a_flight_into_what_must_be_empty_commits_only_where_it_is_empty():
    c = walked(start(LANDING, INNER), "req_ctr : a", "command : CTR(a", IN)
    assert obstacle(c, flight_of(c, "a")) is Obstacle.INCONSISTENT
    assert not any("commit" in each for each in labels(c))
    assert any("commit" in each for each in labels(walked(c, OUT)))


def test_of_several_that_are_to_fly_one_in_transit_is_enough_to_wait_for():
    text = """
    rule both(u: UAV, v: UAV, p: Sea) { u || v || p.$0 -> p.(u | v | $0) }
    BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO west0) }
    BigActor b hosted_at uav1 with_behavior { control(both(uav0, uav1, east0)) }
    """
    c = walked(start(text, INNER), "req_ctr : a", "req_ctr : b")
    assert any("command : CTR(b" in each for each in labels(c))
    assert labels(walked(c, "command : CTR(a")) == {"⟨commit : FLY(a, MOVE_HOST_TO west0)⟩"}


def test_of_several_matches_the_one_that_comes_furthest_says_what_is_in_the_way():
    text = """
    rule enter_by(u: UAV, p: Sea) { u[c] || p.$0 -> p.(u[c] | $0) }
    BigActor a hosted_at uav0 with_behavior { control(enter_by(uav0, west0)) }
    environment { wifi drops fog0 drifts among box (0.01, 0.01) (0.04, 0.04) }
    """
    world = INNER.replace("buoy0: Buoy", "fog0: Sea = box (0.2, 0.2) (0.23, 0.23)\n  buoy0: Buoy")
    c = walked(start(text, world), "req_ctr : a", "fog0 drifts", "wifi drops")
    (request,) = (each.request for each in c.eta.of("a"))
    assert obstacle(c, request) is Obstacle.UNREALISABLE


@pytest.mark.parametrize(("place", "found"), [("south0", set()), ("bay0", {"unrealisable"})])
def test_what_is_put_down_in_a_smaller_place_is_not_put_into_the_one_around_it(place, found):
    world = WORLD.replace("  vessel0:", "  bay0: Location = box (36.995, -8.66) (36.96, -8.74)\n  vessel0:")
    text = f"BigActor a hosted_at vessel0 with_behavior {{ control(PUT drifter0 IN {place}) }}"
    assert set(kinds(verdict(text, "local_consistency", world))) == found
