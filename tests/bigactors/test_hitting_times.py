"""Curves of the first times of predicates: steps, marks and names of one picture."""

import re
from xml.etree import ElementTree

import pytest

from bigactors.pictures.hitting_times import Curve, draw_curves, marks
from physical.map_style import PALETTE

WORDS = {"title": "runs", "gloss": "shares", "axis": "time", "end": 10.0}


def curve(name="rich", times=(2.0, 5.0), shares=(0.5, 1.0)):
    return Curve(name, times, shares, [share * 0.9 for share in shares], shares)


def test_a_curve_jumps_at_each_time_and_goes_on_to_the_end():
    (line,) = re.findall(
        rf'd="M([^"]*)" fill="none" stroke="{PALETTE[0]}" stroke-width="1.6"', picture().shapes
    )[1:]
    xs = [float(x) for x in line.split()[::2]]
    assert xs == sorted(xs)
    assert len(xs) == 7  # the start, and two corners for each of two jumps and the end
    assert (xs[1] - xs[0]) / (xs[-1] - xs[0]) == pytest.approx(0.2)


def picture(*curves):
    return draw_curves(curves or (curve(),), **WORDS)


def test_a_curve_without_a_time_stays_at_nothing():
    root = ElementTree.fromstring(picture(curve(times=(), shares=())).svg)
    assert "rich" in [text.text for text in root.iter("{http://www.w3.org/2000/svg}text")]


def test_only_as_many_curves_are_drawn_as_there_are_colours_and_long_names_are_cut():
    drawn = picture(*(curve(f"{'n' * 90}{number}") for number in range(12)))
    names = re.findall(r">(n+…)<", drawn.shapes)
    assert len(names) == len(PALETTE)


@pytest.mark.parametrize("end", [1e-6, 0.3, 1.0, 7.0, 8.0, 99.0, 1e9])
def test_an_axis_has_a_few_round_marks(end):
    found = marks(end)
    assert 4 <= len(found) <= 9
    assert found[0] == 0.0
    assert found[-1] <= end * (1 + 1e-9)
