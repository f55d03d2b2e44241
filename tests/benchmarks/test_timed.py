"""The timed family has the counts and the verdicts that are known."""

from pathlib import Path

import pytest
from scripts import script

from checker import Engine, ZoneClock, check, explore
from semantics.properties.property import watching
from specs import parse_bytes
from specs.elaboration import elaborate

timed_family = script("timed_family")
timed = script("timed")


@pytest.mark.parametrize("engine", [Engine.REFERENCE, Engine.FAST])
def test_uavs_are_there_in_time_and_home_on_their_batteries(engine):
    source, tree = parse_bytes("timed.mission", timed_family.text(1, 3).encode())
    report = check(elaborate(tree, source, Path()), engine=engine)
    assert (report.configurations, report.transitions) == (25, 31)
    assert {each.outcome.value for each in report.verdicts} == {"holds"}
    # 3 ticks until it takes off, then 3 flights of 6.05 km at 18 m/s, 34 ticks each, with a tick between two
    assert report.verdicts["there0"].note == "after 17:50 at the latest"


def test_a_row_says_how_many_zones_there_are(monkeypatch):
    monkeypatch.delenv("TCHECKER", raising=False)
    said = timed.row(1, 3, "fcfs")
    assert said.startswith("1 UAVs, 3 places, fcfs: 25 configurations, 25 zones in ")


def test_others_learn_nothing_anew_of_a_queue_that_all_share(tmp_path):
    found = timed.explored(timed_family.text(2, 3), tmp_path)
    assert (found.size, found.times.search.count) == (2490, 7103)
    assert found.times.network.learner.runs == 1890  # it was 7,857 when rules read the queue whole


def test_half_of_the_zones_are_there_for_the_sake_of_batteries(tmp_path):
    text, clock = timed_family.text(3, 1, scheduler="program_order"), ZoneClock.GLOBAL
    start = timed.explored(text, tmp_path, clock=clock)
    other = explore(watching(start.times.initial, ()), engine=Engine.FAST, clock=clock)
    assert (start.size, start.times.search.count) == (1044, 5527)
    assert (other.size, other.times.search.count) == (1044, 3111)


@pytest.mark.parametrize(("uavs", "places", "zones"), [(2, 3, 365), (3, 1, 1044), (3, 3, 6017)])
def test_in_local_time_each_configuration_of_independent_uavs_has_one_zone(uavs, places, zones, tmp_path):
    found = timed.explored(timed_family.text(uavs, places, scheduler="program_order"), tmp_path)
    assert (found.size, found.times.search.count) == (zones, zones)


def test_a_rule_reads_no_lines_of_agents_that_do_not_fly_its_vehicle(tmp_path):
    found = timed.explored(timed_family.text(2, 1, scheduler="program_order"), tmp_path)
    learner = found.times.network.learner
    for number, label in learner.steps.items():
        if label.rule == "command":
            trees = learner.leaves.parts_of(number)
            asked = {
                ask.cell for tree in trees if tree in learner.writing_trees for ask in asks_of(learner, tree)
            }
            assert ("line", f"patrol{1 - int(label.agent[-1])}") not in asked


def asks_of(learner, tree):
    """Return the questions of a tree."""
    waiting, found = [int(learner.trees.root.room[tree])], []
    while waiting:
        node = waiting.pop() - 1
        if node >= 0:
            _, width, base = learner.trees.window(node)
            found.append(learner.trees.asks[node])
            waiting += learner.trees.next.room[base : base + width].tolist()
    return found


@pytest.mark.long
@pytest.mark.parametrize(("most", "outcome"), [(37, "holds"), (36, "violated")])
def test_a_deadline_flips_at_the_same_moment_in_local_time(most, outcome):
    text = timed_family.text(2, 1, scheduler="program_order").replace("within 2 h", f"within {10 * most} s")
    source, tree = parse_bytes("timed.mission", text.encode())
    mission = elaborate(tree, source, Path())
    reports = [check(mission, engine=Engine.FAST, clock=clock) for clock in ZoneClock]
    assert [each.verdicts["there0"].outcome.value for each in reports] == [outcome] * 2
    assert reports[0].verdicts == reports[1].verdicts


def test_tchecker_gets_a_process_for_each_uav_and_nothing_that_they_share(tmp_path):
    lines = timed.exported(timed_family.text(2, 1, scheduler="program_order"), tmp_path).splitlines()
    assert [line for line in lines if line.startswith("process:")] == [
        f"process:agent_patrol{i}" for i in (0, 1)
    ]
    assert not [line for line in lines if line.startswith("sync:")]
