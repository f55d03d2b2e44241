"""Write a bigraph as an XMI file of the Bigraph Framework (bigraphs.org); `read_xmi` reads it back."""

from __future__ import annotations

import re
from typing import Final
from xml.sax.saxutils import quoteattr

from bigraphs.bigraph import Bigraph, Link, Place, children, sites_in
from bigraphs.errors import BigraphError
from bigraphs.notation.reading import MAX_NESTING

PREFIX: Final = "bigraphBaseModel"
NAMESPACE: Final = "http://org.bigraphs.model"
_HEAD: Final = (
    '<?xml version="1.0" encoding="UTF-8"?>\n'
    f'<{PREFIX}:BBigraph xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" '
    f'xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns:{PREFIX}="{NAMESPACE}">'
)
_CONTROL: Final = re.compile(r"[A-Za-z_][\w.-]*")
_OF_METAMODEL: Final = re.compile(r"B(Bigraph|Edge|InnerName|Link|Node|OuterName|Place|Point|Port|Root|Site)")


def write_xmi(bigraph: Bigraph) -> str:
    """Write a bigraph; raises BigraphError for what the format has no way to say.

    That is: places in several others or in none, names of nodes, and controls whose names are no names of classes.
    What controls are declared to be (status, ordered ports) is a matter of the reader's signature.
    """
    _check(bigraph)
    return _Writer(bigraph).text()


def _check(bigraph: Bigraph) -> None:
    homes = [*((str(node), node.parents) for node in bigraph.nodes)]
    homes += [(f"site {number}", parents) for number, parents in enumerate(bigraph.sites)]
    for what, parents in homes:
        if len(parents) != 1:
            raise _unwritable(f"that {what} is in {len(parents)} places", "give it one parent")
    for node in bigraph.nodes:
        if node.name is not None:
            raise _unwritable(f"the name of the node {node}", "leave names of nodes out")
        if not names_a_control(node.control):
            raise _unwritable(
                f"the control '{node.control}'", "call it by letters and digits, without parameters"
            )


def names_a_control(name: str) -> bool:
    """Say whether a class of nodes may have this name, beside the classes of the metamodel."""
    return bool(_CONTROL.fullmatch(name)) and not _OF_METAMODEL.fullmatch(name)


def _unwritable(what: str, hint: str) -> BigraphError:
    return BigraphError("notation", f"XMI of the Bigraph Framework has no way to write {what}", hint)


class _Writer:
    """The lines of one document; a path leads to each port, for the links that list them."""

    def __init__(self, bigraph: Bigraph) -> None:
        self.bigraph = bigraph
        self.children = children(bigraph)
        self.sites = sites_in(bigraph)
        names = {name: f"//@bOuterNames.{number}" for number, name in enumerate(bigraph.outer_names)}
        self.paths: dict[Link, str] = {edge: f"//@bEdges.{edge}" for edge in range(bigraph.edges)} | names
        self.points: dict[Link, list[str]] = {link: [] for link in self.paths}
        self.lines = [_HEAD]

    def text(self) -> str:
        for region in range(self.bigraph.regions):
            self.place(~region, "bRoots", _index(region), f"//@bRoots.{region}", 1)
        inner = []
        for number, (name, link) in enumerate(self.bigraph.inner_links):
            self.points[link].append(f"//@bInnerNames.{number}")
            inner.append(f'  <bInnerNames name={quoteattr(name)} bLink="{self.paths[link]}"/>')
        for edge in range(self.bigraph.edges):
            self.lines.append(f'  <bEdges name="e{edge}"{self.listed(edge)}/>')
        self.lines += inner
        for name in self.bigraph.outer_names:
            self.lines.append(f"  <bOuterNames name={quoteattr(name)}{self.listed(name)}/>")
        return "\n".join([*self.lines, f"</{PREFIX}:BBigraph>", ""])

    def place(self, place: Place, element: str, attributes: str, path: str, depth: int) -> None:
        """Write a region or a node, with all that is in it."""
        if depth >= MAX_NESTING:
            raise BigraphError(
                "too-deep", f"places nest deeper than {MAX_NESTING - 2}", "no deeper text is read"
            )
        indent = "  " * depth
        self.lines.append(f"{indent}<{element}{attributes}>")
        for count, child in enumerate(self.children[place]):
            attributes = f' xsi:type="{PREFIX}:{self.bigraph.nodes[child].control}" name="v{child}"'
            self.place(child, "bChild", attributes, f"{path}/@bChild.{count}", depth + 1)
        for site in self.sites.get(place, ()):
            self.lines.append(f'{indent}  <bChild xsi:type="{PREFIX}:BSite"{_index(site)}/>')
        for port, link in enumerate(self.bigraph.nodes[place].ports if place >= 0 else ()):
            self.points[link].append(f"{path}/@bPorts.{port}")
            self.lines.append(f'{indent}  <bPorts bLink="{self.paths[link]}"{_index(port)}/>')
        self.lines.append(f"{indent}</{element}>")

    def listed(self, link: Link) -> str:
        return f' bPoints="{" ".join(self.points[link])}"' if self.points[link] else ""


def _index(number: int) -> str:
    return f' index="{number}"' if number else ""  # 0 is the metamodel's default
