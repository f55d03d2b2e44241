import pytest
from bigraph_strategies import SIGNATURE, bigraphs
from hypothesis import given
from hypothesis import strategies as st

from bigraphs.canonical_form import equal
from bigraphs.errors import BigraphError, NotationError
from bigraphs.notation.big.expression_of import write_big
from bigraphs.notation.big.fragments import read_big, read_theory
from bigraphs.relational_bigraphs import from_relations
from bigraphs.rewriting import successors

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


@given(st.booleans().flatmap(lambda sharing: bigraphs(max_nodes=5, sharing=sharing)))
def test_elaborating_gives_back_the_bigraph_that_was_written(bigraph):
    assert equal(read_big(write_big(bigraph), SIGNATURE), bigraph)


def test_a_theory_is_elaborated_and_runs():
    theory = read_theory(THEORY.replace("big start = /g (Loc.(UAV{g} | id) | Loc.1) * (Loc.1 || 1);\n", ""))
    start = dict(theory.bigraphs)["s0"]
    ((_, after),) = successors(theory.rules[0], start)
    assert equal(after, start)  # the places are alike
    assert write_big(after) == "/e0 (Loc.1 | Loc.UAV{e0})"


def test_an_interface_that_does_not_fit_is_told_where_it_stands():
    with pytest.raises(NotationError) as found:
        read_theory(THEORY)
    assert found.value.render("move.big") == (
        "move.big:6:47: this shows <2, {}>, and what it is put into is for <1, {}>\n"
        "    6 | big start = /g (Loc.(UAV{g} | id) | Loc.1) * (Loc.1 || 1);\n"
        "      |                                               ^^^^^^^^^^\n"
        "hint: extend one of them with an identity such as id(1, {x})"
    )


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
            "the text ends, expected '(', '/', 'id', 'merge', 'par', 'split', '{', a control, a name or a number",
        ),
        ("A B", "found 'B', expected '(', '*', '+', '.', '{', '|' or the end"),
        ("unknown", "unknown bigraph 'unknown'"),
        ("Q", "unknown control 'Q'"),
        ("B", "'B' has 1 port, this has no links"),
        ("Z{x}.1", "'Z' is atomic, so there is nothing in it"),
        ("/q A", "there is no outer name 'q' here"),
        ("7", "a number is no bigraph"),
        (
            "A | " * 300 + "|",
            "found '|', expected '(', '/', 'id', 'merge', 'par', 'share', 'split', '{', a control, a name or a number",
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
        ("ctrl A = 0; react r = A --> A | A;", "the redex has 1 site, the reactum 2"),
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
