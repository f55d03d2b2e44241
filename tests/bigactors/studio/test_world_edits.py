"""Edits of the world on the map, as changes of the text: what is read again is what was drawn."""

from pathlib import Path

import pytest

from bigactors.lsp.edited_mission import reading_of
from bigactors.studio.page_requests import Add, Reshape
from bigactors.studio.world_edits import Uneditable, changes, from_file, shapes

TEXT = """\
mission m
signature { kind Location contains Location, UAV kind UAV driven }
world {
  a: Location = box (37.04, -8.59) (36.94, -8.79)  // corners
  b: Location = circle (37°08'56"N, 8°35.04'W) radius 0.9 km altitude 10 m to 50 m
  c: Location = polygon (37.1, -8.6) (37.1, -8.5) (37.06, -8.5)
  u: UAV = point (37.147, -8.582) linked control:g
  ghost: UAV absent
}
"""
IN_ONE_LINE = "mission m signature { kind Place } world { p: Place = point (1, 2) }"


def read(text):
    return reading_of("m.mission", text, Path())


def applied(text, found):
    for each in sorted(found, key=lambda change: -change.start):
        text = text[: each.start] + each.text + text[each.end :]
    return text


@pytest.mark.parametrize(
    ("edit", "old", "new"),
    [
        (Reshape("u", ((37.2, -8.5),)), "point (37.147, -8.582)", "point (37.2, -8.5)"),
        (
            Reshape("a", ((37.04, -8.59), (36.9, -8.812345678))),
            "(36.94, -8.79)",
            "(36.9, -8.81235)",
        ),
        (Reshape("b", ((37 + 536 / 3600, -8.584),), 1200.4), "radius 0.9 km", "radius 1200 m"),
        (Reshape("b", ((-0.000001, 8.0),), 900.0), "(37°08'56\"N, 8°35.04'W)", "(0, 8)"),
        (
            Reshape("c", ((37.1, -8.6), (37.2, -8.5), (37.06, -8.5))),
            "(37.1, -8.5) (37.06",
            "(37.2, -8.5) (37.06",
        ),
    ],
)
def test_a_shape_changes_where_it_was_moved_and_nowhere_else(edit, old, new):
    name, found = changes(read(TEXT), edit)
    assert name == edit.name
    text = applied(TEXT, found)
    assert text == TEXT.replace(old, new, 1)
    assert not read(text).recovered.mistakes


@pytest.mark.parametrize(
    ("shape", "line"),
    [
        ("point", "point (37, -8)"),
        ("circle", "circle (37, -8) radius 500 m"),
        ("box", "box (37.0045, -7.99437) (36.9955, -8.00563)"),
        (
            "polygon",
            "polygon (37.0045, -8.00563) (37.0045, -7.99437) (36.9955, -7.99437) (36.9955, -8.00563)",
        ),
    ],
)
def test_an_entity_is_added_at_the_end_of_the_world_under_a_free_name(shape, line):
    kind, name = ("UAV", "uav0") if shape == "point" else ("Location", "location0")
    named, found = changes(read(TEXT), Add(kind, shape, (37.0, -8.0), 1000.0))
    text = applied(TEXT, found)
    assert named == name
    assert text == TEXT.replace("absent\n}", f"absent\n  {name}: {kind} = {line}\n}}")
    again, _ = changes(read(text), Add(kind, shape, (37.0, -8.0), 1000.0))
    assert again == name.replace("0", "1")


def test_a_world_in_one_line_and_a_text_without_a_world_take_entities_too():
    _, found = changes(read(IN_ONE_LINE), Add("Place", "point", (3.0, 4.0), 1.0))
    text = applied(IN_ONE_LINE, found)
    assert list(shapes(read(text))["shapes"]) == ["p", "place0"]
    empty = "mission m\nsignature standard\n"
    _, found = changes(read(empty), Add("Vessel", "point", (3.0, 4.0), 1.0))
    assert applied(empty, found) == f"{empty}\nworld {{\n  vessel0: Vessel = point (3, 4)\n}}\n"


def test_a_file_comes_into_the_world_once():
    (found,) = from_file(read(TEXT), "places.geojson")
    text = applied(TEXT, [found])
    assert text.endswith('  ghost: UAV absent\n  from "places.geojson"\n}\n')
    assert from_file(read(text), "places.geojson") == []


@pytest.mark.parametrize(
    ("edit", "words"),
    [
        (
            Reshape("ghost", ((1.0, 2.0),)),
            "the text places no ghost: it comes from a file, is carried, or absent",
        ),
        (
            Reshape("nobody", ((1.0, 2.0),)),
            "the text places no nobody: it comes from a file, is carried, or absent",
        ),
        (Reshape("c", ((1.0, 2.0),)), "c has 3 points in the text"),
        (Add("Boat", "point", (1.0, 2.0), 1.0), "the signature has no kind Boat"),
    ],
)
def test_an_edit_of_what_is_not_in_the_text_is_refused_in_words(edit, words):
    with pytest.raises(Uneditable) as refused:
        changes(read(TEXT), edit)
    assert str(refused.value) == words


def test_the_shapes_of_a_text_with_mistakes_elsewhere_are_known():
    found = shapes(read(TEXT + "chekc { }"))
    assert found["kinds"] == ["Location", "UAV"]
    assert list(found["shapes"]) == ["a", "b", "c", "u"]
    assert found["shapes"]["b"]["radius"] == 900.0
