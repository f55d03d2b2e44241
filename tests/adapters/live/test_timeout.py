"""`react { ... after d => ... }` in live runs: it waits by the clock."""

import pytest
from live_missions import TOUR, Run, flying, mission, plan_of

from adapters.live.batch import Saying
from adapters.recording.recording_reader import read_recording
from adapters.recording.writing import Recorder
from checker import replay
from checker.traces import SCHEMA

WAIT = """
BigActor a hosted_at uav0 with_behavior {
  react {
    case "go" => control(MOVE_HOST_TO east0)
    after 10 s => display("nobody came")
  }
}
environment { someone says "go" to a  someone says "stop" to a }
"""


def test_an_agent_waits_as_long_as_it_says_and_no_longer():
    run = Run(plan_of(TOUR + WAIT))
    run.turn(0.0)
    assert run.again == 10.0
    run.turn(9.9)
    assert run.rules == []
    assert run.again == 10.0
    run.turn(10.0)
    assert run.labels == ["⟨timeout : a, after 10 s⟩", "⟨fun : a⟩"]
    assert run.shown == ["nobody came"]
    assert run.again is None
    assert run.state.due.timeouts == {}


@pytest.mark.parametrize("now", [9.9, 10.0], ids=["before its end", "with its end"])
def test_a_message_that_comes_in_time_ends_the_wait(now):
    run = flying(TOUR + WAIT)
    run.turn(now, sayings=(Saying("a", "go"),))
    assert run.rules == ["say", "rcv_msg", "req_ctr", "command"]
    run.turn(10.0)
    assert "timeout" not in run.rules


def test_a_message_that_no_case_takes_prolongs_no_wait():
    run = Run(plan_of(TOUR + WAIT))
    run.turn(0.0)
    run.turn(5.0, sayings=(Saying("a", "stop"),))
    assert run.again == 10.0
    run.turn(10.0)
    assert run.rules == ["say", "timeout", "fun"]


def test_time_without_listening_does_not_count():
    run = Run(plan_of(TOUR + WAIT))
    run.turn(0.0)
    run.turn(12.0, missed=5.0)
    assert run.rules == []
    assert run.again == 15.0


def test_each_turn_of_a_loop_waits_anew():
    run = Run(plan_of(TOUR + WAIT.replace("react", "loop { react", 1).replace("\n  }\n}", "\n  } }\n}", 1)))
    run.turn(0.0)
    run.turn(10.0)
    assert run.again == 20.0
    run.turn(20.0)
    assert run.shown == ["nobody came", "nobody came"]


def test_a_recorded_wait_replays_without_a_clock(tmp_path):
    path, run = tmp_path / "run.mcap", Run(plan_of(TOUR + WAIT))
    recorder = Recorder(
        path, {"mission": "tour.mission", "text": TOUR + WAIT, "digest": "", "version": "0"}, 0.0
    )
    for now, missed in ((0.0, 0.0), (4.0, 2.0), (12.0, 0.0)):
        recorder.turn(run.turn(now, missed=missed), now, lambda _finding: ())
    recorder.close("done", 12.0)
    recording = read_recording(path)
    deadlines = [message.data for message in recording.of("deadlines")]
    assert deadlines == [{"agent": "a", "until": until} for until in (10.0, 12.0, None)]
    again = tmp_path / "again.mcap"
    recorder = Recorder(again, {"mission": "tour.mission", "text": "", "digest": "", "version": "0"}, 13.0)
    recorder.copy(message for message in recording.messages if message.time < 10.0)
    recorder.turn(run.turn(13.0), 13.0, lambda _finding: ())
    recorder.close("done", 14.0)
    assert read_recording(again).of("deadlines")[-1].data == {"agent": "a", "until": None}
    trace = replay(mission(TOUR + WAIT).initial, recording.trace(SCHEMA))
    assert [step.label.rule for step in trace.steps] == ["timeout", "fun"]
    assert trace.configurations[-1] == run.state.configuration
