"""What the parser makes of each construct, where it says things stand, and how it stays bounded."""

import time
from pathlib import Path

import pytest

from specs import syntax as s
from specs.codes import Code
from specs.diagnostics import MissionError, Source
from specs.parser import parse, parse_bytes

CORPUS = Path(__file__).parents[1] / "corpus"


def read(text):
    return parse(Source("m", text))


def statement(text):
    return read(f"def f() = {{ {text} }}").declarations[0].body[0]


def expression(text):
    return statement(f"let q = {text}").value


def formula(text):
    return read(f'check {{ invariant "q": {text} }}').declarations[0].properties[0].formula


def n(text):
    return s.Name(text)


def code_of(text):
    with pytest.raises(MissionError) as caught:
        read(text)
    return caught.value.diagnostics[0].code


def corpus(name):
    return parse_bytes(name, (CORPUS / "ok" / name).read_bytes())[1]


LINKED = s.Observe(s.QueryApplication("LINKED_TO", s.HostReference()))
OBSERVED = s.Case(s.ObservationPattern(n("obs")), None, (s.Display(n("obs")), LINKED))
HANDED = s.Control(s.Command("HAND", (n("uav0"), n("gcs0"))))
HANDOVER = s.Case(s.LiteralPattern(s.TextLiteral("handover")), None, (HANDED,))
FIGURE_8 = s.BigActor(None, n("gcs2"), (LINKED, s.Loop((s.React((OBSERVED, HANDOVER)),))))


@pytest.mark.parametrize("name", ["figure8", "figure8_numbered", "figure8_from_one"])
def test_figure_8_of_the_paper_parses_with_and_without_its_line_numbers(name):
    assert corpus(f"{name}.mission").each(s.BigActor) == (FIGURE_8,)


def test_line_numbers_are_numbers_where_they_do_not_count_on():
    text = "0 BigActor hosted_at g with_behavior {\n1 x =\n2\n}"
    assert code_of(text) is Code.UNEXPECTED  # blanked out, so that nothing stands behind the '='
    assert read("BigActor hosted_at g with_behavior { x =\n2\n}").each(s.BigActor)[0].body == (
        s.Assign(n("x"), s.IntegerLiteral(2)),
    )


def test_spans_are_exact():
    text = "world {\n  uav0: UAV = point (37.08, -8.55)\n}"
    mission = read(text)
    entity = mission.declarations[0].entries[0]
    assert text[entity.span.start : entity.span.end] == "uav0: UAV = point (37.08, -8.55)"
    assert text[entity.kind.span.start : entity.kind.span.end] == "UAV"
    longitude = entity.placement.geometry.position
    assert text[longitude.span.start : longitude.span.end] == "(37.08, -8.55)"


def test_every_part_lies_within_its_node():
    for path in sorted((CORPUS / "ok").glob("*.mission")):
        mission = parse_bytes(path.name, path.read_bytes())[1]
        for node in s.walk(mission):
            for part in s.parts(node):
                assert node.span.start <= part.span.start <= part.span.end <= node.span.end


def test_equality_does_not_depend_on_where_something_stands():
    assert read("scheduler fcfs") == read("// moved\n\n scheduler   fcfs ;")


def test_arithmetic_binds_tighter_than_comparison_and_that_tighter_than_connectives():
    assert expression("not a in b + c && d or -e == f of K") == s.BinaryOperation(
        "or",
        s.BinaryOperation(
            "and",
            s.UnaryOperation("not", s.BinaryOperation("in", n("a"), s.BinaryOperation("+", n("b"), n("c")))),
            n("d"),
        ),
        s.BinaryOperation("==", s.UnaryOperation("-", n("e")), s.OfKind(n("f"), n("K"))),
    )


def test_a_quantifier_reaches_as_far_as_it_can():
    assert formula("forall x: K . known x and known y") == s.Quantified(
        "forall", n("x"), n("K"), s.Connective("and", s.Known(n("x")), s.Known(n("y")))
    )


def test_implication_associates_to_the_right():
    known = {name: s.Known(n(name)) for name in "abc"}
    assert formula("known a -> known b -> known c") == s.Connective(
        "->", known["a"], s.Connective("->", known["b"], known["c"])
    )


def test_both_ways_of_sending_and_of_choosing_are_one():
    assert statement('send "x" to a') == statement('send("x", a)') == s.Send(s.TextLiteral("x"), n("a"))
    assert statement("choose { case => skip case => }") == statement("choose { skip } or { }")


def test_a_behaviour_may_be_given_by_a_call():
    actor = read("BigActor a hosted_at u with_behavior visit(b)").declarations[0]
    assert actor.body == (s.Call(n("visit"), (n("b"),)),)


