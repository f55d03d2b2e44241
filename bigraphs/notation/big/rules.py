"""Elaboration of rules: it evaluates both sides, compares their interfaces, and checks weights and conditions."""

from __future__ import annotations

import math

from bigraphs.algebra import lean
from bigraphs.bigraph import Bigraph
from bigraphs.notation.big.declarations import ConditionTerm, ReactDeclaration
from bigraphs.notation.big.expression_evaluation import Evaluation
from bigraphs.notation.big.scope import CallFrame
from bigraphs.notation.big.solidity import faults, pattern_of
from bigraphs.notation.big.syntax import Expression, ValueExpression
from bigraphs.notation.lalr import Span
from bigraphs.system import Condition, Rule, SourcePosition, SystemKind, Value, Where


class RuleElaborator:
    """The rules of one file; the kind of the system determines their weights."""

    def __init__(self, evaluation: Evaluation, kind: SystemKind | None) -> None:
        self.evaluation = evaluation
        self.scope = evaluation.scope
        self.kind = kind
        self._known: dict[str, Rule | None] = {}
        self._positions: dict[int, SourcePosition] = {}

    def named(self, name: str, given: tuple[Value, ...], span: Span, frame: CallFrame) -> Rule | None:
        """Return a declared rule for these arguments, or None after a recorded mistake."""
        declaration = self._declaration(name, given, span)
        if declaration is None:
            return None
        parameters = declaration.parameters
        if parameters and not self.scope.fits(name, parameters, given, span, frame):
            return None
        inner = self.scope.entered(declaration, given, span, frame)
        if inner is None:
            return None
        key = inner.key(name, given)
        if key not in self._known:
            self._known[key] = self.rule(declaration, given, inner)
        return self._known[key]

    def _declaration(self, name: str, given: tuple[Value, ...], span: Span) -> ReactDeclaration | None:
        found = self.scope.names.reacts.get(name)
        if found is not None and found.arguments:
            return self.scope.instance(self.scope.names.given_reacts[name], given, span)
        return found if found is not None and len(found.parameters) == len(given) else None

    def rule(self, react: ReactDeclaration, given: tuple[Value, ...], frame: CallFrame) -> Rule | None:
        """Return the rule of a declaration for these arguments."""
        patterns = [(condition.pattern, pattern_of) for condition in react.conditions]
        parts = [(react.redex, lean), (react.reactum, lean), *patterns]
        sides = self.evaluation.instance(react, frame, parts) or self._sides(react, frame)
        weight = self._weight(react, frame)
        if sides is None:
            return None
        self.evaluation.is_well(react, frame)
        redex, reactum, *conditions = sides
        sites = react.instantiation if react.instantiation is not None else tuple(range(len(redex.sites)))
        action = self.scope.names.actions.get(react.name)
        return Rule(
            react.name,
            redex,
            reactum,
            sites,
            weight,
            action.name if action is not None and self.kind is SystemKind.NBRS else None,
            self.reward(action.reward if action is not None else None),
            tuple(map(_condition, react.conditions, conditions)),
            given,
            position=self.position(react.span),
        )

    def _sides(self, react: ReactDeclaration, frame: CallFrame) -> list[Bigraph] | None:
        redex = self.evaluation.value(react.redex, frame)
        reactum = self.evaluation.value(react.reactum, frame)
        patterns = [self.pattern(condition.pattern, frame) for condition in react.conditions]
        if redex is None or reactum is None or not self._fitting(react, redex, reactum, frame):
            return None
        found = [pattern for pattern in patterns if pattern is not None]
        return [lean(redex), lean(reactum), *found] if len(found) == len(patterns) else None

    def reward(self, expression: ValueExpression | None) -> int | float:
        """Return the reward of an action or a predicate, 0 by default."""
        found = 0 if expression is None else self.scope.value(expression, CallFrame())
        if expression is not None and (isinstance(found, str) or not _finite(found)):
            self.scope.add("type", "a reward is a number", expression.span, CallFrame())
        return found if isinstance(found, int | float) else 0

    def position(self, span: Span) -> SourcePosition:
        """Return the line and column of a span's start."""
        if span.start not in self._positions:
            text, start = self.scope.findings.text, span.start
            self._positions[start] = SourcePosition(
                text.count("\n", 0, start) + 1, start - text.rfind("\n", 0, start)
            )
        return self._positions[span.start]

    def pattern(self, expression: Expression, frame: CallFrame) -> Bigraph | None:
        """Return the pattern of a condition or predicate."""
        found = self.evaluation.value(expression, frame)
        return None if found is None else self.as_pattern(found, expression.span, frame)

    def as_pattern(self, bigraph: Bigraph, span: Span, frame: CallFrame) -> Bigraph | None:
        """Return the part of a bigraph that determines its occurrence."""
        found = pattern_of(bigraph)
        if not found.nodes:
            self.scope.add("pattern", "this has no node, so it would always occur", span, frame)
        elif found.inner_links:
            self.scope.add("pattern", "a pattern has sites, but no inner names", span, frame)
        else:
            return found
        return None

    def _fitting(self, react: ReactDeclaration, redex: Bigraph, reactum: Bigraph, frame: CallFrame) -> bool:
        """Check that the two sides form a rule; record every mistake."""
        before = len(self.scope.findings)
        for message, hint in faults(redex):
            self.scope.add("redex", message, react.redex.span, frame, hint)
        self._check_faces(react, redex, reactum, frame)
        if reactum.inner_links:
            name = reactum.inner_links[0][0]
            self.scope.add("rule", f"the reactum has the inner name '{name}'", react.reactum.span, frame)
        if () in reactum.sites:
            message = (
                f"site {reactum.sites.index(())} of the reactum is in no region, so its content has no place"
            )
            hint = "leave it out, and list the content of each of the others with '@ [...]'"
            self.scope.add("rule", message, react.reactum.span, frame, hint)
        self._check_sites(react, len(redex.sites), len(reactum.sites), frame)
        return len(self.scope.findings) == before

    def _check_faces(
        self, react: ReactDeclaration, redex: Bigraph, reactum: Bigraph, frame: CallFrame
    ) -> None:
        at = react.reactum.span
        if redex.regions != reactum.regions:
            found = f"the redex has {_regions(redex.regions)}, the reactum {reactum.regions}"
            self.scope.add("rule", found, at, frame, "write 1 for an empty region")
        lost = sorted(set(redex.outer_names) - set(reactum.outer_names))
        new = sorted(set(reactum.outer_names) - set(redex.outer_names))
        if lost:
            hint = f"to leave it without this end, write '| {{{lost[0]}}}' there"
            self.scope.add("rule", f"the reactum lacks the name '{lost[0]}' of the redex", at, frame, hint)
        if new:
            hint = f"close it with /{new[0]}, or give it to the redex"
            self.scope.add("rule", f"the redex lacks the name '{new[0]}' of the reactum", at, frame, hint)

    def _check_sites(self, react: ReactDeclaration, given: int, wanted: int, frame: CallFrame) -> None:
        sites = react.instantiation
        if sites is None and given != wanted:
            found = f"the redex has {_sites(given)}, the reactum {wanted}"
            hint = "list the content of each site of the reactum with '@ [...]'"
            self.scope.add("rule", found, react.reactum.span, frame, hint)
        elif sites is not None and len(sites) != wanted:
            found = f"the reactum has {_sites(wanted)}, the map lists {len(sites)}"
            self.scope.add("rule", found, react.reactum.span, frame)
        elif sites is not None and sites and max(sites) >= given:
            found = f"the redex has {_sites(given)}, there is no site {max(sites)}"
            self.scope.add("rule", found, react.reactum.span, frame, "count sites from 0")

    def _weight(self, react: ReactDeclaration, frame: CallFrame) -> float | None:
        if self.kind in (None, SystemKind.BRS):
            return None
        if react.weight is None:
            kind = self.kind.value if self.kind else ""
            hint = "write -[1]-> for the weight 1"
            self.scope.add("weight", f"a rule of a {kind} has a weight", react.span, frame, hint)
            return None
        found = self.scope.value(react.weight, frame)
        if found is None:
            return None
        wrong = _wrong_weight(found, self.kind)
        if wrong:
            self.scope.add("weight", wrong, react.weight.span, frame)
            return None
        return float(found)


def _condition(term: ConditionTerm, pattern: Bigraph) -> Condition:
    return Condition(term.positive, pattern, Where(term.where))


def _wrong_weight(weight: Value, kind: SystemKind | None) -> str:
    if isinstance(weight, str):
        return "a weight is a number, this is a string"
    if kind is SystemKind.SBRS:
        return "" if weight > 0 else f"a rate is more than 0, this is {weight}"
    return "" if weight >= 0 and _finite(weight) else f"a weight is 0 or more, and finite, this is {weight}"


def _finite(value: Value | None) -> bool:
    return isinstance(value, int | float) and math.isfinite(value)


def _regions(count: int) -> str:
    return f"{count} region{'' if count == 1 else 's'}"


def _sites(count: int) -> str:
    return f"{count} site{'' if count == 1 else 's'}"
