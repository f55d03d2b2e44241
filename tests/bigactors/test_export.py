"""`bigactors export`: timed automata for TChecker."""

import os
import re
import subprocess

import pytest
from shipped import TIMED

from bigactors.cli import main
from checker import check
from checker.verdicts import Outcome
from semantics.properties.kinds import PropertyKind
from specs.elaboration import load_mission


def exported(capsys, *arguments):
    assert main(["export", "--format", "tchecker", *arguments]) == 0
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


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["oil_spill"], "oil_spill says nothing of times"),
        (["endurance", "--property", "endurence"], "did you mean 'endurance'?"),
        (["endurance", "--property", "race_freedom"], "only deadlines and endurance are exported"),
    ],
)
def test_what_has_no_automaton_is_said(capsys, arguments, said):
    assert main(["export", "--format", "tchecker", *arguments]) == 2
    assert said in capsys.readouterr().err


@pytest.mark.skipif("TCHECKER" not in os.environ, reason="TCHECKER names no program `tck-reach`")
@pytest.mark.parametrize("name", TIMED)
def test_tchecker_comes_to_the_same_verdicts(tmp_path, capsys, name):
    for verdict in check(load_mission(name)).verdicts:
        if verdict.property.kind not in (PropertyKind.WITHIN, PropertyKind.ENDURANCE):
            continue
        model = tmp_path / "model.tck"
        model.write_text(exported(capsys, name, "--property", verdict.property.name))
        program = [os.environ["TCHECKER"], "-a", "covreach", "-l", "wrong", str(model)]
        said = subprocess.run(program, capture_output=True, text=True, check=True).stdout
        assert ("REACHABLE true" in said) == (verdict.outcome is Outcome.VIOLATED)
