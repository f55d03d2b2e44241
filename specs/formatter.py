"""`bigactors fmt`: the canonical layout of a mission, with its comments."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from specs.diagnostics import Source
from specs.layout import Line, lay_out
from specs.parser import build
from specs.preprocessing import Comment, Prepared, prepare
from specs.syntax import Mission


def format_mission(text: str, name: str = "mission") -> str:
    """Return the mission in canonical layout; raises MissionError where it does not parse.

    The result says the same (the syntax trees are equal), and formatting it again changes nothing. A comment behind
    something stays behind it, any other stays before what follows it; single empty lines stay.
    """
    source = Source(name, text.replace("\r\n", "\n").replace("\r", "\n").removeprefix("\ufeff"))
    prepared = prepare(source)
    mission = build(prepared, source)
    lines = lay_out(mission, prepared.text, tuple(comment.span.start for comment in prepared.comments))
    return _join(_rows(_attach(lines, prepared), source.text))


def write_mission(mission: Mission) -> str:
    """Return the canonical text of a syntax tree, without comments."""
    return _join(_rows([_Commented(line) for line in lay_out(mission)], ""))


@dataclass(slots=True)
class _Commented:
    """A line with the comments before it and behind it; the last may have none (`line` is None)."""

    line: Line | None
    before: list[Comment] = field(default_factory=list)
    behind: list[Comment] = field(default_factory=list)


def _attach(lines: Sequence[Line], prepared: Prepared) -> list[_Commented]:
    anchors = [line.anchor for line in lines]
    found = [*(_Commented(line) for line in lines), _Commented(None)]
    for comment in prepared.comments:
        following = bisect_right(anchors, comment.span.start)
        if following and _is_behind_code(comment, prepared.text):
            found[following - 1].behind.append(comment)
        else:
            found[following].before.append(comment)
    return found


def _is_behind_code(comment: Comment, blanked: str) -> bool:
    start = comment.span.start
    return bool(blanked[blanked.rfind("\n", 0, start) + 1 : start].strip())


def _rows(lines: Sequence[_Commented], source: str) -> Iterator[str]:
    """Yield the rows of the result; an empty one where there is to be an empty line."""
    opened = True  # at the start, and behind an opening brace, there is no empty line
    for item in lines:
        closing = item.line is None or item.line.pieces[0].startswith("}")
        apart = item.line is not None and item.line.apart
        for row, place, is_comment in _own_rows(item, closing):
            gap = apart or (place is not None and _follows_empty_line(source, place))
            if gap and not opened and (is_comment or not closing):
                yield ""
            yield row
            opened = apart = False
        opened = item.line is not None and item.line.pieces[-1].endswith("{")


def _own_rows(item: _Commented, closing: bool) -> Iterator[tuple[str, int | None, bool]]:
    """Yield a line and its comments, the place whose empty line each keeps, and whether it is a comment.

    Of several comments behind what becomes one line, the last stays behind it and the others go before it.
    """
    indent = "  " * (item.line.depth + closing) if item.line else ""
    place = item.line.anchor if item.line else None
    for comment in item.before:
        yield indent + comment.text, comment.span.start, True
    for comment in item.behind[:-1]:
        yield indent + comment.text, place, True
        place = None
    if item.line:
        yield item.line.text() + "".join(f"  {comment.text}" for comment in item.behind[-1:]), place, False


def _follows_empty_line(source: str, offset: int) -> bool:
    gap = offset - 1
    while gap >= 0 and source[gap] in " \t\n;":
        gap -= 1
    return source.count("\n", gap + 1, offset) > 1


def _join(rows: Iterator[str]) -> str:
    text = "\n".join(rows)
    return f"{text}\n" if text else ""
