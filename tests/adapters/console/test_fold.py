"""What a console shows of whole runs: of spill_watch as it is flown, of what may be said, of what it cannot replay."""

import json
import time
from dataclasses import replace
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st
from live_missions import TOUR
from recorded import EAST, WEST, Tape, folded, messages, read, shown, uav
from scale import examples

from adapters.camera.votes import share
from adapters.console.entity_tracks import CHUNK, EVERY, MOST_CHUNKS, extended
from adapters.console.facts import MOST_TICKS, Facts
from adapters.recording.mcap_files import McapWriter
from adapters.recording.schemas import SCHEMAS
from bigactors.commands.console.recorded_history import history_of
from bigactors.live_demo import SPILL
from bigactors.recordings import open_recording
from physical.shape import canonical

# --- spill_watch ----------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def watched(spill_watch):
    return read(spill_watch), open_recording(str(spill_watch)).of("steps")


def moment(watched, rule, about, later):
    """Return what is shown some seconds after the first step by a rule that is about something."""
    history, steps = watched
    found = next(
        each for each in steps if each.data["label"].startswith(f"⟨{rule} ") and about in each.data["label"]
    )
    time = found.time + later
    return history.at(time).forward(time).sections


AWAY, SEARCHES, SPILL_SEEN = (
    ("airfield0", "region"),
    ("searchArea0", "searchArea0"),
    ("oilSpill0", "oilSpill0"),
)


@pytest.mark.parametrize(
    ("rule", "about", "later", "where", "asked"),
    [
        ("command", "searchArea0", 100, AWAY, "FLY(pilot, MOVE_HOST_TO searchArea0)"),
        ("commit", "searchArea0", 0.05, SEARCHES, None),
        ("env", "oilSpill0 appears", 0, SEARCHES, None),
        ("command", "oilSpill0", 1, SEARCHES, "FLY(pilot, MOVE_HOST_TO oilSpill0)"),
        ("commit", "oilSpill0", 1, SPILL_SEEN, None),
        ("command", "airfield0", 300, ("oilSpill0", "region"), "FLY(shore, MOVE uav0 TO airfield0)"),
        ("commit", "airfield0", 0, ("airfield0", "airfield0"), None),
    ],
)
def test_spill_watch_is_shown_as_the_mission_says_it_goes(watched, rule, about, later, where, asked):
    card = moment(watched, rule, about, later)["vehicles"]["uav0"]
    assert (card["believed"], card["actual"], card["differs"]) == (*where, where[0] != where[1])
    if asked is not None:
        assert (card["request"]["text"], card["request"]["limit"]) == (asked, 1800.0)
        assert card["order"]["state"] == "accepted"
    is_over = about == "airfield0" and not asked  # the run ends with its mission
    assert (card["level"], card["word"]) == (0, "ended" if is_over else "well")


def test_the_authority_over_the_plane_is_handed_over(watched):
    before = moment(watched, "command", "oilSpill0", 1)["vehicles"]["uav0"]
    after = moment(watched, "command", "airfield0", 1)["vehicles"]["uav0"]
    assert (before["authority"], after["authority"]) == (["gcs0"], ["gcs1"])
    assert (before["handed"], after["handed"]["from"], after["handed"]["to"]) == (None, ["gcs0"], ["gcs1"])
    assert abs(after["height"] - (after["altitude"] - 20.0)) < 3.0


def test_at_the_end_of_spill_watch_all_is_known_and_its_track_is_whole(watched):
    view = watched[0].newest().sections
    assert {name: agent["state"] for name, agent in view["agents"].items()} == dict.fromkeys(
        ("pilot", "shore", "tower"), "has ended"
    )
    assert view["clock"]["ended"] == "the mission has ended"
    assert view["clock"]["rate"] is None  # flown as fast as it can be computed
    assert len(view["steps"]) == 200
    assert view["mission"]["verified"] is True
    assert {each["verdict"] for each in view["mission"]["verdicts"]} == {"holds"}
    assert set(view["places"]) == {"airfield0", "gcs0", "gcs1", "gcs2", "oilSpill0", "searchArea0", "shore0"}
    assert set(view["entities"]) == {"drifter0", "drifter1", "uav0"}
    assert not any(alert["wrong"] for alert in view["alerts"].values())
    assert "oilSpill0: OilSpill" in view["bigraph"]["text"]
    assert {sort for _, sort in view["ticks"].values()} >= {"world", "control"}
    pieces = [view["tracks"][f"uav0#{rank}"] for rank in range(len(view["tracks"]))]
    assert all(len(piece) <= CHUNK for piece in pieces)
    assert all(before[-1] == after[0] for before, after in pairwise(pieces))
    assert pieces[0][0] == (37.147, -8.582)
    assert pieces[-1][-1][0] > 37.14


