"""What a live run makes of other stations: parcels, flights that they ordered, agents that moved, what broke there."""

import json
from dataclasses import replace
from pathlib import Path

import jsonschema
import pytest
from live_missions import BETWEEN, EAST, TOUR, WEST, Run, boat, plan_of, seen

from adapters.live.batch import Saying
from adapters.live.plan import Plan
from adapters.plugin import Believes, Broken, Delivered, Hosts, LinkLost, Underway
from adapters.recording.encoding import step_json
from checker import replay
from checker.traces import SCHEMA
from semantics.behaviours.values import Text
from semantics.state.parcel_serialization import parcel_json
from semantics.state.parcels import Parcel
from semantics.state.physical_model import InTransit
from semantics.state.station_partition import Parting, parted, station_of
from semantics.timing.actor_clocks import ActorClock, Sort

TEXT = (
    (
        TOUR
        + """
BigActor op0 hosted_at gcs0 with_behavior { loop { react {
  case "tell" => send "told" to op1
  case "fly" => control(MOVE uav0 TO east0)
  case "bear" => spawn child hosted_at gcs1 with_behavior Childhood() } } }
BigActor op1 hosted_at gcs1 with_behavior { loop { react { case "told" => send ("thanks", 1) to op0
                                                           case "move" => migrate(uav0) } } }
def Childhood() = { skip }
environment { says "tell" to op0 at most 9 times
              says "fly" to op0 at most once
              says "stop" to op1 at most once }
"""
    )
    .replace("linked control:gcs0\n", "linked control:gcs0, internet\n", 1)
    .replace("linked control:gcs1\n", "linked control:gcs1, internet\n", 1)
)
HOSTS = {"gcs0": "gcs0", "gcs1": "gcs1", "uav0": "gcs1"}


def at(station, vehicles=("uav0",), more=""):
    owners = {"uav0": "autopilot" if "uav0" in vehicles else "stations"}
    return Run(
        Plan(parted(plan_of(TEXT + more).first, Parting(station, HOSTS, {}, {})), owners, peers="stations")
    )


def message(number, agent="op1", text="told", station="gcs0"):
    return Delivered(station, 1.0, number, json.loads(json.dumps(parcel_json(Parcel(agent, (Text(text),))))))


TRACES = json.loads((Path(__file__).parents[3] / "docs" / "reference" / "trace.schema.json").read_text())


def replayed(run):
    steps = [{**step_json(step), "changes": []} for step in run.steps]
    data = {
        "schema": SCHEMA,
        "mission": "m",
        "digest": "sha256:" + "0" * 64,
        "monitored": False,
        "steps": steps,
    }
    jsonschema.validate(json.loads(json.dumps(data)), TRACES)
    return replay(run.plan.first, json.loads(json.dumps(data))).configurations[-1]


def test_a_message_leaves_with_the_step_that_sends_it_and_enters_at_the_other_station():
    gcs0, gcs1 = at("gcs0"), at("gcs1")
    turn = gcs0.turn(0.0, sayings=[Saying("op0", "tell")])
    (left,) = turn.parcels
    assert (left.station, left.number, left.parcel) == ("gcs1", 1, Parcel("op1", (Text("told"),)))
    assert gcs0.rules[-2:] == ["snd", "leave"]
    gcs1.turn(0.0, reports=[message(1), message(1)])
    assert gcs1.rules[:2] == ["enter", "rcv_msg"]
    assert gcs1.rules.count("enter") == 1
    assert gcs1.labels[-1] == "⟨leave : op0, gcs0⟩"
    for run in (gcs0, gcs1):
        assert replayed(run) == run.state.configuration


# --- times

TIMED = """
scheduler fcfs
control timed
timing {
  agents react within 2 s
  uav0 lasts 10 min, restored in west0
}
"""


def untimely(run):
    return [
        finding.message.partition(";")[0] for finding in run.findings if "mission says" in finding.message
    ]


@pytest.mark.parametrize(
    ("done", "said"), [(9.5, []), (7.0, ['⟨rcv_msg : op1, react("told")⟩ takes longer than 2 s']), (None, [])]
)
def test_a_reaction_to_a_message_is_timed_from_when_that_left_the_other_station(done, said):
    run = at("gcs1", more=TIMED)
    run.turn(0.0)
    run.turn(10.0, reports=[replace(message(1), done=done)])
    assert run.rules[:2] == ["enter", "rcv_msg"]
    assert untimely(run) == said


