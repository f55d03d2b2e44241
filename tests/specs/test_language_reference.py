"""The language reference is complete, and all that it shows parses."""

import re

import pytest

from semantics.behaviours.commands import COMMANDS, WAY
from semantics.behaviours.observations import QueryOperator
from specs import syntax as s
from specs.construct_text import write
from specs.diagnostics import Source
from specs.formatter import format_mission
from specs.language_reference import EXAMPLES, NODES, forms, grammar_parts, language_reference
from specs.parser import parse

FRAMES = {
    "Geometry": "world {{ a: B = {} }}",
    "Statements": "def f() = {{ {} }}",
    "Patterns": "def f() = {{ react {{ case {} => skip }} }}",
    "Queries": "def f() = {{ observe({}) }}",
    "Control actions": "def f() = {{ control({}) }}",
    "Expressions": "def f() = {{ let q = {} }}",
    "Formulas": 'check {{ invariant "q": {} }}',
    "World": "world {{ {} }}",
    "Beliefs": "believes {{ {} }}",
    "Signature": "signature {{ {} }}",
    "Environment": "environment {{ {} }}",
    "Checks": "check {{ {} }}",
    "Timing": "timing {{ {} }}",
    "Live runs": "live {{ {} }}",
}
SPECIAL = {
    s.AltitudeBand: "world {{ a: B = point (1, 2) {} }}",
    s.Length: "world {{ a: B = circle (1, 2) radius {} }}",
    s.Duration: "live {{ a within {}: hold }}",
    s.Speed: "timing {{ a flies at {} }}",
    s.Speeds: "timing {{ a flies at {} }}",
    s.Lapse: "timing {{ sense {} }}",
    s.Coordinate: "world {{ a: B = point {} }}",
    s.Keep: 'world {{ from "x" keep {} }}',
    s.Parameter: "rule r({}) {{ a -> b }}",
    s.RuleBody: "rule r {}",
    s.Case: "def f() = {{ react {{ {} }} }}",
    s.After: "def f() = {{ react {{ {} }} }}",
    s.Steps: 'check {{ ltl "q": taken {} }}',
    s.Fairness: "check {{ progress under {} }}",
    s.Alternative: "def f() = {{ choose {{ {} }} }}",
}
SECTIONS = {s.Signature, s.World, s.Believes, s.Environment, s.Check, s.Timing, s.Live, s.Mission}


def concrete(form):
    form = re.sub(
        r"\b[FG]\b",
        "known f",
        re.sub(r"\{ (kind )?\.\.\. \}", "{}", form).replace("case ...", "case => skip"),
    )
    return (
        form.replace("statements", "skip")
        .replace("=> ...", "=> skip")
        .replace("react { case => ", "react { case x => ")
        .replace("(r)", "(MOVE_HOST_TO r)")
    )


@pytest.mark.parametrize(
    ("heading", "node"), [(heading, node) for heading, nodes in NODES.items() for node in nodes]
)
def test_the_form_that_is_shown_of_a_construct_reads_as_that_construct(heading, node):
    form = concrete(forms(node)[0])
    if node is s.Match:
        form = form.replace("case => skip", "case x => skip")
    frame = "{}" if node in SECTIONS else SPECIAL.get(node, FRAMES.get(heading, "{}"))
    mission = parse(Source(form, frame.format(form)))
    assert any(isinstance(part, node) for part in s.walk(mission))
    assert parse(Source("again", format_mission(frame.format(form)))) == mission


def test_the_form_of_a_query_shows_every_operator():
    assert forms(s.QueryApplication) == tuple(f"{operator}(q)" for operator in QueryOperator)


@pytest.mark.parametrize("command", COMMANDS.values(), ids=COMMANDS)
def test_a_command_is_in_the_reference_and_reads_as_it_is_shown(command):
    way = command.write(command.operands, WAY)
    for form in (command.form, way) if command.travels else (command.form,):
        assert f"`{form}`" in language_reference()
        (found,) = (
            each
            for each in s.walk(parse(Source("m", f"def f() = {{ control({form}) }}")))
            if isinstance(each, s.Command)
        )
        assert (found.name, write(found)) == (command.name, form)


@pytest.mark.parametrize("heading", EXAMPLES)
def test_an_example_parses_and_is_in_canonical_layout(heading):
    assert format_mission(EXAMPLES[heading]) == EXAMPLES[heading]


def test_every_heading_of_the_grammar_but_the_words_is_explained():
    assert [heading for heading, _ in grammar_parts() if not NODES[heading]] == ["Words"]


def test_every_construct_is_in_the_reference():
    concrete_nodes = {
        node for name in s.__all__ if isinstance(node := getattr(s, name), type) and issubclass(node, s.Node)
    }
    assert concrete_nodes - {s.Node} == {node for nodes in NODES.values() for node in nodes}


def test_the_page_shows_no_inner_names_of_the_grammar():
    page = language_reference()
    for block in re.findall(r"```ebnf\n(.*?)```", page, re.DOTALL):
        assert not re.search(r'(?<!["\w])[?_][a-z]|->(?!")|";"', block), block
