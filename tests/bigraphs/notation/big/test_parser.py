import pytest
from big_strategies import expressions, models, values
from hypothesis import given
from hypothesis import strategies as st
from scale import examples

from bigraphs.errors import NotationError
from bigraphs.notation.big.parser import parse_expression, parse_model
from bigraphs.notation.big.printer import format_expression, format_model, format_value
from bigraphs.notation.big.syntax import Arithmetic, Chain, Ion, Literal, Negated, Repeat, Variable


def value(text):
    return parse_expression(f"K({text})").arguments[0]


@given(expressions)
def test_expressions_are_read_back_as_written(expression):
    assert parse_expression(format_expression(expression)) == expression


@given(values)
def test_values_are_read_back_as_written(expression):
    assert value(format_value(expression)) == expression


@examples(60)
@given(models)
def test_files_are_read_back_as_written(model):
    assert parse_model(format_model(model)) == model


def test_operators_bind_as_in_bigrapher():
    assert parse_expression("a | b || c") == parse_expression("(a) | b || (c)")
    assert parse_expression("a | b + c * d") == parse_expression("a | (b + (c * d))")
    assert parse_expression("/x a | b") == parse_expression("(/x a) | b")
    assert parse_expression("A.B.1 | b") == parse_expression("(A.(B.1)) | b")
    assert parse_expression("merge(2) + split") == parse_expression("([{0}, {0}], 1) + ([{0, 1}], 2)")
    assert parse_expression("share a by b in c | d") == parse_expression("(share a by b in c) | d")
    assert parse_expression("(a)(b)") == parse_expression("a * b")
    assert parse_expression("/x share a by b in c") == parse_expression("/x (share a by b in c)")


def test_signs_and_powers_of_numbers_bind_as_in_bigrapher():
    assert value("1 + 2 * 3") == Arithmetic(
        Literal(1), (("+", Arithmetic(Literal(2), (("*", Literal(3)),))),)
    )
    assert value("2 ^ 3 ^ n") == value("2 ^ (3 ^ n)")
    assert value("-2 ^ 2") == Negated(value("2 ^ 2"))
    assert value("1 - 2 - 3") == Arithmetic(Literal(1), (("-", Literal(2)), ("-", Literal(3))))


def test_numbers_and_strings_are_told_apart():
    assert [value(text) for text in ("1_000", "1.", "2.5e-1", "inf", '"a b"', "info")] == [
        Literal(1000),
        Literal(1.0),
        Literal(0.25),
        Literal(float("inf")),
        Literal("a b"),
        Variable("info"),
    ]
    assert isinstance(value("1.").value, float)


def test_a_repetition_takes_any_expression():
    found = parse_expression("ppar(n + 1, /x A{x} | b)")
    assert isinstance(found, Repeat)
    assert isinstance(found.body, Chain)
    assert parse_expression("par_1") == parse_expression("(par_1)")


def test_spaces_and_comments_mean_nothing():
    assert parse_expression("A ( 1 ) { x }# a comment\n") == Ion("A", ("x",), (Literal(1),))
    assert parse_expression("/x/y a") == parse_expression("/x /y a")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("ctrl A = 99999999999999999999999;", "a number of 23 digits is too large"),
        ("ctrl A = 4611686018427387904;", "a number of 19 digits is too large"),
        ("big b = merge(20001);", "a bigraph of more than 20000 parts"),
        ("big b = K(1e999);", "1e999 is too large"),
        ("big end = 1;", "'end' is a word of the language"),
        ("atomic passive ctrl A = 0;", "'atomic passive' does not go together"),
        ("ctrl A = 0", "the text ends, expected ';'"),
        ("big b = K(" + "-" * 300 + "1);", "signs and powers nest deeper than 50"),
        ("big b = K(" + "2^" * 300 + "1);", "signs and powers nest deeper than 50"),
        ("react r = A --> B if A in there;", "found 'there', expected 'ctx' or 'param'"),
    ],
)
def test_what_does_not_parse_is_told_in_the_users_words(text, message):
    with pytest.raises(NotationError) as found:
        parse_model(text)
    assert found.value.message == message


def test_words_of_the_language_beyond_bigrapher_may_be_names():
    model = parse_model("big place = 1; big sort = place; big link = sort; ordered ctrl A = 0;")
    assert format_model(model).startswith("big place = 1;\nbig sort = place;")


def test_a_guarded_number_is_refused_by_name():
    text = "atomic fun ctrl Num(n) = 0; react r = Num([n, $ >= 0]) --> Num(n);"
    with pytest.raises(NotationError) as caught:
        parse_model(text)
    assert caught.value.message == "'[n, $ >= 0]' guards a number, as no published BigraphER does"
    assert (
        caught.value.hint
        == "write 'n' in 'fun react r(n)', and list in the system the values that '$ >= 0' admits"
    )
    assert caught.value.offset == text.index("[")


@given(st.text(st.sampled_from('aAB{}().|/10*+xid ,;=-[]>\n"^!@'), max_size=30))
def test_any_text_is_read_or_refused_with_a_place_in_it(text):
    for parse in (parse_model, parse_expression):
        assert all(0 <= offset <= len(text) for offset in offsets_of_mistakes(parse, text))


def offsets_of_mistakes(parse, text):
    try:
        parse(text)
    except NotationError as error:
        return [mistake.offset for mistake in error.mistakes]
    return []
