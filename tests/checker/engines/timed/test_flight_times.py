"""How long a flight may take, beside the distances of a meridian: places, ways, circles, bands, positions."""

from math import ceil, floor, pi

import pytest
from checked_missions import load
from pyproj import Geod

from checker import explore
from semantics.state.requests import FLY
from semantics.successors import expand
from semantics.timing.arrivals import is_unfair
from semantics.timing.flight_times import aim, interval_of_flight
from semantics.timing.intervals import ANY_TIME, Interval

WORLD = """
signature {
  kind Place contains UAV, Ship, Buoy, Pad, Raft
  kind UAV driven
  kind Ship driven carries UAV, Pad
  kind Pad driven carries UAV
  kind Buoy carries UAV, Pad, Tug
  kind Tug driven carries Raft
  kind Raft carries UAV
}
world {
  near0: Place = circle (37.02, -8.7) radius 300 m
  far0: Place = circle (37.05, -8.7) radius 300 m
  high0: Place = circle (37.035, -8.7) radius 300 m altitude 500 m to 700 m
  low0: Place = circle (37.04, -8.7) radius 200 m altitude 10 m to 20 m
  uav0: UAV = point (37.0, -8.7) altitude 80 m to 120 m linked mesh
  uav1: UAV = point (37.01, -8.7)
  uav2: UAV carried by ship0 linked mesh
  uav3: UAV carried by buoy0
  uav4: UAV = point (37.051, -8.7) linked mesh
  tug0: Tug carried by buoy0 linked mesh
  raft0: Raft carried by tug0
  ship0: Ship = point (37.06, -8.7) linked mesh
  pad0: Pad carried by ship0
  pad1: Pad carried by buoy0
  buoy0: Buoy = point (37.05, -8.7) linked mesh
}
control timed
scheduler fcfs
"""
LATITUDES = {
    "near": 37.02, "far": 37.05, "high": 37.035, "uav0": 37.0, "uav1": 37.01, "ship": 37.06
}  # fmt: skip
SPEEDS = "flies at 10 m/s to 20 m/s"


def metres(one, other):
    return Geod(ellps="WGS84").inv(-8.7, LATITUDES[one], -8.7, LATITUDES[other])[2]


def flights(text, lines):
    """Return the intervals of the last flight of a, as they change; other flights end first."""
    c = load(f"{text}\ntiming {{\n{lines}\n}}\n", WORLD).initial
    found = []
    while steps := expand(c).by_agents:
        c = min(steps, key=lambda step: step.label.rule == "commit" and step.label.agent == "a").target
        requests = (each.request for each in c.eta.of("a"))
        found += [interval_of_flight(c, each) for each in requests if isinstance(each, FLY)]
    return found


def of_flights(text, lines, ask=interval_of_flight):
    """Return the intervals of the flights of a in all configurations."""
    found = explore(load(f"{text}\ntiming {{\n{lines}\n}}\n", WORLD).initial).configurations
    pending = ((c, each.request) for c in found for each in c.eta.of("a"))
    return {ask(c, request) for c, request in pending if isinstance(request, FLY)}


def going(*controls):
    does = " ".join(f"control({each})" for each in controls)
    return f"BigActor a hosted_at uav0 with_behavior {{ {does} }}\n"


NEAR, FAR, HIGH = metres("uav0", "near"), metres("uav0", "far"), metres("uav0", "high")
BETWEEN, DOWN, SHIP = metres("near", "far"), metres("high", "far"), metres("uav0", "ship")
BOTH = "rule both(u: UAV) { u || uav1 || near0 -> near0.(u | uav1) }\n"
ALONE = "rule alone(u: UAV) { u || near0 -> near0.u }\n"
SAILS = "BigActor b hosted_at ship0 with_behavior { control(MOVE_HOST_TO far0) }\n"
LANDED = """
BigActor b hosted_at ship0 with_behavior {
  control(MOVE_HOST_TO far0) observe(PARENT(HOST)) react { case there: Observation => send("go", a) }
}
"""


