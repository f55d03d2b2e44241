"""The section `timing` in live runs: what takes longer than it says, or is over sooner, breaks an assumption."""

from dataclasses import replace

import pytest
from audited import SHUTTLE, copter, flown_in
from live_missions import BETWEEN, EAST, TOUR, WEST, Run, boat, flying, known_of, mission, plan_of, seen

from adapters.live.batch import Heard, Saying
from adapters.live.core import resumed
from adapters.live.due_times import DueTimes
from adapters.live.overrides import Overrides
from adapters.live.timing_monitor import OWN
from adapters.live.timing_monitor import flying as flights
from adapters.plugin import Gone, LinkLost, LinkRestored
from adapters.recording.writing import Recorder
from bigactors.mission_lookup import digest_of
from bigactors.recordings import resume
from bigactors.vehicle_lines import vehicle_line
from semantics.live_policy import Fallback, LivePolicy
from semantics.timing.actor_clocks import Sort

FLIGHT = """
BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO east0) }
scheduler fcfs
control timed
timing {
  uav0 flies at 18 m/s to 25 m/s
  uav0 lasts 10 min, restored in west0
  agents react within 1 s
}
"""
FLIES = "uav0 flies at 18 m/s to 25 m/s (line 21)"


def airborne(text=FLIGHT, **more):
    run = flying(TOUR + text, **more)
    run.turn(0.1, seen("uav0", WEST, 0.1))
    assert run.rules == ["req_ctr", "command"]
    return run


def broken(run):
    return run.messages("broken assumption")


def test_a_flight_has_its_interval_while_it_is_under_way():
    run = airborne()
    (flight,) = flights(run.state.due.timers)
    assert (flight.vehicle, flight.destination, flight.since) == ("uav0", "east0", 0.0)
    assert (flight.least, flight.most) == (71.0, 255.0)
    said = vehicle_line("uav0", run.state, None, 30.0)
    assert said == "uav0 is on its way to east0, 2.7 km away, for 30 s, 41 s to 3:45 to go"


@pytest.mark.parametrize(("now", "soon"), [(20.0, True), (100.0, False)])
def test_a_flight_that_is_over_before_it_can_be_breaks_its_assumption(now, soon):
    run = airborne()
    run.turn(now, seen("uav0", EAST, now))
    assert run.rules[-1] == "commit"
    told = f"the flight of uav0 to east0 is over after 20 s, sooner than 71 s; the mission says: {FLIES}"
    assert broken(run) == [told] * soon


def test_a_flight_that_takes_too_long_breaks_its_assumption_at_once_and_only_once():
    run = airborne(precautions=LivePolicy(on_broken=Fallback.RETURN))
    run.turn(200.0, seen("uav0", BETWEEN, 200.0))
    assert run.again is not None
    assert 255.0 < run.again < 256.0
    assert broken(run) == []
    for now in (256.0, 257.0):
        run.turn(now, seen("uav0", BETWEEN, now))
    assert broken(run) == [f"the flight of uav0 to east0 takes longer than 4:15; the mission says: {FLIES}"]
    assert type(run.commands[-1]).__name__ == "Return"


def test_a_vehicle_that_is_aloft_for_longer_than_it_lasts_breaks_its_assumption():
    run = airborne()
    run.turn(100.0, seen("uav0", EAST, 100.0))
    run.turn(599.0, seen("uav0", EAST, 599.0))
    assert broken(run) == []
    run.turn(601.0, seen("uav0", EAST, 601.0))
    assert broken(run) == [
        "uav0 goes unrestored for longer than 10 min; the mission says: uav0 lasts 10 min, restored in west0 (line 22)"
    ]


def test_a_drift_that_comes_too_soon_breaks_its_assumption():
    drifts = "boat0 drifts among point (37.01, -8.65), point (37.01, -8.61)"
    run = watched(drifts, "boat0 drifts at most every 20 min")
    run.turn(0.0, boat(WEST, 0.0))
    run.turn(10.0, boat(EAST, 10.0))
    assert broken(run) == [
        "boat0 drifts again after 10 s; the mission says: boat0 drifts at most every 20 min (line 21)"
    ]