def test_contextual_words_are_names_elsewhere():
    called = s.FunctionCall(n("linked"), (n("point"), n("box"), s.IntegerLiteral(3)))
    assert statement("kind = linked(point, box, 3)") == s.Assign(n("kind"), called)
    assert statement("letter = 1") == s.Assign(n("letter"), s.IntegerLiteral(1))


def test_channels_may_have_colons_dashes_and_begin_with_a_digit():
    (environment,) = read(
        "environment { control:gcs0 drops 3g drops and returns u leaves wifi-1 }"
    ).declarations
    assert environment.clauses == (
        s.Drops(n("control:gcs0")),
        s.Drops(n("3g"), True),
        s.Leaves(n("u"), n("wifi-1")),
    )


def test_rule_bodies_come_with_their_terms_and_offsets():
    text = "rule r { a.$0 // from\n -> b.$0 }"
    body = read(text).declarations[0].body
    assert str(body.term) == "a.$0 -> b.$0"
    assert body.text == "a.$0 -> b.$0"
    assert text[body.raw_start : body.raw_start + 5] == body.raw[:5] == " a.$0"


def test_mistakes_in_rule_bodies_are_all_reported_in_order():
    with pytest.raises(MissionError) as caught:
        read("rule a { u[ -> }\nrule b { u -> v }\nrule c { u -> $7 }")
    assert [item.code for item in caught.value.diagnostics] == [Code.RULE_SYNTAX] * 2


def test_the_true_end_is_reported_and_not_the_last_word():
    text = "def f() = {\n  skip\n\n// comment\n"
    with pytest.raises(MissionError) as caught:
        read(text)
    assert caught.value.diagnostics[0].span.start == text.index("skip") + 4


@pytest.mark.parametrize(
    "text",
    [
        "def f() = { let x = " + "(" * 10_000 + ")" * 10_000 + "}",
        "a" * 5_000_000,
        "a" * 900_000,
        '"' * 900_000,
        '"' + '\\"' * 400_000,
        "def f() = {" + "visit(a, b)\n" * 75_000 + "}",
        "def f() = { let x = " + "- " * 50_000 + "1}",
        "def f() = { " + "if a {} else " * 10_000 + "{} }",
        'check { invariant "x": ' + "known a -> " * 25_000 + "true }",
        "rule a { a -> }\n" * 8_000,
        "".join(f"{number} BigActor\n" for number in range(50_000)),
        "#" * 900_000 + "\n{ " + " " * 90_000,
        "0" + " " * 900_000 + "BigActor",
    ],
    ids=lambda text: text[:24],
)
def test_hostile_texts_are_refused_in_bounded_time(text):
    started = time.perf_counter()
    with pytest.raises(MissionError):
        read(text)
    assert time.perf_counter() - started < 20  # about 3 s at most on an idle machine


def test_deep_trees_that_are_accepted_can_be_compared_hashed_and_printed():
    mission = read("def f() = {" + "loop {" * 197 + "}" * 198)
    assert mission == read("def f() = {" + "loop { " * 197 + "}" * 198)
    assert hash(mission)
    assert repr(mission)


@pytest.mark.parametrize(
    ("written", "position"),
    [
        ("37°08'49\"N, 8°35'W", (37 + 8 / 60 + 49 / 3600, -(8 + 35 / 60))),
        ("37°8.82'S, 8.5°E", (-(37 + 8.82 / 60), 8.5)),
        ("37º 08′ 49.5″ N, -8.5", (37 + 8 / 60 + 49.5 / 3600, -8.5)),
        ("37° 8’ 30’’ N, 8°0'30\"W", (37 + 8 / 60 + 30 / 3600, -30 / 3600 - 8)),
    ],
)
def test_degrees_minutes_and_seconds_are_a_position(written, position):
    (world,) = read(f"world {{ a: B = point ({written}) }}").declarations
    found = world.entries[0].placement.geometry.position
    assert (found.latitude, found.longitude) == pytest.approx(position, abs=1e-12)


@pytest.mark.parametrize("angle", ["37°60'N", "37°08'60\"N", "37..1°N", "37°1.'N"])
def test_what_is_no_angle_is_refused(angle):
    assert code_of(f"world {{ a: B = point ({angle}, 8) }}") is Code.BAD_COORDINATE


def test_an_angle_without_an_end_takes_no_time():
    text = "world { a: B = point (" + " ".join(["1." * 4000] * 100) + " }"
    start = time.perf_counter()
    code_of(text)
    assert time.perf_counter() - start < 5  # it would be hours if it were looked at from each of its digits
