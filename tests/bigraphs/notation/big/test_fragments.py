import pytest
from bigraph_strategies import SIGNATURE, bigraphs
from hypothesis import given
from hypothesis import strategies as st

from bigraphs.canonical_form import equal
from bigraphs.errors import BigraphError, NotationError
from bigraphs.notation.big.expression_of import write_big
from bigraphs.notation.big.fragments import read_big
from bigraphs.relational_bigraphs import from_relations


@given(st.booleans().flatmap(lambda sharing: bigraphs(max_nodes=5, sharing=sharing)))
def test_elaborating_gives_back_the_bigraph_that_was_written(bigraph):
    assert equal(read_big(write_big(bigraph), SIGNATURE), bigraph)


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
        ("Z{x}.1", "'Z' is atomic, so it has no content"),
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


def test_a_named_node_cannot_be_written():
    with pytest.raises(BigraphError, match="cannot name a node"):
        write_big(from_relations({"a": "K"}, {}, {}))