def watched(environment, timing):
    """A run in which nobody flies, and the environment is held to its times."""
    return Run(
        plan_of(
            TOUR
            + f"""
BigActor a hosted_at gcs0 with_behavior {{ react {{ case "go" => }} }}
scheduler fcfs
control timed
environment {{ {environment}  someone says "go" to a }}
timing {{ {timing} }}
"""
        )
    )


VANISHES = ("boat0 vanishes", "boat0 vanishes after 10 s, within 60 s")


@pytest.mark.parametrize(
    ("gone", "said"),
    [
        (5.0, ["boat0 vanishes 5 s after the start"]),
        (30.0, []),
        (90.0, ["boat0 vanishes later than 1 min after the start"]),
    ],
)
def test_what_vanishes_is_held_to_its_window(gone, said):
    run = watched(*VANISHES)
    run.turn(0.0, boat(BETWEEN, 0.0))
    for now in sorted({gone, 61.0, 95.0, 96.0}):
        run.turn(now, *([Heard("ais", Gone("boat0", now, "ais"))] if now == gone else []))
    because = "the mission says: boat0 vanishes after 10 s, within 60 s (line 21)"
    assert broken(run) == [f"{each}; {because}" for each in said]


def test_what_appeared_in_its_window_may_appear_again_at_any_time():
    run = watched(
        "boat0 vanishes  boat0 appears at point (37.03, -8.63)", "boat0 appears after 0 s, within 60 s"
    )
    for now in (0.0, 40.0, 80.0):
        run.turn(now, boat(BETWEEN, now))
        run.turn(now + 20.0, Heard("ais", Gone("boat0", now + 20.0, "ais")))
    assert run.rules == ["env"] * 5
    assert broken(run) == []


def test_a_channel_drops_at_most_every_so_often_and_returns_in_time():
    run = watched(
        "control:gcs0 drops and returns", "control:gcs0 drops at most every 10 min, returns within 60 s"
    )
    lost, back = [LinkLost("uav0", 0.0, 0.0)], [LinkRestored("uav0", 0.0)]
    run.turn(0.0, seen("uav0", WEST, 0.0))
    run.turn(5.0, reports=lost)
    run.turn(30.0, seen("uav0", WEST, 30.0), reports=back)
    assert run.labels == ["⟨env : control:gcs0 drops⟩", "⟨env : control:gcs0 returns⟩"]
    assert broken(run) == []
    run.turn(100.0, reports=lost)
    because = "the mission says: control:gcs0 drops at most every 10 min, returns within 60 s (line 21)"
    assert broken(run) == [f"control:gcs0 drops again after 95 s; {because}"]
    run.turn(161.0)
    assert broken(run)[1:] == [f"⟨env : control:gcs0 returns⟩ takes longer than 1 min; {because}"]


def test_what_is_said_is_held_to_its_times():
    run = watched("", 'someone says "go" to a after 10 s, until 20 s')
    run.turn(0.0, boat(BETWEEN, 0.0))
    run.turn(5.0, sayings=[Saying("a", "go")])
    said = 'someone says "go" to a'
    because = f"the mission says: {said} after 10 s, until 20 s (line 21)"
    assert broken(run) == [f"{said} 5 s after the start; {because}"]


def test_time_without_listening_does_not_count():
    run = airborne()
    run.turn(300.0, seen("uav0", BETWEEN, 300.0), missed=100.0)
    assert broken(run) == []


def test_a_mission_without_times_keeps_no_timers():
    run = Run(plan_of(TOUR + "BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO east0) }"))
    run.turn(0.0, seen("uav0", WEST, 0.0))
    assert run.state.due.timers is None


# --- a run that goes on after it was killed

