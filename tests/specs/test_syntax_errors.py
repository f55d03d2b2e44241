"""Bad snippets and the names of their mistakes: the table that lark's `match_examples` would be given."""

import re

import pytest
from elaborating import mistakes

from specs.codes import Code
from specs.grammar import spellings

IN_BEHAVIOUR = "def f() = {{ {} }}"
IN_WORLD = "world {{ {} }}"
IN_CHECK = 'check {{ invariant "x": {} }}'
IN_ENVIRONMENT = "environment {{ {} }}"

TABLE = [
    (Code.MISSING_ARROW, IN_BEHAVIOUR, "react { case x display(x) }"),
    (Code.MISSING_ARROW, IN_BEHAVIOUR, 'react { case "handover" control(MOVE_HOST_TO a) }'),
    (Code.MISSING_ARROW, IN_BEHAVIOUR, "react { case x: Observation if a in x skip }"),
    (Code.MISSING_ARROW, IN_BEHAVIOUR, "match x { case (a, b) = skip }"),
    (Code.SINGLE_EQUALS, IN_BEHAVIOUR, "if f(x) = 3 { skip }"),
    (Code.SINGLE_EQUALS, IN_BEHAVIOUR, "while a of K = b { skip }"),
    (Code.SINGLE_EQUALS, IN_BEHAVIOUR, "react { case x if x = 2 => skip }"),
    (Code.SINGLE_EQUALS, IN_BEHAVIOUR, "let x = y = 3"),
    (Code.SINGLE_EQUALS, IN_CHECK, "a.x = 3"),
    (Code.MISSING_DESTINATION, IN_BEHAVIOUR, "control(HAND uav0)"),
    (Code.MISSING_DESTINATION, IN_BEHAVIOUR, "control(CONNECT_HOST_TO)"),
    (Code.MISSPELT_KEYWORD, IN_BEHAVIOUR, "whlie x in y { skip }"),
    (Code.MISSPELT_KEYWORD, IN_BEHAVIOUR, "react { cas x => skip }"),
    (Code.MISSPELT_KEYWORD, IN_WORLD, "chanel wifi"),
    (Code.MISSPELT_KEYWORD, IN_ENVIRONMENT, "uav0 drift among a"),
    (Code.MISSPELT_KEYWORD, IN_ENVIRONMENT, 'somone says "x"'),
    (Code.MISSPELT_KEYWORD, "{}", "bigactor a hosted_at b with_behavior { }"),
    (Code.MISSPELT_KEYWORD, "check {{ {} }}", 'reachabel "x": true'),
    (Code.MISSING_COMMA, IN_BEHAVIOUR, 'send("x" a)'),
    (Code.MISSING_COMMA, IN_BEHAVIOUR, "let x = (a b)"),
    (Code.RESERVED_WORD, IN_BEHAVIOUR, "for loop in x { skip }"),
    (Code.RESERVED_WORD, "signature {{ {} }}", "kind HOST"),
    (Code.RESERVED_WORD, "world {{ a: B = point (0, 0) linked w {} }}", ", true- b"),
    (Code.MISSING_BRACE, IN_BEHAVIOUR, "if a skip"),
    (Code.MISSING_BRACE, "{}", "world a: B"),
    (Code.MISSING_UNIT, IN_WORLD, "a: B = point (1, 2) altitude 100 to 300 m"),
    (Code.BAD_NUMBER, IN_WORLD, "a: B = point (.5, 2)"),
    (Code.BAD_NUMBER, IN_WORLD, "a: B = point (inf, 2)"),
    (Code.BAD_NUMBER, IN_WORLD, 'from "x" limit many'),
    (Code.BAD_COORDINATE, IN_WORLD, "a: B = box (1, 2)"),
    (Code.BAD_COORDINATE, IN_WORLD, "a: B = point (37.1 N, 2)"),
    (Code.BAD_COORDINATE, IN_WORLD, "a: B = point (N37°8', 2)"),
    (Code.BAD_COORDINATE, IN_WORLD, "a: B = point (37:08:49, 2)"),
    (Code.MISSING_COMMA, IN_WORLD, "a: B = point (37 08 49, 2)"),
    (Code.CHAINED_COMPARISON, IN_BEHAVIOUR, "let x = a in b in c"),
    (Code.UNKNOWN_CHARACTER, IN_BEHAVIOUR, "display('x')"),
    (Code.UNEXPECTED, IN_ENVIRONMENT, "3 4"),
    (Code.UNOPENED_BRACKET, IN_BEHAVIOUR, "display(x))"),
    (Code.UNCLOSED_BRACKET, IN_BEHAVIOUR, "display({a, b)"),
]


@pytest.mark.parametrize(("code", "frame", "snippet"), TABLE, ids=[snippet for _, _, snippet in TABLE])
def test_a_bad_snippet_has_its_mistake_named_and_no_terminal_of_the_grammar(code, frame, snippet):
    (found,) = mistakes(frame.format(snippet))
    assert found.code is code
    names = {name for name in spellings() if not name.isalpha() or name not in set(spellings().values())}
    said = set(re.findall(r"\w+", found.message + found.hint)) - set(re.findall(r"\w+", snippet))
    assert not said & (names - set(spellings().values()) - {"NAME"})


def test_a_section_within_a_block_points_at_the_block_that_is_open():
    text = "BigActor a hosted_at b with_behavior {\n  loop {\n    skip\n  }\n\nenvironment {\n}\n"
    (found,) = mistakes(text)
    assert found.code is Code.UNCLOSED_BRACKET
    assert found.span.start == text.index("{")


def test_at_the_end_the_hint_says_which_bracket_is_open():
    (found,) = mistakes("def f() = {\n  loop {\n    skip\n  }\n")
    assert found.code is Code.UNEXPECTED_END
    assert found.hint == "the '{' of line 1, column 11 is still open"


@pytest.mark.parametrize(
    ("snippet", "message"),
    [
        ("x 3", "expected '(' or '=', found '3'"),
        ("observe()", "expected a query, found ')'"),
        ("display()", "expected an expression, found ')'"),
        ("=>", "expected a statement or '}', found '=>'"),
    ],
)
def test_what_was_expected_is_said_in_the_words_of_the_language(snippet, message):
    assert [found.message for found in mistakes(IN_BEHAVIOUR.format(snippet))] == [message]
