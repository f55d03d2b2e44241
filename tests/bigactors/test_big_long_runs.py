"""Explorations of `.big` systems that were killed, interrupted or moved to files end as if they had not been."""

import os
import re
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
from processes import begun
from repository import ROOT

from bigactors.commands.big.states_file import KINDS, SCHEMA
from checker.engines.archive import read_archive, write_archive

BALLS = """\
ctrl Room = 1; atomic ctrl Ball = 0;
big nine = Room{a}.(Ball | Ball | Ball | Ball | Ball | Ball | Ball | Ball | Ball) | Room{b}.1 | Room{c}.1 | Room{d}.1;
big three = Room{b}.(Ball | Ball | Ball | id);
react move = Room{x}.(Ball | id) | Room{y}.id --> Room{x}.id | Room{y}.(Ball | id);
begin brs init nine; rules = [ {move} ]; preds = { three }; end
"""
CALLS = """\
int most = 5;
atomic ctrl Phone = 2; atomic ctrl Line = 1;
big quiet = /a /b /c /d (Phone{a,h} | Phone{b,h} | Phone{c,h} | Phone{d,h} | Line{h} | Line{h} | Line{h});
big busy = /x (Phone{x,h} | Phone{x,h});
react call = /x /y (Phone{x,h} | Phone{y,h}) | Line{h} -[1.5]-> /x (Phone{x,h} | Phone{x,h});
react quit = /x (Phone{x,h} | Phone{x,h}) -[0.1]-> /x /y (Phone{x,h} | Phone{y,h}) | Line{h};
begin sbrs init quiet; rules = [ {call, quit} ]; preds = { busy }; end
"""
LAMPS = """\
%active Lamp : 0;
%passive On : 0;
%passive Off : 0;
Lamp.Off -> Lamp.On;
Lamp.On -> Lamp.Off;
Lamp.Off | Lamp.Off | Lamp.Off;
%property dark !matches(Lamp.On | Lamp.On);
%check
"""
STATES = "balls.big/states.checkpoint"


@pytest.fixture
def systems(missions):
    (missions / "balls.big").write_text(BALLS, encoding="utf-8")
    (missions / "calls.big").write_text(CALLS, encoding="utf-8")
    (missions / "lamps.bgm").write_text(LAMPS, encoding="utf-8")
    return missions


