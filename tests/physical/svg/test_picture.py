"""A picture's files: SVG and PNG, the same in every run and on every machine."""

import re
import struct

import pytest

from physical.svg import Canvas, Paint, PictureError, Words


def picture():
    canvas = Canvas(100, 40)
    canvas.rectangle((5, 5), (90, 30), Paint("#e8f1fd", "#4f86c6"), radius=5)
    canvas.text((50, 24), "uav0", Words(10.0, "#000", anchor="middle"))
    return canvas.picture("uav0")


@pytest.mark.parametrize("suffix", ["svg", "png"])
def test_a_file_is_the_same_twice(tmp_path, suffix):
    for name in ("a", "b"):
        picture().save(tmp_path / f"{name}.{suffix}")
    assert (tmp_path / f"a.{suffix}").read_bytes() == (tmp_path / f"b.{suffix}").read_bytes()


def test_a_png_has_144_dots_an_inch_and_its_text_is_drawn():
    blank = Canvas(100, 40)
    blank.rectangle((5, 5), (90, 30), Paint("#e8f1fd", "#4f86c6"), radius=5)
    assert struct.unpack(">II", picture().png[16:24]) == (200, 80)
    assert len(picture().png) > len(blank.picture("uav0").png)


def test_a_png_needs_no_font_of_the_machine(monkeypatch, tmp_path):
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("XDG_DATA_DIRS", str(tmp_path))
    assert picture().png == picture().png


def test_another_suffix_is_refused(tmp_path):
    with pytest.raises(PictureError, match=r"cannot write a picture as 'c.pdf': name it .svg or .png"):
        picture().save(tmp_path / "c.pdf")


def test_a_png_that_is_too_large_is_refused_with_a_remedy(tmp_path):
    with pytest.raises(
        PictureError, match=r"80,000 dots high, and a .png has at most 65,535: name it .svg or .html"
    ):
        Canvas(100, 40_000).picture("t").save(tmp_path / "t.png")
    with pytest.raises(PictureError, match="80,000 dots wide"):
        Canvas(40_000, 100).picture("t").save(tmp_path / "t.png")


def test_a_notebook_shows_a_picture_in_its_width():
    assert re.search(
        r'style="width:100%;max-width:100pt;height:auto" viewBox="0 0 100 40"', picture()._repr_svg_()
    )
    assert picture()._repr_png_() == picture().png


def test_a_picture_may_be_magnified():
    larger = Canvas(100, 40).picture("t", 1.5)
    assert (larger.width, larger.height) == (150, 60)