def lifting(vehicle, place):
    takes_off = f'react {{ case "go" => control(MOVE_HOST_TO {place}) }}'
    return f"BigActor a hosted_at {vehicle} with_behavior {{ {takes_off} }}\n"


DRIFTS = "environment { buoy0 drifts within far0 }"
FLIGHTS = {
    "to a place": (going("MOVE_HOST_TO near0"), "", NEAR - 300, NEAR),
    "by way of another, to which it may have to come back": (
        going("MOVE_HOST_TO far0 VIA near0"), "", FAR - 900, 2 * BETWEEN
    ),
    "with a circle at each point": (
        going("MOVE_HOST_TO far0 VIA near0"), ", circles 80 m", FAR - 900, 2 * BETWEEN + 2 * pi * 160
    ),
    "from anywhere in a place": (
        going("MOVE_HOST_TO near0", "MOVE_HOST_TO far0"), "", BETWEEN - 600, BETWEEN + 300
    ),
    "from where in a place it was at first, which does not matter": (
        "BigActor a hosted_at uav4 with_behavior { control(MOVE_HOST_TO near0) }", "",
        BETWEEN - 600, BETWEEN + 300,
    ),
    "beside what drifts": (going("MOVE_HOST_TO near0") + DRIFTS, "", NEAR - 300, NEAR),
    "from a circle that leaves the place": (
        going("MOVE_HOST_TO near0", "MOVE_HOST_TO far0"), ", circles 80 m",
        BETWEEN - 760, BETWEEN + 460 + pi * 160,
    ),
    "to a ship that stays": (going("MOVE_HOST_TO ship0"), "", SHIP, SHIP),
    "to a ship that is somewhere in a place": (going("MOVE_HOST_TO ship0") + SAILS, "", FAR - 300, FAR + 300),
    "to what is aboard of it": (going("MOVE_HOST_TO pad0") + SAILS, "", FAR - 300, FAR + 300),
    "from a ship that is somewhere in a place": (LANDED + lifting("uav2", "near0"), "", BETWEEN - 600, BETWEEN + 300),
    "through a band, which takes longer than the way up": (
        going("MOVE_HOST_TO far0 VIA high0"), ", climbs at 2 m/s to 5 m/s",
        FAR - 900, HIGH + DOWN + 620 / 2 * 10,
    ),
    "through two bands, which takes less than the way up and down": (
        going("MOVE_HOST_TO far0 VIA high0, low0"), ", climbs at 0.5 m/s to 0.6 m/s",
        (380 + 480) / 0.6 * 20, HIGH + DOWN + (620 + 690) / 0.5 * 10,
    ),
}  # fmt: skip


@pytest.mark.parametrize(("text", "more", "least", "most"), FLIGHTS.values(), ids=FLIGHTS)
def test_a_flight_takes_the_shortest_way_at_most_speed_to_the_longest_at_least_speed(text, more, least, most):
    found = flights(text, f"UAV {SPEEDS}{more}")[-1]
    assert (found.lo, found.hi) == (floor(least / 20), ceil(most / 10))


def test_of_several_that_fly_by_one_request_the_slowest_counts():
    text = f"{BOTH}{going('both(uav0)')}"
    (far,), (near,), (both,) = (set(flights(text, f"{each} {SPEEDS}")) for each in ("uav0", "uav1", "UAV"))
    assert far == Interval(both.lo)
    assert near == Interval(floor((metres("uav1", "near") - 300) / 20))
    assert both == Interval(floor((NEAR - 300) / 20), ceil(NEAR / 10))


def test_a_flight_need_not_end_while_its_destination_is_in_transit_or_has_no_room():
    for control in ("MOVE_HOST_TO ship0", "MOVE_HOST_TO near0 VIA ship0"):
        assert None in {each.hi for each in flights(going(control) + SAILS, f"UAV {SPEEDS}")}
    sailing = Interval(floor((FAR - 300) / 20))  # it may be there already
    assert sailing in flights(going("MOVE_HOST_TO ship0") + SAILS, f"UAV {SPEEDS}")
    full = "BigActor d hosted_at uav1 with_behavior { control(MOVE_HOST_TO near0) }"
    ends = {each.hi is None for each in of_flights(f"{ALONE}{going('alone(uav0)')}{full}", f"UAV {SPEEDS}")}
    assert ends == {False, True}


