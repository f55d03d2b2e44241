"""Text on one line of bounded length, for the `repr` of large values."""

from typing import Final

MOST: Final = 120


def cut(text: object, most: int = MOST) -> str:
    r"""Return a text on one line, cut to at most `most` characters.

    >>> cut("observe(ALL)", 9), cut("one\ntwo")
    ('observe(…', 'one two')
    """
    line = " ".join(str(text).split())
    return line if len(line) <= most else f"{line[: most - 1]}…"
