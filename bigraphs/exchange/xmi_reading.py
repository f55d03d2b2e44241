"""Read a bigraph from an XMI file of the Bigraph Framework (bigraphs.org).

Such a file is an instance of the framework's metamodel of bigraphs: places nest as elements, and a port, or an inner
name, refers to its link by a path. It has no declarations: a control has as many ports as its nodes show, which have
an order, and is active. Names of nodes tell the framework's objects apart, and mean nothing; they are not read.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Final
from xml.parsers import expat

from bigraphs.bigraph import Bigraph, Link, Node, Place, assemble
from bigraphs.errors import BigraphError, NotationError
from bigraphs.exchange.xmi_writing import names_a_control
from bigraphs.notation.reading import MAX_BYTES, MAX_NESTING
from bigraphs.signature import Control, Signature

TYPE: Final = "http://www.w3.org/2001/XMLSchema-instance type"
MOST_PORTS: Final = 1_000
"""The most ports of a node that is read: a file may give any number as an index."""

_LINK: Final = re.compile(r"#?//@(bEdges|bOuterNames)\.(\d{1,7})", re.ASCII)
_PARTS: Final[Mapping[str, frozenset[str]]] = {
    "BBigraph": frozenset({"bRoots", "bEdges", "bInnerNames", "bOuterNames"}),
    "bRoots": frozenset({"bChild"}),
    "bChild": frozenset({"bChild", "bPorts"}),
}
"""Which elements may be in which: all others have none."""
_ATTRIBUTES: Final = frozenset({"name", "index", "bLink", "bPoints"})
"""What elements may say, beside what XMI itself lets them."""


@dataclass(slots=True)
class _Element:
    kind: str
    attributes: Mapping[str, str]
    offset: int
    parts: list[_Element] = field(default_factory=list)

    def of(self, kind: str) -> list[_Element]:
        return [part for part in self.parts if part.kind == kind]

    @property
    def control(self) -> str:
        """The local name of the element's type, `Room` of `sample:Room`."""
        return self.attributes.get(TYPE, "").rpartition(":")[2]


def read_xmi(text: str) -> Bigraph:
    """Return the bigraph in an XMI file; raises NotationError for what is none, or would be lost.

    A port or an inner name without a link has an edge of its own.
    """
    return _Reader(text, _parse(text)).bigraph()


def _parse(text: str) -> _Element:
    """Return the tree of elements; a document with a DOCTYPE, and so with entities, is refused."""
    content = text.encode("utf-8", "surrogatepass")
    if len(content) > MAX_BYTES:
        raise NotationError("too-long", "the text is longer than 1 MB", text, 0)
    parser = expat.ParserCreate("utf-8", " ")
    top = _Element("", {}, 0)
    open_elements = [top]

    def offset() -> int:
        return len(content[: parser.CurrentByteIndex].decode("utf-8", "replace"))

    def start(name: str, attributes: dict[str, str]) -> None:
        inside = open_elements[-1]
        kind = name.rpartition(" ")[2]
        if kind not in (_PARTS.get(inside.kind, frozenset()) if inside is not top else {"BBigraph"}):
            where = f"in {inside.kind}" if inside is not top else "as the whole"
            hint = "only one plain bigraph of the Bigraph Framework is read, without attributes"
            raise NotationError("element", f"an element '{kind}' {where}", text, offset(), hint=hint)
        if len(open_elements) > MAX_NESTING:
            raise NotationError("too-deep", f"nesting deeper than {MAX_NESTING}", text, offset())
        if lost := [each for each in attributes if " " not in each and each not in _ATTRIBUTES]:
            raise NotationError("attribute", f"an attribute '{lost[0]}', which is not read", text, offset())
        inside.parts.append(_Element(kind, attributes, offset()))
        open_elements.append(inside.parts[-1])

    def characters(data: str) -> None:
        if data.strip():
            raise NotationError("syntax", "a text between the elements", text, offset(), hint="take it out")

    def doctype(*_: object) -> None:
        raise NotationError("doctype", "a DOCTYPE, which is not read", text, offset(), hint="take it out")

    parser.StartElementHandler = start
    parser.EndElementHandler = lambda _: open_elements.pop()
    parser.CharacterDataHandler = characters
    parser.StartDoctypeDeclHandler = doctype
    try:
        parser.Parse(content, True)
    except expat.ExpatError as error:
        message = f"this is no XML: {expat.ErrorString(error.code)}"
        at = len(content[: parser.ErrorByteIndex].decode("utf-8", "replace"))
        raise NotationError("syntax", message, text, at) from None
    return top.parts[0]


