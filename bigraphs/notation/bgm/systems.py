"""Elaboration of a `.bgm` file to a system with properties."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

from bigraphs.algebra import lean
from bigraphs.bigraph import Bigraph
from bigraphs.errors import NotationError, counted
from bigraphs.notation.bgm import property_elaboration
from bigraphs.notation.bgm.parser import parse_bgm
from bigraphs.notation.bgm.syntax import (
    ControlLine,
    Hole,
    Line,
    ModelLine,
    NameLine,
    Prefix,
    PropertyLine,
    RuleLine,
    Term,
    Wide,
)
from bigraphs.notation.bgm.terms import Terms, holes, name_and_kind, names_in, walk
from bigraphs.notation.big.file_mistakes import Findings
from bigraphs.notation.big.solidity import faults
from bigraphs.notation.big.syntax import MAX_SIZE
from bigraphs.notation.lalr import Span
from bigraphs.properties import SystemProperty
from bigraphs.signature import Control, Signature
from bigraphs.system import PriorityClass, Rule, SourcePosition, System, SystemKind

_ONE: Final = 1


def read_bgm(text: str) -> System:
    """Return the system of a `.bgm` file.

    All rules have one priority. A name declared with `%outer` (or `%name`) matches only itself in rules; any other name
    matches any link. Ports are ordered, and `-` is a link with one end.

    Raises:
        NotationError: With the first syntax error, or else with all other mistakes.
    """
    lines = parse_bgm(text)
    findings = Findings(text)
    found = _Reading(lines, findings).system()
    findings.raise_any()
    if found is None:
        raise AssertionError("no system, and no mistake")
    return found


class _Reading:
    """The elaboration of one file."""

    def __init__(self, lines: Sequence[Line], findings: Findings) -> None:
        self.lines = lines
        self.findings = findings
        controls = [line for line in lines if isinstance(line, ControlLine)]
        self.refuse_again("control", [(line.name, line.offset) for line in controls])
        for line in controls:
            if line.arity > MAX_SIZE:
                self.add("too-large", f"a node of more than {MAX_SIZE} ports", line.offset, len(line.name))
                controls = []
        kinds = {line.name: Control(line.name, line.arity, line.status) for line in controls}
        self.warnings: tuple[NotationError, ...] = ()
        if not controls and not len(findings):
            kinds = self.inferred()
        self.terms = Terms(Signature(tuple(kinds.values())), findings, named=not controls)
        self.declared = frozenset(line.name for line in lines if isinstance(line, NameLine))

    def inferred(self) -> dict[str, Control]:
        """Return the controls that a file without declarations uses, and add a warning that lists them."""
        wides = [
            wide
            for line in self.lines
            for wide in (
                [line.redex, line.reactum]
                if isinstance(line, RuleLine)
                else [line.term]
                if isinstance(line, ModelLine)
                else []
            )
        ]
        ports: dict[str, int] = {}
        for _, term in (pair for wide in wides for pair in walk(wide)):
            if isinstance(term, Prefix):
                _, kind = name_and_kind(term.control)
                ports[kind] = max(ports.get(kind, 0), len(term.ports))
        told = ", ".join(f"%active {kind} : {count}" for kind, count in sorted(ports.items()))
        hint = f"declare them: {told}"
        message = "no control is declared, so they are inferred from their uses"
        self.warnings = (NotationError("name", message, self.findings.text, 0, hint=hint),) if ports else ()
        return {kind: Control(kind, count) for kind, count in ports.items()}

    def system(self) -> System | None:
        """Return the system, or None after a recorded mistake."""
        for line in self.lines:
            if isinstance(line, NameLine) and line.inner:
                self.add("initial", "a first state has no inner names", line.offset, len(line.name))
        initial = self.initial([line for line in self.lines if isinstance(line, ModelLine)])
        rules = tuple(self.rules())
        properties = tuple(self.properties())
        if len(self.findings) or initial is None:
            return None
        classes = (PriorityClass(rules),) if rules else ()
        return System(
            SystemKind.BRS,
            self.terms.signature,
            initial,
            classes,
            properties=properties,
            warnings=self.warnings,
        )

    def add(self, code: str, message: str, offset: int, length: int = _ONE, hint: str = "") -> None:
        self.findings.add(code, message, Span(offset, offset + length), hint)

    def refuse_again(self, what: str, named: Sequence[tuple[str, int]]) -> None:
        seen: set[str] = set()
        for name, offset in named:
            if name in seen:
                self.add("name", f"{what} '{name}' is declared twice", offset, len(name))
            seen.add(name)

    def initial(self, models: Sequence[ModelLine]) -> Bigraph | None:
        if len(models) != 1:
            count = "no first state" if not models else f"{len(models)} first states"
            self.add("system", f"the file has {count}", models[1].offset if models else 0)
            return None
        if any(self.no_holes(model.term, "a first state") for model in models):
            return None
        found = self.terms.bigraph(models[0].term, {}, self.declared)
        return None if found is None else lean(found)

    def no_holes(self, wide: Wide, what: str) -> bool:
        """Record each hole as a mistake; return whether there are any."""
        found = holes(wide)
        for _, hole in found:
            self.add("site", f"{what} has no holes", hole.offset, 2)
        return bool(found)

    def rules(self) -> Iterator[Rule]:
        lines = [line for line in self.lines if isinstance(line, RuleLine)]
        self.refuse_again("rule", [(line.name, line.offset) for line in lines if line.name is not None])
        taken = {line.name for line in lines}
        fresh = (name for n in range(1, 2 * len(lines) + 1) if (name := f"rule{n}") not in taken)
        for line in lines:
            found = self.rule(line, line.name if line.name is not None else next(fresh))
            if found is not None:
                yield found

    def rule(self, line: RuleLine, name: str) -> Rule | None:
        redex, reactum = self.without_rest(line)
        if not self.holes_fit(redex, reactum, line):
            return None
        sites = {hole.index: site for site, (_, hole) in enumerate(holes(redex))}
        written = [hole for _, hole in holes(reactum)]
        order = tuple(sites[hole.index] for hole in written)
        used = names_in(redex) | (names_in(reactum) & self.declared)
        for unknown in sorted(names_in(reactum) - used):
            hint = f"declare it with '%outer {unknown}', or name it in the redex"
            self.add("rule", f"the redex lacks the name '{unknown}' of the reactum", line.offset, hint=hint)
        before = self.terms.bigraph(redex, sites, used)
        after = self.terms.bigraph(_numbered(reactum), {n: n for n in range(len(written))}, used)
        if before is None or after is None or not self.fitting(before, after, line):
            return None
        constants = frozenset(used & self.declared)
        text = self.findings.text
        start = text.rfind("\n", 0, line.offset)
        position = SourcePosition(text.count("\n", 0, line.offset) + 1, line.offset - start)
        return Rule(name, before, after, order, link_constants=constants, position=position)

    def without_rest(self, line: RuleLine) -> tuple[Wide, Wide]:
        """Remove each hole that stands beside both the redex and the reactum: that content stays in any case."""
        redex, reactum = list(line.redex), list(line.reactum)
        for region, place in enumerate(redex):
            for hole in [term for term in place if isinstance(term, Hole)]:
                there = reactum[region] if region < len(reactum) else ()
                times = sum(other.index == hole.index for _, other in holes(line.reactum))
                if times == 1 and hole in there:
                    redex[region] = tuple(term for term in redex[region] if term != hole)
                    reactum[region] = tuple(term for term in there if term != hole)
        return tuple(redex), tuple(reactum)

    def holes_fit(self, redex: Wide, reactum: Wide, line: RuleLine) -> bool:
        before = len(self.findings)
        seen: set[int] = set()
        for place, hole in holes(redex):
            if place < 0:
                hint = "put it into a node, or leave it where it is"
                message = f"${hole.index} is beside the redex, and does not stay there"
                self.add("redex", message, hole.offset, 2, hint)
            if hole.index in seen:
                self.add("site", f"${hole.index} is in the redex twice", hole.offset, 2)
            seen.add(hole.index)
        for _, hole in holes(reactum):
            if hole.index not in seen:
                self.add("site", f"${hole.index} is not in the redex", hole.offset, 2)
        if len(redex) != len(reactum):
            message = f"the redex has {counted(len(redex), 'region')}, the reactum {len(reactum)}"
            self.add("rule", message, line.offset)
        return len(self.findings) == before

    def fitting(self, redex: Bigraph, reactum: Bigraph, line: RuleLine) -> bool:
        before = len(self.findings)
        for message, hint in faults(redex):
            if "no port of the redex" not in message:  # a declared name matches only its own link
                self.add("redex", message, line.offset, hint=hint)
        return len(self.findings) == before and redex.outer == reactum.outer

    def properties(self) -> Iterator[SystemProperty]:
        lines = [line for line in self.lines if isinstance(line, PropertyLine)]
        self.refuse_again("property", [(line.name, line.offset) for line in lines])
        for line in lines:
            found = property_elaboration.formula(line.query, self.terms, self.declared)
            if found is not None:
                yield SystemProperty(line.name, found)


def _numbered(wide: Wide) -> Wide:
    """Return the term with its holes numbered in source order."""
    count = 0

    def term(each: Prefix | Hole) -> Prefix | Hole:
        nonlocal count
        if isinstance(each, Hole):
            count += 1
            return Hole(count - 1, each.offset)
        return Prefix(each.control, each.ports, place(each.inside), each.offset)

    def place(terms: Term) -> Term:
        return tuple(map(term, terms))

    return tuple(map(place, wide))
