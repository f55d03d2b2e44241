import pytest
from bigraph_strategies import bigraphs
from hypothesis import given
from hypothesis import strategies as st

from bigraphs.algebra import close, placing
from bigraphs.canonical_form import equal
from bigraphs.errors import BigraphError, NotationError
from bigraphs.interface import Interface
from bigraphs.notation.paper_bigraphs import read_bigraph, read_rule, write_bigraph, write_rule

writable = st.tuples(st.integers(0, 2), st.integers(1, 2), st.booleans()).flatmap(
    lambda drawn: bigraphs(
        Interface(drawn[0]), Interface(drawn[1], ("x", "y")), max_edges=0, named=drawn[2], max_nodes=6
    )
)


@given(writable)
def test_reading_gives_back_the_bigraph_that_was_written(bigraph):
    used = {link for node in bigraph.nodes for link in node.ports}
    if used != set(bigraph.outer_names):
        with pytest.raises(BigraphError, match="idle name"):
            write_bigraph(bigraph)
        return
    assert equal(read_bigraph(write_bigraph(bigraph), bigraph.signature), bigraph)


@pytest.mark.parametrize(
    "text",
    [
        "l0_Location.(u0_UAV[net] | $0) || l1_Location.$1 -> l0_Location.$0 || l1_Location.(u0_UAV[net] | $1)",
        "h_Host[c] || u_UAV[c] || g_Host[d] -> h_Host[c] || u_UAV[d] || g_Host[d]",
        "_A.$3 -> _A.$3 | _A.$3",
        "_A.($1 | $0) -> _B.$0",
    ],
)
def test_rules_are_read_back_as_written(text):
    rule = read_rule(text)
    assert read_rule(write_rule(rule)) == rule


def test_a_site_copied_in_the_reactum_is_instantiated_twice():
    assert read_rule("_A.($0 | $1) -> _A.($1 | $0) | _A.$1").instantiation == (1, 0, 1)


def test_a_control_may_be_left_out_where_the_redex_says_it():
    assert read_rule("a_A.$0 -> a.$0") == read_rule("a_A.$0 -> a_A.$0")


@pytest.mark.parametrize(
    ("text", "message"),
    [("a", "'a' has no control"), ("a_A.$1", "there are 1 sites, and one is $1")],
)
def test_what_makes_no_bigraph_is_refused_where_it_stands(text, message):
    with pytest.raises(NotationError) as found:
        read_bigraph(text)
    assert found.value.message == message


@pytest.mark.parametrize(
    "bigraph",
    [
        close(read_bigraph("_A[x]"), "x"),
        read_bigraph("_A.$0 | _A.$1") @ placing([{0, 1}], 2) @ read_bigraph("_A"),
    ],
)
def test_edges_and_sharing_are_refused(bigraph):
    with pytest.raises(BigraphError, match="this notation cannot say"):
        write_bigraph(bigraph)