GOING_ON = (
    TOUR
    + """
BigActor a hosted_at uav0 with_behavior {
  observe(CHILDREN(east0))
  react { case obs => control(MOVE_HOST_TO east0) }
  observe(CHILDREN(east0))
  react { case obs => }
  react { case "go" => after 20 s => }
}
scheduler fcfs
control timed
environment {
  boat0 drifts among point (37.01, -8.65), point (37.01, -8.61)
  boat0 vanishes
}
timing {
  uav0 flies at 18 m/s to 25 m/s
  uav0 lasts 10 min, restored in west0
  agents react within 1 s
  sense within 5 s
  boat0 drifts at most every 20 min
  boat0 vanishes after 10 s, within 30 min
}
"""
)


OPEN = []


@pytest.fixture(autouse=True)
def closed():
    yield
    while OPEN:
        OPEN.pop().recorder.close("the test is over", 0.0)


class Recorded(Run):
    """A live run with its recording, which may be left at any moment."""

    def __init__(self, path, text=GOING_ON, before=None):
        super().__init__(plan_of(text))
        self.path, self.mission = path, mission(text)
        header = {"mission": "tour.mission", "text": text, "digest": digest_of(self.mission), "version": "0"}
        self.recorder = Recorder(path, header, 0.0)
        OPEN.append(self)
        if before is not None:
            self.recorder.copy(before.messages)
            known = known_of(self.state, due=DueTimes(timers=before.timers, stopped=before.until))
            killed = replace(known, configuration=before.configuration, number=before.steps)
            self.state = resumed(self.plan, killed, before.until)

    def turn(self, now, *heard, **more):
        turn = super().turn(now, *heard, **more)
        self.recorder.turn(turn, now, lambda _: ())
        return turn

    def lives(self, turns):
        for now, heard, more in turns:
            self.turn(now, *heard, **more)

    def killed(self):
        """What its recording says, which has no end."""
        return resume(str(self.path), self.mission)

    def goes_on(self, path):
        return Recorded(path, before=self.killed())


TURNS = [
    (0.0, [seen("uav0", WEST, 0.0), boat(WEST, 0.0)], {}),
    (0.5, [], {}),
    (40.0, [], {"missed": 30.0}),
    (41.0, [seen("uav0", BETWEEN, 41.0)], {}),
    (100.0, [seen("uav0", BETWEEN, 100.0)], {}),
    (150.0, [seen("uav0", EAST, 150.0)], {}),
    (151.0, [Heard("ais", Gone("boat0", 151.0, "ais"))], {}),
    (175.0, [], {}),
]


def clocks(timers):
    return timers.since, timers.windows, timers.began, timers.rested


def test_the_clocks_of_a_recording_are_those_of_its_run_after_every_turn(tmp_path):
    run = Recorded(tmp_path / "run.mcap")
    sorts = set()
    for now, heard, more in TURNS:
        run.turn(now, *heard, **more)
        assert clocks(run.killed().timers) == clocks(run.state.due.timers)
        sorts |= {clock.sort for clock in run.state.due.timers.since}
    assert run.rules.count("commit") == 1
    assert sorts >= {Sort.MISSION, Sort.EVERY, Sort.ALOFT, Sort.AFTER, Sort.FLIGHT, Sort.AIM}


@pytest.mark.parametrize("left", range(1, len(TURNS)))
def test_a_run_that_goes_on_at_once_has_the_clocks_of_one_that_was_never_killed(tmp_path, left):
    whole, run = Recorded(tmp_path / "whole.mcap"), Recorded(tmp_path / "first.mcap")
    for each in (whole, run):
        each.lives(TURNS[:left])
    run = run.goes_on(tmp_path / "second.mcap")
    run.turn(TURNS[left - 1][0])
    for each in (whole, run):
        each.lives(TURNS[left:])
    agree = [clock for clock in whole.state.due.timers.since if clock.sort is not Sort.AFTER]
    assert agree
    assert [run.state.due.timers.since[each] for each in agree] == [
        whole.state.due.timers.since[each] for each in agree
    ]
    assert broken(run) == broken(whole)[len(broken(whole)) - len(broken(run)) :]


