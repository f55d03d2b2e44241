"""Prepare a mission's text for parsing.

Check limits and brackets, and blank out comments and printed line numbers. All functions take linear time and only
replace characters by spaces, so offsets stay.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Final

from specs.codes import Code
from specs.diagnostics import Diagnostic, MissionError, Source
from specs.syntax.nodes import Span

MAX_BYTES: Final = 1_000_000
MAX_WORD: Final = 10_000
MAX_NESTING: Final = 200
MAX_WORDS: Final = 60_000

_SCAN: Final = re.compile(
    r"""(?P<comment>(?://|\#)[^\n]*)
      | (?P<block>/\*)
      | [NSEW]?[0-9.]{1,30}+\s?[°º][^,()\n]*  # an angle, whose marks are no quotes
      | (?P<string>"(?:[^"\\\n]|\\.)*+")
      | (?P<unclosed>"[^\n]*)
      | (?P<open>[(\[{])
      | (?P<close>[)\]}])
      | \w+ | [^\w\s]""",
    re.VERBOSE,
)
_UNSEEN: Final = re.compile(r"[^\n]")
_RUN: Final = re.compile(r"""[^\s"()\[\]{},;/\#]+""")
_CONTROL: Final = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f\ud800-\udfff]")
_NUMBERED: Final = re.compile(r"[ \t]*(?P<number>[0-9]{1,6})(?=\s|$)")
_NUMBERED_ACTOR: Final = re.compile(r"[ \t]*[0-9]{1,6}[ \t]+BigActor\b")
_QUOTED: Final = re.compile(r'"(?:[^"\\\n]|\\.)*+"')
_CLOSE: Final = 'close it with ", or look for a quote that is missing before it'
_PARTNER: Final = {"(": ")", "[": "]", "{": "}"}


@dataclass(frozen=True, slots=True)
class Comment:
    """A comment; `text` includes its `//` or `#`."""

    span: Span
    text: str


@dataclass(frozen=True, slots=True)
class Prepared:
    """A text ready for the grammar, with its comments and mistakes.

    Attributes:
        text: The text, with spaces for the parts hidden from the grammar.
        comments: The blanked-out comments, for the formatter.
        mistakes: Unclosed strings, and comments of other languages.
        unmatched: The offset at which the first unmatched bracket was noticed, and its diagnostic.
        open_at_end: The offsets of the brackets that are never closed.
    """

    text: str
    comments: tuple[Comment, ...]
    mistakes: tuple[Diagnostic, ...]
    unmatched: tuple[int, Diagnostic] | None
    open_at_end: tuple[int, ...]


def decode(name: str, data: bytes) -> Source:
    """Return the source in a file's bytes, with line feeds as line ends; raises MissionError."""
    if len(data) > MAX_BYTES:
        raise MissionError(Source(name, ""), [_too_large(len(data))])
    try:
        text = data.decode("utf-8").removeprefix("\ufeff")
    except UnicodeDecodeError as error:
        before = _line_ends(data[: error.start].decode("utf-8").removeprefix("\ufeff"))
        source = Source(name, before + "\N{REPLACEMENT CHARACTER}")
        message = f"byte {error.start} of the file is not UTF-8 (0x{data[error.start]:02x})"
        span = Span(len(before), len(before) + 1)
        raise MissionError(
            source, [Diagnostic(Code.NOT_UTF8, span, message, "save the file as UTF-8")]
        ) from None
    return Source(name, _line_ends(text))


def prepare(source: Source) -> Prepared:
    """Check the limits, and blank out comments and printed line numbers; raises MissionError."""
    text = source.text
    problem = _out_of_bounds(text)
    if problem:
        raise MissionError(
            Source(source.name, "") if problem.code is Code.FILE_TOO_LARGE else source, [problem]
        )
    try:
        scanned = _scan(text)
    except _Refused as refused:
        raise MissionError(source, [refused.diagnostic]) from None
    unseen = sorted([*(each.span for each in scanned.comments), *(each.span for each in scanned.mistakes)])
    return replace(scanned, text=_without_line_numbers(_blank(text, unseen)))


class _Refused(Exception):
    def __init__(self, diagnostic: Diagnostic) -> None:
        self.diagnostic = diagnostic
        super().__init__(diagnostic)


def _line_ends(text: str) -> str:
    return text.replace("\r\n", "\n").replace("\r", "\n")


def _too_large(size: int) -> Diagnostic:
    message = f"the file has {size:,} bytes, more than {MAX_BYTES:,}"
    return Diagnostic(Code.FILE_TOO_LARGE, Span(0, 0), message, "put large worlds into GeoJSON files")


def _out_of_bounds(text: str) -> Diagnostic | None:
    if (size := len(text)) > MAX_BYTES or (size := len(text.encode("utf-8", "surrogatepass"))) > MAX_BYTES:
        return _too_large(size)
    if found := _CONTROL.search(text):
        message = f"control character U+{ord(found.group()):04X}"
        hint = "a mission file is text in UTF-8; remove it"
        return Diagnostic(Code.CONTROL_CHARACTER, Span(found.start(), found.end()), message, hint)
    return next((_too_long(run.start(), run.end()) for run in _RUN.finditer(text) if _long(run)), None)


def _long(found: re.Match[str]) -> bool:
    return found.end() - found.start() > MAX_WORD


def _too_long(start: int, end: int) -> Diagnostic:
    message = f"a word of {end - start:,} characters, more than {MAX_WORD:,}"
    return Diagnostic(
        Code.WORD_TOO_LONG, Span(start, end), message, "is a space, a quote or a brace missing?"
    )


def _scan(text: str) -> Prepared:
    comments: list[Comment] = []
    mistakes: list[Diagnostic] = []
    unmatched: tuple[int, Diagnostic] | None = None
    waiting: list[int] = []
    words = behind = 0
    last = text.rfind("*/")
    for found in _SCAN.finditer(text):
        start, end, sort = found.start(), found.end(), found.lastgroup
        if start < behind:
            continue
        if sort == "block":
            behind = text.find("*/", end) + len("*/") if end <= last else _line_end(text, end)
            mistakes.append(_block(start, behind))
            continue
        if sort == "comment":
            comments.append(Comment(Span(start, end), found.group().rstrip()))
            continue
        words += 1
        _refuse(sort, start, end, words, len(waiting))
        if sort == "unclosed":
            mistakes.append(_unclosed(start, end))
        elif sort == "open":
            waiting.append(start)
        elif sort == "close":
            if waiting and _PARTNER[text[waiting[-1]]] == found.group():
                waiting.pop()
            elif unmatched is None:
                unmatched = start, _mismatch(text, waiting, start)
    return Prepared(text, tuple(comments), tuple(mistakes), unmatched, tuple(waiting))


def _unclosed(start: int, end: int) -> Diagnostic:
    message = "the string that begins here does not end on its line"
    return Diagnostic(Code.UNCLOSED_STRING, Span(start, end), message, _CLOSE)


def _line_end(text: str, start: int) -> int:
    end = text.find("\n", start)
    return len(text) if end < 0 else end


def _block(start: int, end: int) -> Diagnostic:
    hint = "write // before each line of the comment"
    return Diagnostic(Code.UNKNOWN_CHARACTER, Span(start, end), "'/*' begins no comment here", hint)


def _refuse(sort: str | None, start: int, end: int, words: int, depth: int) -> None:
    if words > MAX_WORDS:
        message = f"more than {MAX_WORDS:,} words and symbols"
        hint = "put large worlds into GeoJSON files"
        raise _Refused(Diagnostic(Code.TOO_MANY_WORDS, Span(start, end), message, hint))
    if sort == "open" and depth >= MAX_NESTING:
        message = f"brackets nested more than {MAX_NESTING} deep"
        hint = "define behaviours with def and name values with let"
        raise _Refused(Diagnostic(Code.NESTED_TOO_DEEPLY, Span(start, end), message, hint))
    if sort == "string" and end - start > MAX_WORD:
        raise _Refused(_too_long(start, end))


def _mismatch(text: str, waiting: list[int], start: int) -> Diagnostic:
    closing = text[start]
    if not any(_PARTNER[text[opening]] == closing for opening in waiting):
        message = f"'{closing}' closes nothing"
        hint = "remove it, or look for an opening bracket that is missing or commented out"
        return Diagnostic(Code.UNOPENED_BRACKET, Span(start, start + 1), message, hint)
    opening = waiting[-1]
    message = (
        f"'{text[opening]}' is not closed before the '{closing}' in line {text.count(chr(10), 0, start) + 1}"
    )
    hint = f"close it with '{_PARTNER[text[opening]]}'"
    return Diagnostic(Code.UNCLOSED_BRACKET, Span(opening, opening + 1), message, hint)


def _blank(text: str, spans: list[Span]) -> str:
    pieces, last = [], 0
    for span in spans:
        pieces += [text[last : span.start], _UNSEEN.sub(" ", text[span.start : span.end])]
        last = span.end
    return "".join([*pieces, text[last:]])


def _without_line_numbers(text: str) -> str:
    """Blank out the line numbers of programs pasted from print, such as the paper's Figure 8.

    A line that begins with a number and `BigActor` starts the numbering. It ends with the block, or where a line's
    number is not the next one.
    """
    return _blank(text, list(_line_numbers(text))) if "BigActor" in text else text


def _line_numbers(text: str) -> Iterator[Span]:
    offset, expected, depth = 0, None, 0
    for line in text.splitlines(keepends=True):
        found = _NUMBERED.match(line)
        if found and _NUMBERED_ACTOR.match(line):
            expected, depth = int(found["number"]), 0
        if found and int(found["number"]) == expected:
            yield Span(offset + found.start("number"), offset + found.end("number"))
            code = _QUOTED.sub("", line)
            depth += code.count("{") - code.count("}")
            expected = expected + 1 if depth > 0 else None
        elif line.strip():
            expected = None
        offset += len(line)
