"""Elaboration of the formulas of properties: expand quantifiers and resolve names, within bounds.

A quantifier whose body is only about entities is not expanded: its instances are created on demand.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Final

from semantics.behaviours.program import VariableOf
from semantics.properties.propositions import (
    Always,
    And,
    Ended,
    Exists,
    HasPending,
    HostedAt,
    Inside,
    Instances,
    IsBound,
    Known,
    LinkedWith,
    Not,
    Or,
    Present,
    Proposition,
    Range,
    Same,
    VariableIs,
    Waiting,
    is_variable,
)
from semantics.state.signature import REGION
from specs import syntax as s
from specs.codes import Code
from specs.construct_text import write
from specs.elaboration.among import Among
from specs.elaboration.bodies import Bodies
from specs.elaboration.comparisons import check_comparable
from specs.elaboration.constant_values import elaborate_constant
from specs.elaboration.distances import RegionClaim, RegionContext, region_atom
from specs.elaboration.mission_mistakes import a
from specs.elaboration.names import Names
from specs.elaboration.value_types import Types

MOST_ATOMS: Final = 50_000
"""The most atoms of all properties together, after expansion."""

LONG: Final = 1_000
"""The most atoms of a quantifier over entities that keeps its instances."""

MOST_ASKED: Final = 200_000
"""The most atoms of such a quantifier that one configuration may have to evaluate."""

NOBODY: Final = REGION
"""The value of a quantified name with an empty range."""


@dataclass(frozen=True, slots=True)
class Context:
    """The context of a subformula.

    An unbound variable neither violates nor fulfils a property. Below `always` a comparison with an unbound variable is
    true, below `eventually` false, and a negation exchanges the two. So `not always F` is `eventually not F`.

    Attributes:
        unbound: The truth value here of a comparison whose variable is unbound.
        names: The value of each quantified name.
        depth: The number of enclosing path operators.
        is_alone: Whether no enclosing formula is about runs; then quantifiers need not be expanded.
        variables: The placeholder of each name whose quantifier is not expanded; `names` has one value of its range.
    """

    unbound: bool
    names: Mapping[str, str] = field(default_factory=dict)
    depth: int = 0
    is_alone: bool = False
    variables: Mapping[str, str] = field(default_factory=dict)

    def naming(self, variable: str, name: str) -> Context:
        """Return the context with a value for a quantified name."""
        return replace(self, names={**self.names, variable: name})

    def leaving(self, variable: str, name: str, left: str) -> Context:
        """Return the context with a placeholder for a quantified name; `name` is one of its values."""
        return replace(self.naming(variable, name), variables={**self.variables, variable: left})

    def denied(self) -> Context:
        """Return the context below a negation."""
        return replace(self, unbound=not self.unbound)

    def on_paths(self, *, unbound: bool) -> Context:
        """Return the context below one more path operator."""
        return replace(self, unbound=unbound, depth=self.depth + 1)


class TooLarge(Exception):
    """A formula exceeds a bound; carries the message and the hint."""


class FormulaElaborator:
    """Elaborates the formulas of a mission; `atoms` counts all their atoms, `left` the quantifiers not expanded."""

    def __init__(
        self, names: Names, bodies: Bodies, types: Types, ways: RegionContext, *, is_timed: bool = False
    ) -> None:
        self.names = names
        self.bodies = bodies
        self.types = types
        self.ways = ways
        self.is_timed = is_timed
        self.atoms = 0
        self.left = 0
        self.among = Among(names, bodies)
        self.ranges = set[tuple[str, ...]]()

    def elaborate(self, formula: s.Formula, *, invariant: bool) -> Proposition:
        """Return a formula as a proposition; reports its mistakes, and a bound that it exceeds."""
        if self.full:
            return Always(True)
        if invariant and isinstance(formula, s.PathPrefix) and formula.operator in ("always", "[]"):
            message = "an invariant is about every configuration by itself"
            self.names.findings.add(Code.WRONG_LOGIC, formula, message, "leave the operator in front out")
            return Always(True)
        try:
            return self.proposition(formula, Context(unbound=invariant, is_alone=True))
        except TooLarge as error:
            self.report(formula, error)
            return Always(True)

    @property
    def full(self) -> bool:
        """Whether the bound on atoms is exceeded, so that all later properties are skipped."""
        return self.atoms > MOST_ATOMS

    def report(self, formula: s.Formula, error: TooLarge) -> None:
        """Report a formula that is too large."""
        message, hint = error.args
        self.names.findings.add(Code.FORMULA_TOO_LARGE, formula, message, hint)

    def proposition(self, node: s.Formula, around: Context) -> Proposition:
        """Return a formula as a proposition, with the quantified names of its context replaced."""
        match node:
            case s.Negation(operand):
                return Not(self.proposition(operand, around.denied()))
            case s.Connective():
                return self._connective(node, around)
            case s.Quantified():
                return self._quantified(node, around)
            case _:
                self.count(1)
                atom = self._atom(node, around)  # reports mistakes
                if not around.variables:
                    return atom
                return self._atom(node, replace(around, names={**around.names, **around.variables}))

    def count(self, atoms: int) -> None:
        """Count atoms; raises TooLarge if there are too many."""
        self.atoms += atoms
        if self.full:
            message = f"written out, the properties have more than {MOST_ATOMS:,} atoms"
            raise TooLarge(message, "quantify over fewer names, or split it")

    def _connective(self, node: s.Connective, around: Context) -> Proposition:
        if node.operator in IMPLICATIONS:
            ways = [
                Or((Not(self.proposition(condition, around.denied())), self.proposition(then, around)))
                for condition, then in implications(node)
            ]
            return ways[0] if len(ways) == 1 else And(tuple(ways))
        left, right = self.proposition(node.left, around), self.proposition(node.right, around)
        make = And if node.operator == "and" else Or
        return make((*_parts(left, make), *_parts(right, make)))

    def _quantified(self, node: s.Quantified, around: Context) -> Proposition:
        if around.variables or (around.is_alone and self._size(node) is not None):
            return self._left(node, around)
        every, found = node.quantifier == "forall", []
        for each, if_so in self.instances(node, around, self.proposition):
            body = self.proposition(node.body, each)
            found.append(body if if_so is None else Or((Not(if_so), body)) if every else And((if_so, body)))
        return And(tuple(found)) if every else Or(tuple(found))

    def instances(
        self, node: s.Quantified, around: Context, elaborate: Callable[[s.Formula, Context], object]
    ) -> list[tuple[Context, Proposition | None]]:
        """Return the context of each instance of a quantifier, and the condition under which it counts."""
        mistakes = len(self.names.findings)
        instances = self.among.instances(node, around.names)
        if len(self.names.findings) > mistakes:
            return []
        if not instances:
            self._warn_of_nothing(node)
            elaborate(node.body, around.naming(node.variable.text, NOBODY))  # for its mistakes
        self.ranges.add(tuple(name for name, _ in instances))
        self.count(sum(condition is not None for _, condition in instances))
        return [(around.naming(node.variable.text, name), condition) for name, condition in instances]

    def _warn_of_nothing(self, node: s.Quantified) -> None:
        always = "true whatever happens" if node.quantifier == "forall" else "never true"
        among = write(replace(node, body=s.TruthLiteral(True))).removesuffix(" . true")
        kind = node.range.text in self.names.signature.kinds
        self.names.findings.warn(
            Code.NOTHING_QUANTIFIED,
            node.range,
            f"there is no {f'entity of kind {node.range.text}' if kind else 'such bigActor'}: '{among}' is {always}",
            "declare one, absent if it is to appear later, or quantify over another kind"
            if kind
            else "declare one, or quantify over others",
        )

    # --- quantifiers that are not expanded

    def _size(self, node: s.Formula) -> int | None:
        """Return the number of atoms of an expanded formula about entities; None if it is also about anything else."""
        match node:
            case s.Quantified(_, _, among, body, None, None) if among.text in self.names.signature.kinds:
                members = sum(kind == among.text for kind in self.names.kinds.values())
                size = self._size(body)
                return None if size is None else members * size
            case s.Negation(operand):
                return self._size(operand)
            case s.Connective(operator, left, right):
                sizes = self._size(left), self._size(right)
                known = [size for size in sizes if size is not None]
                return None if len(known) < 2 else sum(known) * (2 if operator == "<->" else 1)
            case s.Inside() | s.LinkedTo() | s.Known() | s.SameName() | s.TruthLiteral():
                return 1
            case s.PossiblyIn() | s.SurelyIn() | s.ApartFrom() | s.WithinRangeOf():
                return 1
            case s.Present(entity):
                return None if isinstance(entity, s.Member) else 1
        return None

    def _left(self, node: s.Quantified, around: Context) -> Proposition:
        """Return a quantifier whose instances are created on demand."""
        chain, left = [node], list[tuple[str, Range]]()
        while isinstance(inner := chain[-1].body, s.Quantified) and inner.quantifier == node.quantifier:
            chain.append(inner)
        if len({each.variable.text for each in chain}) == len(chain):  # no variable hides another
            chain.sort(key=lambda each: not _is_said_something_of(each.variable.text, inner))
        for each in chain:
            names = tuple(name for name, _ in self.among.instances(each, around.names))
            if not names:
                self._warn_of_nothing(each)
            self.ranges.add(names)
            self.left += 1
            left.append((f"?{self.left}", Range(each.variable.text, each.range.text, names)))
            around = around.leaving(each.variable.text, names[0] if names else NOBODY, left[-1][0])
        every, body = node.quantifier == "forall", self.proposition(inner, around)
        are_kept = (self._size(node) or 0) <= LONG
        for variable, among in reversed(left):
            instances = Instances.of(variable, among, body, every=every, are_kept=are_kept)
            body = And(instances) if every else Or(instances)
        if (asked := _asked(body)) > MOST_ASKED:
            message = f"each configuration would be asked {asked:,} atoms, and {MOST_ASKED:,} is the most"
            hint = (
                "quantify over fewer names, split it, or begin with a condition on few places: x in c -> ..."
            )
            raise TooLarge(message, hint)
        return body

    # --- atoms

    def _atom(self, node: s.Formula, around: Context) -> Proposition:
        if isinstance(node, RegionClaim):
            entity = partial(self._entity, bound=around.names)
            return region_atom(node, self.names, self.ways, around.names, entity)
        return self._atom_of_one_moment(node, around)

    def _atom_of_one_moment(self, node: s.Formula, around: Context) -> Proposition:
        bound = around.names
        match node:
            case s.TruthLiteral(value):
                return Always(value)
            case s.Inside(entity, place, directly, actually):
                within = REGION if place.text == REGION else self._entity(place, bound)
                who = self._entity(entity, bound)
                self._check_inside(node, who, within, directly=directly)
                return Inside(who, within, actually, directly)
            case s.LinkedTo(entity, other, actually):
                return LinkedWith(self._entity(entity, bound), self._node_or_channel(other, bound), actually)
            case s.Present(entity):
                agent = isinstance(entity, s.Member) or self._stands_for(entity, bound) in self.names.agents
                return Exists(self.agent(entity, bound)) if agent else Present(self._entity(entity, bound))
            case s.Known(entity):
                return Known(self._entity(entity, bound))
            case s.HostedAt(agent, host):
                return HostedAt(self.agent(agent, bound), self._entity(host, bound))
            case s.Pending(agent, request):
                return HasPending(self.agent(agent, bound), request)
            case s.Ended(agent):
                return Ended(self.agent(agent, bound))
            case s.Waiting(agent):
                return Waiting(self.agent(agent, bound))
            case s.SameName():
                return self._same(node, bound)
            case s.Stored():
                return self._stored(node, around)
            case s.HasValue(agent, variable):
                return IsBound(self._variable(agent, variable, bound))
        message = "this is about runs, and the property is about single configurations"
        hint = 'write within 5 min "name": F, or F leads to G' if self.is_timed else "write it in ltl or ctl"
        self.names.findings.add(Code.WRONG_LOGIC, node, message, hint)
        return Always(True)

    def _stands_for(self, name: s.Name, bound: Mapping[str, str]) -> str:
        return bound.get(name.text, name.text)

    def _entity(self, name: s.Agent, bound: Mapping[str, str]) -> str:
        if isinstance(name, s.Member):
            hint = "of its host, write a hosted_at X"
            self.names.findings.add(
                Code.WRONG_SORT, name, f"'{write(name)}' is a bigActor, and not an entity", hint
            )
            return NOBODY
        if name.text not in bound:
            self.names.entity(name)
        elif bound[name.text] in self.names.agents:
            hint = f"of its host, write {name.text} hosted_at X"
            message = f"'{name.text}' stands for a bigActor, and not for an entity"
            self.names.findings.add(Code.WRONG_SORT, name, message, hint)
        return self._stands_for(name, bound)

    def _check_inside(self, node: s.Node, who: str, within: str, *, directly: bool) -> None:
        """Warn of a place that can never contain an entity of that kind, according to the signature."""
        kind, around = self.names.kinds.get(who), self.names.kinds.get(within)
        if kind is None or around is None or kind in self.names.signature.within(around, directly=directly):
            return
        message = f"this is never true: {a(around)} cannot contain {a(kind)}"
        hint = f"name a place of another kind, or declare it: kind {around} contains {kind}"
        self.names.findings.warn(Code.NEVER_INSIDE, node, message, hint)

    def agent(self, name: s.Agent, bound: Mapping[str, str]) -> str:
        """Return the bigActor that a name denotes; reports a name that denotes none. `bound` are quantified names."""
        if not isinstance(name, s.Name) or name.text not in bound:
            return self.names.agent(name, bound) or NOBODY
        if bound[name.text] in self.names.kinds:
            hint = f"quantify over bigActors: {name.text}: agents, or name a family's member: patrol[{name.text}]"
            message = f"'{name.text}' stands for an entity, and not for a bigActor"
            self.names.findings.add(Code.WRONG_SORT, name, message, hint)
        return bound[name.text]

    def _either(self, name: s.Agent, bound: Mapping[str, str]) -> str:
        agent = isinstance(name, s.Member) or self._stands_for(name, bound) in self.names.agents
        return self.agent(name, bound) if agent else self._entity(name, bound)

    def _node_or_channel(self, name: s.Name, bound: Mapping[str, str]) -> str:
        if name.text in bound or name.text in self.names.channels:
            return bound.get(name.text, name.text)
        return self._entity(name, bound)

    def _same(self, node: s.SameName, bound: Mapping[str, str]) -> Proposition:
        if not any(isinstance(part, s.Name) and part.text in bound for part in s.walk(node)):
            hint = "quantify one of them; a bigActor's variable is written a.x"
            message = f"'{write(node.left)}' and '{write(node.right)}' are two fixed names"
            self.names.findings.add(Code.NOT_QUANTIFIED, node, message, hint)
        left, right = self._either(node.left, bound), self._either(node.right, bound)
        return Same(left, right) if is_variable(left) or is_variable(right) else Always(left == right)

    def _stored(self, node: s.Stored, around: Context) -> Proposition:
        mistakes = len(self.names.findings)
        variable = self._variable(node.agent, node.variable, around.names)
        value = elaborate_constant(node.value, self.names, around.names)
        if len(self.names.findings) == mistakes:
            check_comparable(node, variable, value, self.names, self.types)
        return VariableIs(variable, value, node.operator, around.unbound)

    def _variable(self, agent: s.Agent, variable: s.Name, bound: Mapping[str, str]) -> VariableOf:
        if isinstance(agent, s.Name) and agent.text in self.names.kinds.keys() - bound:
            message = f"'{agent.text}' is an entity, and has no variables"
            hint = f"only bigActors have variables; write {agent.text} in place, {agent.text} linked channel"
            self.names.findings.add(Code.WRONG_SORT, agent, message, hint)
            return VariableOf(NOBODY, (variable.text,))
        whose, shown = self.agent(agent, bound), variable.text
        known = list(self._variables(whose))
        unique = tuple(sorted({each for name, each in known if name == shown}))
        if not unique and whose in self.names.agents:
            among = {name for name, _ in known}
            otherwise = f"'{whose}' has {', '.join(sorted(among)[:8]) or 'none'}"
            self.names.findings.unknown(variable, among, sort="variable", otherwise=otherwise)
        return VariableOf(whose, unique or (shown,))

    def _variables(self, agent: str) -> Iterator[tuple[str, str]]:
        """Yield the variables in the bodies that a bigActor may run: their written and their unique names."""
        for body in self.bodies.running(agent):
            for name, renamed in body.variables.items():
                yield from ((name, unique) for unique in renamed)


IMPLICATIONS: Final = ("->", "<->")


def implications(node: s.Connective) -> Iterator[tuple[s.Formula, s.Formula]]:
    """Yield the condition and the conclusion of an implication; for `<->` in both directions."""
    yield node.left, node.right
    if node.operator == "<->":
        yield node.right, node.left


def _parts(formula: Proposition, make: type[And | Or]) -> tuple[Proposition, ...]:
    if isinstance(formula, And | Or) and isinstance(formula, make) and isinstance(formula.formulas, tuple):
        return formula.formulas
    return (formula,)


def _asked(formula: Proposition) -> int:
    """Return how many atoms of a proposition a configuration has to evaluate; an anchored quantifier counts as one."""
    match formula:
        case Not(inner):
            return _asked(inner)
        case And(Instances() as parts) | Or(Instances() as parts):
            return (1 if parts.anchor else len(parts)) * _asked(parts.body)
        case And(parts) | Or(parts):
            return sum(map(_asked, parts))
    return 1


def _is_said_something_of(variable: str, node: s.Formula) -> bool:
    """Whether a formula has an atom about a quantified name, other than as a place that contains another."""
    for each in s.walk(node):
        match each:
            case s.Inside(entity) | s.Known(entity) | s.Present(s.Name() as entity) if (
                entity.text == variable
            ):
                return True
            case s.LinkedTo(entity, other) if variable in (entity.text, other.text):
                return True
            case s.PossiblyIn(entity) | s.SurelyIn(entity) if entity.text == variable:
                return True
            case s.ApartFrom(s.Name(one), s.Name(other)) | s.WithinRangeOf(s.Name(one), s.Name(other)) if (
                variable in (one, other)
            ):
                return True
    return False
