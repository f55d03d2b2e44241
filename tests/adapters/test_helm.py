"""Who has the helm: what a vehicle shows beside what it was told, without a vehicle."""

from dataclasses import replace

import pytest
from packets import beat
from worlds import AREA

from adapters.mavlink import pilot
from adapters.mavlink.message import say
from adapters.mavlink.pilot import Pilot
from adapters.mavlink.profiles import COPTER, PLANE, ROVER
from adapters.mavlink.takeover import STRANGE, Helm, given_back, modes_of, watch
from adapters.mavlink.telemetry import Telemetry, VehiclePosition
from adapters.mavlink.vehicle_identities import Craft, Stations
from adapters.plugin import (
    Accepted,
    Doubted,
    Follow,
    GiveBack,
    GoTo,
    HandOver,
    Hold,
    Rejected,
    Return,
    TakenOver,
)
from physical import point

THERE = GoTo("r1", "uav0", AREA)
RTL, GUIDED, AUTO, LOITER = PLANE.home, PLANE.guided, PLANE.auto, PLANE.hold


def shows(mode, beat, armed=True, **more):
    return Telemetry(heard=beat, beat=beat, profile=PLANE, mode=mode, armed=armed, active=armed, **more)


def watched(*shown, command=THERE, helm=None):
    """The helm after heartbeats, one a second: modes, or modes with whether it is armed."""
    helm = helm or Helm()
    for second, each in enumerate(shown):
        known = each if isinstance(each, Telemetry) else shows(each, float(second))
        helm = watch(helm, known, PLANE, command)
    return helm


@pytest.mark.parametrize(
    ("command", "plane", "copter", "rover"),
    [
        (THERE, {GUIDED, AUTO}, {COPTER.guided}, {ROVER.guided}),
        (Follow("r1", "uav0", (AREA,)), {AUTO}, {COPTER.guided, COPTER.auto}, {ROVER.auto}),
        (Hold("r1", "uav0"), {LOITER}, {COPTER.hold}, {ROVER.hold}),
        (Return("r1", "uav0"), {RTL}, {COPTER.home}, {ROVER.home}),
        (HandOver("r1", "uav0", "control:gcs0", "control:gcs1"), set(), set(), set()),
    ],
)
def test_each_command_has_its_modes(command, plane, copter, rover):
    assert [set(modes_of(command, profile)) for profile in (PLANE, COPTER, ROVER)] == [plane, copter, rover]


def test_a_mode_that_nobody_ordered_counts_once_heartbeats_have_shown_it_for_a_while():
    assert watched(GUIDED, GUIDED).held
    doubted = watched(GUIDED, RTL, RTL, RTL, RTL)
    assert (doubted.held, doubted.taken) == (False, "")
    assert (
        watched(GUIDED, RTL, RTL, RTL, RTL, RTL).taken
        == "it is in RTL, by itself or by a command from elsewhere"
    )
    late = watched(GUIDED, RTL, shows(RTL, 2 * STRANGE))
    assert late.taken


def test_one_heartbeat_that_comes_late_takes_nothing_over():
    helm = watched(GUIDED, LOITER, command=THERE)
    silent = watch(helm, shows(LOITER, 1.0), PLANE, THERE)  # nothing more is heard
    assert (silent.held, silent.taken) == (False, "")
    assert watch(silent, shows(GUIDED, 30.0), PLANE, THERE).held


def test_the_mode_before_counts_as_ordered_until_the_new_one_is_there():
    held = watched(LOITER, LOITER, command=Hold("r1", "uav0"), helm=given_back(shows(LOITER, 0.0)))
    going = watched(LOITER, GUIDED, GUIDED, helm=held)
    assert (going.held, going.modes) == (True, {GUIDED, AUTO})
    assert watched(*[LOITER] * 6, helm=going).taken


def test_a_vehicle_found_flying_is_taken_over_unless_it_is_in_a_mode_for_stations():
    assert watched(*[RTL] * 6, command=None).taken
    assert watched(*[RTL] * 6).taken
    for mode in (GUIDED, AUTO):
        assert watched(*[mode] * 6, command=None) == Helm()


def test_what_is_not_armed_may_be_handled_by_anybody():
    assert watched(*[shows(mode, float(mode), armed=False) for mode in (0, 2, 5, RTL, 0)]).held


