"""The check of every name in a file before evaluation: it must be declared, and its use must fit."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TypeAlias

from bigraphs.notation.big.declarations import (
    ActionDeclaration,
    BigDeclaration,
    Call,
    ConstantDeclaration,
    Declaration,
    Model,
    ReactDeclaration,
    SystemTerm,
)
from bigraphs.notation.big.file_mistakes import Findings
from bigraphs.notation.big.names import Names
from bigraphs.notation.big.syntax import (
    Absolute,
    Arithmetic,
    Chain,
    Expression,
    Ion,
    Negated,
    Nest,
    Ref,
    Repeat,
    Share,
    ValueExpression,
    Variable,
    Wired,
)
from bigraphs.notation.lalr import Span

_Used: TypeAlias = tuple[type, str]
"""The kind of a call, bigraph or rule, and its name."""


def survey(model: Model, names: Names, findings: Findings, given: Iterable[str] = ()) -> None:
    """Record every undeclared name and every wrong number of links or arguments; `given` are external constants."""
    constants = frozenset(given) | names.constants.keys()
    ranging = () if model.system is None else model.system.parameters
    look = SyntaxWalk(names, findings, constants, frozenset(name for each in ranging for name in each.names))
    for declaration in model.declarations:
        look.declaration(declaration)
    names.free.update(look.free())
    if model.system is not None:
        look.system(model.system)
    look.settle(model.system is not None)
    for name in sorted(set(given) - names.constants.keys() - look.seen):
        findings.add("name", f"no constant '{name}' is in the file", Span(0, 1), "leave it out")


class SyntaxWalk:
    """A walk over syntax that knows the visible values at each point."""

    def __init__(
        self,
        names: Names,
        findings: Findings,
        constants: frozenset[str],
        ranging: frozenset[str] = frozenset(),
    ) -> None:
        self.names = names
        self.findings = findings
        self.variables = self.constants = constants
        self._ranging = ranging - constants
        self._free: dict[_Used, set[str]] = {}
        self.seen: set[str] = set()
        self._within: _Used | None = None
        self._uses: dict[_Used | None, set[_Used]] = {}
        self._apart: dict[_Used, Findings] = {}

    def apart(self, what: type, name: str, parameters: Sequence[str], walk: Callable[[], None]) -> None:
        """Check a declaration with its parameters visible.

        Mistakes in a parametrised declaration are collected separately: they count only if it is called.
        """
        if not parameters:
            walk()
        else:
            self.variables = self.constants | self._ranging | frozenset(parameters)
            self._free[what, name] = set()
            whole, self.findings, self._within = self.findings, Findings(self.findings.text), (what, name)
            walk()
            self._apart[what, name] = self.findings
            self.findings, self._within = whole, None
            self._free[what, name].difference_update(parameters)
            self.variables = self.constants

    def free(self) -> dict[_Used, tuple[str, ...]]:
        """Return the system parameters that each declaration uses, directly or through its calls."""
        grown = True
        while grown and any(self._free.values()):
            before = sum(map(len, self._free.values()))
            for each, found in self._free.items():
                called = (self._free.get(other, ()) for other in self._uses.get(each, ()))
                found.update(*called)
                found.difference_update(self.parameters(each))
            grown = sum(map(len, self._free.values())) > before
        return {each: tuple(sorted(found)) for each, found in self._free.items() if found}

    def parameters(self, used: _Used) -> tuple[str, ...]:
        """Return the parameters of a bigraph or a rule."""
        what, name = used
        known: Mapping[str, BigDeclaration | ReactDeclaration]
        known = self.names.bigs if what is BigDeclaration else self.names.reacts
        return known[name].parameters

    def settle(self, called: bool) -> None:
        """Turn the mistakes of uncalled declarations into warnings, and report the others."""
        reached: list[_Used | None] = [None, *(() if called else self._apart)]
        for each in reached:  # the list grows during the loop
            reached.extend(self._uses.pop(each, ()))
        for each, found in self._apart.items():
            (self.findings.take if each in reached else self.findings.warn)(found)

    def declaration(self, declaration: Declaration) -> None:
        """Check one declaration, with its parameters visible."""
        match declaration:
            case ConstantDeclaration(value=value):
                self.value(value)
            case BigDeclaration(name, body=body, parameters=parameters, arguments=arguments):
                self.values(arguments)
                self.apart(BigDeclaration, name, parameters, lambda: self.expression(body))
            case ReactDeclaration():
                self.react(declaration)
            case ActionDeclaration(rules=rules, reward=reward):
                self.values(() if reward is None else (reward,))
                for rule in rules:
                    self.react(rule)
            case _:
                pass

    def react(self, react: ReactDeclaration) -> None:
        """Check a rule, with its parameters visible."""
        self.values(react.arguments)
        self.apart(ReactDeclaration, react.name, react.parameters, lambda: self.change(react))

    def change(self, react: ReactDeclaration) -> None:
        """Check the parts of a rule."""
        self.expression(react.redex)
        self.expression(react.reactum)
        self.values(() if react.weight is None else (react.weight,))
        for condition in react.conditions:
            self.expression(condition.pattern)

    def system(self, system: SystemTerm) -> None:
        """Check a system, with its parameters visible."""
        for parameter in system.parameters:
            self.values(parameter.values)
            self.variables |= frozenset(parameter.names)
        self.call(system.init, "bigraph")
        for each in system.classes:
            for rule in each.rules:
                self.call(rule, "rule")
        for action in system.actions:
            self.values(() if action.reward is None else (action.reward,))
        for predicate in system.predicates:
            self.call(predicate, "bigraph")

    def call(self, call: Call, what: str) -> None:
        """Check a call in a system."""
        self.values(call.arguments)
        self.values(() if call.reward is None else (call.reward,))
        self.used(what, call.name, len(call.arguments), call.span)

    def used(self, what: str, name: str, arguments: int, span: Span) -> None:
        """Check a name that is used as a bigraph or a rule, and the number of its arguments."""
        kind = BigDeclaration if what == "bigraph" else ReactDeclaration
        self._uses.setdefault(self._within, set()).add((kind, name))
        known = self.names.bigs if what == "bigraph" else self.names.reacts
        if name not in known:
            self.findings.unknown(what, name, Span(span.start, span.start + len(name)), known)
            return
        declaration = known[name]
        wanted = len(declaration.parameters) or len(declaration.arguments)
        self.counted(name, wanted, arguments, span)

    def counted(self, name: str, wanted: int, arguments: int, span: Span) -> None:
        """Check the number of arguments."""
        if arguments != wanted:
            found = f"'{name}' takes {_many(wanted, 'argument')}, this has {arguments}"
            self.findings.add("arguments", found, span)

    def expression(self, expression: Expression) -> None:
        """Check an expression and all its parts; the parser has limited its nesting."""
        match expression:
            case Ref(name, arguments):
                self.values(arguments)
                self.used("bigraph", name, len(arguments), expression.span)
            case Ion():
                self.ion(expression)
            case Nest(ion, inside):
                self.nest(ion, inside)
            case Wired(_, body):
                self.expression(body)
            case Chain(first, rest):
                for operand in (first, *(operand for _, operand in rest)):
                    self.expression(operand)
            case Share(what, by, where):
                for part in (what, by, where):
                    self.expression(part)
            case Repeat(_, times, body):
                self.value(times)
                self.expression(body)
            case _:
                pass

    def ion(self, ion: Ion) -> None:
        """Check an ion."""
        self.values(ion.arguments)
        if ion.control not in self.names.controls:
            at = Span(ion.span.start, ion.span.start + len(ion.control))
            self.findings.unknown("control", ion.control, at, self.names.controls)
            return
        control = self.names.controls[ion.control]
        self.counted(ion.control, len(control.parameters), len(ion.arguments), ion.span)
        if control.arity is not None and len(ion.links) != control.arity:
            found = f"'{ion.control}' has {_many(control.arity, 'port')}, this has {_many(len(ion.links), 'link')}"
            hint = f"its declaration gives {control.arity}; every port needs a link"
            self.findings.add("arity", found, ion.span, hint)

    def nest(self, ion: Ion, inside: Expression) -> None:
        """Check an ion with content."""
        self.expression(ion)
        self.expression(inside)
        control = self.names.controls.get(ion.control)
        if control is not None and control.status == "atomic":
            hint = "leave out the content behind the dot, or the 'atomic' in its declaration"
            self.findings.add("atomic", f"'{ion.control}' is atomic, so it has no content", ion.span, hint)

    def values(self, values: Iterable[ValueExpression]) -> None:
        """Check several values."""
        for value in values:
            self.value(value)

    def value(self, value: ValueExpression) -> None:
        """Check a value."""
        match value:
            case Variable(name):
                self.seen.add(name)
                if self._within is not None and name in self._ranging:
                    self._free[self._within].add(name)
                if name not in self.variables:
                    self.findings.unknown("value", name, value.span, self.variables)
            case Negated(operand) | Absolute(operand):
                self.value(operand)
            case Arithmetic(first, rest):
                self.values((first, *(operand for _, operand in rest)))
            case _:
                pass


def _many(count: int, thing: str) -> str:
    return f"{count or 'no'} {thing}{'' if count == 1 else 's'}"
