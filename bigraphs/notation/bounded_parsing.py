"""Bounded parsing: checks before lark reads a text, and error messages afterwards."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Final

from bigraphs.errors import NotationError
from bigraphs.notation.lalr import ParsingStopped, Tables

if TYPE_CHECKING:
    from lark import Lark
    from lark.exceptions import UnexpectedInput

MAX_BYTES: Final = 1_000_000
MAX_NESTING: Final = 200
MAX_TOKEN: Final = 10_000
MAX_WORDS: Final = 200_000

_WORD: Final = re.compile(r"\w+|[^\w\s]")
_STEPS: Final = re.compile(r"[()]|\.|\|\|?|-->|->|[;,=]|[^\W\d]\w*|/")
_RESETS: Final = frozenset({"|", "||", "->", "-->", ";", ",", "="})


def read(parser: Lark, text: str, words: Mapping[str, str], start: str) -> Any:
    """Parse `text` from `start`; raises NotationError at the first syntax error, with terminals named by `words`.

    The parser must build its values while it parses, so that depth costs no recursion.
    """
    from lark.exceptions import UnexpectedInput  # noqa: PLC0415 - slow to load

    check_bounds(text)
    try:
        return parser.parse(text, start=start)
    except UnexpectedInput as found:
        raise _explain(found, text, words) from None


def read_into(
    builder: object, tables: Tables, make: Callable[[], Lark], text: str, words: Mapping[str, str], start: str
) -> Any:
    """Return the builder's value of a text, parsed by the tables of `make`'s parser.

    Raises:
        NotationError: At the first syntax error, with terminals named by `words`; lark explains it.
    """
    check_bounds(text)
    try:
        return tables.read(text, start, builder)
    except ParsingStopped:
        read(make(), text, words, start)
        raise


def check_bounds(text: str) -> None:
    """Raise NotationError if the text or a word is too long, has too many words or nests too deeply.

    The check takes linear time.
    """
    if len(text) > MAX_BYTES or len(text.encode("utf-8", "surrogatepass")) > MAX_BYTES:
        hint = "split it, or write it as relations (from_relations)"
        raise NotationError("too-long", "the text is longer than 1 MB", text, 0, hint=hint)
    for word in re.finditer(rf"[^\s.|(){{}}\[\],;/]{{{MAX_TOKEN + 1},}}", text):
        raise NotationError("too-long", "a word is longer than 10 kB", text, word.start())
    if sum(1 for _ in _WORD.finditer(text)) > MAX_WORDS:
        raise NotationError("too-long", f"the text has more than {MAX_WORDS} words and symbols", text, 0)
    _check_nesting(text)


def _check_nesting(text: str) -> None:
    depth, base, before = 0, [0], [0]
    for step in _STEPS.finditer(text):
        symbol = step.group()
        if symbol == "(":
            before.append(depth)
            depth += 1
            base.append(depth)
        elif symbol == ")":
            depth = before.pop() if len(before) > 1 else 0
            del base[len(before) :]
        elif symbol in _RESETS:
            depth = base[-1]
        elif symbol in "./":
            depth += 1
        if depth > MAX_NESTING:
            message = f"nesting deeper than {MAX_NESTING}"
            raise NotationError("too-deep", message, text, step.start(), hint="name inner parts apart")


def _explain(found: UnexpectedInput, text: str, words: Mapping[str, str]) -> NotationError:
    from lark.exceptions import UnexpectedCharacters, UnexpectedToken  # noqa: PLC0415 - slow to load

    if isinstance(found, UnexpectedToken):
        names = found.accepts or found.expected
        at_end = found.token.type == "$END"
        offset = len(text.rstrip()) if at_end else found.token.start_pos or 0
        seen = "the text ends" if at_end else f"found '{_short(str(found.token))}'"
        length = 1 if at_end else len(found.token)
    else:
        names = found.allowed if isinstance(found, UnexpectedCharacters) else set()
        offset, length = found.pos_in_stream or 0, 1
        seen = f"found {_short(text[offset : offset + 1])!r}"
    expected = sorted({words[name] for name in names or () if name in words})
    message = f"{seen}, expected {_one_of(expected)}" if expected else f"{seen}, which is not allowed here"
    return NotationError("syntax", message, text, offset, length=length)


def _short(token: str) -> str:
    return token if len(token) <= 40 else token[:37] + "..."


def _one_of(words: list[str]) -> str:
    return words[0] if len(words) == 1 else ", ".join(words[:-1]) + " or " + words[-1]
