"""Vehicles that do what nobody here ordered: nothing of it is an arrival, and nobody here overrules it."""

import asyncio
from dataclasses import replace
from functools import partial
from pathlib import Path

import pytest
from audited import flown_in
from live_missions import BETWEEN, EAST, LIVE, TOUR, WEST, Run, flying, plan_of, seen
from worlds import ROUND

from adapters.live.batch import GivingBack
from adapters.live.operator_socket import give_back
from adapters.mavlink.command import long
from adapters.mavlink.constants import Cmd, Result
from adapters.plugin import Rejected, TakenOver
from adapters.simulated import Kind, Vehicle, protocol
from adapters.simulated.reporting import Reporter
from bigactors.cli import main
from bigactors.mission_lookup import open_mission
from bigactors.recordings import open_recording, resume
from semantics.live_policy import Fallback, LivePolicy

GO = "BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO east0) }"


def test_a_vehicle_that_was_taken_over_has_not_arrived_though_the_same_news_show_it_there():
    run = flying(TOUR + GO)
    run.turn(1.0, seen("uav0", BETWEEN, 1.0))
    run.turn(2.0, seen("uav0", EAST, 2.0), reports=[TakenOver("uav0", 2.0, "it is in RTL")])
    assert "commit" not in run.rules
    assert run.messages() == [
        "uav0 was taken over: it is in RTL; it gets no commands until `bigactors give-back uav0`"
    ]
    run.turn(3.0, reports=[Rejected("a-1", "uav0", 3.0, "it is in RTL")])
    assert run.kinds() == ["taken over"]


@pytest.mark.parametrize("fallback", [Fallback.HOLD, Fallback.RETURN])
def test_what_the_mission_falls_back_on_does_not_overrule_who_has_taken_a_vehicle_over(fallback):
    run = flying(TOUR, LivePolicy(fallback))
    run.turn(1.0, seen("uav0", BETWEEN, 1.0), reports=[TakenOver("uav0", 1.0, "it is in RTL")])
    assert run.kinds() == ["taken over", "broken assumption", "taken over"]
    assert run.commands == []


def test_nothing_is_told_to_a_vehicle_that_was_taken_over_before_it_is_given_back():
    run = Run(plan_of(TOUR + GO))
    run.turn(0.0, reports=[TakenOver("uav0", 0.0, "it is in RTL")])
    run.turn(1.0, seen("uav0", WEST, 1.0))
    assert run.commands == []
    run.turn(2.0, sayings=[GivingBack("uav0")])
    assert (run.told, run.refusals, run.state.overrides.taken) == (["GiveBack", "GoTo"], [""], {})
    run.turn(3.0, sayings=[GivingBack("uav0"), GivingBack("uav9")])
    assert run.refusals[1:] == [
        "uav0 was not taken over here, and has refused nothing",
        "there is no vehicle 'uav9'; there are uav0",
    ]


def test_a_vehicle_that_is_given_back_is_told_anew_what_it_was_to_do():
    run = flying(TOUR + GO)
    for number, report in enumerate((TakenOver("uav0", 1.0, "x"), Rejected("a-3", "uav0", 2.0, "denied")), 1):
        run.turn(float(number), reports=[report])
        run.turn(number + 0.5, sayings=[GivingBack("uav0")])
    requests = [command.request for command in run.commands]
    assert requests == ["a-1", "give-back-2", "a-3", "give-back-4", "a-5"]
    run.turn(3.0, seen("uav0", EAST, 3.0))
    assert "commit" in run.rules


# --- flown ---


@pytest.fixture
def flight(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return partial(flown_in, tmp_path, ROUND)


def plane(**more):
    return Vehicle(Kind.PLANE, (37.0, -8.6, 20.0), **more)


async def leg(witness, number):
    """Wait until the vehicle is on its way from the place of its so-many-th commit."""
    while witness.rules.count("commit") < number:
        await asyncio.sleep(0.5)
    await asyncio.sleep(5.0)


def low_battery(number):
    async def foe(_flight, _simulator, witness):
        await leg(witness, number)
        witness.vehicle.parameters |= {"BATT_FS_LOW_ACT": 1.0, "BATT_LOW_TIMER": 1.0, "BATT_LOW_VOLT": 30.0}

    return foe


async def other_station(_flight, simulator, witness):
    await leg(witness, 1)
    told = replace(long(Cmd.DO_SET_MODE, 1, 1, 11), system=253)
    assert protocol.hear(witness.vehicle, Reporter(), told, simulator.now())[0]["result"] == Result.ACCEPTED


async def killed_on_the_way_home(_flight, simulator, witness):
    await leg(witness, 3)
    simulator.restart(1)


def resumed_from(recording):
    return resume(recording, open_mission("flown.mission", LIVE))


def home(vehicle):
    return vehicle.mode == vehicle.kind.profile.home


BATTERY = "'Battery 1 is low 12.60V used 0 mAh'"
RTL = "it is in RTL, by itself or by a command from elsewhere"


@pytest.mark.long
@pytest.mark.parametrize(
    ("foe", "legs", "reason"),
    [
        (low_battery(1), 1, f"it said {BATTERY}; {RTL}"),
        (low_battery(3), 3, f"it said {BATTERY}; {RTL}"),
        (other_station, 1, RTL),
    ],
    ids=["over its destination", "to where the mission ends", "by another station"],
)
def test_a_vehicle_that_flies_home_unasked_arrives_nowhere_and_is_not_called_back(flight, foe, legs, reason):
    flown = flight(plane(enforce=False), foe=foe, seconds=600)
    assert flown.witness.rules.count("commit") == legs
    assert not flown.ended
    assert home(flown.vehicle)
    assert flown.inside("home0")
    assert flown.ending.state.overrides.taken == resumed_from("r.mcap").taken == {"uav0": reason}
    assert flown.witness.kinds() == {"taken over"}


@pytest.mark.long
def test_a_vehicle_that_boots_anew_on_the_ground_where_it_was_to_go_has_not_arrived(flight):
    flown = flight(plane(), foe=killed_on_the_way_home, seconds=600)
    assert flown.inside("home0")
    assert flown.witness.rules.count("commit") == 3
    assert not flown.ended
    assert not flown.vehicle.armed
    (reason,) = flown.ending.state.overrides.taken.values()
    assert reason.startswith("it has booted anew and is disarmed")


@pytest.mark.long
def test_a_vehicle_that_an_operator_gives_back_flies_its_mission_to_the_end(flight):
    answers = []

    async def operator(flight, simulator, witness):
        await low_battery(1)(flight, simulator, witness)
        while "taken over" not in witness.kinds():
            await asyncio.sleep(0.5)
        await asyncio.sleep(60.0)
        answers.append((await give_back(Path("s"), "uav1")).refusal)
        answers.append((await give_back(Path("s"), "uav0")).refusal)

    flown = flight(plane(), foe=operator, seconds=1500)
    assert flown.ended
    assert answers == ["there is no vehicle 'uav1'; there are uav0", ""]
    assert flown.ending.state.overrides.taken == resumed_from("r.mcap").taken == {}
    assert flown.witness.kinds() == {"taken over", "given back"}
    recording = open_recording("r.mcap")
    assert [message.data for message in recording.of("given_back")] == [
        {"vehicle": "uav1", "by": "", "refusal": answers[0]},
        {"vehicle": "uav0", "by": "", "refusal": ""},
    ]
    told = [message.data["command"] for message in recording.of("commands")]
    assert told == ["GoTo", "GoTo", "GiveBack", "GoTo", "GoTo", "GoTo"]
    assert main(["replay", "r.mcap"]) == 0
