"""Elaboration of BigMC's terms to bigraphs: names are outer names, each `-` is an edge, holes are sites."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from bigraphs.bigraph import Bigraph, Link, Node, Place, assemble
from bigraphs.errors import counted
from bigraphs.notation.bgm.syntax import Hole, Prefix, Wide
from bigraphs.notation.big.file_mistakes import Findings
from bigraphs.notation.big.syntax import MAX_SIZE
from bigraphs.notation.lalr import Span
from bigraphs.signature import Signature


@dataclass(frozen=True, slots=True)
class Terms:
    """The elaboration of one file's terms; with inferred controls, nodes may be `named`, as in `uav0_UAV`."""

    signature: Signature
    findings: Findings
    named: bool = False

    def bigraph(self, wide: Wide, sites: Mapping[int, int], names: Iterable[str]) -> Bigraph | None:
        """Return the bigraph of a term, or None after a recorded mistake.

        `sites` maps the holes to sites. The bigraph has at least the outer names `names`.
        """
        before = len(self.findings)
        nodes: list[Node] = []
        parents: list[list[Place]] = [[] for _ in sites]
        outer, edges, taken = set(names), 0, set[str | None]()
        for place, term in walk(wide):
            if isinstance(term, Hole):
                parents[sites[term.index]].append(place)
                continue
            links: list[Link] = []
            for name in self._ports(term):
                links.append(edges if name is None else name)
                edges += name is None
            outer |= {link for link in links if isinstance(link, str)}
            name, kind = self._kind(term)
            if name in taken:
                at = Span(term.offset, term.offset + len(term.control))
                self.findings.add("name", f"node '{name}' is there twice", at, "a name identifies one node")
            taken |= {name} - {None}
            nodes.append(Node(kind, name, tuple(links), (place,)))
            if len(nodes) + edges > MAX_SIZE:
                message = f"a bigraph of more than {MAX_SIZE} parts"
                self.findings.add("too-large", message, Span(term.offset, term.offset + 1))
                return None
        if len(self.findings) > before:
            return None
        return assemble(
            self.signature, nodes, regions=len(wide), sites=parents, edges=edges, outer_names=outer
        )

    def _kind(self, term: Prefix) -> tuple[str | None, str]:
        return name_and_kind(term.control) if self.named else (None, term.control)

    def _ports(self, term: Prefix) -> tuple[str | None, ...]:
        at = Span(term.offset, term.offset + len(term.control))
        _, kind = self._kind(term)
        if kind not in self.signature:
            known = [control.name for control in self.signature.controls]
            self.findings.unknown("control", term.control, at, known, "'%active' or '%passive'")
            return ()
        arity = self.signature[kind].arity or 0
        if term.ports and len(term.ports) != arity:
            message = (
                f"'{term.control}' has {counted(arity, 'port')}, this has {counted(len(term.ports), 'name')}"
            )
            self.findings.add("arity", message, at, "write '-' for a port that is not linked")
        return term.ports or (None,) * arity


def name_and_kind(written: str) -> tuple[str | None, str]:
    """Return the optional name and the control of a node in the runtime's notation, `uav0_UAV`."""
    name, _, kind = written.rpartition("_")
    return (name, kind) if name and kind[:1].isupper() else (None, written)


def walk(wide: Wide) -> Iterator[tuple[Place, Prefix | Hole]]:
    """Yield each node and hole with its parent, parents first; nodes are numbered in this order."""
    waiting: list[tuple[Place, Prefix | Hole]] = [
        (~region, term) for region in reversed(range(len(wide))) for term in reversed(wide[region])
    ]
    count = 0
    while waiting:
        place, term = waiting.pop()
        yield place, term
        if isinstance(term, Prefix):
            waiting.extend((count, child) for child in reversed(term.inside))
            count += 1


def holes(wide: Wide) -> list[tuple[Place, Hole]]:
    """Return each hole with its parent, in source order."""
    return [(place, term) for place, term in walk(wide) if isinstance(term, Hole)]


def names_in(wide: Wide) -> set[str]:
    """Return the names on ports."""
    return {
        name for _, term in walk(wide) if isinstance(term, Prefix) for name in term.ports if name is not None
    }