class _Reader:
    """What is known while one document becomes a bigraph."""

    def __init__(self, text: str, document: _Element) -> None:
        self.text = text
        self.document = document
        self.edges = len(document.of("bEdges"))
        self.outer_names = self.names(document.of("bOuterNames"))
        self.points: dict[Link, int] = {}

    def bigraph(self) -> Bigraph:
        roots = self.in_order(self.document.of("bRoots"))
        places = self.places(roots)
        nodes = [(each, parent) for each, parent in places if each.control != "BSite"]
        number = {id(each): count for count, (each, _) in enumerate(nodes)}
        number |= {id(root): ~region for region, root in enumerate(roots)}
        arity = self.arities(each for each, _ in nodes)
        made = [
            Node(each.control, None, self.ports(each, arity[each.control]), (number[id(parent)],))
            for each, parent in nodes
        ]
        home: dict[int, Place] = {
            id(each): number[id(parent)] for each, parent in places if each.control == "BSite"
        }
        sites = [(home[id(site)],) for site in self.in_order([e for e, _ in places if e.control == "BSite"])]
        inner_names = self.document.of("bInnerNames")
        inner = dict(zip(self.names(inner_names), map(self.link, inner_names), strict=True))
        self.check_points()
        try:
            return assemble(
                Signature(tuple(Control(name, ports, ordered=ports > 1) for name, ports in arity.items())),
                made,
                regions=len(roots),
                sites=sites,
                edges=self.edges,
                inner_links=inner,
                outer_names=self.outer_names,
            )
        except BigraphError as error:
            raise self.mistake(error.code, error.message, self.document) from None

    def mistake(self, code: str, message: str, element: _Element, hint: str = "") -> NotationError:
        return NotationError(code, message, self.text, element.offset, hint=hint)

    def places(self, roots: Iterable[_Element]) -> list[tuple[_Element, _Element]]:
        """Return every node and site with what it is in."""
        found = [(child, root) for root in roots for child in root.of("bChild")]
        for place, _ in found:  # grows while it is walked
            if place.control != "BSite" and not names_a_control(place.control):
                message = f"the type '{place.attributes.get(TYPE, '')}' is no control"
                raise self.mistake("control", message, place, "give an xsi:type such as m:Room, or m:BSite")
            if place.control == "BSite" and place.parts:
                raise self.mistake("element", "a site with something in it", place)
            found += [(child, place) for child in place.of("bChild")]
        return found

    def index(self, element: _Element) -> int:
        written = element.attributes.get("index", "0")
        if not re.fullmatch(r"\d{1,7}", written, re.ASCII):
            raise self.mistake("index", f"'{written}' is no index", element, "count from 0")
        return int(written)

    def in_order(self, elements: list[_Element]) -> list[_Element]:
        """Return roots or sites by their indices, which are 0, 1, 2 and so on."""
        ordered = sorted(elements, key=self.index)
        for expected, each in enumerate(ordered):
            if self.index(each) != expected:
                message = f"index {self.index(each)} of {each.kind}, expected {expected}"
                raise self.mistake("index", message, each, "give every root, and every site, its own number")
        return ordered

    def arities(self, nodes: Iterable[_Element]) -> dict[str, int]:
        """Return how many ports each control has: as many as the highest index at one of its nodes asks for."""
        found: dict[str, int] = {}
        for node in nodes:
            ports = [self.index(port) for port in node.of("bPorts")]
            if len(set(ports)) < len(ports):
                raise self.mistake("index", f"two ports of one index at a {node.control}", node)
            highest = max(ports, default=-1) + 1
            if highest > MOST_PORTS:
                raise self.mistake("arity", f"more than {MOST_PORTS:,} ports at a {node.control}", node)
            found[node.control] = max(found.get(node.control, 0), highest)
        return found

    def ports(self, node: _Element, arity: int) -> tuple[Link, ...]:
        given = {self.index(port): port for port in node.of("bPorts")}
        return tuple(self.link(given[port]) if port in given else self.fresh() for port in range(arity))

    def link(self, point: _Element) -> Link:
        written = point.attributes.get("bLink")
        if written is None:
            return self.fresh()
        path = _LINK.fullmatch(written)
        kind, number = (path[1], int(path[2])) if path else ("", 0)
        if not path or number >= len(self.document.of(kind)):
            hint = "a link is written as //@bEdges.0 or //@bOuterNames.0"
            raise self.mistake("link", f"'{written}' is no link of this bigraph", point, hint)
        link: Link = number if kind == "bEdges" else self.outer_names[number]
        self.points[link] = self.points.get(link, 0) + 1
        return link

    def fresh(self) -> Link:
        """Return a new edge."""
        self.edges += 1
        return self.edges - 1

    def check_points(self) -> None:
        """Refuse a link that lists more points than refer to it; who refers to a link is on it, listed or not."""
        links: list[tuple[Link, _Element]] = [*enumerate(self.document.of("bEdges"))]
        links += zip(self.outer_names, self.document.of("bOuterNames"), strict=True)
        for link, element in links:
            listed = element.attributes.get("bPoints", "").split()
            if len(listed) > self.points.get(link, 0):
                message = (
                    f"{len(listed)} points are listed, and {self.points.get(link, 0)} refer to this link"
                )
                raise self.mistake("link", message, element, "give every port and inner name its bLink")

    def names(self, elements: Iterable[_Element]) -> list[str]:
        """Return the names of the elements, each of which has its own."""
        found: dict[str, None] = {}
        for each in elements:
            name = each.attributes.get("name", "")
            if not name or name in found:
                message = f"a second {each.kind} called '{name}'" if name else f"{each.kind} without a name"
                raise self.mistake("name", message, each)
            found[name] = None
        return list(found)
