"""How much of a mission is read in spite of its mistakes, and that no mistake is reported twice."""

import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scale import examples

from specs import syntax as s
from specs.codes import Code
from specs.diagnostics import MissionError, Source
from specs.parser import parse, read
from specs.recovery import MOST_MISTAKES

MISSIONS = sorted((Path(__file__).parents[2] / "specs/missions").glob("*.mission"))
IN_BEHAVIOUR = "BigActor a hosted_at u with_behavior {{\n  observe(HOST)\n  {}\n  skip\n}}\nscheduler fcfs\n"


def recovered(text):
    return read(Source("m", text))


def codes(text):
    return [mistake.code for mistake in recovered(text).mistakes]


def unread(text):
    return [text[span.start : span.end].strip() for span in recovered(text).unread]


def statements(text):
    (actor,) = recovered(text).mission.each(s.BigActor)
    return [type(statement).__name__ for statement in actor.body]


def declared(text):
    return [type(each).__name__ for each in recovered(text).mission.declarations]


def test_mistakes_in_two_declarations_are_both_reported():
    text = "signature {\n  kind A drivn\n}\nworld {\n  a: A = point (37.0 -8.5)\n  b: A\n}\n"
    assert codes(text) == [Code.MISSPELT_KEYWORD, Code.MISSING_COMMA]
    assert [entry.name.text for entry in recovered(text).mission.declarations[1].entries] == ["b"]


BRACES = ["loop {", "loop observe(HOST) }", "loop { } }", "react { case x => {"]


@pytest.mark.parametrize(
    "statement",
    [
        *BRACES,
        "let x = ",
        "if x = y { observe(ALL) }",
        "if x = y { observe(ALL) } else { skip }",
        "let if = 3",
        "for loop in x { skip }",
        "observe(CHILDREN(PARENT(HOST)",
        "send x toa b",
        "display('x')",
        'display("x)',
        "choose { case skip }",
        "react {\n    case x display(x)\n  }",
        "@ $ %",
        "kind UAV",
        "whlie x { observe(ALL) }",
        "control(MOVE uav0)",
    ],
)
def test_a_mistake_in_a_statement_leaves_the_statements_around_it(statement):
    text = IN_BEHAVIOUR.format(statement)
    assert len(codes(text)) == 1
    assert statements(text)[:1] == ["Observe"]
    assert statement in BRACES or statements(text)[-1:] == ["Skip"]
    assert len(recovered(text).mission.each(s.Scheduler)) == 1


def test_a_mistake_in_a_case_leaves_the_other_cases():
    text = IN_BEHAVIOUR.format("react {\n    case x Observation => skip\n    case y => skip\n  }")
    (actor,) = recovered(text).mission.each(s.BigActor)
    assert [case.pattern.variable.text for case in actor.body[1].cases] == ["y"]


def test_a_section_within_another_costs_one_mistake():
    text = "world {\n  a: A\n  environment {\n    a vanishes\n  }\n}\nscheduler fcfs\n"
    assert codes(text) == [Code.UNCLOSED_BRACKET]
    assert declared(text) == ["World", "Environment", "Scheduler"]


def test_a_declaration_that_the_end_of_the_file_cuts_short_is_kept():
    text = "BigActor a hosted_at u with_behavior {\n  observe(HOST)\n  loop {\n    skip\n    let x"
    assert codes(text) == [Code.UNEXPECTED_END]
    assert statements(text) == ["Observe", "Loop"]
    assert unread(text) == ["let x"]


def test_one_wrong_line_number_is_one_mistake():
    text = "0 BigActor a hosted_at u with_behavior {\n1   skip\n3   skip\n4   skip\n5 }\nscheduler fcfs\n"
    assert codes(text) == [Code.UNEXPECTED]
    assert len(recovered(text).mission.each(s.Scheduler)) == 1


def test_an_option_that_does_not_exist_leaves_the_rest():
    text = "scheduler fast\ncontrol slow\nlive {\n  on broken assumption: explode\n}\nscheduler fcfs\n"
    assert codes(text) == [Code.UNKNOWN_OPTION] * 3
    assert declared(text) == ["Live", "Scheduler"]


def test_what_is_unread_begins_with_the_item_that_the_mistake_is_in():
    text = "signature {\n  kind A\n  kind UAV drivn\n}\n"
    assert unread(text) == ["kind UAV drivn"]


def test_a_body_of_a_rule_is_no_reason_to_leave_the_rule_out():
    text = "rule land(u: UAV) { u || }\nscheduler slow\n"
    assert codes(text) == [Code.UNKNOWN_OPTION, Code.RULE_SYNTAX]
    assert [rule.name.text for rule in recovered(text).mission.each(s.Rule)] == ["land"]


def test_after_many_mistakes_the_rest_is_left_out():
    text = "world {\n" + "  a: @\n" * (MOST_MISTAKES + 10) + "}\nscheduler fcfs\n"
    assert codes(text) == [Code.UNKNOWN_CHARACTER] * MOST_MISTAKES
    assert recovered(text).mission.each(s.Scheduler) == ()


WORDS = st.sampled_from(
    [*'(){}[];,:=@"', "case", "loop", "environment {", "\n", "HOST", "x", "3", "or", "check"]
)


@examples(300, deadline=None)
@given(st.sampled_from(MISSIONS), st.data())
def test_whatever_is_wrong_is_reported_and_the_rest_is_a_tree(path, data):
    text = path.read_text(encoding="utf-8")
    for _ in range(data.draw(st.integers(1, 3))):
        at = data.draw(st.integers(0, len(text)))
        text = text[:at] + data.draw(WORDS) + text[at + data.draw(st.integers(0, 12)) :]
    found = recovered(text)
    assert bool(found.unread) <= bool(found.mistakes)
    words = {
        word for of in (r"[^\W\d]\w*", r"[\w:.\-]+", r"\w+(?:[:.\-]\w+)*") for word in re.findall(of, text)
    }
    assert {node.text for node in s.walk(found.mission) if isinstance(node, s.Name)} <= words
    if found.mistakes:
        with pytest.raises(MissionError) as caught:
            parse(Source("m", text))
        assert set(caught.value.diagnostics) == set(found.mistakes)
