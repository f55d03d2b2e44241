from bigraph_strategies import SIGNATURE, bigraphs
from hypothesis import given

from bigraphs.bigraph import Node, assemble
from bigraphs.node_labels import node_labels
from bigraphs.relational_bigraphs import from_relations
from bigraphs.text import draw_text


def test_places_are_a_tree_and_links_a_list():
    world = from_relations(
        {"area0": "Location", "uav0": "UAV", "uav1": "UAV", "gcs0": "Station"},
        {"uav0": "area0", "uav1": "area0"},
        {"control:gcs0": ["uav0", "gcs0"], "free": []},
    )
    assert draw_text(world) == (
        "region 0\n"
        "├─ area0: Location\n"
        "│  ├─ uav0: UAV [control:gcs0]\n"
        "│  └─ uav1: UAV\n"
        "└─ gcs0: Station [control:gcs0]\n"
        "control:gcs0 ─ gcs0, uav0\n"
        "free ─ (idle)"
    )


def test_shared_nodes_sites_edges_and_inner_names_are_shown():
    shared = assemble(
        SIGNATURE,
        [Node("A", "a"), Node("A", "b"), Node("B", None, (0,), (0, 1))],
        sites=[(0,), (1,)],
        edges=1,
        inner_links={"i": 0},
    )
    assert draw_text(shared) == (
        "region 0\n├─ a: A\n│  ├─ $0\n│  └─ B [/0]\n└─ b: A\n   ├─ $1\n   └─ ↑ B\n/0 ─ B, i (inner)"
    )


@given(bigraphs(sharing=True, max_nodes=6))
def test_labels_are_all_different_and_every_one_is_drawn(bigraph):
    labels = node_labels(bigraph)
    assert len(set(labels)) == len(labels)
    assert all(label in draw_text(bigraph) for label in labels)


def test_anonymous_nodes_are_numbered_where_there_are_several():
    nodes = [Node("A"), Node("A"), Node("B", None, (0,)), Node("P", "A#1")]
    assert node_labels(assemble(SIGNATURE, nodes, edges=1)) == ("A#1", "A#1'", "A#2", "B")
