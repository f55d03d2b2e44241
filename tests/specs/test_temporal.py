"""Properties of runs: how they are read, what they come to, and how they are written."""

import re
from pathlib import Path

import pytest
from elaborating import elaborated, told

from semantics.properties import temporal as t
from specs import syntax as s
from specs.diagnostics import Source
from specs.formatter import format_mission
from specs.parser import parse

DOCS = Path(__file__).parents[2] / "docs" / "reference"
WORLD = """
signature { kind Location contains UAV kind UAV driven }
world {
  base0: Location = box (37.04, -8.59) (36.94, -8.79)
  uav0: UAV = point (37.08, -8.55)
  uav1: UAV = point (37.09, -8.55)
}
BigActor a hosted_at uav0 with_behavior { observe(HOST) }
BigActor b hosted_at uav1 with_behavior { observe(HOST) }
"""


def checked(text, world=WORLD):
    return elaborated(f"{world}check {{ {text} }}").properties[0]


def formula(text, logic="ltl", world=WORLD):
    return str(checked(f'{logic} "q": {text}', world).temporal)


LINEAR = {
    "G ended a": "[] ended a",
    "[] <> ended a": "[] <> ended a",
    "infinitely often ended a": "[] <> ended a",
    "[] ended a -> ended b": "not [] ended a or ended b",
    "always ended a -> ended b": "[] (not ended a or ended b)",
    "ended a leads to ended b": "[] (not ended a or <> ended b)",
    "ended a or waiting a leads to next ended b": "[] (not (ended a or waiting a) or <> X ended b)",
    "ended a U ended b U waiting a": "ended a U (ended b U waiting a)",
    "(ended a until ended b) until waiting a": "(ended a U ended b) U waiting a",
    "not ended a W ended b and X ended a": "(not ended a W ended b) and X ended a",
    "ended a R ended b or F ended a": "(ended a R ended b) or <> ended a",
    "[] (ended a <-> <> ended b)": "[] ((not ended a or <> ended b) and (not <> ended b or ended a))",
    "forall u: UAV . <> u in base0": "<> uav0 in base0 and <> uav1 in base0",
    "exists u: UAV . u in base0 U ended a": "(uav0 in base0 U ended a) or (uav1 in base0 U ended a)",
    "forall x: Location . exists u: UAV . [] u in x": "[] uav0 in base0 or [] uav1 in base0",
    "taken sense a leads to taken b": "[] (not taken sense a or <> taken b)",
    "enabled agents or taken env or taken environment": "enabled agents or taken env or taken environment",
    "ended a and ended b": "ended a and ended b",
}
BRANCHING = {
    "AG EF ended a": "A [] E <> ended a",
    "A G ended a": "A [] ended a",
    "AX not EX ended a": "A X not E X ended a",
    "A (ended a U ended b)": "A (ended a U ended b)",
    "E (ended a W ended b)": "E (ended a W ended b)",
    "A always ended a": "A [] ended a",
    "E eventually ended a or ended b": "E <> (ended a or ended b)",
    "ended a leads to ended b": "A [] (not ended a or A <> ended b)",
    "AG (enabled sense a -> EX ended a)": "A [] (not enabled sense a or E X ended a)",
}


@pytest.mark.parametrize("text", [*LINEAR, *BRANCHING])
def test_a_formula_means_and_its_layout_says_the_same(text):
    logic, meaning = ("ltl", LINEAR[text]) if text in LINEAR else ("ctl", BRANCHING[text])
    assert formula(text, logic) == meaning
    once = format_mission(f'check {{ {logic} "q": {text} }}')
    assert format_mission(once) == once
    again = once.split(":", 1)[1].rsplit("}", 1)[0]
    assert formula(again, logic) == meaning


def test_a_kind_without_entities_gives_what_no_conjunct_and_no_disjunct_give():
    world = WORLD.replace("kind UAV driven", "kind UAV driven kind Buoy")
    text = "(forall x: Buoy . <> x in base0) and (exists x: Buoy . <> x in base0)"
    assert formula(text, world=world) == "true and false"


@pytest.mark.parametrize("letter", ["A", "E", "F", "G", "X", "AG", "EF"])
def test_a_letter_that_a_claim_begins_with_is_a_name(letter):
    text = f'check {{ ctl "q": AG ({letter} in {letter} and {letter}.x == 3 and {letter} linked n) }}'
    mission = parse(Source("m", text))
    assert [each.text for each in s.walk(mission) if isinstance(each, s.Name)] == [
        *(letter, letter, letter, "x", letter, "n")
    ]


FAIRNESS = {
    "weak fairness of a": [t.Fairness(False, t.Steps((), "a"), (), "a")],
    "strong fairness of sense a": [t.Fairness(True, t.Steps(("sense",), "a"), (), "sense a")],
    "weak fairness of sense": [t.Fairness(False, t.Steps(("sense",)), ("agent",), "sense")],
    "weak fairness of agents": [t.Fairness(False, t.Steps(), ("agent",), "agents")],
    "weak fairness of rules": [t.Fairness(False, t.Steps(), ("agent", "rule"), "rules")],
    "weak fairness of requests": [t.Fairness(False, t.Steps(t.SERVES), ("label",), "requests")],
    "weak fairness of environment": [t.Fairness(False, t.Steps(t.ENVIRONMENTS), (), "environment")],
    "weak fairness of env": [t.Fairness(False, t.Steps(("env",)), ("label",), "env")],
    "weak fairness of migrate a and strong fairness of spawn, b": [
        t.Fairness(False, t.Steps(("migrate",), "a"), (), "migrate a"),
        t.Fairness(True, t.Steps(("spawn",)), ("agent",), "spawn"),
        t.Fairness(True, t.Steps((), "b"), (), "b"),
    ],
}


@pytest.mark.parametrize("text", FAIRNESS)
def test_fairness_means(text):
    for prop in (f'ltl "q" under {text}: ended a', f"progress under {text}"):
        assert checked(prop).fairness == tuple(FAIRNESS[text])


def test_progress_may_have_a_name():
    assert [checked(text).name for text in ("progress", 'progress "served"')] == ["progress", "served"]
    assert checked("progress").kind == "progress"


@pytest.mark.parametrize(
    ("prop", "code"),
    [
        ('invariant "q": [] ended a', "LS611"),
        ('reachable "q": E (ended a U ended b)', "LS611"),
        ('ltl "q": AG ended a', "LS611"),
        ('ctl "q": [] ended a', "LS611"),
        ('ctl "q": A ended a', "LS611"),
        ('ctl "q": EF taken a', "LS611"),
        ('ctl "q": A infinitely often ended a', "LS611"),
        ('ltl "q": forall u: UAV . taken say a', "LS611"),
        ('ltl "q": ' + "".join(f"forall x{n}: UAV . " for n in range(16)) + "<> x0 in base0", "LS607"),
        ('ltl "q": ' + "X " * 33 + "ended a", "LS607"),
    ],
)
def test_an_operator_of_another_logic_and_a_formula_that_comes_to_too_much_are_refused(prop, code):
    assert code in [each for each, *_ in told(f"{WORLD}check {{ {prop} }}")]


def test_the_missions_of_the_page_are_in_canonical_layout():
    page = (DOCS / "temporal.md").read_text(encoding="utf-8")
    blocks = re.findall(r"```mission\n(.*?)```", page, re.DOTALL)
    assert blocks
    assert [format_mission(block) for block in blocks] == blocks