def test_a_trail_that_grows_too_long_keeps_its_ends_and_every_second_position():
    trail = None
    for k in range(5_000):
        trail = extended(trail, (k / 1e5, 0.0), k * EVERY)
    assert trail.every == 4 * EVERY
    assert len(trail.chunks) <= MOST_CHUNKS
    positions = [at for piece in trail.chunks for at in piece]
    assert positions[0][0] < 5e-5
    assert positions[-1][0] > 4_990 / 1e5
    assert positions == sorted(positions)


def test_of_too_many_ticks_the_commonest_sort_is_thinned_out():
    draft = Facts()
    for k in range(3 * MOST_TICKS):
        draft.tick(float(k), "finding" if k % 1_000 == 0 else "world")
    sorts = [sort for _, sort in draft.ticks.values()]
    assert len(sorts) <= MOST_TICKS
    assert sorts.count("finding") == 6


# --- what may be said -----------------------------------------------------------------------------------


def test_what_may_be_said_becomes_less_with_each_saying(recording):
    history = read(recording)

    def left(at):
        sayings = history.at(at).forward(at).sections["sayings"]
        return {key: each["left"] for key, each in sayings.items()}

    assert left(1049.0) == {'op "handover"': 2, 'op "status"': 3}
    assert left(1050.0) == {'op "handover"': 2, 'op "status"': 2}
    assert left(1061.0) == {'op "handover"': 1, 'op "status"': 2}
    shown = history.newest().sections
    saying = {"agent": "op", "message": "status", "left": 2, "awaited": False, "vain": None}
    assert shown["sayings"]['op "status"'] == saying
    assert [(each["what"], each["state"]) for each in shown["actions"].values()] == [
        ('say "status"', "confirmed"),
        ('say "nonsense"', "refused"),
        ('say "handover"', "confirmed"),
    ]
    assert "permitted now" in shown["actions"]["2"]["why"]


def test_steps_say_what_they_changed_and_whether_the_terminal_tells_of_them(recording):
    steps = read(recording).newest().sections["steps"]
    commit = next(each for each in steps.values() if each["rule"] == "commit")
    assert ["L", "uav0", ":", "west0", "↦", "east0"] in [each.split() for each in commit["changes"]]
    assert (commit["agent"], commit["told"]) == ("a", True)
    assert not next(each for each in steps.values() if each["rule"] == "req_ctr")["told"]


def test_an_agent_waits_for_its_request_or_a_message(flight):
    agents = flight.shown()["agents"]
    assert agents["a"]["state"] == "waits for FLY(a, MOVE_HOST_TO east0)"
    assert agents["a"]["host"] == "uav0"
    waits = {"host": "gcs0", "state": 'waits for "there"', "request": None}
    assert agents["op"] == waits | {"awaits": ['"there"'], "until": None}


WAITS = """BigActor op hosted_at gcs0 with_behavior {
  loop {
    react {
      case "handover" => skip
      case (n, "go") if n == 1 => skip
      case x: Observation => skip
      after 2 min => react { case _ => react { after 1 min => skip } }
    }
  }
}
environment {
  says "handover" to op at most 2 times
  says "status" to op at most 2 times
}
"""


def test_an_agent_says_what_it_waits_for_and_until_when_and_which_saying_it_takes_now(tmp_path):
    def seen():
        shown = tape.shown()
        awaited = [shown["sayings"][f'op "{each}"']["awaited"] for each in ("handover", "status")]
        return (shown["agents"]["op"]["awaits"], shown["agents"]["op"]["until"], *awaited)

    with Tape(tmp_path / "r.mcap", f"mission tour\n{TOUR}\n{WAITS}") as tape:
        tape.turn(0, uav(WEST, 0))
        tape.turn(1)
        waits = ['"handover"', '(n, "go") that passes a test', "an observation"]
        assert seen() == (waits, 1120.0, True, False)
        tape.turn(30, sayings=[("op", "handover")])
        assert seen() == (waits, 1150.0, True, False)
        tape.turn(150)
        tape.turn(151)
        assert seen() == (["anything"], None, True, True)
        tape.turn(160, sayings=[("op", "status")])
        tape.turn(161)
        assert seen() == ([], 1220.0, False, False)
        assert tape.shown()["agents"]["op"]["state"] == "waits"