def test_a_flight_goes_on_while_the_run_does_not_and_is_held_to_its_whole_time(tmp_path):
    run = Recorded(tmp_path / "first.mcap")
    run.lives(TURNS[:2])
    (before,) = flights(run.state.due.timers)
    again = run.goes_on(tmp_path / "second.mcap")
    again.turn(200.0, seen("uav0", BETWEEN, 200.0))
    assert list(flights(again.state.due.timers)) == [before]
    assert broken(again) == []
    again.turn(256.0, seen("uav0", BETWEEN, 256.0))
    assert [each[:46] for each in broken(again)] == ["the flight of uav0 to east0 takes longer than "]
    third = again.goes_on(tmp_path / "third.mcap")
    third.turn(601.0, seen("uav0", BETWEEN, 601.0))
    assert "uav0 goes unrestored for longer than 10 min" in broken(third)[-1]


def test_what_a_run_does_itself_stands_still_while_it_does(tmp_path):
    run = Recorded(tmp_path / "first.mcap")
    run.state = replace(run.state, overrides=Overrides(suspended=True))  # controls wait
    run.turn(0.0, seen("uav0", WEST, 0.0), boat(WEST, 0.0))
    run.turn(0.5)
    assert {clock.sort for clock in run.state.due.timers.since} & OWN == {Sort.REQUEST}
    again = run.goes_on(tmp_path / "second.mcap")
    again.turn(100.5)
    assert again.state.due.timers.rested == 100.5  # nothing was recorded after the first turn
    assert broken(again) == []
    assert clocks(again.killed().timers) == clocks(again.state.due.timers)


def test_who_waits_for_some_time_waits_anew(tmp_path):
    run = Recorded(tmp_path / "first.mcap")
    run.lives(TURNS[:-1])
    (waits,) = (clock for clock in run.state.due.timers.since if clock.sort is Sort.AFTER)
    assert run.state.due.timers.since[waits][0] < 151.0
    again = run.goes_on(tmp_path / "second.mcap")
    again.turn(300.0, seen("uav0", EAST, 300.0))
    assert again.state.due.timers.since[waits] == (300.0,)
    again.turn(320.5, seen("uav0", EAST, 320.5))
    assert again.rules[-1] == "timeout"
    assert not any("timeout" in each for each in broken(again))


def test_a_recording_that_does_not_say_when_its_mission_began_has_no_clocks(tmp_path):
    run = Recorded(tmp_path / "first.mcap")
    run.lives(TURNS[:3])
    old = Recorded(tmp_path / "old.mcap")
    old.recorder.copy(each for each in run.killed().messages if each.topic != "clocks")
    before = old.killed()
    assert (before.steps, before.timers) == (len(run.steps), None)
    again = Recorded(tmp_path / "second.mcap", before=before)
    again.turn(100.0, seen("uav0", BETWEEN, 100.0))
    (flight,) = flights(again.state.due.timers)
    assert flight.since == again.state.due.timers.began == 100.0


# --- flown

FLOWN = (
    SHUTTLE[: SHUTTLE.index("BigActor")]
    + """
BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO east0) }
scheduler fcfs
control timed
environment { uav0 arrives }
timing {
  tick 10 s
  uav0 flies at 8 m/s to 12 m/s
}
live { on broken assumption: return }
check { time "there": actually uav0 in east0 }
"""
)


@pytest.mark.long
@pytest.mark.parametrize("slowed", [1.0, 0.3])
def test_a_vehicle_that_is_slowed_breaks_the_assumption_about_its_flight(tmp_path, monkeypatch, slowed):
    monkeypatch.chdir(tmp_path)
    vehicle = copter()
    vehicle.slowed = slowed
    flown = flown_in(tmp_path, FLOWN, vehicle, seconds=1500)
    assert flown.ended == (slowed == 1.0)
    assert flown.broken == (slowed < 1.0)
    line = 1 + FLOWN[: FLOWN.index("uav0 flies")].count("\n")
    told = f"the mission says: uav0 flies at 8 m/s to 12 m/s (line {line})"
    assert flown.witness.told() == (
        ""
        if flown.ended
        else f"the flight of uav0 to east0 takes longer than 9:40; {told}\nuav0 returns, as the mission ordered"
    )
    assert flown.inside("east0" if flown.ended else "west0")
