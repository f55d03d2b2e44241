import struct

import pytest
from bigraph_strategies import bigraphs
from hypothesis import given
from matplotlib.figure import Figure
from scale import examples

from bigraphs.algebra import close
from bigraphs.drawing import draw_bigraph, save_bigraph
from bigraphs.errors import BigraphError
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


def test_a_png_is_as_large_as_its_layout_asks(tmp_path):
    save_bigraph(WORLD, tmp_path / "world.png")
    width, height = struct.unpack(">II", (tmp_path / "world.png").read_bytes()[16:24])
    assert 300 < width < 2000
    assert 200 < height < 2000


def test_an_svg_has_no_date(tmp_path):
    save_bigraph(WORLD, tmp_path / "world.svg")
    assert "<dc:date>" not in (tmp_path / "world.svg").read_text()


def test_drawing_beside_something_else_uses_the_axes_given():
    figure = Figure(figsize=(8, 3))
    left, right = figure.subplots(1, 2)
    assert draw_bigraph(WORLD, right, highlight=frozenset({"uav0"}), title="c3") is right
    assert not left.patches
    assert {text.get_text() for text in right.texts} >= {"uav0", "UAV", "area0", "control:gcs0", "c3"}


def test_labels_shrink_with_the_axes():
    figure = Figure(figsize=(8, 8))
    small, large = figure.add_axes((0, 0, 0.2, 0.2)), figure.add_axes((0.3, 0.3, 0.7, 0.7))
    sizes = [draw_bigraph(WORLD, axes).texts[0].get_fontsize() for axes in (small, large)]
    assert sizes[0] < sizes[1]


@examples(15)
@given(bigraphs(sharing=True, max_nodes=6))
def test_every_bigraph_can_be_drawn(bigraph):
    assert draw_bigraph(bigraph).patches or not bigraph.regions


def test_another_kind_of_file_is_refused(tmp_path):
    with pytest.raises(BigraphError, match=r"cannot write a picture as 'world\.gif'"):
        save_bigraph(WORLD, tmp_path / "world.gif")


def test_dollars_in_names_are_no_formulas():
    assert "a$b$_{" in {
        text.get_text() for text in draw_bigraph(from_relations({"a$b$_{": "K"}, {}, {})).texts
    }
