"""`bigactors fmt`: the canonical layout of a mission, with its comments."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from specs.diagnostics import Source
from specs.mission_layout import WrappedLine, lay_out
from specs.parser import build
from specs.preprocessing import Comment, Prepared, prepare
from specs.syntax import Mission


def format_mission(text: str, name: str = "mission") -> str:
    """Return the mission in canonical layout; raises MissionError if it does not parse.

    The result has an equal syntax tree, and formatting it again changes nothing. A comment at the end of a line stays
    there; any other stays before the next line; single empty lines stay.
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
    """A line with the comments before it and behind it; comments at the end of the file have no `line`."""

    line: WrappedLine | None
    before: list[Comment] = field(default_factory=list)
    behind: list[Comment] = field(default_factory=list)


def _attach(lines: Sequence[WrappedLine], prepared: Prepared) -> list[_Commented]:
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
    """Yield the rows of the result; an empty row for an empty line."""
    opened = True  # no empty line at the start or behind an opening brace
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
    """Yield the rows of a line and its comments: text, offset whose empty line it keeps, whether it is a comment.

    If one line gathers several trailing comments, the last stays behind it and the others go before it.
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
    gap = min(offset, len(source)) - 1  # a tree without its text has places in it all the same
    while gap >= 0 and source[gap] in " \t\n;":
        gap -= 1
    return source.count("\n", gap + 1, offset) > 1


def _join(rows: Iterator[str]) -> str:
    text = "\n".join(rows)
    return f"{text}\n" if text else ""
