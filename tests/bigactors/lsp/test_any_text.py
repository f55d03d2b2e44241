"""Whatever is typed, each question has an answer, and that is within the text."""

from pathlib import Path

from hypothesis import given, settings
from hypothesis import strategies as st

from bigactors.lsp.completion import complete
from bigactors.lsp.edited_mission import reading_of
from bigactors.lsp.fixes import fixes
from bigactors.lsp.hover import hover
from bigactors.lsp.outline import outline
from bigactors.lsp.renaming import RenameRefused, rename
from bigactors.lsp.textmate import tokens

FOLDER = Path(__file__).parents[3] / "specs/missions"
MISSIONS = sorted(path for path in FOLDER.glob("*.mission") if "watch" not in path.stem)
TYPED = st.one_of(
    st.text(max_size=5),
    st.sampled_from(
        [*'(){}[];,:=@"', "//", "\r\n", "\r", "case ", "loop {", "environment {", "🚁", "a.", "° N", "{ u ||"]
    ),
)


def answers(text, offset):
    """Ask everything that an editor asks; return the spans of the answers."""
    reading = reading_of("m", text, FOLDER)
    yield complete(reading, offset).span
    if shown := hover(reading, offset):
        yield shown.span
    waiting = [*outline(reading)]
    while waiting:
        part = waiting.pop()
        yield from (part.span, part.name)
        waiting += part.parts
    yield from (token.span for token in tokens(reading))
    for found in (*reading.diagnosis.mistakes, *reading.diagnosis.warnings):
        yield found.span
        yield from (fix.span for fix in fixes(found, text))
    try:
        yield from rename(reading, offset, "other")
    except RenameRefused:
        return


@settings(max_examples=60, deadline=None)
@given(st.sampled_from(MISSIONS), st.data())
def test_random_changes_of_missions_leave_every_answer_within_the_text(path, data):
    text = path.read_text(encoding="utf-8")
    for _ in range(data.draw(st.integers(1, 4))):
        at = data.draw(st.integers(0, len(text)))
        text = text[:at] + data.draw(TYPED) + text[at + data.draw(st.integers(0, 30)) :]
        offset = data.draw(st.integers(0, len(text)))
        for span in answers(text, offset):
            assert 0 <= span.start <= span.end <= len(text)