def line(*words):
    """Return the words of a command, and the environment in which each process hashes texts differently."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "PYTHONHASHSEED": "random"}
    return [sys.executable, "-m", "bigactors", "big", *words], environment


def written(folder, *words):
    """Return the state space that a complete exploration writes."""
    words, environment = line("full", "balls.big", *words, "--json", "space.json")
    subprocess.run(words, env=environment, cwd=folder, check=True, capture_output=True)
    return (folder / "space.json").read_bytes()


def ended(folder, sent, writes, *words):
    """Send a signal to an exploration after so many checkpoints; return its exit code, output and messages."""
    path, seen = folder / "kept" / STATES, set()
    words, environment = line(
        "full", "balls.big", "--checkpoint", "kept", "--every", "0.001", "--resume", *words
    )
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    with begun(words, env=environment, cwd=folder, **pipes) as process:
        while len(seen) < writes and process.poll() is None:
            if path.exists():
                seen.add(path.stat().st_ino)
            time.sleep(0.001)
        process.send_signal(sent)
        out, err = process.communicate()
        return process.returncode, out, err


@pytest.mark.long
@pytest.mark.parametrize("threads", ["1", "2"])
def test_an_exploration_that_is_killed_again_and_again_ends_as_if_it_were_not(systems, threads):
    whole = written(systems)
    for writes in (1, 2, 3):
        ended(systems, signal.SIGKILL, writes, "--threads", threads)
        assert (systems / "kept" / STATES).exists()
    assert written(systems, "--checkpoint", "kept", "--resume", "--threads", threads) == whole


@pytest.mark.long
@pytest.mark.parametrize("sent", [signal.SIGINT, signal.SIGTERM])
def test_an_exploration_that_is_interrupted_is_saved_and_goes_on(systems, sent):
    whole = written(systems)
    code, out, err = ended(systems, sent, 1)
    wholly = "bigactors: interrupted, nothing is decided" in err  # it came when the exploration had ended
    assert (code, wholly or "incomplete: it was interrupted" in out) in ((3, True), (0, False))
    assert written(systems, "--checkpoint", "kept", "--resume") == whole


@pytest.mark.usefixtures("systems")
class TestCheckpoints:
    def test_what_a_limit_ended_goes_on_with_a_higher_one(self, bigactors, refused):
        claims = ["--reachable", "busy", "--ltl", "[]<> busy", "--no-deadlock"]
        for task, *words in (
            ["full", "calls.big"],
            ["check", "calls.big", *claims],
            ["full", "sensor_network"],
            ["check", "lamps.bgm"],
        ):
            more = ["--checkpoint", f"{task} kept", "--resume", "--json", "-"]
            whole = bigactors("big", task, *words, "--json", "-")
            assert bigactors("big", task, *words, *more, "--max-states", "2")[0] == 3
            assert bigactors("big", task, *words, *more) == whole
        err = refused("big", "check", "lamps.bgm", *more, "--max-states", "2")
        assert re.search(r"it has \d+ states, more than the limit of 2", err)

    def test_of_another_system_or_constant_it_is_refused(self, done, refused, systems):
        done("big", "full", "calls.big", "--checkpoint", "kept")
        for other in (["--const", "most=6"], ["--const", "most=5"]):
            err = refused("big", "full", "calls.big", "--checkpoint", "kept", "--resume", *other)
            assert "this checkpoint is of another system, other constants or another version" in err
            assert "hint: leave --resume out to begin anew" in err
        (systems / "calls.big").write_text(BALLS, encoding="utf-8")
        refused("big", "full", "calls.big", "--checkpoint", "kept", "--resume")

    def test_damaged_it_is_refused(self, done, refused, systems):
        words = ["big", "full", "balls.big", "--checkpoint", "kept"]
        done(*words)
        path = systems / "kept" / STATES
        data = bytearray(path.read_bytes())
        data[-5] ^= 1
        path.write_bytes(data)
        assert "its digest differs from that of its content" in refused(*words, "--resume")
        done(*words)
        head, arrays = read_archive(path, SCHEMA, KINDS)
        arrays["targets"][7] += np.uint32(1)
        write_archive(path, head, KINDS, list(arrays.values()))
        err = refused(*words, "--resume")
        assert f"kept/{STATES}: this checkpoint is damaged: " in err
        done(*words)
        done(*words, "--resume")

    def test_one_that_cannot_be_written_makes_it_incomplete(self, bigactors, systems):
        (systems / "kept").write_text("a file", encoding="utf-8")
        code, out, _ = bigactors("big", "full", "balls.big", "--checkpoint", "kept")
        assert code == 3
        assert f"incomplete: the checkpoint can't be written to kept/{STATES}: " in out

    def test_options_without_what_they_need_are_refused(self, refused):
        assert "--resume goes on from a checkpoint" in refused("big", "full", "balls.big", "--resume")
        assert "--spill needs a limit on memory" in refused("big", "full", "balls.big", "--spill", "room")

    def test_memory_is_a_limit_that_files_raise(self, bigactors, done, systems, monkeypatch):
        whole = done("big", "full", "balls.big", "--json", "-")
        monkeypatch.setattr("bigraphs.exploration.LOOK_EVERY", 0.0)
        code, out, _ = bigactors("big", "full", "balls.big", "--max-memory", "1M")
        assert (code, "incomplete: the memory limit of 1 MB was reached" in out) == (3, True)
        monkeypatch.setattr("bigraphs.exploration.memory_taken", iter([10**7, *[0] * 10**6]).__next__)
        out = done("big", "full", "balls.big", "--max-memory", "1M", "--spill", "room", "--json", "-")
        assert out == whole
        assert not list((systems / "room").iterdir())
