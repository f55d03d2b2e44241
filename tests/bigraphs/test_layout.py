from itertools import combinations, pairwise

from bigraph_strategies import bigraphs
from hypothesis import given
from hypothesis import strategies as st

from bigraphs.layout import GAP, Box, label_size, layout, pill_width
from bigraphs.link_curves import route
from bigraphs.relational_bigraphs import from_relations


@st.composite
def worlds(draw, largest=30):
    """Draw relations as missions make them."""
    size = draw(st.integers(1, largest))
    names = [f"{draw(st.sampled_from(['uav', 'searchArea', 'mmsi24467']))}{n}" for n in range(size)]
    parent = {name: draw(st.sampled_from([None, *names[:n]])) for n, name in enumerate(names)}
    links = {
        f"control:gcs{n}": draw(st.lists(st.sampled_from(names), max_size=6))
        for n in range(draw(st.integers(0, 4)))
    }
    return from_relations({name: draw(st.sampled_from(["UAV", "Location"])) for name in names}, parent, links)


anything = worlds() | bigraphs(sharing=True, max_nodes=8)


@given(anything)
def test_siblings_do_not_overlap_and_children_are_inside_their_parents(bigraph):
    plan = layout(bigraph)
    for (one, here), (other, there) in combinations(plan.boxes, 2):
        inside = here.contains(there) or there.contains(here)
        assert inside or not here.overlaps(there), (one, other)
    boxes = {item.number: box for item, box in plan.boxes if item.kind == "node"}
    for number, node in enumerate(bigraph.nodes):
        first = node.parents[0]
        outside = boxes[first] if first >= 0 else plan.box("region", ~first)
        assert outside.contains(boxes[number])
    for item, box in plan.boxes:
        if item.place is not None:
            outside = boxes[item.place] if item.place >= 0 else plan.box("region", ~item.place)
            assert outside.contains(box)


@given(anything)
def test_every_label_fits_its_box(bigraph):
    plan = layout(bigraph)
    for item, box in plan.boxes:
        width, height = label_size(plan.shown, item)
        assert box.width >= width
        assert box.height >= height


@given(anything)
def test_everything_is_drawn_once_and_within_the_page(bigraph):
    plan = layout(bigraph)
    kinds = [item.kind for item, _ in plan.boxes]
    assert kinds.count("node") == len(bigraph.nodes)
    assert kinds.count("region") == bigraph.regions
    assert kinds.count("ghost") == sum(len(node.parents) - 1 for node in bigraph.nodes)
    assert kinds.count("site") == sum(len(parents) for parents in bigraph.sites)
    page = Box(0, 0, plan.width, plan.height)
    assert all(page.contains(box) for _, box in plan.boxes)
    assert [name for name, _ in plan.outer] == list(bigraph.outer_names)


@given(st.lists(st.sampled_from(["x", "control:gcs0", "mmsi244670316"]), max_size=12))
def test_names_on_the_rim_do_not_overlap(names):
    bigraph = from_relations({"a": "K"}, {}, {f"{name}{n}": ["a"] for n, name in enumerate(names)})
    plan = layout(bigraph)
    for (_, one), (_, other) in combinations(plan.outer, 2):
        assert not one.overlaps(other)
    assert all(box.width >= pill_width(name) for name, box in plan.outer)


@given(worlds(12))
def test_curves_run_from_the_border_of_their_nodes_to_their_name(bigraph):
    plan = layout(bigraph)
    borders = dict(plan.outer)
    for found in route(plan):
        pill = borders[found.link]
        for port, curve in zip(found.ports, found.curves, strict=True):
            assert curve[0] == port
            assert curve[-1] == (pill.centre[0], pill.y + pill.height)
            assert len(curve) % 3 == 1


def test_rows_keep_the_order_of_names():
    bigraph = from_relations({f"n{n}": "K" for n in range(9)}, {}, {})
    plan = layout(bigraph)
    centres = [plan.box("node", number).centre for number in range(9)]
    assert all(one[1] < other[1] or one[0] < other[0] for one, other in pairwise(centres))


def test_wide_and_narrow_places_keep_a_gap():
    bigraph = from_relations({"a": "K", "b": "K"}, {}, {})
    one, other = layout(bigraph).box("node", 0), layout(bigraph).box("node", 1)
    assert max(other.x - one.x - one.width, other.y - one.y - one.height) >= GAP - 1e-6


def test_nothing_has_a_layout_too():
    assert layout(from_relations({}, {}, {})).box("region", 0).width > 0
