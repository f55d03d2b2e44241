"""Widths of text come from the font that draws it."""

import pytest

from physical.svg import shortened, text_width


@pytest.mark.parametrize(
    ("text", "bold", "width"),
    [
        ("searchArea0", False, 62.59),
        ("searchArea0", True, 70.62),
        ("AVATAR", False, 37.59),
        ("α → ∅", False, 30.04),
    ],
)
def test_a_line_is_as_wide_as_its_characters_with_kerning(text, bold, width):
    assert text_width(text, 10.0, bold) == pytest.approx(width, abs=0.02)


def test_an_unknown_character_is_as_wide_as_the_font_is_high():
    assert text_width("海", 10.0) == 10.0


def test_shortened_text_fits():
    text = "READY(searcher, CHILDREN(PARENT(uav0)), {oilSpill0, searchArea0})"
    assert text_width(shortened(text, 120, 8), 8) <= 120
    assert shortened(text, 1000, 8) == text
    assert shortened(text, 0, 8) == "…"
