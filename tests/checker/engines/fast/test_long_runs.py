"""Long runs: checkpoints and going on from them, limits of memory, and cross-checks."""

import json
import os
import signal
import subprocess
import sys
import time
from contextlib import nullcontext
from pathlib import Path

import numpy as np
import pytest

from checker import CheckpointError, Engine, Keeping, Limits, check, explore
from checker.engines.contract import sample
from checker.engines.fast.search.crosscheck import Disagreement, crosscheck
from checker.engines.zones import explorer as timed_explorer
from specs.elaboration import load_mission

ROOT = Path(__file__).parents[4]


def start(name):
    return load_mission(name).initial


def explored(initial, **options):
    return explore(initial, engine=Engine.FAST, **options)


def bigactors(*words):
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "PYTHONHASHSEED": "random"}
    return [sys.executable, "-m", "bigactors", *words], environment


@pytest.mark.long
def test_what_was_killed_goes_on_and_comes_to_the_same_report(tmp_path):
    kept, whole, again = tmp_path / "kept", tmp_path / "whole.json", tmp_path / "again.json"
    line, environment = bigactors("check", "takeover", "--no-traces", "--engine", "fast")
    subprocess.run([*line, "--json", str(whole)], env=environment, check=True, capture_output=True)
    long = [*line, "--checkpoint", str(kept), "--every", "0.001"]
    running = subprocess.Popen(long, env=environment, stdout=subprocess.DEVNULL)
    while not list(kept.rglob("*.checkpoint")) and running.poll() is None:
        time.sleep(0.002)
    running.send_signal(signal.SIGKILL)
    running.wait()
    assert list(kept.rglob("*.checkpoint"))
    resumed = [*long, "--resume", "--json", str(again)]
    subprocess.run(resumed, env=environment, check=True, capture_output=True)
    reports = [json.loads(path.read_text()) for path in (whole, again)]
    assert {report.pop("seconds") >= 0 for report in reports} == {True}
    assert reports[0] == reports[1]


def test_a_checkpoint_of_something_else_is_refused(tmp_path):
    explored(start("oil_spill"), keeping=Keeping(str(tmp_path), digest="one"))
    with pytest.raises(CheckpointError, match="of another mission"):
        explored(start("oil_spill"), keeping=Keeping(str(tmp_path), True, "other"))
    limits = Limits(configurations=7)
    with pytest.raises(CheckpointError, match="of another mission"):
        explored(start("oil_spill"), limits=limits, keeping=Keeping(str(tmp_path), True, "one"))


@pytest.mark.parametrize("engine", [Engine.REFERENCE, Engine.FAST])
def test_without_memory_the_search_is_incomplete(engine):
    mission = load_mission("rendezvous")
    report = check(mission.initial, mission.properties, Limits(memory=1_000_000), engine=engine)
    assert str(report.bounds[0]) == "the memory limit of 1 MB"
    assert not report.complete
    assert "holds" not in {
        each.outcome.value for each in report.verdicts if each.property.kind == "invariant"
    }


@pytest.mark.parametrize("name", ["takeover", "nomad", "handover"])
def test_the_interpreter_agrees_with_what_was_learned(name):
    found = explored(start(name), limits=Limits(configurations=300))
    crosscheck(found.survey.search.expander, sample(found.expanded, 60))


@pytest.mark.parametrize("name", ["takeover", "oil_spill_timed"])
def test_configurations_with_too_much_pending_have_no_successors_to_check(name):
    found = explored(start(name), limits=Limits(pending=1), keeping=Keeping(doubted=300))
    assert any("pending" in str(bound) for bound in found.bounds)


def test_the_cross_check_finds_what_was_learned_wrong():
    search = explored(start("oil_spill")).survey.search
    wrong = int(np.flatnonzero(search.expander.counts.used)[-1])  # some that was taken
    width = search.store.packing.words
    search.model.loops.masks[2 * width * wrong + width] ^= ~np.uint64(0)  # it sets what it should not
    with pytest.raises(Disagreement):
        crosscheck(search.expander, range(search.size))


@pytest.mark.parametrize("is_right", [True, False])
def test_timed_missions_are_checked_again(monkeypatch, is_right):
    doubt = timed_explorer._doubt

    def spoil_and_doubt(network, count, reduce):
        if not is_right:
            width, transitions = network.store.packing.words, len(network.learner.leaves.rule)
            masks = network.model.loops.masks[: 2 * width * transitions].reshape(-1, 2, width)
            masks[:, 0], masks[:, 1] = ~np.uint64(0), 0  # nothing is written
        doubt(network, count, reduce)

    monkeypatch.setattr(timed_explorer, "_doubt", spoil_and_doubt)
    with nullcontext() if is_right else pytest.raises(Disagreement):
        explored(start("handover_timed"), keeping=Keeping(doubted=10))


ROOMY = """
import resource
from checker import Engine, Limits, check, report_text
from specs.elaboration import elaborate
from specs.parser import parse_bytes
from contextlib import nullcontext
from pathlib import Path

def loop(name, host):
    body = "n = n + 1  control(MOVE_HOST_TO there0)  control(MOVE_HOST_TO here0)"
    return f"BigActor {name} hosted_at {host} with_behavior {{ let n = 0  loop {{ {body} }} }}"

text = f'''
signature {{ kind Location contains UAV  kind UAV driven }}
world {{
  here0: Location = box (37.1, -8.6) (37.0, -8.7)
  there0: Location = box (37.1, -8.4) (37.0, -8.5)
  uav0: UAV = point (37.05, -8.65)
  uav1: UAV = point (37.05, -8.65)
}}
{loop("a", "uav0")}
{loop("b", "uav1")}
check {{ local_consistency }}
'''
source, tree = parse_bytes("m", text.encode())
mission = elaborate(tree, source, Path())

def checked(limits):
    return check(mission, limits=limits, engine=Engine.FAST)

checked(Limits(configurations=50_000))  # compiled and loaded
taken = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
resource.setrlimit(resource.RLIMIT_AS, (taken + 40_000_000, resource.RLIM_INFINITY))
print(*report_text("m", checked(Limits(configurations=None, seconds=100.0)), traces=False), sep="\\n")
"""


@pytest.mark.long
@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="memory is told of by /proc")
def test_where_the_system_gives_no_more_memory_the_search_is_incomplete_and_says_so():
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    ran = subprocess.run(
        [sys.executable, "-c", ROOMY],
        check=False,
        env=environment,
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert ran.returncode == 0, ran.stderr
    assert "stopped at the end of the available memory: the rest" in ran.stdout
    assert "? local_consistency  incomplete" in ran.stdout