@pytest.mark.parametrize(("done", "said"), [(100.0, 1), (300.0, 0)])
def test_a_vehicle_is_aloft_from_when_the_other_station_says_that_it_was_sent(done, said):
    run = at("gcs1", (), TIMED)
    run.turn(0.0, seen("uav0", WEST, 0.0, "stations"))
    run.turn(350.0, reports=[Underway("uav0", 350.0, "east0", done)])
    (since,) = run.state.due.timers.since[ActorClock(Sort.ALOFT, "uav0")]
    assert since == done
    run.turn(800.0, seen("uav0", EAST, 800.0, "stations"), reports=[Underway("uav0", 800.0, "", 700.0)])
    assert run.findings == []  # the station that commands it tells of it
    assert run.steps[-1].date == 700.0
    run.plan = replace(run.plan, vehicles={"uav0": "autopilot"})  # it is handed over to this one
    for now in (801.0, 802.0):
        run.turn(now, seen("uav0", EAST, now, channels=("control:gcs1",)))
    assert len([each for each in untimely(run) if "unrestored for longer" in each]) == said


def test_a_parcel_that_cannot_enter_is_said_once_and_nothing_after_it_enters():
    run = at("gcs1")
    bad = replace(message(1), parcel={"Parcel": "x"})
    run.turn(0.0, reports=[bad, message(2)])
    run.turn(1.0, reports=[bad, message(2)])
    assert run.rules == []
    assert run.messages() == [
        "parcel 1 of gcs0 cannot enter, nor any later one: {'Parcel': 'x'} should be Parcel"
    ]
    stranger = at("gcs1")
    stranger.turn(0.0, reports=[message(1, agent="nobody")])
    assert "there is no bigActor nobody here" in stranger.findings[0].message


def test_what_is_said_to_an_agent_elsewhere_is_said_there():
    run = at("gcs0")
    run.turn(0.0, sayings=[Saying("op1", "stop")])
    assert run.refusals == ["op1 runs at gcs1: send the message there"]
    assert run.steps == []


def test_a_vehicle_that_another_station_sent_is_in_transit_here_until_it_has_come_there():
    run = at("gcs1", vehicles=())
    run.turn(0.0, seen("uav0", WEST, 0.0, "stations"))
    run.turn(1.0, reports=[Underway("uav0", 1.0, "east0")])
    run.turn(2.0, seen("uav0", BETWEEN, 2.0, "stations"))
    assert run.labels == ["⟨env : uav0 is sent to east0⟩"]
    assert isinstance(run.state.configuration.structure.physical.placement("uav0"), InTransit)
    run.turn(3.0, seen("uav0", EAST, 3.0, "stations"), reports=[Underway("uav0", 3.0, "")])
    assert run.labels[1:] == ["⟨env : uav0 is seen in east0⟩"]
    assert run.findings == []
    assert replayed(run) == run.state.configuration


def test_what_is_under_command_here_another_station_does_not_place():
    run = at("gcs0")
    run.turn(0.0, seen("uav0", WEST, 0.0), sayings=[Saying("op0", "fly")])
    assert run.told == ["GoTo"]
    run.turn(1.0, reports=[Underway("uav0", 1.0, "west0"), Underway("uav0", 1.0, "")])
    assert run.state.configuration.structure.physical.going_to("uav0") == "east0"
    run.turn(2.0, seen("uav0", EAST, 2.0))
    assert run.rules[-1] == "commit"


def test_a_peer_has_not_sent_a_vehicle_that_obeys_this_station():
    run = at("gcs0")
    run.turn(0.0, seen("uav0", WEST, 0.0))
    run.turn(1.0, reports=[Underway("uav0", 1.0, "east0")])
    assert run.state.configuration.structure.physical.going_to("uav0") == ""
    assert run.messages() == [
        "another station reports that it has sent uav0 to east0, but uav0 obeys this one"
    ]


def test_a_vehicle_of_another_stations_is_not_commanded_from_here():
    run = at("gcs0", vehicles=())
    run.turn(0.0, seen("uav0", WEST, 0.0, "stations"), sayings=[Saying("op0", "fly")])
    assert run.commands == []
    assert "no vehicle takes commands as uav0 at this station" in run.findings[0].message


def test_of_a_vehicle_the_station_says_what_broke_that_has_the_authority():
    for station, broken in (("gcs0", ["broken assumption"]), ("gcs1", [])):
        run = at(station)
        run.turn(0.0, seen("uav0", WEST, 0.0))
        run.turn(1.0, seen("uav0", EAST, 1.0))
        assert run.kinds() == broken
        assert run.told == ["Hold"] * len(broken)
        assert run.labels == ["⟨env : uav0 is seen in east0⟩"]


