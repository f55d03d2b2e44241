"""Templates: the result of a parametrised declaration, evaluated once for all values of its parameters.

Parameters usually fill controls. If none counts repetitions or selects a declaration, all instances are one bigraph
with different controls. The template is evaluated with symbols as values; each instance computes the symbols' values
and relabels the nodes. Any other expression, or one with a mistake, is evaluated as written.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from bigraphs.bigraph import Bigraph, relabelled
from bigraphs.notation.big import values
from bigraphs.notation.big.declarations import ControlDeclaration
from bigraphs.notation.big.file_mistakes import Findings
from bigraphs.notation.big.scope import CallFrame, FileScope, control_of
from bigraphs.notation.big.syntax import Expression, ValueExpression, Variable
from bigraphs.signature import Control, Signature
from bigraphs.system import Value

Part: TypeAlias = tuple[Expression, Callable[[Bigraph], Bigraph]]
"""An expression, and the function applied to its bigraph."""


class Placeholder(str):
    """A placeholder for a value: a parameter, or a value computed from earlier ones.

    As a string it is `#` and its number; no string of the language has this form.
    """

    __slots__ = ()

    @property
    def number(self) -> int:
        """Return its index among the known values."""
        return int(self[1:])


@dataclass(frozen=True, slots=True)
class Template:
    """Bigraphs with symbols in their controls; `steps` compute the symbols that are not parameters.

    `controls` are the controls with symbols, `fixed` the others.
    """

    bigraphs: tuple[Bigraph, ...]
    steps: tuple[tuple[ValueExpression, CallFrame], ...]
    controls: Mapping[str, tuple[ControlDeclaration, tuple[Value, ...]]]
    fixed: tuple[Control, ...]
    scope: FileScope

    def instance(self, given: Sequence[Value]) -> tuple[list[Bigraph], list[Control]] | None:
        """Return the bigraphs for these arguments, with their controls; None after a mistake in an argument."""
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

    def _computed(
        self, expression: ValueExpression, frame: CallFrame, known: Sequence[Value]
    ) -> Value | None:
        def lookup(variable: Variable) -> Value | None:
            found = frame.values.get(variable.name)
            return self.scope.constant(variable.name) if found is None else _resolved(found, known)

        return values.evaluate(expression, lookup, Findings(""))


class SymbolicScope(FileScope):
    """A scope whose values may be symbols; an operation that needs a real value records a mistake."""

    def __init__(self, scope: FileScope, parameters: Sequence[str]) -> None:
        super().__init__(scope.names, Findings(scope.findings.text), {})
        self.constants = scope.constants
        self.frame = CallFrame(
            values={name: Placeholder(f"#{number}") for number, name in enumerate(parameters)}
        )
        self.steps: list[tuple[ValueExpression, CallFrame]] = []
        self.controls: dict[str, tuple[ControlDeclaration, tuple[Value, ...]]] = {}
        self.fixed: dict[str, Control] = {}

    def value(self, expression: ValueExpression, frame: CallFrame) -> Value | None:
        """Return the value of an expression; a symbol if it depends on symbols."""
        symbols = [
            name for name in values.variables(expression) if isinstance(frame.values.get(name), Placeholder)
        ]
        if not symbols:
            return super().value(expression, frame)
        if isinstance(expression, Variable):
            return frame.values[expression.name]
        self.steps.append((expression, frame))
        return Placeholder(f"#{len(self.frame.values) + len(self.steps) - 1}")

    def fits(self, *_: object) -> bool:
        """Return True: the instance that was evaluated as written has arguments of the same types."""
        return True

    def filled(self, declaration: ControlDeclaration, given: tuple[Value, ...]) -> Control:
        """Return a control, with symbols in its name if they are among the arguments."""
        mark = super().filled(declaration, given)
        if any(isinstance(value, Placeholder) for value in given):
            self.controls[mark.name] = declaration, given
        else:
            self.fixed[mark.name] = mark
        return mark

    def template(self, bigraphs: Iterable[Bigraph], scope: FileScope) -> Template:
        """Return the template of bigraphs that were evaluated here."""
        return Template(tuple(bigraphs), tuple(self.steps), self.controls, tuple(self.fixed.values()), scope)


def _resolved(value: Value, known: Sequence[Value]) -> Value:
    return known[value.number] if isinstance(value, Placeholder) else value
