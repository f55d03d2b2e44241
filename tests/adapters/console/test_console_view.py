"""Differences of views: applied to what was shown before they give what is shown after, and cost little."""

from hypothesis import given
from hypothesis import strategies as st

from adapters.console.console_view import NOTHING, View, difference, keeping

VALUES = st.recursive(st.integers(0, 2) | st.none(), lambda inner: st.lists(inner, max_size=2))
SECTIONS = st.dictionaries(
    st.sampled_from("ab"), st.dictionaries(st.sampled_from("xyz"), VALUES, max_size=3), max_size=2
)


def applied(sections, changes):
    """Do to what a browser shows what a frame says."""
    changed, gone = changes
    after = {name: dict(section) for name, section in sections.items()}
    for name, keys in gone.items():
        for key in keys:
            del after[name][key]
    for name, values in changed.items():
        after.setdefault(name, {}).update(values)
    return after


def full(sections):
    """Leave out empty sections, which nobody can tell from none."""
    return {name: dict(section) for name, section in sections.items() if section}


@given(SECTIONS, SECTIONS)
def test_a_difference_applied_to_what_was_before_gives_what_is_after(before, after):
    assert full(applied(before, difference(View(before), View(after)))) == full(after)


@given(SECTIONS)
def test_views_that_are_equal_differ_in_nothing(sections):
    again = {name: dict(section) for name, section in sections.items()}
    assert difference(View(sections), View(again)) == ({}, {})


def test_values_that_are_equal_stay_the_same_objects_and_so_do_sections():
    before = {"x": [1], "y": [2]}
    assert keeping(before, {"x": [1], "y": [2]}) is before
    after = keeping(before, {"x": [1], "y": [3]})
    assert after == {"x": [1], "y": [3]}
    assert after["x"] is before["x"]


def test_to_who_was_shown_nothing_everything_is_new():
    assert difference(NOTHING, View({"a": {"x": 1}})) == ({"a": {"x": 1}}, {})
