"""The rules phase: from `redex -> reactum` in the paper's notation to patterns of relations."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from bigraphs.notation.paper import NodeTerm as WrittenNode
from bigraphs.notation.paper import RegionTerm, RuleTerm, SiteTerm
from semantics.behaviours.commands import HOST
from semantics.behaviours.reaction_rules import (
    LinkTerm,
    LinkVariable,
    NodeTerm,
    NodeVariable,
    Pattern,
    PlaceTerm,
)
from specs import syntax as s
from specs.codes import Code
from specs.elaboration.mission_mistakes import a
from specs.elaboration.names import Names
from specs.elaboration.rule_regions import Side, WrittenRegion, region_places, regions_of
from specs.elaboration.rule_schemas import Moved, Schema, SchemaParameter


@dataclass(slots=True)
class _Reading:
    """The state of reading one rule.

    Attributes:
        given: The free names of the rule: its parameters, with their kinds.
        terms: The meaning of each word, once known.
        sound: Whether no mistake was found.
    """

    names: Names
    body: s.RuleBody
    given: Mapping[str, str | None]
    terms: dict[str, NodeTerm | None] = field(default_factory=dict)
    kinds: dict[NodeTerm, str | None] = field(default_factory=dict)
    words: dict[str, tuple[str, str]] = field(default_factory=dict)
    sound: bool = True

    def where(self, node: WrittenNode | SiteTerm) -> s.Span:
        """Return the span of a node in the mission."""
        start = self.body.raw_start + node.offset
        return s.Span(
            start, start + max(1, len(word_of(node) if isinstance(node, WrittenNode) else str(node)))
        )

    def mistake(self, code: Code, node: WrittenNode | SiteTerm | None, message: str, hint: str = "") -> None:
        self.sound = False
        self.names.findings.add(code, self.where(node) if node is not None else self.body, message, hint)


def elaborate_rules(mission: s.Mission, names: Names) -> dict[str, Schema]:
    """Return the schemas of the named rules that are sound."""
    found: dict[str, Schema] = {}
    for rule in mission.each(s.Rule):
        parameters = tuple(_parameters(rule, names))
        given = {parameter.shown: parameter.kind for parameter in parameters}
        schema = elaborate_rule(rule.body, rule.name.text, parameters, given, names)
        if schema is not None:
            found.setdefault(rule.name.text, schema)
    return found


def _parameters(rule: s.Rule, names: Names) -> Iterator[SchemaParameter]:
    seen: set[str] = set()
    for parameter in rule.parameters:
        known = names.kind(parameter.kind)
        if parameter.name.text in seen:
            message = f"rule '{rule.name.text}' has two parameters '{parameter.name.text}'"
            names.findings.add(Code.DUPLICATE_NAME, parameter, message, "rename one of the two")
        seen.add(parameter.name.text)
        yield SchemaParameter(f"{parameter.name.text}#", parameter.kind.text if known else None)


def elaborate_rule(
    body: s.RuleBody,
    name: str,
    parameters: tuple[SchemaParameter, ...],
    given: Mapping[str, str | None],
    names: Names,
) -> Schema | None:
    """Return the schema of a rule's body; None, and findings, if it has mistakes.

    `given` has the parameters as written, with their kinds.
    """
    if body.term is None:
        return None
    reading = _Reading(names, body, given)
    redex, reactum = (tuple(regions_of(side)) for side in (body.term.redex, body.term.reactum))
    for region in redex:
        _name_nodes(reading, region)
    for region in reactum:
        _name_nodes(reading, region)
    if not reading.sound:
        return None
    before, after = Side(redex, reading.terms), Side(reactum, reading.terms)
    _check_same_nodes(reading, before, after)
    if not reading.sound:
        return None
    places = region_places(before, after)
    _check_sites(reading, before, after, places.same)
    parents = (before.nested + places.redex, after.nested + places.reactum)
    for node in {index: node for node, index in reversed(places.unplaced)}.values():
        hint = "write it into a node, or beside one that stays where it is: b.(u | $0) -> b.$0 | u"
        reading.mistake(Code.UNPLACED_NODE, node, f"'{word_of(node)}' has no new place", hint)
    links = [tuple(_links(reading, side, body.term)) for side in (before, after)]
    if not reading.sound:
        return None
    old = Pattern(before.terms, parents[0], links[0], before.closed)
    new = Pattern(after.terms, parents[1], links[1])
    moves = tuple(_moves(reading, before, after, *parents))
    return Schema(name, body.text, parameters, old, new, moves, reading.words, reading.kinds)


# --- the meaning of words ---------------------------------------------------------------------------------------


def word_of(node: WrittenNode) -> str:
    """Return the written word of a node."""
    return node.name or "" if node.control is None else f"{node.name or ''}_{node.control}"


def _name_nodes(reading: _Reading, region: WrittenRegion) -> None:
    for node in region.nodes():
        word = word_of(node)
        if word not in reading.terms:
            reading.terms[word] = _term(reading, node)
        term = reading.terms[word]
        if node.control is not None and term not in (word, f"{word}#"):
            _check_control(reading, node, term)


def _term(reading: _Reading, node: WrittenNode) -> NodeTerm | None:
    """Return the term of a node's word: the host, a parameter, an entity, else a variable."""
    for name, rest in ((word_of(node), ""), (node.name, f"_{node.control}" if node.control else "")):
        if name is None:
            continue
        if name == HOST or name in reading.given:
            term = name if name == HOST else f"{name}#"
            reading.words[word_of(node)] = (term, rest)
            reading.kinds.setdefault(term, reading.given.get(name))
            return term
        if name in reading.names.kinds:
            reading.kinds[name] = reading.names.kinds[name]
            return name
    if node.name is None:
        hint = "give it one, so that both sides mean the same node"
        reading.mistake(Code.CREATES_OR_DELETES, node, f"'{word_of(node)}' has no name", hint)
        return None
    variable = next((t for t in reading.kinds if isinstance(t, NodeVariable) and t.name == node.name), None)
    if variable is None and node.control is None:
        _unknown(reading, node)
        return None
    variable = variable or NodeVariable(node.name, node.control)
    reading.kinds[variable] = variable.kind
    return variable


