"""How a mistake is printed."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from specs.codes import Code
from specs.diagnostics import Diagnostic, MissionError, Source, render, render_all
from specs.syntax import Span


def shown(text, word, hint=""):
    start = text.index(word)
    found = Diagnostic(Code.UNEXPECTED, Span(start, start + len(word)), "here", hint)
    return render(found, Source("a.mission", text))


def test_a_mistake_is_shown_with_its_line_a_caret_and_the_hint():
    assert shown("one\n  control(MOVE_HOST_TO serchArea0)\n", "serchArea0", "did you mean it?") == (
        "a.mission:2:24: LS101: here\n"
        "  2 |   control(MOVE_HOST_TO serchArea0)\n"
        "    |                        ^^^^^^^^^^\n"
        "  hint: did you mean it?"
    )


def test_carets_stand_under_their_words_behind_tabs_and_wide_characters():
    block = shown("\tx 日本 e\N{COMBINING ACUTE ACCENT} bad", "bad").splitlines()
    assert block[1] == "  1 |     x 日本 e\N{COMBINING ACUTE ACCENT} bad"
    assert block[2] == "    | " + " " * 13 + "^^^"


def test_a_wide_word_is_underlined_in_full():
    assert shown("日本", "日本").endswith("| ^^^^")


def test_control_characters_are_not_printed():
    assert "\x1b" not in shown("\x1b[31m bad", "bad")


@pytest.mark.parametrize(
    ("text", "start"),
    [("a " * 100 + "bad" + " b" * 100, "…"), ("x" * 500 + " bad " + "y" * 500, "…"), ("bad " * 99, "bad")],
)
def test_of_a_long_line_the_part_around_the_mistake_is_shown_and_both_cuts_are_marked(text, start):
    _, line, caret = shown(text, "bad").splitlines()
    assert len(line) <= 110
    assert line[caret.index("^") :].startswith("bad")
    assert line.startswith(f"  1 | {start}")
    assert line.endswith("…")


def test_a_mistake_of_several_lines_is_underlined_in_its_first():
    assert shown("abc {\nx }", "{\nx }").endswith("  1 | abc {\n    |     ^")


def test_the_end_of_the_text_can_be_pointed_at():
    found = Diagnostic(Code.UNEXPECTED_END, Span(3, 3), "end")
    assert render(found, Source("m", "abc")) == "m:1:4: LS102: end\n  1 | abc\n    |    ^"
    assert render(found, Source("m", "")) == "m:1:1: LS102: end\n  1 |\n    | ^"


def test_mistakes_are_sorted_by_position():
    late, early = (Diagnostic(Code.UNEXPECTED, Span(at, at + 1), f"at {at}") for at in (4, 0))
    source = Source("m", "a\nb\nc")
    assert MissionError(source, [late, early]).diagnostics == (early, late)
    assert render_all([late, early], source).index("at 0") < render_all([late, early], source).index("at 4")
    with pytest.raises(MissionError, match="m:1:1: LS101: at 0"):
        raise MissionError(source, [late, early])


@settings(deadline=None)
@given(st.text(), st.integers(0, 50), st.integers(0, 50))
def test_anything_can_be_rendered(text, start, length):
    found = Diagnostic(Code.UNEXPECTED, Span(start, start + length), "x")
    assert render(found, Source("m", text)).count("\n") == 2
