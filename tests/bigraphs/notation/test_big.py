import pytest
from bigraph_strategies import SIGNATURE, bigraphs
from hypothesis import given
from hypothesis import strategies as st

from bigraphs.canonical import equal
from bigraphs.errors import BigraphError, NotationError
from bigraphs.notation.big_elaboration import read_big, read_theory
from bigraphs.notation.big_expression import write_big
from bigraphs.notation.big_parser import parse_expression, parse_model
from bigraphs.notation.big_printer import format_expression, format_model
from bigraphs.notation.big_syntax import (
    BigDeclaration,
    Chain,
    Close,
    ControlDeclaration,
    Identity,
    Ion,
    Model,
    Nest,
    NewNames,
    Number,
    Placed,
    PriorityClass,
    ReactDeclaration,
    Ref,
    Share,
    Substitute,
    System,
    Wired,
)
from bigraphs.relations import from_relations
from bigraphs.rewriting import successors

words = st.sampled_from(["x", "y", "a_b", "net'"])
some_names = st.lists(words, min_size=1, max_size=2).map(tuple)
ions = st.builds(Ion, st.sampled_from(["A", "Loc", "B'"]), st.lists(words, max_size=2).map(tuple))
sets = st.lists(st.lists(st.integers(0, 3), max_size=2).map(tuple), max_size=3).map(tuple)
leaves = st.one_of(
    ions,
    st.builds(Ref, words),
    st.builds(Number, st.integers(0, 1)),
    st.builds(Identity, st.integers(0, 3), st.just(())),
    st.builds(Identity, st.integers(0, 3), some_names),
    st.builds(Placed, sets, st.integers(0, 4)),
    st.builds(Close, some_names),
    st.builds(Substitute, words, some_names),
    st.builds(NewNames, some_names),
)
wires = st.lists(
    st.builds(Close, some_names) | st.builds(Substitute, words, some_names), min_size=1, max_size=2
)


def chains(operand):
    levels = st.sampled_from([("|", "||"), ("+",), ("*",)])
    return levels.flatmap(
        lambda operators: st.builds(
            Chain,
            operand,
            st.lists(st.tuples(st.sampled_from(operators), operand), min_size=1, max_size=3).map(tuple),
        )
    )


expressions = st.recursive(
    leaves,
    lambda inner: st.one_of(
        st.builds(Nest, ions, inner),
        st.builds(Wired, wires.map(tuple), inner),
        chains(inner),
        st.builds(Share, inner, inner, inner),
    ),
    max_leaves=8,
)
declarations = st.one_of(
    st.builds(ControlDeclaration, st.sampled_from(["A", "B"]), st.integers(0, 9), st.booleans()),
    st.builds(BigDeclaration, words, expressions),
    st.builds(ReactDeclaration, words, expressions, expressions, st.none() | st.just((0, 1)) | st.just(())),
)
classes = st.builds(PriorityClass, some_names, st.booleans())
systems = st.builds(
    System, words, st.lists(classes, min_size=1, max_size=2).map(tuple), st.just(()) | some_names
)

THEORY = """
# A vehicle moves between places.
atomic ctrl UAV = 1;
ctrl Loc = 0;

big start = /g (Loc.(UAV{g} | id) | Loc.1) * (Loc.1 || 1);
big s0 = /g (Loc.UAV{g} | Loc.1);
react move = Loc.(UAV{x} | id) | Loc.id --> Loc.id | Loc.(UAV{x} | id);
begin brs
  init s0;
  rules = [ {move} ];
  preds = { s0 };
end
"""


@given(expressions)
def test_expressions_are_read_back_as_written(expression):
    assert parse_expression(format_expression(expression)) == expression


@given(st.builds(Model, st.lists(declarations, max_size=3).map(tuple), st.none() | systems))
def test_files_are_read_back_as_written(model):
    assert parse_model(format_model(model)) == model


@given(st.booleans().flatmap(lambda sharing: bigraphs(max_nodes=5, sharing=sharing)))
def test_elaborating_gives_back_the_bigraph_that_was_written(bigraph):
    assert equal(read_big(write_big(bigraph), SIGNATURE), bigraph)


