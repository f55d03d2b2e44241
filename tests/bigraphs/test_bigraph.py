import pytest
from bigraph_strategies import SIGNATURE, bigraphs
from hypothesis import given
from hypothesis import strategies as st

from bigraphs.bigraph import Bigraph, Node, assemble, children, find, links, points
from bigraphs.errors import BigraphError
from bigraphs.interface import Interface
from bigraphs.relational_bigraphs import from_relations
from bigraphs.signature import Control, Signature, open_signature

A, B, Z = Node("A"), Node("B", None, (0,)), Node("Z", None, (0,))


@pytest.mark.parametrize(
    ("nodes", "options", "message"),
    [
        ([Node("Q")], {}, "unknown control 'Q'"),
        ([Node("B")], {}, "B has 0 links, its control has 1 port"),
        ([Node("B", None, ("x",))], {}, "B is linked to 'x', which is no outer name of the bigraph"),
        ([B], {}, "B is linked to edge 0 of 0"),
        ([Node("A", "a"), Node("A", "a")], {}, "node 'a' is there 2 times"),
        ([Node("A", "")], {}, "an empty node"),
        ([Node("A", "a\n")], {}, "node 'a\\n' has a character that cannot be shown"),
        ([Node("A", None, (), (~1,))], {}, "A is in region 1, which the bigraph does not have"),
        ([Node("A", None, (), (7,))], {}, "A is in node 7, which the bigraph does not have"),
        ([Node("A", None, (), ())], {}, "A has no parent"),
        (
            [Z, Node("A", None, (), (0,))],
            {"edges": 1},
            "A is in Z, whose control is atomic and holds nothing",
        ),
        (
            [Node("A", "a", (), (1,)), Node("A", "b", (), (0,))],
            {},
            "places contain each other: a:A in b:A in a:A",
        ),
        ([Node("A", "a", (), (0,))], {}, "places contain each other: a:A in a:A"),
        (
            [],
            {"inner_links": {"i": "x"}},
            "inner name 'i' is linked to 'x', which is no outer name of the bigraph",
        ),
        ([], {"regions": -1}, "regions and edges are counted from 0"),
    ],
)
def test_what_is_no_bigraph_is_refused_with_a_reason(nodes, options, message):
    with pytest.raises(BigraphError) as found:
        assemble(SIGNATURE, nodes, **options)
    assert found.value.message == message


def test_the_order_of_named_nodes_and_edges_leaves_no_trace():
    nodes = [Node("C", "a", (0, 1)), Node("B", "b", (1,)), Node("B", "c", (0,))]
    turned = [Node("B", "c", (1,)), Node("C", "a", (1, 0)), Node("B", "b", (0,))]
    assert assemble(SIGNATURE, nodes, edges=2) == assemble(SIGNATURE, turned, edges=2)


def test_unordered_ports_are_sorted_and_ordered_ones_are_not():
    assert assemble(SIGNATURE, [Node("U", "u", ("y", "x"))], outer_names="xy").nodes[0].ports == ("x", "y")
    assert assemble(SIGNATURE, [Node("C", "c", ("y", "x"))], outer_names="xy").nodes[0].ports == ("y", "x")


@given(bigraphs(sharing=True))
def test_views_agree_with_the_value(bigraph):
    inside = children(bigraph)
    assert all(
        (child in inside[p]) == (p in bigraph.nodes[child].parents)
        for p in inside
        for child in range(len(bigraph.nodes))
    )
    assert sum(map(len, points(bigraph).values())) == sum(len(node.ports) for node in bigraph.nodes)
    assert list(points(bigraph)) == links(bigraph)
    assert hash(bigraph) == hash(Bigraph(**{name: getattr(bigraph, name) for name in bigraph.__slots__}))


names = st.lists(st.sampled_from("abcdef"), unique=True, min_size=1)


@given(names.flatmap(lambda found: st.tuples(st.just(found), st.permutations(found))))
def test_relations_make_the_same_bigraph_in_any_order(orders):
    found = [
        from_relations(
            dict.fromkeys(order, "K"),
            {name: (min(order) if name != min(order) else None) for name in order},
            {"net": reversed(order), "idle": []},
        )
        for order in orders
    ]
    assert found[0] == found[1]
    assert found[0].outer == Interface(1, ("idle", "net"))


def test_relations_say_who_is_in_what_and_on_which_link():
    world = from_relations({"u": "UAV", "l": "Location"}, {"u": "l", "l": None}, {"net": ["u", "u"]})
    uav = world.nodes[find(world, "u")]
    assert (uav.control, uav.ports, uav.parents) == ("UAV", ("net",), (find(world, "l"),))
    assert find(world, "nobody") is None


@pytest.mark.parametrize(
    ("parent", "links", "message"),
    [
        ({"a": "b"}, {}, "'b' is a parent but is no node"),
        ({"b": None}, {}, "'b' has a parent but is no node"),
        ({}, {"net": ["b"]}, "'b' is on link 'net' but is no node"),
        ({"a": "a"}, {}, "places contain each other: a:K in a:K"),
    ],
)
def test_relations_about_nobody_are_refused(parent, links, message):
    with pytest.raises(BigraphError) as found:
        from_relations({"a": "K"}, parent, links)
    assert found.value.message == message


def test_ten_thousand_nested_places_are_no_difficulty():
    order = [f"n{n:05}" for n in range(10_000)]
    world = from_relations(dict.fromkeys(order, "K"), dict(zip(order[1:], order, strict=False)), {})
    assert len(world.nodes) == 10_000
    assert str(
        from_relations(dict.fromkeys(order[:500], "K"), dict(zip(order[1:500], order, strict=False)), {})
    )


def test_signatures_join_where_they_agree():
    one, other = Signature((Control("A", 1),)), Signature((Control("B"), Control("A", 1)))
    assert (one | other) == other == (other | one)
    with pytest.raises(BigraphError, match="control 'A' is declared in two different ways"):
        _ = one | open_signature(["A"])
    with pytest.raises(BigraphError, match="control 'A' is declared twice"):
        Signature((Control("A"), Control("A", 1)))
    with pytest.raises(BigraphError, match="control 'A' has the arity -1"):
        Control("A", -1)
