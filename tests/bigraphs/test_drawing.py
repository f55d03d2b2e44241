from xml.etree import ElementTree

import pytest
from bigraph_strategies import bigraphs
from hypothesis import given
from scale import examples

from bigraphs.algebra import close
from bigraphs.drawing import draw_bigraph, draw_layout, save_bigraph
from bigraphs.layout import layout
from bigraphs.relational_bigraphs import from_relations

WORLD = close(
    from_relations(
        {"area0": "Location", "uav0": "UAV", "gcs0": "Station", "vessel0": "Vessel"},
        {"uav0": "area0"},
        {"control:gcs0": ["uav0", "gcs0"], "wifi": ["uav0", "gcs0", "vessel0"]},
    ),
    "wifi",
)


@pytest.mark.parametrize("kind", ["svg", "png"])
def test_the_same_bigraph_gives_the_same_bytes(tmp_path, kind):
    for name in ("one", "two"):
        save_bigraph(WORLD, tmp_path / f"{name}.{kind}", highlight=frozenset({"uav0"}), title="c2")
    assert (tmp_path / f"one.{kind}").read_bytes() == (tmp_path / f"two.{kind}").read_bytes()


def texts_of(picture):
    """Return the lines of text of a picture."""
    root = ElementTree.fromstring(picture.svg)
    return [text.text for text in root.iter("{http://www.w3.org/2000/svg}text")]


def test_a_picture_has_the_names_the_kinds_and_the_title():
    texts = texts_of(draw_bigraph(WORLD, highlight=frozenset({"uav0"}), title="c3"))
    assert set(texts) >= {"uav0", "UAV", "area0", "control:gcs0", "c3"}


def test_a_highlighted_node_glows_and_a_marked_one_has_a_dashed_outline():
    plain, lit, marked = (
        draw_layout(layout(WORLD), **look).shapes.count("<rect")
        for look in ({}, {"highlight": frozenset({"uav0"})}, {"marked": frozenset({"uav0"})})
    )
    assert lit == marked == plain + 1


def test_a_large_picture_is_reduced():
    wide = from_relations({f"node{n}": f"K{n}" for n in range(400)}, {}, {})
    picture = draw_bigraph(wide)
    assert max(picture.width, picture.height) <= 1440.5


@examples(15)
@given(bigraphs(sharing=True, max_nodes=6))
def test_every_bigraph_can_be_drawn(bigraph):
    assert ElementTree.fromstring(draw_bigraph(bigraph).svg) is not None
    assert "<rect" in draw_bigraph(bigraph).shapes or not bigraph.regions


def test_a_notebook_shows_the_same_picture():
    assert texts_of(draw_bigraph(WORLD)) == [
        text.text
        for text in ElementTree.fromstring(WORLD._repr_svg_()).iter("{http://www.w3.org/2000/svg}text")
    ]


def test_names_are_written_as_they_are():
    names = {"a$b$_{": "K", "<b>&": "K"}
    assert set(names) <= set(texts_of(draw_bigraph(from_relations(names, {}, {}))))