@pytest.mark.parametrize(("rate", "said"), [(10.0, 10.0), (None, None), (0, None), ("fast", None)])
def test_the_clock_says_how_fast_the_run_goes(tmp_path, rate, said):
    with Tape(tmp_path / "r.mcap", rate=rate) as tape:
        tape.turn(0, uav(WEST, 0))
        assert tape.shown()["clock"]["rate"] == said


# --- what cannot be replayed ----------------------------------------------------------------------------


def spoilt(recording, to, change):
    """Write a recording anew, with some of its messages changed; return what is shown of it."""
    writer = McapWriter(to, SCHEMAS)
    for message in messages(recording):
        writer.write(message.topic, message.time, message.data | change(message))
    writer.close()
    return read(to).newest().sections


def test_a_step_that_the_rules_do_not_allow_is_told_and_arrivals_go_on(recording, tmp_path):
    def change(message):
        return {"digest": "sha256:0"} if message.topic == "steps" and message.data["number"] == 4 else {}

    view = spoilt(recording, tmp_path / "r.mcap", change)
    alert = view["alerts"]["0"]
    assert alert["message"].startswith("the logical model is not known any more: step 4: ")
    assert not alert["wrong"]
    assert view["entities"]["uav0"]["at"] == EAST
    card = view["vehicles"]["uav0"]
    assert (card["believed"], card["actual"], card["differs"]) == (None, None, False)
    assert (view["agents"], view["sayings"], view["bigraph"]) == ({}, {}, {})
    commit = next(each for each in view["steps"].values() if each["rule"] == "commit")
    assert (commit["about"], commit["changes"]) == ("FLY(a, MOVE_HOST_TO east0)", ())


def test_of_a_mission_that_cannot_be_read_arrivals_are_shown(recording, tmp_path):
    def change(message):
        return {"text": "mission ?"} if message.topic == "run" else {}

    view = spoilt(recording, tmp_path / "r.mcap", change)
    message = view["alerts"]["0"]["message"]
    assert message.startswith("the logical model is not known: its mission cannot be read")
    assert view["entities"]["uav0"]["at"] == EAST
    assert view["vehicles"]["uav0"]["kind"] == "UAV"


# --- pictures -------------------------------------------------------------------------------------------


def drawn(moment):
    """Return what is shown of the bigraph when it is drawn."""
    end = time.monotonic() + 60.0
    while (bigraph := moment().sections["bigraph"])["drawn"] is None:
        assert time.monotonic() < end
        time.sleep(0.05)
    return bigraph


def test_the_bigraph_is_drawn_in_its_own_process_and_shown_when_it_is_ready(recording):
    with history_of(recording) as history:
        while history.read_on(1.0):
            pass
        assert history.newest().sections["bigraph"]["svg"] is None  # nobody waits for it
        newest = drawn(history.newest)
        assert newest["drawn"] == newest["step"]
        assert newest["svg"].startswith("<svg ")
        assert "uav0" in newest["svg"]
        moment = history.at(1001.0)
        earlier = drawn(lambda: moment.forward(1001.0))
        assert earlier["drawn"] == earlier["step"] < newest["drawn"]


# --- what is no run's ---------------------------------------------------------------------------------------

ODD = (None, True, -1, 10**30, 1.5, "", "x" * 1_000, [], {}, [[1, 2]], [None], {"a": 1})


def mutated(value, chance):
    """Return a message's data with other values here and there."""
    if chance.random() < 0.15:
        return chance.choice(ODD)
    if isinstance(value, dict):
        return {key: mutated(each, chance) for key, each in value.items()}
    return [mutated(each, chance) for each in value] if isinstance(value, list) else value


@pytest.fixture(scope="module")
def told(recording):
    return messages(recording)


@examples(60, deadline=None)
@given(chance=st.randoms(use_true_random=False))
def test_whatever_messages_say_a_console_shows_something(told, chance):
    some = [
        replace(each, data=mutated(each.data, chance))
        if each.topic != "run" and chance.random() < 0.3
        else each
        for each in told
    ]
    facts = folded(some)
    json.dumps(shown(facts, facts.time + chance.random() * 100), allow_nan=False)


def test_the_spill_of_the_live_demonstration_is_where_its_camera_found_it(spill_watch):
    found = [each for each in messages(spill_watch) if each.topic == "arrivals"]
    seen = [each.data for each in found if each.data["entity"] == "oilSpill0"]
    assert {each["plugin"] for each in seen} == {"camera1 on uav0"}
    outlines = [canonical([tuple(each) for each in data["ring"]]) for data in seen]
    assert min(share(each, SPILL) for each in outlines) >= 0.9