def test_a_hand_over_by_another_station_breaks_nothing():
    run = at("gcs1")
    run.turn(0.0, seen("uav0", WEST, 0.0))
    run.turn(1.0, seen("uav0", WEST, 1.0, channels=("control:gcs1",)))
    assert run.labels == ["⟨env : uav0 is off control:gcs0⟩", "⟨env : uav0 is on control:gcs1⟩"]
    assert run.findings == []
    run.turn(2.0, seen("uav0", WEST, 2.0, channels=("control:gcs0",)))
    assert set(run.kinds()) == {"broken assumption"}  # nobody here has handed it back


def test_a_link_that_is_lost_here_says_nothing_of_another_stations():
    run = at("gcs1")
    run.turn(0.0, seen("uav0", WEST, 0.0))
    run.turn(9.0, reports=[LinkLost("uav0", 9.0, 0.0)])
    assert run.kinds() == ["lost link"]
    assert run.steps == []


def test_what_broke_at_another_station_holds_this_one_too():
    run = at("gcs0")
    run.turn(0.0, seen("uav0", WEST, 0.0))
    run.turn(1.0, reports=[Broken("gcs1", 1.0, "boat0 is in east0")])
    assert [(each.message, each.elsewhere) for each in run.findings] == [("at gcs1: boat0 is in east0", True)]
    assert run.told == ["Hold"]
    run.turn(2.0, boat(EAST, 2.0), sayings=[Saying("op0", "fly")])
    assert "command" not in run.rules


def test_what_another_station_has_written_into_l_is_written_here():
    run = at("gcs1")
    run.turn(0.0, seen("uav0", WEST, 0.0, channels=("control:gcs1",)))
    assert run.state.configuration.structure.logical.links("uav0") == ("control:gcs0",)
    run.turn(
        1.0, reports=[Believes("uav0", 1.0, "links", ("control:gcs1",)), Believes("nobody", 1.0, "links", ())]
    )
    assert run.labels[-1] == "⟨believe : uav0⟩"
    logical = run.state.configuration.structure.logical
    assert (logical.links("uav0"), logical.parent("uav0")) == (("control:gcs1",), "west0")
    run.turn(2.0, reports=[Believes("uav0", 1.0, "links", ("control:gcs1",))])
    assert run.rules.count("believe") == 1
    assert replayed(run) == run.state.configuration


@pytest.mark.parametrize(
    ("node", "names", "parent"),
    [
        ("uav0", ("east0",), "east0"),
        ("uav0", (), None),
        ("east0", ("east0",), "region"),
        ("uav0", ("x",), "west0"),
    ],
)
def test_l_stays_a_forest_whatever_others_write_into_it(node, names, parent):
    run = at("gcs1")
    run.turn(0.0, reports=[Believes(node, 0.0, "parent", names)])
    assert run.state.configuration.structure.logical.parent(node) == parent
    run.turn(
        1.0,
        reports=[Believes("west0", 1.0, "parent", ("east0",)), Believes("east0", 1.0, "parent", ("west0",))],
    )
    assert run.state.configuration.structure.logical.parent("east0") == "region"
    assert replayed(run) == run.state.configuration


def test_where_an_agent_went_is_learned_and_messages_follow_it():
    run = at("gcs0")
    run.turn(0.0, reports=[Hosts("op1", 0.0, "uav0"), Hosts("child", 0.0, "gcs1"), Hosts("op0", 0.0, "gcs1")])
    run.turn(
        0.0, reports=[Hosts("nobody", 0.0, "gcs1"), Hosts("child", 0.0, "uav0")]
    )  # the text has no such thing
    assert run.labels == ["⟨learn : op1, uav0⟩", "⟨learn : child, gcs1⟩"]
    c = run.state.configuration
    assert (station_of(c, "op1"), station_of(c, "child"), station_of(c, "op0")) == ("gcs1", "gcs1", "gcs0")
    run.turn(
        1.0, reports=[Hosts("op1", 1.0, "uav0"), Hosts("op1", 1.0, "gcs0"), Hosts("op1", 1.0, "nowhere")]
    )
    assert len(run.steps) == 2
    run.turn(2.0, sayings=[Saying("op0", "tell")])
    assert run.rules[-1] == "leave"  # hosted at uav0, which is linked with gcs0 over control:gcs0
    assert replayed(run) == run.state.configuration