def test_a_theory_is_elaborated_and_runs():
    theory = read_theory(THEORY.replace("big start = /g (Loc.(UAV{g} | id) | Loc.1) * (Loc.1 || 1);\n", ""))
    start = dict(theory.bigraphs)["s0"]
    ((_, after),) = successors(theory.rules[0], start)
    assert equal(after, start)  # the places are alike
    assert write_big(after) == "/e0 (Loc.1 | Loc.UAV{e0})"
    assert theory.system is not None
    assert theory.system.init == "s0"


def test_an_interface_that_does_not_fit_is_told_where_it_stands():
    with pytest.raises(NotationError) as found:
        read_theory(THEORY)
    assert found.value.render("move.big") == (
        "move.big:6:13: a context for <1, {}> does not fit a content of <2, {}>\n"
        "    6 | big start = /g (Loc.(UAV{g} | id) | Loc.1) * (Loc.1 || 1);\n"
        "      |             ^\n"
        "hint: extend one of them with an identity, or use nest"
    )


def test_operators_bind_as_in_bigrapher():
    assert parse_expression("a | b || c") == parse_expression("(a) | b || (c)")
    assert parse_expression("a | b + c * d") == parse_expression("a | (b + (c * d))")
    assert parse_expression("/x a | b") == parse_expression("(/x a) | b")
    assert parse_expression("A.B.1 | b") == parse_expression("(A.(B.1)) | b")
    assert parse_expression("merge(2) + split") == parse_expression("([{0}, {0}], 1) + ([{0, 1}], 2)")


def test_share_puts_one_node_into_several_places():
    text = "share (Z{a} || Z{b}) by ([{0, 1}, {1}], 2) in (id{a, b} | A | A)"
    found = read_big(text, SIGNATURE)
    assert sorted(len(node.parents) for node in found.nodes if node.control == "Z") == [1, 2]
    assert found.outer.names == ("a", "b")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "A.",
            "the text ends, expected '(', '/', 'id', 'merge', 'split', '{', a control, a name or a number",
        ),
        ("A B", "found 'B', expected '*', '+', '.', '{', '|' or the end"),
        ("unknown", "unknown bigraph 'unknown'"),
        ("Q", "unknown control 'Q'"),
        ("B", "B has 0 links, its control has 1 ports"),
        ("Z{x}.1", "a context for <0, {}> does not fit a content of <1, {}>"),
        ("/q A", "there is no outer name 'q' here"),
        ("7", "a number is no bigraph"),
        (
            "A | " * 300 + "|",
            "found '|', expected '(', '/', 'id', 'merge', 'share', 'split', '{', a control, a name or a number",
        ),
        ("A.(" * 300, "nesting deeper than 200"),
        ("||".join(["id(999)"] * 30), "a bigraph of more than 20000 parts"),
    ],
)
def test_mistakes_are_told_in_the_users_words(text, message):
    with pytest.raises(NotationError) as found:
        read_big(text, SIGNATURE)
    assert found.value.message == message


def test_doubling_definitions_are_refused_before_they_fill_the_memory():
    lines = ["ctrl A = 0;", "big b0 = A | A;", *(f"big b{n} = b{n - 1} | b{n - 1};" for n in range(1, 60))]
    with pytest.raises(NotationError, match="more than 20000 parts"):
        read_theory("\n".join(lines))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("ctrl A = 0; ctrl A = 1;", "control 'A' is declared twice"),
        ("ctrl A = 0; big a = A; big a = A;", "bigraph 'a' is declared twice"),
        ("ctrl A = 0; react r = A --> A | A;", "the redex has 1 sites, the reactum 2"),
        ("ctrl A = 0; big a = A.1; begin brs init b; rules = [{r}]; end", "unknown bigraph 'b'"),
        ("ctrl A = 0; big a = A.1; begin brs init a; rules = [{r}]; end", "unknown rule 'r'"),
    ],
)
def test_a_file_that_makes_no_sense_is_refused(text, message):
    with pytest.raises(NotationError) as found:
        read_theory(text)
    assert found.value.message == message


def test_a_named_node_cannot_be_written():
    with pytest.raises(BigraphError, match="cannot name a node"):
        write_big(from_relations({"a": "K"}, {}, {}))


@given(st.text(st.sampled_from("aAB{}().|/10*+xid ,\n"), max_size=25))
def test_any_text_is_read_or_refused_with_a_place_in_it(text):
    try:
        read_big(text, SIGNATURE)
    except NotationError as error:
        found = error
    else:
        return
    assert 0 <= found.offset <= len(text)