def test_who_is_disarmed_is_taken_over_and_who_boots_so_is_said_to():
    down = [shows(GUIDED, second, armed=False) for second in (2.0, 6.0)]
    assert watched(GUIDED, GUIDED, *down).taken == "it was disarmed, and is not armed again"
    booted = [replace(known, boots=1, mode=0) for known in down]
    assert (
        watched(GUIDED, GUIDED, *booted).taken == "it has booted anew and is disarmed, and is not armed again"
    )


def test_a_reboot_that_leaves_it_flying_as_it_was_takes_nothing_over():
    assert watched(GUIDED, shows(GUIDED, 9.0, boots=1)) == Helm(frozenset({GUIDED, AUTO}), True, 1)


def test_who_has_landed_after_it_was_told_to_return_may_be_handled_by_anybody():
    home = Return("r1", "uav0")
    landed = watched(GUIDED, RTL, shows(RTL, 9.0, armed=False), shows(0, 10.0, armed=False), command=home)
    assert landed == Helm()


def test_what_was_taken_over_stays_so_until_it_is_given_back_in_whatever_mode_it_is():
    taken = watched(GUIDED, *[RTL] * 6)
    assert watch(taken, shows(GUIDED, 20.0), PLANE, THERE).taken
    assert watched(RTL, RTL, GUIDED, helm=given_back(shows(RTL, 20.0))).held


# --- with a pilot ---------------------------------------------------------------------------------------

AT = VehiclePosition(37.0, -8.6, 120.0, 100.0, 20.0, 0.0, 0.0, 0.0)
TO = (37.01, -8.6175)
STATIONS = Stations({"gcs0": 255, "gcs1": 254}, ("gcs0",))


class Flown:
    """A pilot, and what its vehicle says each second."""

    def __init__(self, mode=GUIDED, command=THERE, **known):
        ready = {"position": AT, "healthy": True, "authority": 255, "target": TO, "current": 2}
        self.pilot = Pilot(Craft("uav0"), STATIONS, 1, known=shows(mode, 0.0, **{**ready, **known}))
        self.now, self.sent, self.reports, self.published = 0.0, [], [], []
        if command is not None:
            self.pilot = pilot.command(self.pilot, command, 0.0).pilot

    def goes_on(self, mode, seconds, armed=True):
        said = beat(mode=1 | 128 * armed, custom=mode, status=4)
        for _ in range(seconds):
            self.now += 1.0
            self.take(pilot.hear(self.pilot, replace(said, system=1, component=1), self.now))
            moved = replace(self.pilot.known.position, time=self.now)
            self.pilot = replace(self.pilot, known=replace(self.pilot.known, position=moved))
            self.take(pilot.tick(self.pilot, self.now))
        return self

    def take(self, outcome):
        self.pilot = outcome.pilot
        self.sent += [
            each for each in outcome.sent if each.name.startswith("COMMAND") and each["command"] < 500
        ]
        self.reports += outcome.reports
        self.published += outcome.published

    def of(self, kind):
        return [report for report in self.reports if isinstance(report, kind)]


def test_while_it_is_not_certain_who_has_the_helm_it_is_doubted_and_told_nothing():
    flown = Flown().goes_on(GUIDED, 3).goes_on(RTL, 4)
    assert [type(report) for report in flown.reports] == [Accepted, Doubted]
    assert flown.sent == []
    flown.goes_on(RTL, 1)
    assert [report.entity for report in flown.of(TakenOver)] == ["uav0"]
    assert [report.request for report in flown.of(Rejected)] == ["r1"]


def test_what_was_doubted_for_one_late_heartbeat_is_accepted_again():
    flown = Flown().goes_on(GUIDED, 3).goes_on(LOITER, 1).goes_on(GUIDED, 9)
    assert [type(report) for report in flown.reports] == [Accepted, Doubted, Accepted]


def test_what_is_told_while_it_is_doubted_makes_nothing_of_it_ordered():
    flown = Flown().goes_on(GUIDED, 3).goes_on(RTL, 1)
    flown.take(pilot.command(flown.pilot, Return("r2", "uav0"), flown.now))
    assert flown.goes_on(RTL, 5).sent == []
    assert len(flown.of(TakenOver)) == 1
    assert [report.request for report in flown.of(Rejected)] == ["r2"]


def test_a_vehicle_that_has_arrived_is_taken_over_too():
    flown = Flown(position=replace(AT, latitude=TO[0], longitude=TO[1])).goes_on(GUIDED, 3)
    assert flown.pilot.moving.over
    flown.goes_on(RTL, 6)
    assert flown.of(Rejected) == []
    assert len(flown.of(TakenOver)) == 1


