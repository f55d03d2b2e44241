"""Checks of text from outside: names, JSON, and quotations of either.

Checked text can be printed, encoded and recorded without further checks.
"""

from __future__ import annotations

import json
import math
import re
from collections import Counter
from typing import Final, NoReturn, TypeGuard

from physical.errors import PhysicalError

MAX_WORD: Final = 200
MAX_TEXT: Final = 2_000
"""The maximum length of a message or a reason, in characters."""

MAX_DIGITS: Final = 300
"""The maximum digits of an integer in JSON: every such integer fits a float, and parsing is fast."""

_SURROGATE: Final = re.compile(rb"\\u[dD][89a-fA-F]|\xed[\xa0-\xbf]")
"""The forms of half a surrogate pair in JSON: an escape, or bytes that are invalid UTF-8."""


def is_word(value: object) -> TypeGuard[str]:
    """Whether a value is a valid name: 1 to 200 printable characters, not only spaces.

    >>> is_word("oilSpill0"), is_word(" "), is_word("a" * 201), is_word(chr(0xD800)), is_word(7)
    (True, False, False, False, False)
    """
    return (
        isinstance(value, str) and 0 < len(value) <= MAX_WORD and value.isprintable() and bool(value.strip())
    )


def is_text(value: object) -> TypeGuard[str]:
    """Whether a value is a message: valid Unicode of at most 2,000 characters."""
    if not isinstance(value, str) or len(value) > MAX_TEXT:
        return False
    return not any("\ud800" <= sign <= "\udfff" for sign in value)


def legible(text: str, most: int = MAX_TEXT) -> str:
    r"""Return a foreign text for quotation: unprintable characters are replaced, and a long text is cut.

    >>> legible("a\ud800b"), legible("abcdefgh", 6)
    ('a�b', 'abc...')
    """
    cut = text if len(text) <= most else f"{text[: most - 3]}..."
    if cut.isprintable():
        return cut
    return "".join(
        sign if sign.isprintable() or sign in "\n\t" else "\N{REPLACEMENT CHARACTER}" for sign in cut
    )


def read_json(text: str | bytes, most: int) -> object:
    """Return the value of a JSON text; it can be encoded as JSON again.

    Raises:
        PhysicalError: If the text is longer than `most` bytes or characters, is no UTF-8 or no JSON, or is nested too
            deeply. Also for a repeated key in an object, for a number that is infinite, NaN or longer than 300 digits,
            and for half of a surrogate pair.
    """
    if len(text) > most:
        raise PhysicalError("too-large", f"the text is over {most:,} bytes", "simplify it")
    try:
        said = text if isinstance(text, str) else text.decode("utf-8-sig")
        value: object = _DECODER.decode(said)
        if _SURROGATE.search(said.encode("utf-8", "surrogatepass")):
            json.dumps(value, ensure_ascii=False).encode()
    except UnicodeDecodeError as problem:
        message = f"the text is not UTF-8: byte {problem.start} is not valid"
        raise PhysicalError("encoding", message, "save it as UTF-8") from None
    except UnicodeEncodeError:
        message = "the text has half of a surrogate pair, which is no character"
        raise PhysicalError("encoding", message, "save it as UTF-8") from None
    except RecursionError:
        raise PhysicalError("json", "the text is nested too deeply") from None
    except ValueError as problem:
        raise PhysicalError("json", f"the text is not JSON: {problem}") from None
    return value


def _each_once(pairs: list[tuple[str, object]]) -> dict[str, object]:
    found = dict(pairs)
    if len(found) < len(pairs):
        twice = next(key for key, count in Counter(key for key, _ in pairs).items() if count > 1)
        raise ValueError(f"the key {legible(twice, 60)!r} is there twice in one object")
    return found


def _whole(digits: str) -> int:
    return int(digits) if len(digits.removeprefix("-")) <= MAX_DIGITS else _too_long(digits)


def _too_long(digits: str) -> NoReturn:
    raise ValueError(f"a number of {len(digits):,} digits is longer than {MAX_DIGITS}")


def _no_number(name: str) -> NoReturn:
    raise ValueError(f"{name} is no number")


def _finite(digits: str) -> float:
    value = float(digits)
    return value if math.isfinite(value) else _no_number(f"{digits:.40}")


_DECODER: Final = json.JSONDecoder(
    object_pairs_hook=_each_once, parse_float=_finite, parse_int=_whole, parse_constant=_no_number
)
