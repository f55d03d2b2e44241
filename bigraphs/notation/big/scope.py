"""The scope during elaboration: the meanings of names, and the current position of evaluation."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Final, TypeVar

from bigraphs.notation.big import values
from bigraphs.notation.big.declarations import BigDeclaration, ControlDeclaration, ReactDeclaration
from bigraphs.notation.big.file_mistakes import Findings
from bigraphs.notation.big.names import Names
from bigraphs.notation.big.syntax import Ion, ValueExpression, Variable
from bigraphs.notation.lalr import Span
from bigraphs.signature import Control
from bigraphs.system import Value, call

NESTED: Final = 100
"""The nesting limit of constants and of bigraph calls."""


_Given = TypeVar("_Given", BigDeclaration, ReactDeclaration)


@dataclass(frozen=True, slots=True)
class CallFrame:
    """The declaration under evaluation: `label` is its call, if it has parameters; `values` are their values."""

    label: str = ""
    values: Mapping[str, Value] = field(default_factory=dict)
    depth: int = 0

    def inside(
        self, name: str, parameters: Sequence[str], arguments: Sequence[Value], free: Iterable[str] = ()
    ) -> CallFrame:
        """Return the frame of a call from this one; free names keep their values."""
        given = {each: self.values[each] for each in free if each in self.values}
        given.update(zip(parameters, arguments, strict=True))
        return CallFrame(call(name, tuple(arguments)) if parameters else "", given, self.depth + 1)

    def key(self, name: str, given: tuple[Value, ...]) -> str:
        """Return the key of a call: its arguments and the values of its free names."""
        return " ".join((call(name, given), *(f"{each}={value!r}" for each, value in self.values.items())))


class FileScope:
    """The constants and controls of one file, each evaluated once, and the types of parameters."""

    def __init__(self, names: Names, findings: Findings, given: Mapping[str, Value]) -> None:
        self.names = names
        self.findings = findings
        self.constants: dict[str, Value | None] = dict(given)
        self._types: dict[tuple[str, str], tuple[str, int]] = {}
        self._under_way: set[str] = set()
        self._instances: dict[tuple[type, str], dict[str, Any]] = {}
        self._depth = 0

    def add(self, code: str, message: str, span: Span, frame: CallFrame, hint: str = "") -> None:
        """Add a mistake, with the call in which it occurred."""
        where = f", in {frame.label}" if frame.label else ""
        self.findings.add(code, message + where, span, hint)

    def value(self, expression: ValueExpression, frame: CallFrame) -> Value | None:
        """Return the value of an expression, or None after a recorded mistake."""
        return values.evaluate(expression, lambda name: self._variable(name, frame), self.findings)

    def arguments(self, expressions: Sequence[ValueExpression], frame: CallFrame) -> tuple[Value, ...] | None:
        """Return the values of arguments."""
        found = [self.value(expression, frame) for expression in expressions]
        known = tuple(value for value in found if value is not None)
        return known if len(known) == len(found) else None

    def _variable(self, variable: Variable, frame: CallFrame) -> Value | None:
        if variable.name in frame.values:
            return frame.values[variable.name]
        return self.constant(variable.name)

    def constant(self, name: str) -> Value | None:
        """Return the value of a constant; constants may use each other in any order."""
        if name not in self.constants and name in self.names.constants:
            declaration = self.names.constants[name]
            self.constants[name] = None  # during its own evaluation
            if self._depth >= NESTED:
                message = f"constants use each other more than {NESTED} deep"
                self.findings.add("too-deep", message, declaration.span)
                return None
            self._depth += 1
            self._under_way.add(name)
            found = values.evaluate(declaration.value, self._inner(declaration.name), self.findings)
            self._under_way.discard(name)
            self._depth -= 1
            if found is not None:
                self.constants[name] = values.typed(
                    declaration.type, found, declaration.value.span, self.findings
                )
        return self.constants.get(name)

    def _inner(self, of: str) -> values.Lookup:
        def lookup(variable: Variable) -> Value | None:
            if variable.name in self._under_way:
                message = f"'{of}' needs '{variable.name}', which is not known before it"
                self.findings.add("cycle", message, variable.span)
            return self.constant(variable.name)

        return lookup

    def entered(
        self,
        declaration: BigDeclaration | ReactDeclaration,
        given: tuple[Value, ...],
        span: Span,
        frame: CallFrame,
    ) -> CallFrame | None:
        """Return the frame of a call; None after a recorded mistake if it leaves a system parameter undefined."""
        free = self.names.free.get((type(declaration), declaration.name), ())
        parameters = declaration.parameters
        inner = frame.inside(declaration.name, parameters, given if parameters else (), free)
        lacking = [each for each in free if each not in inner.values and each not in self.constants]
        if not lacking:
            return inner
        found = (
            f"'{declaration.name}' uses the system's parameter '{lacking[0]}', which this call does not give"
        )
        hint = f"call it from the system with '{lacking[0]}' among its arguments"
        self.add("name", found, span, frame, hint)
        return None

    def control(self, ion: Ion, frame: CallFrame) -> Control | None:
        """Return the control of an ion, with the values of its parameters."""
        declaration = self.names.controls.get(ion.control)
        given = self.arguments(ion.arguments, frame)
        if declaration is None or given is None or len(given) != len(declaration.parameters):
            return None
        if not self.fits(ion.control, declaration.parameters, given, ion.span, frame):
            return None
        if declaration.arity not in (None, len(ion.links)):
            return None
        return self.filled(declaration, given)

    def filled(self, declaration: ControlDeclaration, given: tuple[Value, ...]) -> Control:
        """Return a declared control for arguments that fit it."""
        return control_of(declaration, given)

    def instance(self, choices: Sequence[_Given], given: tuple[Value, ...], span: Span) -> _Given | None:
        """Return the declaration for exactly these arguments, such as `big b(1) = ...`; record a missing one."""
        name = choices[0].name
        if (type(choices[0]), name) not in self._instances:
            self._instances[type(choices[0]), name] = self._by_call(choices)
        found = self._instances[type(choices[0]), name].get(call(name, given))
        if found is None:
            self.findings.add("name", f"'{name}' is not given for these arguments", span)
        return found

    def _by_call(self, choices: Sequence[_Given]) -> dict[str, Any]:
        table: dict[str, Any] = {}
        for each in choices:
            values_ = self.arguments(each.arguments, CallFrame())
            written = "" if values_ is None else call(each.name, values_)
            if written in table:
                self.findings.add("name", f"'{written}' is declared twice", each.span)
            table[written] = each
        return table

    def fits(
        self, name: str, parameters: Sequence[str], given: Sequence[Value], span: Span, frame: CallFrame
    ) -> bool:
        """Check that each parameter has the same type in all calls."""
        fitting = True
        for parameter, value in zip(parameters, given, strict=True):
            type_ = values.type_name(value)
            if (name, parameter) not in self._types:
                line = self.findings.text.count("\n", 0, span.start) + 1
                self._types[name, parameter] = type_, line
            known, first = self._types[name, parameter]
            if known != type_:
                written = f'"{value}"' if isinstance(value, str) else value
                message = f"'{parameter}' of '{name}' is of type {known}, this is the {type_} {written}"
                self.add("type", message, span, frame, f"line {first} gives it its type")
                fitting = False
        return fitting


def control_of(declaration: ControlDeclaration, given: tuple[Value, ...]) -> Control:
    """Return a declared control for these arguments."""
    name = call(declaration.name, given)
    return Control(name, declaration.arity, declaration.status, declaration.ordered)
