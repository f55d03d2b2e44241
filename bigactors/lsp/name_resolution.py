"""Name resolution of a mission: the declaration and the uses of each name."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Final, get_args

from bigraphs.notation.paper import NodeTerm
from specs import syntax as s
from specs.elaboration.names import AGENTS
from specs.elaboration.rule_regions import regions_of

DECLARED: Final[Mapping[type[s.Node], str]] = {
    s.Kind: "kind",
    s.Entity: "entity",
    s.ChannelDeclaration: "channel",
    s.Rule: "rule",
    s.Definition: "behaviour",
    s.BigActor: "agent",
    s.Family: "agent",
    s.Spawn: "agent",
}
"""The sort of the names that each construct declares by its `name`."""

_ONE_SORT: Final = {
    "kind": "kind",
    "contains": "kind",
    "carries": "kind",
    "rule": "rule",
    "behaviour": "behaviour",
}
"""The fields whose names have a fixed sort, even if the same name has another sort elsewhere."""


@dataclass(frozen=True, slots=True, order=True)
class Symbol:
    """A named thing; `place`, the offset of the first binding, distinguishes variables of the same name."""

    sort: str
    name: str
    place: int = -1


@dataclass(frozen=True, slots=True, order=True)
class Occurrence:
    """A name in the text: its symbol, and whether it is declared here."""

    span: s.Span
    symbol: Symbol
    declares: bool = False


@dataclass(frozen=True, slots=True)
class Binding:
    """A variable, and its scope in the text."""

    symbol: Symbol
    seen: s.Span


@dataclass(frozen=True, slots=True)
class Occurrences:
    """All resolved names of a mission.

    Attributes:
        all: The occurrences by position.
        declared: The declared symbols with their spans, in the order of the text.
        bindings: The variables, in the order of the text.
    """

    all: tuple[Occurrence, ...]
    declared: Mapping[Symbol, s.Span]
    bindings: tuple[Binding, ...]

    def at(self, offset: int) -> Occurrence | None:
        """Return the name that contains an offset or ends there."""
        return next((each for each in self.all if each.span.start <= offset <= each.span.end), None)

    def of(self, symbol: Symbol) -> tuple[Occurrence, ...]:
        """Return the occurrences of a symbol."""
        return tuple(each for each in self.all if each.symbol == symbol)

    def names(self, sort: str) -> tuple[str, ...]:
        """Return the declared names of a sort, sorted."""
        return tuple(sorted(symbol.name for symbol in self.declared if symbol.sort == sort))

    def variables(self, offset: int) -> tuple[str, ...]:
        """Return the variables in scope at an offset."""
        seen = (each for each in self.bindings if each.seen.start <= offset <= each.seen.end)
        return tuple(sorted({each.symbol.name for each in seen}))


def occurrences_of(mission: s.Mission) -> Occurrences:
    """Resolve the names of a mission, which may have mistakes."""
    resolver = _Resolver(mission)
    resolver.visit(mission, {})
    resolver.join_named_variables(mission)
    found = {each.span: each for each in resolver.found}  # one entry a word: `keep Vessel` has two
    declared: dict[Symbol, s.Span] = {}
    for each in sorted(found.values()):
        if each.declares or (each.symbol.sort == "channel" and each.symbol not in declared):
            declared.setdefault(each.symbol, each.span)
    return Occurrences(tuple(sorted(found.values())), declared, tuple(resolver.bindings))


def variables_of(mission: s.Mission, agent: str) -> tuple[str, ...]:
    """Return the variables of a bigActor, including those of the behaviours that it may run."""
    spans = _running(mission).get(agent, ())
    bindings = occurrences_of(mission).bindings
    return tuple(sorted({each.symbol.name for each in bindings if _within(each.symbol, spans)}))


Scope = dict[str, Symbol]


@dataclass
class _Resolver:
    mission: s.Mission
    found: list[Occurrence] = field(default_factory=list)
    bindings: list[Binding] = field(default_factory=list)
    known: dict[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for node in s.walk(self.mission):
            for name, sort in _declarations(node):
                self.known.setdefault(name.text, sort)
            for name in (*getattr(node, "channels", ()), getattr(node, "channel", None)):
                if name is not None:
                    self.known.setdefault(name.text, "channel")

    # --- the tree

    def visit(self, node: s.Node, scope: Scope) -> None:
        """Record the names of a node and its descendants; `scope` has the variables bound around it."""
        for declared, sort in _declarations(node):
            self.note(declared, Symbol(sort, declared.text), declares=True)
        match node:
            case s.Name():
                self.note(node, self.meaning(node, scope))
            case s.RuleBody():
                self.rule_body(node, scope)
            case s.Rule(_, parameters, body):
                inner = dict(scope)
                for parameter in parameters:
                    self.bind(parameter.name, inner, body.span)
                    self.visit(parameter.kind, {})
                self.visit(body, inner)
            case s.Definition():
                inner = dict(scope)
                for name in node.parameters:
                    self.bind(name, inner, node.span)
                self.block(node.body, inner, node.span)
            case s.Case():
                self.case(node, scope)
            case s.For(variable, collection, body) | s.ChooseFrom(variable, collection, body):
                self.visit(collection, scope)
                inner = dict(scope)
                self.bind(variable, inner, node.span)
                self.block(body, inner, node.span)
            case s.Quantified():
                self.quantified(node, scope)
            case s.Family():
                self.family(node, scope)
            case _:
                self.fields(node, scope)

    def quantified(self, node: s.Quantified, scope: Scope) -> None:
        inner, among = dict(scope), node.range
        if node.joined:  # the outer quantifier has visited its range
            self.bind(node.variable, inner, node.span)
            self.visit(node.body, inner)
            return
        if among.text != AGENTS or AGENTS in self.known:
            self.sorted_name(among, "agent" if self.known.get(among.text) == "agent" else "kind")
        if node.behaviour is not None:
            self.sorted_name(node.behaviour, "behaviour")
        if node.host is not None:
            self.visit(node.host, scope)
        self.bind(node.variable, inner, node.span)
        self.visit(node.body, inner)

    def family(self, node: s.Family, scope: Scope) -> None:
        inner = dict(scope)
        self.bind(node.variable, inner, node.span)
        if node.index.text == node.variable.text:
            self.note(node.index, inner[node.variable.text])
        else:
            self.bind(node.index, inner, node.span)
        self.visit(node.range, scope)
        self.visit(node.host, inner)
        self.block(node.body, inner, node.span)

    def fields(self, node: s.Node, scope: Scope) -> None:
        """Record the names in the fields of a node that binds no variables."""
        declared = {name for name, _ in _declarations(node)}
        for label in node.__dataclass_fields__:
            value = getattr(node, label)
            items = value if isinstance(value, tuple) else (value,)
            if items and isinstance(items[0], _STATEMENTS):
                self.block(items, dict(scope), node.span)
                continue
            for item in items:
                if isinstance(item, s.Name) and label in _ONE_SORT:
                    self.sorted_name(item, _ONE_SORT[label])
                elif isinstance(item, s.Node) and not any(item is name for name in declared):
                    self.visit(item, scope)

    def block(self, statements: Iterable[s.Node], scope: Scope, around: s.Span) -> None:
        """Record the names of consecutive statements; each `let` is in scope for the statements after it."""
        for statement in statements:
            if isinstance(statement, s.Let):
                self.visit(statement.value, scope)
                self.bind(statement.variable, scope, s.Span(statement.span.end, around.end))
            else:
                self.visit(statement, scope)

    def case(self, node: s.Case, scope: Scope) -> None:
        inner = dict(scope)
        for part in s.walk(node.pattern):
            match part:
                case (
                    s.VariablePattern(variable) | s.ObservationPattern(variable) | s.MessagePattern(variable)
                ):
                    if variable is not None:
                        self.bind(variable, inner, node.span)
                case s.ConstantPattern(name):
                    self.visit(name, {})
        if node.guard is not None:
            self.visit(node.guard, inner)
        self.block(node.body, inner, node.span)

    def rule_body(self, body: s.RuleBody, scope: Scope) -> None:
        """Record the names in a rule's body: `uav0_UAV[wifi]` has three."""
        if body.term is None:
            return
        for side in (body.term.redex, body.term.reactum):
            for region in regions_of(side):
                for node in region.nodes():
                    self.rule_node(node, body, scope)

    def rule_node(self, node: NodeTerm, body: s.RuleBody, scope: Scope) -> None:
        at = body.raw_start + node.offset
        if node.name:
            self.word(node.name, at, scope)
            at += len(node.name)
        if node.control:
            at += 1  # the _ before it
            self.found.append(Occurrence(s.Span(at, at + len(node.control)), Symbol("kind", node.control)))
            at += len(node.control)
        for link in node.links:
            inside = body.raw.find(link, at - body.raw_start)
            self.word(link, body.raw_start + inside, {})
            at = body.raw_start + inside + len(link)

    def word(self, text: str, at: int, scope: Scope) -> None:
        name = s.Name(text, span=s.Span(at, at + len(text)))
        self.note(name, self.meaning(name, scope))

    # --- names

    def meaning(self, name: s.Name, scope: Scope) -> Symbol | None:
        """Return the symbol of a name where several sorts may stand; only variables share names with other sorts."""
        sort = self.known.get(name.text)
        return scope.get(name.text) or (Symbol(sort, name.text) if sort else None)

    def sorted_name(self, name: s.Name, sort: str) -> None:
        self.note(name, Symbol(sort, name.text))

    def note(self, name: s.Name, symbol: Symbol | None, *, declares: bool = False) -> None:
        if symbol is not None:
            self.found.append(Occurrence(name.span, symbol, declares))

    def bind(self, name: s.Name, scope: Scope, seen: s.Span) -> None:
        scope[name.text] = Symbol("variable", name.text, name.span.start)
        self.note(name, scope[name.text], declares=True)
        self.bindings.append(Binding(scope[name.text], seen))

    # --- variables named in properties

    def join_named_variables(self, mission: s.Mission) -> None:
        """Merge the variables of a bigActor that `a.x` in a property may mean, and that `x`, into one symbol."""
        bodies = _running(mission)
        for node in s.walk(mission):
            if isinstance(node, s.Stored | s.HasValue):
                whose = node.agent.family if isinstance(node.agent, s.Member) else node.agent
                spans = bodies.get(whose.text, ())
                meant = {
                    each.symbol
                    for each in self.bindings
                    if each.symbol.name == node.variable.text and _within(each.symbol, spans)
                }
                self._join(meant, node.variable)

    def _join(self, meant: set[Symbol], name: s.Name) -> None:
        one = min(meant, default=None)
        self.found = [each for each in self.found if each.span != name.span]
        self.found = [_renamed(each, meant, one) for each in self.found]
        self.bindings = [
            Binding(one if each.symbol in meant and one else each.symbol, each.seen) for each in self.bindings
        ]
        self.note(name, one)


