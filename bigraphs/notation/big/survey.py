"""Check every name in a file before evaluation: is it declared, and used as what it is?"""

from __future__ import annotations

from collections.abc import Iterable

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
from bigraphs.notation.big.findings import Findings
from bigraphs.notation.big.names import Names
from bigraphs.notation.big.syntax import (
    Arithmetic,
    Chain,
    Expression,
    Ion,
    Negated,
    Nest,
    Ref,
    Repeat,
    Share,
    Span,
    ValueExpression,
    Variable,
    Wired,
)


def survey(model: Model, names: Names, findings: Findings, given: Iterable[str] = ()) -> None:
    """Note every name that is not declared, and every wrong number of links or arguments; `given` are constants."""
    constants = frozenset(given) | names.constants.keys()
    look = Survey(names, findings, constants)
    for declaration in model.declarations:
        look.declaration(declaration)
    if model.system is not None:
        look.system(model.system)
    for name in sorted(set(given) - names.constants.keys() - look.seen):
        findings.add("name", f"no constant '{name}' is in the file", Span(0, 1), "leave it out")


class Survey:
    """A walk over syntax that knows which values can be named where it is."""

    def __init__(self, names: Names, findings: Findings, constants: frozenset[str]) -> None:
        self.names = names
        self.findings = findings
        self.variables = self.constants = constants
        self.seen: set[str] = set()

    def declaration(self, declaration: Declaration) -> None:
        """Look at one declaration, in which its parameters are known."""
        match declaration:
            case ConstantDeclaration(value=value):
                self.value(value)
            case BigDeclaration(body=body, parameters=parameters, arguments=arguments):
                self.values(arguments)
                self.variables = self.constants | frozenset(parameters)
                self.expression(body)
            case ReactDeclaration():
                self.react(declaration)
            case ActionDeclaration(rules=rules, reward=reward):
                self.values(() if reward is None else (reward,))
                for rule in rules:
                    self.react(rule)
            case _:
                pass
        self.variables = self.constants

    def react(self, react: ReactDeclaration) -> None:
        """Look at a rule, in which its parameters are known."""
        self.values(react.arguments)
        self.variables = self.constants | frozenset(react.parameters)
        self.expression(react.redex)
        self.expression(react.reactum)
        self.values(() if react.weight is None else (react.weight,))
        for condition in react.conditions:
            self.expression(condition.pattern)
        self.variables = self.constants

    def system(self, system: SystemTerm) -> None:
        """Look at a system, in which its parameters are known."""
        for parameter in system.parameters:
            self.values(parameter.values)
            self.variables |= frozenset(parameter.names)
        self.call(system.init, "bigraph")
        for each in system.classes:
            for rule in each.rules:
                self.call(rule, "rule")
        for predicate in system.predicates:
            self.call(predicate, "bigraph")

    def call(self, call: Call, what: str) -> None:
        """Look at what a system names."""
        self.values(call.arguments)
        self.values(() if call.reward is None else (call.reward,))
        self.used(what, call.name, len(call.arguments), call.span)

    def used(self, what: str, name: str, arguments: int, span: Span) -> None:
        """Check a name that is used as a bigraph or a rule, and how many arguments it gets."""
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
        """Look at an expression and all that is in it; it nests no deeper than a text may."""
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
        """Look at an ion."""
        self.values(ion.arguments)
        if ion.control not in self.names.controls:
            at = Span(ion.span.start, ion.span.start + len(ion.control))
            self.findings.unknown("control", ion.control, at, self.names.controls)
            return
        control = self.names.controls[ion.control]
        self.counted(ion.control, len(control.parameters), len(ion.arguments), ion.span)
        if control.arity is not None and len(ion.links) != control.arity:
            found = f"'{ion.control}' has {_many(control.arity, 'port')}, this has {_many(len(ion.links), 'link')}"
            hint = f"its declaration says {control.arity}; every port needs a link"
            self.findings.add("arity", found, ion.span, hint)

    def nest(self, ion: Ion, inside: Expression) -> None:
        """Look at an ion with something in it."""
        self.expression(ion)
        self.expression(inside)
        control = self.names.controls.get(ion.control)
        if control is not None and control.status == "atomic":
            hint = "leave out what follows the dot, or the 'atomic' in its declaration"
            self.findings.add(
                "atomic", f"'{ion.control}' is atomic, so there is nothing in it", ion.span, hint
            )

    def values(self, values: Iterable[ValueExpression]) -> None:
        """Look at several values."""
        for value in values:
            self.value(value)

    def value(self, value: ValueExpression) -> None:
        """Look at a value."""
        match value:
            case Variable(name):
                self.seen.add(name)
                if name not in self.variables:
                    self.findings.unknown("value", name, value.span, self.variables)
            case Negated(operand):
                self.value(operand)
            case Arithmetic(first, rest):
                self.values((first, *(operand for _, operand in rest)))
            case _:
                pass


def _many(count: int, thing: str) -> str:
    return f"{count or 'no'} {thing}{'' if count == 1 else 's'}"
