"""Formulas of properties: quantifiers written out, names resolved, within bounds."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Final

from semantics.propositions import (
    Always,
    And,
    Ended,
    HasPending,
    HostedAt,
    Inside,
    Known,
    LinkedWith,
    Not,
    Or,
    Present,
    Proposition,
    VariableIs,
    Waiting,
)
from semantics.signature import REGION
from specs import syntax as s
from specs.codes import Code
from specs.elaboration.bodies import Bodies
from specs.elaboration.constants import elaborate_constant
from specs.elaboration.names import Names

MOST_ATOMS: Final = 50_000

Bound = Mapping[str, str]
"""What each quantified name stands for."""


class TooLarge(Exception):
    """A formula that comes to more than is allowed: what is too much, and what to do."""


class Formulas:
    """Elaborates the formulas of a mission; `atoms` counts those of all of them."""

    def __init__(self, names: Names, bodies: Bodies) -> None:
        self.names = names
        self.bodies = bodies
        self.atoms = 0

    def elaborate(self, formula: s.Formula) -> Proposition:
        """Return a formula as a proposition; reports what is wrong with it, and where the bound is passed."""
        if self.full:
            return Always(True)
        try:
            return self.proposition(formula, {})
        except TooLarge as error:
            self.report(formula, error)
            return Always(True)

    @property
    def full(self) -> bool:
        """Whether so many atoms were counted that the properties which follow are not looked at."""
        return self.atoms > MOST_ATOMS

    def report(self, formula: s.Formula, error: TooLarge) -> None:
        """Report a formula that is too large."""
        message, hint = error.args
        self.names.findings.add(Code.FORMULA_TOO_LARGE, formula, message, hint)

    def proposition(self, node: s.Formula, bound: Bound) -> Proposition:
        """Return a formula with what is quantified around it replaced."""
        match node:
            case s.Negation(operand):
                return Not(self.proposition(operand, bound))
            case s.Connective():
                return self._connective(node, bound)
            case s.Quantified():
                return self._quantified(node, bound)
            case _:
                self.count(1)
                return self._atom(node, bound)

    def count(self, atoms: int) -> None:
        """Count atoms; raises TooLarge where they are too many."""
        self.atoms += atoms
        if self.full:
            message = f"written out, the properties have more than {MOST_ATOMS:,} atoms"
            raise TooLarge(message, "quantify over fewer names, or split it")

    def _connective(self, node: s.Connective, bound: Bound) -> Proposition:
        before = self.atoms
        left, right = self.proposition(node.left, bound), self.proposition(node.right, bound)
        if node.operator == "<->":
            self.count(self.atoms - before)
            return And((_implies(left, right), _implies(right, left)))
        if node.operator == "->":
            return _implies(left, right)
        make = And if node.operator == "and" else Or
        return make((*_parts(left, make), *_parts(right, make)))

    def _quantified(self, node: s.Quantified, bound: Bound) -> Proposition:
        found = []
        for each in self.bindings(node, bound, self.proposition):
            found.append(self.proposition(node.body, each))  # noqa: PERF401 - a frame less
        return And(tuple(found)) if node.quantifier == "forall" else Or(tuple(found))

    def bindings(
        self, node: s.Quantified, bound: Bound, elaborate: Callable[[s.Formula, Bound], object]
    ) -> list[Bound]:
        """Return what names stand for in each instance of what is quantified."""
        if not self.names.kind(node.kind):
            return []
        members = [name for name, kind in sorted(self.names.kinds.items()) if kind == node.kind.text]
        if not members:
            elaborate(node.body, {**bound, node.variable.text: REGION})  # for the mistakes in it
        return [{**bound, node.variable.text: name} for name in members]

    # --- atoms

    def _atom(self, node: s.Formula, bound: Bound) -> Proposition:
        match node:
            case s.TruthLiteral(value):
                return Always(value)
            case s.Inside(entity, place, directly, actually):
                around = REGION if place.text == REGION else self._entity(place, bound)
                return Inside(self._entity(entity, bound), around, actually, directly)
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
                return self._stored(node, bound)
        message = "this is about runs, and here single configurations are looked at"
        self.names.findings.add(Code.WRONG_LOGIC, node, message, "write it in ltl or ctl")
        return Always(True)

    def _entity(self, name: s.Name, bound: Bound) -> str:
        if name.text not in bound:
            self.names.entity(name)
        return bound.get(name.text, name.text)

    def _agent(self, name: s.Name) -> str:
        self.names.agent(name)
        return name.text

    def _node_or_channel(self, name: s.Name, bound: Bound) -> str:
        if name.text in bound or name.text in self.names.channels:
            return bound.get(name.text, name.text)
        return self._entity(name, bound)

    def _same(self, node: s.SameName, bound: Bound) -> Proposition:
        if node.left.text not in bound and node.right.text not in bound:
            hint = "quantify one of them; a bigActor's variable is written a.x"
            message = f"'{node.left.text}' and '{node.right.text}' are two fixed names"
            self.names.findings.add(Code.NOT_QUANTIFIED, node, message, hint)
        return Always(self._entity(node.left, bound) == self._entity(node.right, bound))

    def _stored(self, node: s.Stored, bound: Bound) -> Proposition:
        agent, shown = self._agent(node.agent), node.variable.text
        value = elaborate_constant(node.value, self.names, bound)
        known = list(self._variables(agent))
        renamed = tuple(sorted({unique for name, unique in known if name == shown}))
        if not renamed and agent in self.names.agents:
            among = {name for name, _ in known}
            otherwise = f"'{agent}' has {', '.join(sorted(among)[:8]) or 'none'}"
            self.names.findings.unknown(node.variable, among, sort="variable", otherwise=otherwise)
        return VariableIs(agent, renamed, value, shown)

    def _variables(self, agent: str) -> Iterator[tuple[str, str]]:
        """Yield the variables of what a bigActor may run: as written, and their unique names."""
        for body in self.bodies.running(agent):
            for name, renamed in body.variables.items():
                yield from ((name, unique) for unique in renamed)


def _implies(left: Proposition, right: Proposition) -> Proposition:
    return Or((Not(left), right))


def _parts(formula: Proposition, make: type[And | Or]) -> tuple[Proposition, ...]:
    return formula.formulas if isinstance(formula, make) else (formula,)
