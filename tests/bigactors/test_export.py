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
    text = exported(capsys, name)
    locations = re.findall(r"^location:mission:(\w+)\{", text, re.MULTILINE)
    clocks = re.findall(r"^clock:1:(\w+)$", text, re.MULTILINE)
    edges = re.findall(r"^edge:mission:(\w+):(\w+):(\w+)\{", text, re.MULTILINE)
    assert len(set(locations)) == len(locations)
    assert {place for source, target, _ in edges for place in (source, target)} == set(locations)
    assert {event for *_, event in edges} == set(re.findall(r"^event:(\w+)$", text, re.MULTILINE))
    assert set(re.findall(r"\bx\d+\b", text)) == set(clocks)


def test_a_flight_has_its_interval(capsys):
    text = exported(capsys, "endurance")
    assert "location:mission:first{initial: : committed: }" in text
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
