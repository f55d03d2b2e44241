"""Shapes and text become SVG: escaped, in order, and the same in every run."""

import re
from xml.etree import ElementTree

import pytest

from physical.svg import Canvas, Paint, Words

RED = Paint("#f00")
PLAIN = Words(10.0, "#000")


def elements(canvas):
    return list(ElementTree.fromstring(canvas.picture("t").svg).iter())


def test_text_from_outside_is_escaped_and_has_no_control_characters():
    canvas = Canvas(100, 100)
    canvas.text((1, 2), "</text><script>&\x00\x1b\ud800\n", PLAIN, names=['"><a'])
    canvas.put(Canvas(1, 1), (0, 0), title="<b>\x07")
    tags = {element.tag.rpartition("}")[2] for element in elements(canvas)}
    assert tags == {"svg", "title", "rect", "g", "text"}
    (text,) = (element.text for element in elements(canvas) if element.tag.endswith("text"))
    assert text == "</text><script>&" + "\N{REPLACEMENT CHARACTER}" * 4


def test_a_title_from_outside_is_escaped():
    (title,) = (
        each.text for each in ElementTree.fromstring(Canvas(1, 1).picture("a<b\x00").svg) if each.text
    )
    assert title == "a<b\N{REPLACEMENT CHARACTER}"


def test_only_files_beside_a_picture_are_linked():
    for link, count in (("c01.svg", 1), ("https://evil.example/x.svg", 0), ("javascript:alert(1)", 0)):
        canvas = Canvas(10, 10)
        canvas.rectangle((0, 0), (5, 5), RED, link=link)
        assert canvas.shapes.count("<a ") == count


def test_higher_levels_are_in_front_and_equal_ones_in_the_order_of_drawing():
    canvas = Canvas(10, 10)
    canvas.circle((1, 1), 1, RED, 2.0)
    canvas.line([(0, 0), (1, 1)], RED, 1.0)
    canvas.rectangle((0, 0), (1, 1), RED, 1.0)
    assert re.findall(r"<(\w+)", canvas.shapes) == ["path", "rect", "circle"]


def test_y_may_go_up_from_the_lower_edge():
    up, down = Canvas(10, 10, upwards=True), Canvas(10, 10, (1, 2))
    for canvas in (up, down):
        canvas.line([(0, 0), (3, 4)], RED)
    assert [re.search('d="(.*?)"', canvas.shapes)[1] for canvas in (up, down)] == ["M0 10 3 6", "M1 2 4 6"]


def test_text_has_its_width_in_every_font():
    canvas = Canvas(10, 10)
    canvas.text((0, 5), "searchArea0", PLAIN)
    assert 'textLength="62.6"' in canvas.shapes


def test_text_with_a_halo_is_in_one_group():
    canvas = Canvas(10, 10)
    for words in (PLAIN, Words(9.0, "#000", halo=True), Words(9.0, "#000", halo=True)):
        canvas.text((0, 5), "a", words)
    assert re.findall(r"<(/?[gt])", canvas.shapes) == ["t", "/t", "g", "t", "/t", "t", "/t", "/g"]


def test_spaces_alone_are_no_text():
    canvas = Canvas(10, 10)
    canvas.text((0, 5), "  ", PLAIN)
    assert canvas.shapes == ""


def test_dashes_grow_with_the_width_of_their_line():
    assert 'stroke-dasharray="6 4"' in Paint(stroke="#000", width=2.0, dash=(3, 2)).attributes


@pytest.mark.parametrize("points", [[(0, 0), (1, 1), (2, 0)], [(0, 0), (1, 1), (2, 1), (3, 0)]])
def test_a_curve_is_quadratic_or_cubic(points):
    canvas = Canvas(10, 10)
    canvas.curve(points, RED)
    assert ("Q" if len(points) == 3 else "C") in canvas.shapes


def test_a_clipped_canvas_has_no_id():
    canvas = Canvas(10, 10)
    canvas.put(Canvas(4, 5), (1, 2), 2.0, clipped=True)
    assert canvas.shapes == '<g transform="translate(1 2) scale(2)"><svg width="4" height="5"></svg></g>'