def _unknown(reading: _Reading, node: WrittenNode) -> None:
    among = [*reading.names.kinds, *reading.given, HOST]
    hint = reading.names.findings.suggest(node.name or "", among)
    kind = min(reading.names.signature.kinds, default="UAV")
    otherwise = f"a variable is written with its kind, as in {node.name}_{kind}"
    reading.mistake(Code.UNKNOWN_NAME, node, f"unknown name '{node.name}'", hint or otherwise)


def _check_control(reading: _Reading, node: WrittenNode, term: NodeTerm | None) -> None:
    control = node.control or ""
    if not reading.names.kind(s.Name(control, span=reading.where(node))):
        reading.sound = False
        return
    kind = control if term is None else reading.kinds.get(term)
    if term == HOST and kind is None:
        reading.kinds[HOST] = control
    elif kind is not None and kind != control:
        message = f"'{node.name}' is {a(kind)}, and not {a(control)}"
        reading.mistake(Code.KIND_MISMATCH, node, message, f"write {node.name}_{kind}")


# --- restrictions on rules --------------------------------------------------------------------------------------


def _check_same_nodes(reading: _Reading, before: Side, after: Side) -> None:
    for side, other, verb, where in (
        (after, before, "creates", "redex"),
        (before, after, "deletes", "reactum"),
    ):
        missing = [node for node in side.nodes if reading.terms[word_of(node)] not in set(other.terms)]
        for node in missing:
            hint = f"controls move and link existing nodes: write '{word_of(node)}' in the {where} too"
            reading.mistake(Code.CREATES_OR_DELETES, node, f"the rule {verb} '{word_of(node)}'", hint)
    for side in (before, after):
        seen: set[NodeTerm | None] = set()
        for node in side.nodes:
            term = reading.terms[word_of(node)]
            if term in seen:
                reading.mistake(
                    Code.DUPLICATE_NAME,
                    node,
                    f"'{word_of(node)}' is written twice on one side",
                    "a node is once in a bigraph",
                )
            seen.add(term)


def _check_sites(reading: _Reading, before: Side, after: Side, same: Mapping[int, int | None]) -> None:
    owners = {site.index: owner for site, owner in before.sites}
    kept: set[int] = set()
    for site, owner in after.sites:
        here = same.get(owner) if isinstance(owner, int) else owner
        if owners[site.index] != here or site.index in kept:
            hint = "write the site under the same node on both sides; move nodes by their names"
            reading.mistake(Code.MOVED_CONTENT, site, f"the rule moves the content of {site}", hint)
        kept.add(site.index)
    for site, _ in before.sites:
        if site.index not in kept:
            hint = f"write {site} in the reactum too"
            reading.mistake(Code.CREATES_OR_DELETES, site, f"the rule deletes the content of {site}", hint)


def _links(reading: _Reading, side: Side, rule: RuleTerm) -> Iterator[tuple[LinkTerm, NodeTerm]]:
    before = {link for node in _nodes(rule.redex) for link in node.links}
    done: set[tuple[str, NodeTerm]] = set()
    for node in side.nodes:
        term = reading.terms[word_of(node)]
        for link in node.links:
            constant = link in reading.names.channels
            if not constant and (link not in before or ":" in link):
                hint = reading.names.findings.suggest(link, reading.names.channels)
                otherwise = f"declare it: world {{ channel {link} }}"
                reading.mistake(Code.UNKNOWN_NAME, node, f"unknown channel '{link}'", hint or otherwise)
            elif term is not None and (link, term) not in done:
                done.add((link, term))
                yield (link if constant else LinkVariable(link)), term


def _nodes(regions: tuple[RegionTerm, ...]) -> Iterator[WrittenNode]:
    for region in regions_of(regions):
        yield from region.nodes()


def _moves(
    reading: _Reading,
    before: Side,
    after: Side,
    old: tuple[tuple[NodeTerm, PlaceTerm], ...],
    new: tuple[tuple[NodeTerm, PlaceTerm], ...],
) -> Iterator[Moved]:
    """Yield the nodes that change parent; reports parents whose kind may not contain them, on both sides."""
    written = {reading.terms[word_of(node)]: node for side in (before, after) for node in side.nodes}
    signature = reading.names.signature
    for node, place in (*old, *new):
        kind, around = (
            reading.kinds.get(node),
            reading.kinds.get(place) if isinstance(place, str | NodeVariable) else None,
        )
        if kind is not None and around is not None and not signature[around].may_contain(kind):
            message = f"{a(around)} cannot contain {a(kind)}"
            hint = f"declare it: kind {around} contains {kind}"
            reading.mistake(Code.UNREALISABLE, written[node], message, hint)
    for node, place in new:
        if (node, place) not in old:
            yield Moved(node, place, reading.where(written[node]))
