"""`bigactors export`: timed automata for TChecker and UPPAAL."""

import re
from xml.etree import ElementTree as ET

import pytest
from shipped import TIMED

from bigactors.cli import main
from specs.missions import shipped_missions


def exported(capsys, *arguments, form="tchecker"):
    assert main(["export", "--format", form, *arguments]) == 0
    return capsys.readouterr().out


@pytest.mark.parametrize("name", TIMED)
def test_an_automaton_is_closed(capsys, name):
    text = exported(capsys, name, "--clock", "global")
    locations = re.findall(r"^location:mission:(\w+)\{", text, re.MULTILINE)
    clocks = re.findall(r"^clock:1:(\w+)$", text, re.MULTILINE)
    edges = re.findall(r"^edge:mission:(\w+):(\w+):(\w+)\{", text, re.MULTILINE)
    assert len(set(locations)) == len(locations)
    assert {place for source, target, _ in edges for place in (source, target)} == set(locations)
    assert {event for *_, event in edges} == set(re.findall(r"^event:(\w+)$", text, re.MULTILINE))
    assert set(re.findall(r"\b(?:x\d+|stay_mission)\b", text)) == set(clocks)


def test_each_process_of_local_time_is_one_with_clocks_of_its_own(capsys):
    text = exported(capsys, "relay_timed", "--scheduler", "program_order", "--property", "the report")
    processes = re.findall(r"^process:(\w+)$", text, re.MULTILINE)
    named = ["agent_desk", "agent_eye", "environment_0", "observer", "cells_0", "cells_1", "cells_2"]
    assert processes == named
    owners = {}
    for process, rest in re.findall(r"^(?:location|edge):(\w+)(.*)$", text, re.MULTILINE):
        for clock in re.findall(r"\b(?:x\d+_\d+|stay_\w+)\b", rest):
            owners.setdefault(clock, set()).add(process)
    assert owners.keys() == set(re.findall(r"^clock:1:(\w+)$", text, re.MULTILINE))
    assert all(len(several) == 1 for several in owners.values())
    shared = re.findall(r"^sync:(.*)$", text, re.MULTILINE)
    assert all(len({part.split("@")[1] for part in each.split(":")}) == 1 for each in shared)
    assert not re.search(r"urgent:|committed:|[^<>]= [1-9]", text)


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("endurance", "fcfs has one queue of all requests"),
        ("crossing_timed --clock global", None),
        ("crossing_timed", None),
        ("endurance --scheduler program_order", "the mission has a single bigActor and no environment"),
    ],
)
def test_a_single_process_has_its_reason(capsys, name, why):
    assert main(["export", "--format", "tchecker", *name.split()]) == 0
    assert capsys.readouterr().err == ("" if why is None else f"it has a single process: {why}\n")


def test_a_flight_has_its_interval(capsys):
    text = exported(capsys, "endurance")
    assert len(re.findall(r"^location:mission:l\d+\{initial:", text, re.MULTILINE)) == 1
    assert re.search(r"location:mission:l\d+\{invariant: x\d+ <= \d+\}", text)
    assert re.search(r"edge:mission:l\d+:l\d+:s0\{provided: x\d+ >= \d+\b", text)


def test_where_a_property_is_violated_is_labelled(capsys):
    text = exported(capsys, "broken_endurance", "--property", "endurance")
    assert "location:mission:wrong{labels: wrong}" in text
    assert re.search(r"edge:mission:l\d+:wrong:wrong\{provided: x\d+ >= 163\}", text)


def test_uppaal_is_asked_whether_the_property_holds(capsys):
    text = exported(capsys, "broken_endurance", "--property", "endurance", form="uppaal")
    query = ET.fromstring(text).find("queries/query")
    assert query.findtext("formula") == "A[] not mission.wrong"
    assert query.findtext("comment") == "endurance"
    said = [each.text for each in ET.fromstring(text).iter("label") if each.get("kind") == "comments"]
    assert "⟨commit : FLY(patrol, MOVE_HOST_TO north0)⟩" in said


def test_more_ticks_than_zones_count_are_a_mistake_with_its_remedy(capsys, tmp_path):
    text = shipped_missions()["endurance"].read_text(encoding="utf-8")
    fine = tmp_path / "fine.mission"
    fine.write_text(text.replace("tick 10 s", "tick 1 ms").replace("1630 s", "168 h"), encoding="utf-8")
    for command in (
        ["check", str(fine)],
        ["export", str(fine), "--format", "tchecker", "--property", "endurance"],
    ):
        assert main(command) == 2
        said = capsys.readouterr().err
        assert "604,800,001 ticks are more than the engine 'fast' counts (134,217,728)" in said
        assert "give timing a larger tick" in said