def test_what_is_not_said_is_not_assumed_of_a_flight():
    (up,) = set(flights(going("MOVE_HOST_TO far0 VIA high0"), f"UAV {SPEEDS}"))
    assert up == Interval(floor((FAR - 900) / 20))
    assert set(flights(going("MOVE_HOST_TO near0"), "agents react within 1 s")) == {ANY_TIME}


PUTS = """
BigActor b hosted_at buoy0 with_behavior {
  control(PUT pad1 IN far0) observe(PARENT(pad1)) react { case there: Observation => send("go", a) }
}
"""
UNKNOWN = {
    "to what drifts within a place": (going("MOVE_HOST_TO buoy0") + DRIFTS, 1),
    "to what is aboard of it": (going("MOVE_HOST_TO pad1") + DRIFTS, 1),
    "to what it has put down": (PUTS + lifting("uav0", "pad1") + DRIFTS, 1),
    "to what another has put down aboard of it": (
        PUTS.replace("buoy0", "tug0").replace("pad1", "raft0") + lifting("uav0", "raft0") + DRIFTS,
        1,
    ),
    "from aboard of what drifts": (lifting("uav3", "near0") + DRIFTS[:-1] + 'says "go" to a }', 1),
    "by way of what vanishes": (going("MOVE_HOST_TO near0 VIA high0") + "environment { high0 vanishes }", 2),
}


@pytest.mark.parametrize(("text", "different"), UNKNOWN.values(), ids=UNKNOWN)
def test_of_a_flight_nothing_is_known_while_it_is_unknown_where_it_leads_from_or_to(text, different):
    found = of_flights(text, f"UAV {SPEEDS}")
    assert ANY_TIME in found
    assert len(found) == different


def test_a_flight_has_another_aim_when_a_place_on_it_has_another_shape_around_one_middle():
    for control in ("MOVE_HOST_TO near0", "MOVE_HOST_TO far0 VIA near0"):
        drifts = "near0 drifts among circle (37.02, -8.7) radius 200 m"
        assert len(of_flights(f"{going(control)}environment {{ {drifts} }}", f"UAV {SPEEDS}", aim)) == 2


PROMISES = {
    "nothing": ("", "sense within 5 s", True),
    "that it arrives": ("environment { uav0 arrives }", "sense within 5 s", False),
    "that another arrives": ("environment { uav1 arrives }", "sense within 5 s", True),
    "how fast it flies": ("", f"uav0 {SPEEDS}", False),
    "how fast another flies": ("", f"uav1 {SPEEDS}", True),
}


@pytest.mark.parametrize(("event", "line", "unfair"), PROMISES.values(), ids=PROMISES)
def test_only_the_end_of_a_flight_of_which_nothing_is_promised_is_unfair(event, line, unfair):
    c = load(f"{going('MOVE_HOST_TO near0')}{event}\ntiming {{ {line} }}\n", WORLD).initial
    steps = [(each, step) for each in explore(c).configurations for step in expand(each).by_agents]
    assert [is_unfair(*each) for each in steps] == [
        each[1].label.rule == "commit" and unfair for each in steps
    ]
    assert len(steps) == 3


def test_the_end_of_a_flight_of_several_is_promised_only_if_all_arrive():
    for events, unfair in (("uav0 arrives", True), ("uav0 arrives uav1 arrives", False)):
        c = load(f"{BOTH}{going('both(uav0)')}environment {{ {events} }}", WORLD).initial
        ends = [(each, step) for each in explore(c).configurations for step in expand(each).by_agents]
        assert is_unfair(*ends[-1]) is unfair
