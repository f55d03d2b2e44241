"""Elaboration of temporal properties: formulas of runs, the steps that they name, and fairness."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Final

from bigraphs.notation.spelling import listed
from semantics.properties import temporal as t
from semantics.properties.kinds import PropertyKind
from semantics.properties.property import Property
from semantics.properties.propositions import Always
from semantics.state.setting import Control
from semantics.successors import rules_of
from specs import syntax as s
from specs.codes import Code
from specs.construct_text import write
from specs.elaboration.formulas import IMPLICATIONS, Context, FormulaElaborator, TooLarge, implications
from specs.elaboration.names import Names

MOST_NESTED: Final = 32
"""The largest nesting depth of path operators."""

RULES: Final = (*(rule.__name__ for rule in rules_of(Control.TIMED)), *t.ENVIRONMENTS)

EACH: Final[dict[str, tuple[t.Steps, tuple[str, ...]]]] = {
    "agents": (t.Steps(), ("agent",)),
    "rules": (t.Steps(), ("agent", "rule")),
    "requests": (t.Steps(t.SERVES), ("label",)),
    "environment": (t.Steps(t.ENVIRONMENTS), ()),
}
"""The steps that a word denotes, and the attributes by which fairness groups them."""

_PREFIXES: Final[dict[str, Callable[[t.Temporal], t.Temporal]]] = {
    "[]": t.Globally,
    "always": t.Globally,
    "<>": t.Eventually,
    "eventually": t.Eventually,
    "X": t.Next,
    "next": t.Next,
    "infinitely often": lambda inner: t.Globally(t.Eventually(inner)),
}
_UNBOUND: Final = {
    "[]": True,
    "always": True,
    "<>": False,
    "eventually": False,
    "infinitely often": False,
}
"""The truth value, below an operator, of a comparison with an unbound variable; below `X` as in the context."""

_OPERATIONS: Final[dict[str, Callable[[t.Temporal, t.Temporal], t.Temporal]]] = {
    "U": t.Until,
    "until": t.Until,
    "R": t.Release,
    "W": t.WeakUntil,
}
_OF_RUNS: Final = (s.PathPrefix, s.PathOperation, s.LeadsTo, s.PathQuantifier, s.Taken, s.Enabled)


class TemporalFormulas:
    """Elaborates temporal properties; `formulas` elaborates the parts about single configurations."""

    def __init__(self, formulas: FormulaElaborator) -> None:
        self.formulas = formulas
        self.names: Names = formulas.names
        self.logic = "ltl"
        self.of_runs: set[int] = set()

    def property(self, item: s.TemporalProperty | s.Progress | s.FairDeadlockFreedom, line: int) -> Property:
        """Return a property of runs."""
        fairness = tuple(each for declared in item.fairness for each in self.fairness(declared))
        if not isinstance(item, s.TemporalProperty):
            progress = isinstance(item, s.Progress)
            kind = PropertyKind.PROGRESS if progress else PropertyKind.DEADLOCK_FREEDOM
            return Property(kind, item.label.value if item.label else kind, line=line, fairness=fairness)
        self.logic = item.logic
        return Property(
            PropertyKind(item.logic),
            item.label.value,
            line=line,
            temporal=self.formula(item),
            fairness=fairness,
        )

    def formula(self, item: s.TemporalProperty) -> t.Temporal:
        """Return a property's formula; reports its mistakes, and a bound that it exceeds."""
        if self.formulas.full:
            return t.Now(Always(True))
        self.of_runs = set()
        for node in reversed(tuple(s.walk(item.formula))):  # parts before the whole
            if isinstance(node, _OF_RUNS) or any(id(part) in self.of_runs for part in s.parts(node)):
                self.of_runs.add(id(node))
        try:
            return self._claim(item.formula, Context(unbound=False))
        except TooLarge as error:
            self.formulas.report(item.formula, error)
        return t.Now(Always(True))

    def _claim(self, node: s.Formula, around: Context) -> t.Temporal:
        """Return a formula as a temporal formula, with the quantified names of its context replaced."""
        if id(node) not in self.of_runs:
            return t.Now(self.formulas.proposition(node, around))
        match node:
            case s.Negation(operand):
                return t.Denied(self._claim(operand, around.denied()))
            case s.Connective():
                return self._connective(node, around)
            case s.Quantified():
                return self._quantified(node, around)
            case s.Taken(steps):
                if self.logic == "ctl":
                    message = "ctl is about all possible steps, and so has no 'taken'"
                    self._refuse(node, message, "write it in ltl, or write enabled")
                self.formulas.count(1)
                return t.Taken(self.steps(steps, around.names)[0])
            case s.Enabled(steps):
                self.formulas.count(1)
                return t.Enabled(self.steps(steps, around.names)[0])
        if around.depth >= MOST_NESTED:
            raise TooLarge(f"more than {MOST_NESTED} operators of paths inside each other", "split it")
        return self._of_paths(node, around)

    def _connective(self, node: s.Connective, around: Context) -> t.Temporal:
        if node.operator in IMPLICATIONS:
            ways = [
                t.Either(t.Denied(self._claim(condition, around.denied())), self._claim(then, around))
                for condition, then in implications(node)
            ]
            return ways[0] if len(ways) == 1 else t.Both(*ways)
        left, right = self._claim(node.left, around), self._claim(node.right, around)
        return (t.Both if node.operator == "and" else t.Either)(left, right)

    def _quantified(self, node: s.Quantified, around: Context) -> t.Temporal:
        claims = []
        if around.depth == 0:
            self._check_begun(node)
        for each, if_so in self.formulas.instances(node, around, self._claim):
            claim = self._claim(node.body, each)
            if if_so is not None and node.quantifier == "forall":
                claim = t.Either(t.Denied(t.Now(if_so)), claim)
            elif if_so is not None:
                claim = t.Both(t.Now(if_so), claim)
            claims.append(claim)
        join = t.Both if node.quantifier == "forall" else t.Either
        while len(claims) > 1:  # in pairs, for a tree of small depth
            odd = claims[-1:] if len(claims) % 2 else []
            pairs = zip(claims[::2], claims[1::2], strict=False)
            claims = [*(join(one, other) for one, other in pairs), *odd]
        return claims[0] if claims else t.Now(Always(node.quantifier == "forall"))

    def _check_begun(self, node: s.Quantified) -> None:
        """Report a quantifier about the beginning of runs that ranges over bigActors which are only spawned later."""
        late = self.formulas.among.late(node)
        if late is not None:
            message = f"this is about the beginning of runs, and '{late}' is spawned in them"
            hint = (
                f"write always ({node.quantifier} ...), or quantify over others: agents with_behavior visit"
            )
            self.names.findings.add(Code.WRONG_LOGIC, node.range, message, hint)

    # --- path operators

    def _of_paths(self, node: s.Formula, around: Context) -> t.Temporal:
        match node:
            case s.LeadsTo(left, right):
                below = around.on_paths(unbound=True)
                condition, then = (
                    self._claim(left, below.denied()),
                    self._claim(right, below.on_paths(unbound=False)),
                )
                return self._leads_to(condition, then)
            case s.PathQuantifier():
                return self._on_paths(node, around)
            case s.PathPrefix() | s.PathOperation():
                if self.logic == "ctl":
                    message = "in ctl an operator of paths stands directly behind A or E"
                    self._refuse(node, message, "write AG, EF, AX or A (F U G)")
                return self._path(node, around)
        raise AssertionError(node)

    def _on_paths(self, node: s.PathQuantifier, around: Context) -> t.Temporal:
        path = node.operand
        if self.logic == "ltl":
            message = f"ltl is about every run, and has no '{node.quantifier}'"
            self._refuse(node, message, "leave it out, or write it in ctl")
        if isinstance(path, s.PathPrefix | s.PathOperation):
            make = t.OnAllPaths if node.quantifier == "A" else t.OnSomePath
            return make(self._path(path, around))
        self._refuse(path, f"'{node.quantifier}' needs an operator of paths", "write AG, EF, AX or A (F U G)")
        return t.Now(Always(True))

    def _path(self, node: s.PathPrefix | s.PathOperation, around: Context) -> t.Temporal:
        if isinstance(node, s.PathOperation):
            kept, come = around.on_paths(unbound=True), around.on_paths(unbound=False)
            sides = (come, kept) if node.operator == "R" else (kept, come)
            left, right = (
                self._claim(each, side) for each, side in zip((node.left, node.right), sides, strict=True)
            )
            return _OPERATIONS[node.operator](left, right)
        if node.operator == "infinitely often" and self.logic == "ctl":
            self._refuse(node, "'infinitely often' is two operators of paths", "write AG AF F")
        unbound = _UNBOUND.get(node.operator, around.unbound)
        return _PREFIXES[node.operator](self._claim(node.operand, around.on_paths(unbound=unbound)))

    def _leads_to(self, condition: t.Temporal, then: t.Temporal) -> t.Temporal:
        if self.logic == "ctl":
            comes = t.OnAllPaths(t.Eventually(then))
            return t.OnAllPaths(t.Globally(t.Either(t.Denied(condition), comes)))
        return t.Globally(t.Either(t.Denied(condition), t.Eventually(then)))

    def _refuse(self, node: s.Node, message: str, hint: str) -> None:
        self.names.findings.add(Code.WRONG_LOGIC, node, message, hint)

    # --- steps and fairness

    def fairness(self, declared: s.Fairness) -> Iterable[t.Fairness]:
        """Yield a fairness condition for each of the steps that a declaration lists."""
        for each in declared.steps:
            steps, per = self.steps(each, {})
            word = write(each)
            yield t.Fairness(declared.strength == "strong", steps, per, word)

    def steps(self, node: s.Steps, bound: Mapping[str, str]) -> tuple[t.Steps, tuple[str, ...]]:
        """Return the steps that words name, and the attributes by which fairness groups them."""
        first, *whose = node.words
        if isinstance(first, s.Member) or (
            not whose and (first.text in self.names.agents or first.text in bound)
        ):
            return t.Steps((), self.formulas.agent(first, bound)), ()
        if not whose and first.text in EACH:
            return EACH[first.text]
        if first.text not in RULES:
            self._unknown(first, whose)
            return t.Steps(), ()
        if whose and self._somebodys(first):
            return t.Steps((first.text,), self.formulas.agent(whose[0], bound)), ()
        return t.Steps((first.text,)), ("label",) if first.text in t.ENVIRONMENTS else ("agent",)

    def _unknown(self, first: s.Name, whose: Sequence[s.Agent]) -> None:
        among = RULES if whose else (*RULES, *EACH, *self.names.agents)
        otherwise = f"{listed(self.names.agents, 'bigActors')}; the rules are {', '.join(RULES)}"
        sort = "rule" if whose else "rule or bigActor"
        self.names.findings.unknown(first, among, sort=sort, otherwise=otherwise)

    def _somebodys(self, rule: s.Name) -> bool:
        if rule.text in t.ENVIRONMENTS:
            self._refuse(rule, f"'{rule.text}' is no bigActor's rule", "leave the bigActor out")
        return rule.text not in t.ENVIRONMENTS
