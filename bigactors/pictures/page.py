"""A page: a figure in points from its upper left corner, written as a file.

Text in an SVG stays text with its measured width. Files have no dates and a fixed salt for ids, so two runs give the
same bytes.
"""

import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from bigactors.pictures.vector import svg_file
from physical.map_style import INK, QUIET, shortened, text_width

if TYPE_CHECKING:
    from matplotlib.axes import Axes

FORMATS: Final = ("svg", "png")
RESOLUTION: Final = 144
"""The resolution of a PNG, in dots an inch."""

MOST_DOTS: Final = 65_535
"""The greatest height of a PNG in dots, a limit of the renderer."""


class PictureError(ValueError):
    """A picture that cannot be written as requested."""


class Page:
    """A figure of a width and height in points, with axes over all of it; y goes downwards."""

    def __init__(self, width: float, height: float) -> None:
        from matplotlib.figure import Figure  # noqa: PLC0415 - only drawing needs matplotlib

        self.width, self.height = width, height
        self.figure: Figure = Figure(figsize=(width / 72, height / 72), facecolor="white")
        self.axes = self.panel(0.0, 0.0, width, height)
        self.axes.set(xlim=(0, width), ylim=(height, 0))
        self.axes.axis("off")

    def panel(self, left: float, top: float, width: float, height: float) -> "Axes":
        """Return new axes on a part of the page."""
        frame = (
            left / self.width,
            1 - (top + height) / self.height,
            width / self.width,
            height / self.height,
        )
        return self.figure.add_axes(frame, xticks=(), yticks=())

    def write(self, x: float, baseline: float, text: str, size: float = 8.0, **style: Any) -> None:
        """Write a line of text. `width` cuts it; `bold` and `ink` set its look."""
        bold, width = style.pop("bold", False), style.pop("width", None)
        self.axes.text(
            x,
            baseline,
            text if width is None else shortened(text, width, size, bold),
            fontsize=size,
            fontweight="bold" if bold else "normal",
            color=style.pop("ink", INK),
            parse_math=False,
            **style,
        )

    def heading(self, x: float, baseline: float, text: str, gloss: str) -> None:
        """Write a heading, followed by its meaning in a quiet style."""
        self.write(x, baseline, text, 9.5, bold=True)
        self.write(x + text_width(text, 9.5, bold=True) + 7, baseline, gloss, 8.0, ink=QUIET)

    def rule(self, left: float, right: float, y: float) -> None:
        """Draw a thin horizontal line."""
        self.axes.plot([left, right], [y, y], color="#d8dee4", linewidth=0.8)

    def save(self, path: Path, title: str) -> None:
        """Write the page to a file, `.svg` or `.png`.

        Raises:
            PictureError: The file has another suffix, or the page is too high for a PNG.
        """
        form = path.suffix.lower().lstrip(".")
        if form not in FORMATS:
            raise PictureError(f"cannot write a picture as '{path.name}': name it .svg or .png")
        if form == "svg":
            path.write_text(svg_file(self.figure, title), encoding="utf-8")
        else:
            if (dots := int(self.height * RESOLUTION / 72)) > MOST_DOTS:
                told = f"it would be {dots:,} dots high, and a .png has at most {MOST_DOTS:,}"
                raise PictureError(f"{told}: name it .svg or .html")
            about = {"Software": None, "Title": title}
            self.figure.savefig(path, format=form, dpi=RESOLUTION, metadata=about)


@contextmanager
def plain_style() -> Iterator[None]:
    """Use matplotlib's defaults in the body, whatever the user's settings are."""
    import matplotlib as mpl  # noqa: PLC0415 - only drawing needs matplotlib

    with mpl.rc_context():
        mpl.rcdefaults()
        mpl.rcParams.update({"svg.hashsalt": "bigactors", "font.family": "DejaVu Sans"})
        yield


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