def test_a_vehicle_that_someone_else_sends_elsewhere_is_taken_over():
    flown = Flown().goes_on(GUIDED, 3)
    elsewhere = replace(flown.pilot.known, target=(37.1, -8.6))
    flown.pilot = replace(flown.pilot, known=elsewhere)
    (report,) = flown.goes_on(GUIDED, 6).of(TakenOver)
    assert report.reason == "it has left its task: it would need the command to go there"


def test_a_command_that_meets_a_fail_safe_is_not_told():
    flown = Flown(target=(37.2, -8.6)).goes_on(GUIDED, 1)
    assert [each["param2"] for each in flown.sent] == [0.0]  # it stays in guided mode, or refuses
    flown.sent.clear()
    flown.goes_on(RTL, 20)
    assert flown.sent == []


def test_a_vehicle_of_another_station_is_in_the_mode_that_that_one_ordered():
    flown = Flown(authority=254, command=None).goes_on(RTL, 10)
    assert flown.of(TakenOver) == []
    assert flown.published
    handed = replace(flown.pilot, known=replace(flown.pilot.known, authority=255))
    flown.pilot = handed
    assert len(flown.goes_on(RTL, 10).of(TakenOver)) == 1


def test_what_is_given_back_is_told_the_next_command_though_it_is_in_another_mode():
    flown = Flown().goes_on(GUIDED, 3).goes_on(RTL, 6)
    flown.take(pilot.command(flown.pilot, GiveBack("r2", "uav0"), flown.now))
    assert flown.goes_on(RTL, 3).sent == []
    flown.take(pilot.command(flown.pilot, GoTo("r3", "uav0", point(37.1, -8.6)), flown.now))
    flown.goes_on(RTL, 3)
    assert {each["param2"] for each in flown.sent} == {1.0}
    assert flown.goes_on(GUIDED, 6).pilot.helm.held


def test_the_last_words_of_a_vehicle_stand_before_why_it_was_taken_over():
    flown = Flown().goes_on(GUIDED, 2)
    texts = ("EKF3 IMU0 is using GPS", 6), ("Battery 1 is low 29.90V used 12 mAh", 4)
    for text, severity in texts:
        said = say("STATUSTEXT", severity=severity, text=text)
        flown.take(pilot.hear(flown.pilot, replace(said, system=1, component=1), flown.now))
    (report,) = flown.goes_on(RTL, 6).of(TakenOver)
    assert report.reason == (
        "it said 'Battery 1 is low 29.90V used 12 mAh'; it is in RTL, by itself or by a command from elsewhere"
    )


@pytest.mark.parametrize("stop", [Hold, Return])
def test_a_vehicle_that_is_stopped_is_not_handed_over_any_more(stop):
    flown = Flown(command=None).goes_on(GUIDED, 3)
    told = lambda: {message.name for message in pilot.tick(flown.pilot, flown.now + 2.0).sent}  # noqa: E731
    flown.take(pilot.command(flown.pilot, HandOver("r2", "uav0", "control:gcs0", "control:gcs1"), flown.now))
    assert "PARAM_SET" in told()
    flown.take(pilot.command(flown.pilot, stop("r3", "uav0"), flown.now))
    assert "PARAM_SET" not in told()
    assert "COMMAND_LONG" in told()


@pytest.mark.parametrize("stop", [Hold, Return])
def test_an_order_that_another_station_makes_impossible_ends_what_went_before_and_may_be_given_again(stop):
    flown = Flown(target=(37.2, -8.6)).goes_on(GUIDED, 2)
    flown.pilot = replace(flown.pilot, known=replace(flown.pilot.known, authority=252))
    flown.take(pilot.command(flown.pilot, stop("r2", "uav0"), flown.now))
    (no,) = flown.of(Rejected)
    assert (no.request, no.reason) == ("r2", "it obeys system 252, not gcs0")
    flown.pilot = replace(flown.pilot, known=replace(flown.pilot.known, authority=255))
    flown.sent.clear()
    assert flown.goes_on(GUIDED, 8).sent == []  # it is not sent on to where it was to go before
    flown.take(pilot.command(flown.pilot, stop("r2", "uav0"), flown.now))
    assert {each["command"] for each in flown.goes_on(GUIDED, 2).sent} == {176}
