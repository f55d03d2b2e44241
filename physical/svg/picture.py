"""A finished picture: its SVG, its PNG and its file."""

from __future__ import annotations

import re
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import Final

from physical.svg.widths import FONTS

FORMATS: Final = ("svg", "png")
RESOLUTION: Final = 144
"""The resolution of a PNG, in dots an inch."""

MOST_DOTS: Final = 65_535
"""The greatest width and height of a PNG in dots; many programs open no larger one."""

FAMILY: Final = "'DejaVu Sans',Verdana,Geneva,sans-serif"


class PictureError(ValueError):
    """A picture that cannot be written as requested: the fact and a remedy."""

    def __init__(self, fact: str, remedy: str) -> None:
        super().__init__(f"{fact}: {remedy}")
        self.fact, self.remedy = fact, remedy


@dataclass(frozen=True, slots=True)
class Picture:
    """A picture of a width and a height in points; `shapes` are the SVG elements in it.

    Equal pictures have equal files, as SVG and as PNG.
    """

    width: float
    height: float
    title: str
    shapes: str

    @property
    def svg(self) -> str:
        """The text of an SVG file."""
        width, height = f"{self.width:g}", f"{self.height:g}"
        size = f'width="{width}pt" height="{height}pt" viewBox="0 0 {width} {height}"'
        look = f'font-family="{FAMILY}" stroke-linejoin="round" xml:space="preserve" role="img"'
        about = f"<title>{escape(self.title)}</title>"
        paper = f'<rect width="{width}" height="{height}" fill="#fff"/>'
        return f'<svg xmlns="http://www.w3.org/2000/svg" {size} {look}>{about}{paper}{self.shapes}</svg>\n'

    @property
    def png(self) -> bytes:
        """The picture as PNG.

        Raises:
            PictureError: The picture is too large.
        """
        from resvg_py import svg_to_bytes  # noqa: PLC0415 - only a PNG needs it

        for dots, extent in ((self.height, "high"), (self.width, "wide")):
            if (most := int(dots * RESOLUTION / 72)) > MOST_DOTS:
                fact = f"it would be {most:,} dots {extent}, and a .png has at most {MOST_DOTS:,}"
                raise PictureError(fact, "name it .svg or .html")
        fonts = [str(path) for path in FONTS]
        return bytes(
            svg_to_bytes(svg_string=self.svg, dpi=RESOLUTION, skip_system_fonts=True, font_files=fonts)
        )

    def save(self, path: str | Path) -> None:
        """Write the picture to a file, `.svg` or `.png`.

        Raises:
            PictureError: The file has another suffix, or the picture is too large for a PNG.
            OSError: The file cannot be written.
        """
        path = Path(path)
        form = path.suffix.lower().lstrip(".")
        if form not in FORMATS:
            raise PictureError(f"cannot write a picture as '{path.name}'", "name it .svg or .png")
        if form == "svg":
            path.write_text(self.svg, encoding="utf-8", newline="\n")
        else:
            path.write_bytes(self.png)

    def _repr_svg_(self) -> str:
        """Return the SVG for a notebook, with a width that shrinks with its page."""
        style = r'<svg\1style="width:100%;max-width:\2pt;height:auto"'
        return re.sub(r'<svg(\s[^>]*?)width="([\d.e+]+)pt" height="[\d.e+]+pt"', style, self.svg, count=1)

    def _repr_png_(self) -> bytes:
        """Return the PNG for a notebook."""
        return self.png
