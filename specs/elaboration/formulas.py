"""Elaborate formulas of properties: expand quantifiers and resolve names, within bounds."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Final

from semantics.behaviours.program import Program, VariableOf
from semantics.behaviours.values import Value, show
from semantics.properties.propositions import (
    ORDERS,
    Always,
    And,
    Ended,
    HasPending,
    HostedAt,
    Inside,
    IsBound,
    Known,
    LinkedWith,
    Not,
    Or,
    Present,
    Proposition,
    VariableIs,
    Waiting,
)
from semantics.state.signature import REGION
from specs import syntax as s
from specs.codes import Code
from specs.elaboration.bodies import Bodies
from specs.elaboration.constants import elaborate_constant
from specs.elaboration.names import Names
from specs.elaboration.value_types import ANY, WORDS, types_of

MOST_ATOMS: Final = 50_000


@dataclass(frozen=True, slots=True)
class Context:
    """What there is around a part of a formula.

    What has no value neither violates nor fulfils: below `always`, a comparison is true where its variable has no
    value, below `eventually` false, and the other way round below a negation. So `not always F` is `eventually not F`.

    Attributes:
        unbound: The truth of a comparison here whose variable has no value.
        names: What each quantified name stands for.
        depth: How many operators of paths are around.
    """

    unbound: bool
    names: Mapping[str, str] = field(default_factory=dict)
    depth: int = 0

    def naming(self, variable: str, name: str) -> Context:
        """Return the context in which a quantified name stands for another."""
        return replace(self, names={**self.names, variable: name})

    def denied(self) -> Context:
        """Return the context below a negation."""
        return replace(self, unbound=not self.unbound)

    def on_paths(self, *, unbound: bool) -> Context:
        """Return the context below one more operator of paths."""
        return replace(self, unbound=unbound, depth=self.depth + 1)


class TooLarge(Exception):
    """A formula that comes to more than is allowed: what is too much, and what to do."""


class Formulas:
    """Elaborates the formulas of a mission; `atoms` counts those of all of them."""

    def __init__(self, names: Names, bodies: Bodies, program: Program) -> None:
        self.names = names
        self.bodies = bodies
        self.types = types_of(program)
        self.atoms = 0

    def elaborate(self, formula: s.Formula, *, invariant: bool) -> Proposition:
        """Return a formula as a proposition; reports what is wrong with it, and where the bound is passed."""
        if self.full:
            return Always(True)
        try:
            return self.proposition(formula, Context(unbound=invariant))
        except TooLarge as error:
            self.report(formula, error)
            return Always(True)

    @property
    def full(self) -> bool:
        """Whether there are so many atoms that the following properties are skipped."""
        return self.atoms > MOST_ATOMS

    def report(self, formula: s.Formula, error: TooLarge) -> None:
        """Report a formula that is too large."""
        message, hint = error.args
        self.names.findings.add(Code.FORMULA_TOO_LARGE, formula, message, hint)

    def proposition(self, node: s.Formula, around: Context) -> Proposition:
        """Return a formula as a proposition, the quantified names around it replaced."""
        match node:
            case s.Negation(operand):
                return Not(self.proposition(operand, around.denied()))
            case s.Connective():
                return self._connective(node, around)
            case s.Quantified():
                return self._quantified(node, around)
            case _:
                self.count(1)
                return self._atom(node, around)

    def count(self, atoms: int) -> None:
        """Count atoms; raises TooLarge where they are too many."""
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
        found = []
        for each in self.instances(node, around, self.proposition):
            found.append(self.proposition(node.body, each))  # noqa: PERF401 - a frame less
        return And(tuple(found)) if node.quantifier == "forall" else Or(tuple(found))

    def instances(
        self, node: s.Quantified, around: Context, elaborate: Callable[[s.Formula, Context], object]
    ) -> list[Context]:
        """Return the context of each instance of what is quantified."""
        if not self.names.kind(node.kind):
            return []
        members = [name for name, kind in sorted(self.names.kinds.items()) if kind == node.kind.text]
        if not members:
            always = "true whatever happens" if node.quantifier == "forall" else "never true"
            self.names.findings.warn(
                Code.NOTHING_QUANTIFIED,
                node.kind,
                f"there is no entity of kind {node.kind.text}: '{node.quantifier} {node.variable.text}: "
                f"{node.kind.text}' is {always}",
                "declare one, absent if it is to appear later, or quantify over another kind",
            )
            elaborate(node.body, around.naming(node.variable.text, REGION))  # for the mistakes in it
        return [around.naming(node.variable.text, name) for name in members]

    # --- atoms

    def _atom(self, node: s.Formula, around: Context) -> Proposition:
        bound = around.names
        match node:
            case s.TruthLiteral(value):
                return Always(value)
            case s.Inside(entity, place, directly, actually):
                within = REGION if place.text == REGION else self._entity(place, bound)
                return Inside(self._entity(entity, bound), within, actually, directly)
            case s.LinkedTo(entity, other, actually):
                return LinkedWith(self._entity(entity, bound), self._node_or_channel(other, bound), actually)
            case s.Present(entity):
                return Present(self._entity(entity, bound))
            case s.Known(entity):
                return Known(self._entity(entity, bound))
            case s.HostedAt(agent, host):
                return HostedAt(self._agent(agent), self._entity(host, bound))
            case s.Pending(agent, request):
                return HasPending(self._agent(agent), request)
            case s.Ended(agent):
                return Ended(self._agent(agent))
            case s.Waiting(agent):
                return Waiting(self._agent(agent))
            case s.SameName():
                return self._same(node, bound)
            case s.Stored():
                return self._stored(node, around)
            case s.HasValue(agent, variable):
                return IsBound(self._variable(agent, variable))
        message = "this is about runs, and here single configurations are looked at"
        self.names.findings.add(Code.WRONG_LOGIC, node, message, "write it in ltl or ctl")
        return Always(True)

    def _entity(self, name: s.Name, bound: Mapping[str, str]) -> str:
        if name.text not in bound:
            self.names.entity(name)
        return bound.get(name.text, name.text)

    def _agent(self, name: s.Name) -> str:
        self.names.agent(name)
        return name.text

    def _node_or_channel(self, name: s.Name, bound: Mapping[str, str]) -> str:
        if name.text in bound or name.text in self.names.channels:
            return bound.get(name.text, name.text)
        return self._entity(name, bound)

    def _same(self, node: s.SameName, bound: Mapping[str, str]) -> Proposition:
        if node.left.text not in bound and node.right.text not in bound:
            hint = "quantify one of them; a bigActor's variable is written a.x"
            message = f"'{node.left.text}' and '{node.right.text}' are two fixed names"
            self.names.findings.add(Code.NOT_QUANTIFIED, node, message, hint)
        return Always(self._entity(node.left, bound) == self._entity(node.right, bound))

    def _stored(self, node: s.Stored, around: Context) -> Proposition:
        mistakes = len(self.names.findings)
        variable = self._variable(node.agent, node.variable)
        value = elaborate_constant(node.value, self.names, around.names)
        if len(self.names.findings) == mistakes:
            self._check_comparable(node, variable, value)
        return VariableIs(variable, value, node.operator, around.unbound)

    def _check_comparable(self, node: s.Stored, variable: VariableOf, value: Value) -> None:
        """Report a comparison that no value of the variable can meet."""
        if node.operator in ORDERS and not isinstance(value, int):
            message = f"'{node.operator}' compares numbers, and {show(value)} is none"
            hint = "write a whole number, or compare with == or !="
            self.names.findings.add(Code.NOT_COMPARABLE, node, message, hint)
            return
        types = frozenset[type]().union(*(self.types.get(each, ANY) for each in variable.variables))
        if type(value) not in types:
            has = " or ".join(WORDS[each] for each in WORDS if each in types)
            message = f"'{variable}' never has a value of that type, only {has}"
            hint = f"whether it has a value at all is asked with: bound {variable}"
            self.names.findings.add(Code.NOT_COMPARABLE, node, message, hint)

    def _variable(self, agent: s.Name, variable: s.Name) -> VariableOf:
        whose, shown = self._agent(agent), variable.text
        known = list(self._variables(whose))
        unique = tuple(sorted({each for name, each in known if name == shown}))
        if not unique and whose in self.names.agents:
            among = {name for name, _ in known}
            otherwise = f"'{whose}' has {', '.join(sorted(among)[:8]) or 'none'}"
            self.names.findings.unknown(variable, among, sort="variable", otherwise=otherwise)
        return VariableOf(whose, unique or (shown,))

    def _variables(self, agent: str) -> Iterator[tuple[str, str]]:
        """Yield the variables of what a bigActor may run: as written, and their unique names."""
        for body in self.bodies.running(agent):
            for name, renamed in body.variables.items():
                yield from ((name, unique) for unique in renamed)


IMPLICATIONS: Final = ("->", "<->")


def implications(node: s.Connective) -> Iterator[tuple[s.Formula, s.Formula]]:
    """Yield the condition and the conclusion of an implication; of `<->` both ways."""
    yield node.left, node.right
    if node.operator == "<->":
        yield node.right, node.left


def _parts(formula: Proposition, make: type[And | Or]) -> tuple[Proposition, ...]:
    return formula.formulas if isinstance(formula, make) else (formula,)
