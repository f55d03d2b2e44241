"""Templates: what a parametrised declaration makes, evaluated once for all values of its parameters.

Parameters fill controls. So as long as none counts repetitions or chooses a declaration, all instances are one
bigraph with other controls. It is evaluated with symbols for values; each instance computes what the symbols stand
for and relabels the nodes. Whatever is not of this form, or has a mistake, is evaluated as it is written.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from bigraphs.bigraph import Bigraph, relabelled
from bigraphs.notation.big import values
from bigraphs.notation.big.declarations import ControlDeclaration
from bigraphs.notation.big.findings import Findings
from bigraphs.notation.big.scope import Frame, Scope, control_of
from bigraphs.notation.big.syntax import Expression, ValueExpression, Variable
from bigraphs.signature import Control, Signature
from bigraphs.system import Value

Part: TypeAlias = tuple[Expression, Callable[[Bigraph], Bigraph]]
"""An expression, and what is done with its bigraph."""


class Symbol(str):
    """A value that only an instance has: a parameter, or what is computed from those numbered before it.

    As a string it is `#` and its number, which no string of the language is.
    """

    __slots__ = ()

    @property
    def number(self) -> int:
        """Return which of the known values it is."""
        return int(self[1:])


@dataclass(frozen=True, slots=True)
class Template:
    """Bigraphs with symbols in their controls; `steps` compute the symbols that are no parameters.

    `controls` are those with symbols, `fixed` the others.
    """

    bigraphs: tuple[Bigraph, ...]
    steps: tuple[tuple[ValueExpression, Frame], ...]
    controls: Mapping[str, tuple[ControlDeclaration, tuple[Value, ...]]]
    fixed: tuple[Control, ...]
    scope: Scope

    def instance(self, given: Sequence[Value]) -> tuple[list[Bigraph], list[Control]] | None:
        """Return the bigraphs for some arguments and their controls; None where an argument has a mistake."""
        known = list(given)
        for expression, frame in self.steps:
            found = self._computed(expression, frame, known)
            if found is None:
                return None
            known.append(found)
        made = {
            mark: control_of(declaration, tuple(_resolved(each, known) for each in arguments))
            for mark, (declaration, arguments) in self.controls.items()
        }
        distinct = list({control.name: control for control in (*self.fixed, *made.values())}.values())
        signature = Signature(tuple(distinct))
        names = {mark: control.name for mark, control in made.items()}
        return [relabelled(each, names, signature) for each in self.bigraphs], distinct

    def _computed(self, expression: ValueExpression, frame: Frame, known: Sequence[Value]) -> Value | None:
        def lookup(variable: Variable) -> Value | None:
            found = frame.values.get(variable.name)
            return self.scope.constant(variable.name) if found is None else _resolved(found, known)

        return values.evaluate(expression, lookup, Findings(""))


class SymbolicScope(Scope):
    """A scope whose values may be symbols. What needs a value notes a mistake: the expression makes no template."""

    def __init__(self, scope: Scope, parameters: Sequence[str]) -> None:
        super().__init__(scope.names, Findings(scope.findings.text), {})
        self.constants = scope.constants
        self.frame = Frame(values={name: Symbol(f"#{number}") for number, name in enumerate(parameters)})
        self.steps: list[tuple[ValueExpression, Frame]] = []
        self.controls: dict[str, tuple[ControlDeclaration, tuple[Value, ...]]] = {}
        self.fixed: dict[str, Control] = {}

    def value(self, expression: ValueExpression, frame: Frame) -> Value | None:
        """Return a symbol for what depends on symbols."""
        symbols = [
            name for name in values.variables(expression) if isinstance(frame.values.get(name), Symbol)
        ]
        if not symbols:
            return super().value(expression, frame)
        if isinstance(expression, Variable):
            return frame.values[expression.name]
        self.steps.append((expression, frame))
        return Symbol(f"#{len(self.frame.values) + len(self.steps) - 1}")

    def fits(self, *_: object) -> bool:
        """Say yes: in the instance that was evaluated as written, arguments of the same types fit."""
        return True

    def filled(self, declaration: ControlDeclaration, given: tuple[Value, ...]) -> Control:
        """Return a control, with symbols in its name where they are among the arguments."""
        mark = super().filled(declaration, given)
        if any(isinstance(value, Symbol) for value in given):
            self.controls[mark.name] = declaration, given
        else:
            self.fixed[mark.name] = mark
        return mark

    def template(self, bigraphs: Iterable[Bigraph], scope: Scope) -> Template:
        """Return the template of bigraphs that were evaluated here."""
        return Template(tuple(bigraphs), tuple(self.steps), self.controls, tuple(self.fixed.values()), scope)


def _resolved(value: Value, known: Sequence[Value]) -> Value:
    return known[value.number] if isinstance(value, Symbol) else value
