"""Matplotlib's SVG, reduced to self-contained shapes and text, for a page or a file.

Only known elements and attributes are kept, and only references within the picture or to pictures in the same folder.
Ids have a prefix, so that one page can hold several pictures. Text stays text with its measured width in the reader's
font. A group that stands for several names has them as its title.
"""

import re
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from html import escape
from io import StringIO
from typing import TYPE_CHECKING, Final

from checker.reports.results import clean
from physical.map_style import text_width

if TYPE_CHECKING:
    from matplotlib.figure import Figure

ELEMENTS: Final = frozenset(
    {"g", "a", "path", "text", "tspan", "use", "defs", "clipPath", "rect", "circle", "ellipse", "line"}
)
ATTRIBUTES: Final = frozenset(
    {
        "d",
        "x",
        "y",
        "width",
        "height",
        "transform",
        "style",
        "clip-path",
        "id",
        "r",
        "cx",
        "cy",
        "rx",
        "ry",
        "href",
    }
)
LINK: Final = "{http://www.w3.org/1999/xlink}href"
NAMES: Final = "names:"
"""The prefix of the id of a group that stands for several names."""

FILE: Final = re.compile(r"[\w-]+\.svg")
"""The allowed targets of a link: a picture in the same folder."""

FONTS: Final = "'DejaVu Sans',Verdana,Geneva,sans-serif"
STYLE: Final = (
    ".bigactors text{white-space:pre;paint-order:stroke;stroke:#fff;stroke-opacity:.8;stroke-width:2.2px;"
    "stroke-linejoin:round}"
)
"""A halo around the text of a single picture; the class keeps it from other pictures in the same notebook."""

LONG: Final = re.compile(r"-?\d+\.\d{3,}")
FONT: Final = re.compile(r"font: (?:(?P<style>\w+) )?(?:(?P<weight>\d+|bold) )?(?P<size>[\d.]+)px")


def svg_file(figure: "Figure", title: str) -> str:
    """Return a figure as the text of an SVG file; its units are points."""
    width, height = (72 * inches for inches in figure.get_size_inches())
    about = f"<title>{escape(clean(title))}</title><style>{STYLE}</style>"
    paper = f'<rect width="{width:g}" height="{height:g}" fill="#fff"/>'
    size = f'width="{width:g}pt" height="{height:g}pt" viewBox="0 0 {width:g} {height:g}"'
    look = f'class="bigactors" font-family="{FONTS}" role="img"'
    root = f'<svg xmlns="http://www.w3.org/2000/svg" {size} {look}>'
    return f"{root}{about}{paper}{svg_of(figure, 'p')}</svg>\n"


def svg_of(figure: "Figure", key: str) -> str:
    """Return the shapes of a figure as SVG without the outermost element; the key prefixes all ids."""
    import matplotlib as mpl  # noqa: PLC0415 - only drawing needs matplotlib
    from matplotlib.text import Text  # noqa: PLC0415 - the same

    for text in figure.findobj(Text):
        text.set_path_effects([])  # the page's style sheet draws the halo of text
        text.set_text(clean(text.get_text()))
        if names := text.get_gid():
            text.set_gid(clean(names))
    written = StringIO()
    with mpl.rc_context({"svg.fonttype": "none"}):
        figure.savefig(written, format="svg", metadata={"Date": None, "Creator": None})
    root = ET.fromstring(written.getvalue())
    return "".join(piece for child in root for piece in _element(child, key))


def _element(element: ET.Element, key: str) -> Iterator[str]:
    tag = element.tag.rpartition("}")[2]
    if tag not in ELEMENTS:
        return
    inner = escape((element.text or "").strip(), quote=False) if tag in ("text", "tspan") else ""
    inner += "".join(piece for child in element for piece in _element(child, key))
    kept = dict(_attributes(element, tag, key))
    if "data-names" in kept:
        inner = f"<title>{escape(kept['data-names'])}</title>{inner}"
    if tag in ("g", "defs") and not inner:
        return
    if tag in ("g", "a") and not kept:
        yield inner
        return
    words = "".join(f' {name}="{escape(value)}"' for name, value in kept.items())
    yield f"<{tag}{words}>{inner}</{tag}>" if inner else f"<{tag}{words}/>"


def _attributes(element: ET.Element, tag: str, key: str) -> Iterator[tuple[str, str]]:
    for name, value in element.attrib.items():
        plain = "href" if name == LINK else name
        if tag == "g" and plain == "id" and value.startswith(NAMES):
            yield "data-names", value.removeprefix(NAMES)
        if plain not in ATTRIBUTES or (plain == "id" and tag == "g") or value.startswith("rotate(-0 "):
            continue
        if plain == "href" and not (FILE.fullmatch(value) if tag == "a" else value.startswith("#")):
            continue
        yield plain, value if tag == "a" else _value(plain, value, key)
    if tag == "text" and element.text:
        yield from _measured(element)


def _value(name: str, value: str, key: str) -> str:
    if name == "id":
        return f"{key}-{value}"
    if name == "href":
        return f"#{key}-{value[1:]}"
    if name == "clip-path":
        return re.sub(r"url\(#([\w-]+)\)", rf"url(#{key}-\1)", value)
    if name == "style":
        return re.sub(r"; ?", ";", re.sub(r"font-family: [^;]*;?", "", value)).replace(": ", ":").strip("; ")
    return LONG.sub(
        lambda number: f"{float(number[0]):.2f}", value.replace(" \n", " ").replace("\n", " ")
    ).strip()


def _measured(element: ET.Element) -> Iterator[tuple[str, str]]:
    """Yield the attributes that give text its measured width in the reader's font."""
    style = element.get("style", "")
    size = re.search(r"font-size: ([\d.]+)px", style) or FONT.search(style)
    if size is not None:
        width = float(size["size"] if size.re is FONT else size[1])
        bold = "font-weight: bold" in style or "font-weight: 700" in style or "bold" in style
        wide = text_width((element.text or "").strip(), width, bold=bold)
        if wide > 1:
            yield "textLength", f"{wide:.1f}"
            yield "lengthAdjust", "spacingAndGlyphs"