def _within(symbol: Symbol, spans: Iterable[s.Span]) -> bool:
    return any(span.start <= symbol.place < span.end for span in spans)


def _renamed(each: Occurrence, meant: set[Symbol], one: Symbol | None) -> Occurrence:
    return Occurrence(each.span, one, each.declares) if one and each.symbol in meant else each


_STATEMENTS: Final = get_args(s.Statement)


def _declarations(node: s.Node) -> Iterator[tuple[s.Name, str]]:
    """Yield the names that a node declares, with their sorts; the first mention of a channel declares it."""
    sort = DECLARED.get(type(node))
    name = getattr(node, "name", None)
    if sort is not None and isinstance(name, s.Name):
        yield name, sort


def _running(mission: s.Mission) -> dict[str, tuple[s.Span, ...]]:
    """Return the spans of each bigActor's statements: its own, and those of the behaviours that it may run."""
    definitions = {each.name.text: each for each in mission.each(s.Definition)}
    starts: dict[str, list[s.Node]] = {}
    for node in s.walk(mission):
        if isinstance(node, s.BigActor | s.Family):
            starts.setdefault(node.name.text if node.name else "", []).append(node)
        elif (
            isinstance(node, s.Spawn)
            and node.name is not None
            and node.behaviour.behaviour.text in definitions
        ):
            starts.setdefault(node.name.text, []).append(definitions[node.behaviour.behaviour.text])
    return {name: _reached(nodes, definitions) for name, nodes in starts.items()}


def _reached(nodes: list[s.Node], definitions: Mapping[str, s.Definition]) -> tuple[s.Span, ...]:
    found: list[s.Node] = []
    while nodes:
        node = nodes.pop()
        if not any(node is each for each in found):
            found.append(node)
            called = (each.behaviour.text for each in s.walk(node) if isinstance(each, s.Call))
            nodes += [definitions[name] for name in called if name in definitions]
    return tuple(node.span for node in found)
