"""The explorer: every step is one of the rules', runs replay, searches are shortest, and nothing breaks it."""

import json
from collections import deque

import pytest

from bigactors.studio.exploration import Exploration
from checker import check, replay, to_json
from semantics.properties.propositions import holds
from semantics.successors import successors
from specs.elaboration import load_mission


def exploring(name):
    return Exploration(load_mission(name))


def asked(exploration, **request):
    answer = json.loads(json.dumps(exploration.handle(request)))  # it is plain data
    assert "error" not in answer, answer
    return answer


@pytest.mark.parametrize("name", ["look_before_entry_racy", "oil_spill", "relay_timed", "broken_endurance"])
def test_every_step_of_a_walk_is_one_of_the_rules_and_the_saved_run_replays_to_the_same_address(name):
    exploration = exploring(name)
    walked = asked(exploration, ask="random", run="", count=25, seed=7)
    saved = asked(exploration, ask="save", run=walked["run"])["trace"]
    trace = replay(exploration.initial, saved)
    for before, step in zip(trace.configurations, trace.steps, strict=False):
        assert step.target in [each.target for each in successors(before)]
    assert asked(exploration, ask="load", trace=saved)["run"] == walked["run"]
    assert len(trace) == walked["length"] == len(walked["steps"])


def test_the_choices_are_the_successors_and_each_leads_where_it_says():
    exploration = exploring("look_before_entry_racy")
    for run in ("", "0", "0.1", "1.0.0"):
        shown = asked(exploration, ask="run", run=run)
        c = exploration._go(run).at
        assert [each["label"] for each in shown["choices"]] == [str(each.label) for each in successors(c)]
        for each, transition in zip(shown["choices"], successors(c), strict=True):
            after = f"{run}.{each['step']}".strip(".")
            assert exploration._go(after).at == transition.target
            assert asked(exploration, ask="run", run=after)["steps"][-1]["words"] == each["words"]


@pytest.mark.parametrize(
    ("name", "where", "run"),
    [
        ("look_before_entry_racy", "uav0 in gate0 and uav1 in gate0", ""),
        ("oil_spill", "uav0 in oilSpill0", "0"),
    ],
)
def test_a_run_to_a_proposition_is_a_shortest_one(name, where, run):
    exploration = exploring(name)
    goal = exploration._goal(where)
    start = exploration._go(run).at
    found = asked(exploration, ask="goto", run=run, where=where)
    assert found["length"] - len(run.split(".") if run else []) == distance(start, goal)


def distance(start, goal):
    """Return the steps to a proposition by a search of its own."""
    waiting, known = deque([(start, 0)]), {start}
    while waiting:
        c, far = waiting.popleft()
        if holds(goal.formula, c):
            return far
        for each in successors(c):
            if each.target not in known:
                known.add(each.target)
                waiting.append((each.target, far + 1))
    return None


def test_with_times_a_run_to_a_proposition_has_dates_and_each_step_may_be_taken_in_its_interval_only():
    exploration = exploring("relay_timed")
    found = asked(exploration, ask="goto", run="0", where="ended desk")
    first = check(exploration.mission).verdicts["told"].note
    assert f"at {found['steps'][-1]['date']} at the earliest" in first
    first = asked(exploration, ask="run", run="")["choices"][0]
    assert (first["from"], first["to"], first["ticks"]) == ("0:00", "0:10", [0, 1])
    assert asked(exploration, ask="run", run="0@1")["steps"][0]["at"] == 10_000
    assert "another step is due by 0:10" in exploration.handle({"ask": "run", "run": "0@2"})["error"]


def test_a_violation_loaded_from_its_trace_ends_in_the_same_race_with_the_same_causes():
    exploration = exploring("look_before_entry_racy")
    report = check(exploration.mission)
    trace = report.verdicts["race_freedom"].violations[0].trace
    shown = asked(exploration, ask="load", trace=to_json(trace, "m", "d"))
    roles = {number: step["role"] for number, step in enumerate(shown["steps"], 1) if "role" in step}
    assert roles == trace.race.roles
    assert [each["step"] for each in shown["causes"]] == sorted(roles)
    before = asked(exploration, ask="run", run=shown["run"], at=shown["length"] - 1)
    (value,) = (each for each in before["values"] if each["name"] == "race_freedom")
    assert (value["value"], value["bad"]) == (False, True)


def test_a_run_into_what_an_invariant_forbids_is_told_its_causes():
    exploration = exploring("broken_crossing")
    violation = check(exploration.mission).verdicts["apart"].violations[0]
    shown = asked(exploration, ask="load", trace=to_json(violation.trace, "m", "d"))
    assert [each["text"] for each in shown["causes"]] == [
        "uav0 sets off for east0, as first wants",
        "uav1 sets off for north0, as second wants",
        violation.details[-1],
    ]
    assert asked(exploration, ask="run", run=shown["run"].rpartition(".")[0])["causes"] == []


def test_the_graph_has_the_reachable_configurations_and_each_node_is_where_its_address_leads():
    exploration = exploring("broken_inconsistent")
    graph = asked(exploration, ask="graph", run="0.0")
    assert (graph["whole"], graph["count"]) == (True, check(exploration.mission).configurations)
    assert any(node.get("bad") for node in graph["nodes"])
    places = {node["id"]: exploration._go(node["run"]).at for node in graph["nodes"]}
    assert len(set(places.values())) == len(places)
    for edge in (each for each in graph["edges"] if "folded" not in each):
        assert places[edge["to"]] in [each.target for each in successors(places[edge["from"]])]


def test_of_a_mission_too_large_the_graph_is_the_neighbourhood_of_the_run():
    exploration = exploring("broken_deadlock")
    run = asked(exploration, ask="random", run="", count=9, seed=1)["run"]
    graph = asked(exploration, ask="graph", run=run)
    ends = [node for node in graph["nodes"] if node.get("at") == 9]
    assert not graph["whole"]
    assert len(graph["nodes"]) <= 60
    assert [node["run"] for node in ends] == [run]


HOSTILE = [
    {},
    {"ask": "what"},
    {"ask": "run", "run": "9"},
    {"ask": "run", "run": "0.x"},
    {"ask": "run", "run": 7, "at": 5},
    {"ask": "run", "run": ".".join(["0"] * 5_000)},
    {"ask": "run", "run": "", "at": True},
    {"ask": "random", "run": "", "count": 10**9},
    {"ask": "random", "run": "", "count": "1"},
    {"ask": "goto", "run": "", "where": "uav7 in gate0"},
    {"ask": "goto", "run": "", "where": 'true } check { reachable "x": true'},
    {"ask": "goto", "run": "", "where": "uav0 in"},
    {"ask": "goto", "run": "", "where": "false"},
    {"ask": "goto", "run": "", "where": ["a"]},
    {"ask": "load", "trace": {"schema": "bigactors.trace/1", "steps": [{"label": "⟨fun : z⟩"}]}},
    {"ask": "load", "trace": [1]},
    {"ask": "load"},
]


@pytest.mark.parametrize("request_", HOSTILE, ids=range(len(HOSTILE)))
def test_what_cannot_be_answered_gets_a_reason_and_changes_nothing(request_):
    exploration = exploring("look_before_entry_racy")
    assert exploration.handle(request_)["error"]
    assert len(asked(exploration, ask="run", run="0.1")["steps"]) == 2
