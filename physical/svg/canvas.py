"""A canvas: shapes and lines of text as SVG elements, from back to front."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from html import escape
from itertools import groupby
from typing import Final, TypeAlias

from physical.svg.picture import Picture
from physical.svg.widths import text_width

Point: TypeAlias = tuple[float, float]

FORBIDDEN: Final = re.compile("[\x00-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff]")
"""Control characters, line ends too, and code points that XML cannot hold."""

SLANT: Final = -11.0
"""The angle of slanted text in degrees; there is no slanted font."""

HALO: Final = 'paint-order="stroke" stroke="#fff" stroke-width="2.2" stroke-opacity=".8"'
"""The attributes of a light border around text, which parts it from the lines below it."""

FILE: Final = re.compile(r"[\w-]+\.svg")
"""The allowed targets of a link: a picture in the same folder."""


@dataclass(frozen=True, slots=True)
class Paint:
    """The look of a shape: its colours, the width of its border, the lengths of dashes in widths, and its opacity."""

    fill: str = "none"
    stroke: str = "none"
    width: float = 1.0
    dash: tuple[float, ...] = ()
    opacity: float = 1.0

    @property
    def attributes(self) -> str:
        """The attributes of an SVG element."""
        words = f' fill="{self.fill}"'
        if self.stroke != "none":
            words += f' stroke="{self.stroke}"' + (
                f' stroke-width="{self.width:g}"' if self.width != 1 else ""
            )
            if self.dash:
                words += f' stroke-dasharray="{" ".join(number(each * self.width) for each in self.dash)}"'
        return words + (f' opacity="{self.opacity:g}"' if self.opacity != 1 else "")


@dataclass(frozen=True, slots=True)
class Words:
    """The look of a line of text; `anchor` is its `start`, `middle` or `end`. A `halo` parts it from lines below it."""

    size: float
    ink: str
    bold: bool = False
    slanted: bool = False
    anchor: str = "start"
    opacity: float = 1.0
    halo: bool = False


@dataclass(frozen=True, slots=True)
class _Shape:
    level: float
    element: str
    halo: bool = False


class Canvas:
    """Shapes on a sheet; a shape of a higher level hides those of lower ones.

    The units are points. The origin is the upper left corner of the sheet or another point of it. `y` goes down; on a
    canvas that is `upwards` it goes up from the lower edge.
    """

    def __init__(
        self, width: float, height: float, origin: Point = (0.0, 0.0), *, upwards: bool = False
    ) -> None:
        self.width, self.height, self.origin, self.upwards = width, height, origin, upwards
        self._shapes: list[_Shape] = []

    @property
    def shapes(self) -> str:
        """All SVG elements, from back to front."""
        ordered = sorted(self._shapes, key=lambda shape: shape.level)
        runs = (
            (halo, "".join(shape.element for shape in run))
            for halo, run in groupby(ordered, lambda shape: shape.halo)
        )
        return "".join(f"<g {HALO}>{elements}</g>" if halo else elements for halo, elements in runs)

    def picture(self, title: str, scale: float = 1.0) -> Picture:
        """Return the picture on the canvas, magnified by the scale."""
        if scale != 1.0:
            larger = Canvas(self.width * scale, self.height * scale)
            larger.put(self, (0.0, 0.0), scale)
            return larger.picture(title)
        return Picture(self.width, self.height, plain(title), self.shapes)

    def line(self, points: Iterable[Point], paint: Paint, level: float = 1.0) -> None:
        """Draw a line through points."""
        self._add(f'<path d="{self._path(points)}"{paint.attributes}/>', level)

    def polygon(self, points: Iterable[Point], paint: Paint, level: float = 1.0) -> None:
        """Draw a closed line."""
        self.rings([points], paint, level)

    def rings(self, rings: Iterable[Iterable[Point]], paint: Paint, level: float = 1.0) -> None:
        """Draw a polygon with holes: the ring of its border, then those of the holes."""
        paths = [f"{self._path(ring)}Z" for ring in rings]
        rule = ' fill-rule="evenodd"' if len(paths) > 1 else ""
        self._add(f'<path d="{"".join(paths)}"{rule}{paint.attributes}/>', level)

    def curve(self, points: Sequence[Point], paint: Paint, level: float = 1.0) -> None:
        """Draw a Bézier curve: a quadratic one of three points, or a chain of cubic ones."""
        letter = "Q" if len(points) == 3 else "C"
        path = f"{self._path(points[:1])}{letter}{' '.join(map(self._at, points[1:]))}"
        self._add(f'<path d="{path}"{paint.attributes}/>', level)

    def circle(self, centre: Point, radius: float, paint: Paint, level: float = 1.0) -> None:
        """Draw a circle."""
        x, y = self._at(centre).split()
        self._add(f'<circle cx="{x}" cy="{y}" r="{number(radius)}"{paint.attributes}/>', level)

    def rectangle(
        self,
        corner: Point,
        size: Point,
        paint: Paint,
        level: float = 1.0,
        *,
        radius: float = 0.0,
        link: str | None = None,
    ) -> None:
        """Draw a rectangle from its upper left corner, with rounded corners; in a file it may link to another one."""
        (x, y), (width, height) = self._at(corner).split(), map(number, size)
        turn = f' rx="{number(min(radius, *(side / 2 for side in size)))}"' if radius else ""
        shape = f'<rect x="{x}" y="{y}" width="{width}" height="{height}"{turn}{paint.attributes}/>'
        known = link is not None and FILE.fullmatch(link)
        self._add(f'<a href="{link}">{shape}</a>' if known else shape, level)

    def text(self, at: Point, text: str, words: Words, level: float = 1.0, names: Sequence[str] = ()) -> None:
        """Write a line of text from a point on its baseline; `names` are the names for which it stands."""
        text = plain(text)
        if not text.strip():
            return
        x, y = self._at(at).split()
        place = f'transform="translate({x} {y}) skewX({SLANT:g})"' if words.slanted else f'x="{x}" y="{y}"'
        look = f' font-size="{words.size:g}" fill="{words.ink}"' + (
            ' font-weight="bold"' if words.bold else ""
        )
        look += f' text-anchor="{words.anchor}"' if words.anchor != "start" else ""
        look += f' opacity="{words.opacity:g}"' if words.opacity != 1 else ""
        width = text_width(text, words.size, words.bold)
        fit = f' textLength="{width:.1f}" lengthAdjust="spacingAndGlyphs"' if width > 1 else ""
        shape = f"<text {place}{look}{fit}>{escape(text, quote=False)}</text>"
        if names:
            known = escape(plain(", ".join(names)))
            shape = f'<g data-names="{known}"><title>{known}</title>{shape}</g>'
        self._shapes.append(_Shape(level, shape, words.halo))

    def put(
        self,
        other: Canvas,
        corner: Point,
        scale: float = 1.0,
        level: float = 1.0,
        *,
        clipped: bool = False,
        title: str = "",
    ) -> None:
        """Put another canvas on this one, with its upper left corner at a point.

        `clipped` hides the shapes beyond the other canvas. A browser shows the title over the shapes.
        """
        place = "translate({} {})".format(*self._at(corner).split())
        place += f" scale({number(scale, 4)})" if scale != 1 else ""
        inside = (f"<title>{escape(plain(title))}</title>" if title else "") + other.shapes
        if clipped:  # an inner <svg> clips to its size, without an id
            inside = f'<svg width="{number(other.width)}" height="{number(other.height)}">{inside}</svg>'
        self._add(f'<g transform="{place}">{inside}</g>', level)

    def _add(self, element: str, level: float) -> None:
        self._shapes.append(_Shape(level, element))

    def _path(self, points: Iterable[Point]) -> str:
        return f"M{' '.join(map(self._at, points))}"

    def _at(self, point: Point) -> str:
        x, y = point[0] + self.origin[0], point[1] + self.origin[1]
        return f"{number(x)} {number(self.height - y if self.upwards else y)}"


def plain(text: str) -> str:
    r"""Return one line of text that XML can hold; other characters are replaced.

    >>> plain("a\x1b<b\n")
    'a�<b�'
    """
    return FORBIDDEN.sub("\N{REPLACEMENT CHARACTER}", text)


def number(value: float, digits: int = 2) -> str:
    """Return a coordinate without superfluous digits.

    >>> number(1.5), number(2.0), number(-0.001), number(1 / 3)
    ('1.5', '2', '0', '0.33')
    """
    text = f"{value:.{digits}f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text
