"""A page of a picture: a canvas with headings and rules; and text in several lines."""

import re
from typing import Final

from physical.map_style import INK, QUIET
from physical.svg import Canvas, Paint, Words, shortened, text_width

RULE: Final = Paint(stroke="#d8dee4", width=0.8)


class Page(Canvas):
    """A canvas of a width and height in points from its upper left corner; y goes downwards."""

    def write(  # noqa: PLR0913 - all but three are optional, and passed by name
        self,
        x: float,
        baseline: float,
        text: str,
        size: float = 8.0,
        *,
        bold: bool = False,
        ink: str = INK,
        anchor: str = "start",
        width: float | None = None,
        halo: bool = False,
    ) -> None:
        """Write a line of text; `width` cuts it."""
        text = text if width is None else shortened(text, width, size, bold)
        self.text((x, baseline), text, Words(size, ink, bold, anchor=anchor, halo=halo))

    def heading(self, x: float, baseline: float, text: str, gloss: str) -> None:
        """Write a heading, followed by its meaning in a quiet style."""
        self.write(x, baseline, text, 9.5, bold=True)
        self.write(x + text_width(text, 9.5, bold=True) + 7, baseline, gloss, 8.0, ink=QUIET)

    def rule(self, left: float, right: float, y: float) -> None:
        """Draw a thin horizontal line."""
        self.line([(left, y), (right, y)], RULE)


def wrapped(text: str, width: float, size: float, most: int) -> tuple[str, ...]:
    """Return a text in at most `most` lines, wrapped after blanks and brackets; a last line that is too long is cut.

    >>> wrapped("observe(CHILDREN(PARENT(uav0)))", 90.0, 7.0, 3)
    ('observe(CHILDREN(', 'PARENT(uav0)))')
    """
    lines: list[str] = []
    words = re.split(r"(?<=[ (])", text.strip())
    while any(words) and len(lines) < most - 1:
        fitting = 1
        while fitting < len(words) and text_width("".join(words[: fitting + 1]).rstrip(), size) <= width:
            fitting += 1
        lines.append(shortened("".join(words[:fitting]).rstrip(), width, size))
        words = words[fitting:]
    rest = "".join(words).strip()
    return (*lines, shortened(rest, width, size)) if rest else tuple(lines)
