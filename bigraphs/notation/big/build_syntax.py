"""The builder of declarations and files."""

from __future__ import annotations

from typing import Any, Final, TypeAlias

from bigraphs.notation.big import declarations as declared
from bigraphs.notation.big import syntax
from bigraphs.notation.big.build_expressions import Expressions
from bigraphs.notation.big.syntax import Expression, ValueExpression
from bigraphs.notation.lalr import Span, Token
from bigraphs.signature import Status

_KINDS: Final = {"abrs": "nbrs"}
"""Old names of system kinds, from BigraphER before 1.9.3; some files still use them."""
_Change: TypeAlias = tuple[Any, Any, Any, Any, Any]


class Build(Expressions):
    """Builds declarations and files."""

    def modifier(self, _at: Span, word: Token) -> Token:
        return word

    def control(self, at: Span, *parts: Any) -> declared.ControlDeclaration:
        return self.declared_control(at, parts[:-2], parts[-2], (), parts[-1])

    def fun_control(self, at: Span, *parts: Any) -> declared.ControlDeclaration:
        return self.declared_control(at, parts[:-3], parts[-3], parts[-2], parts[-1])

    def declared_control(
        self, at: Span, modifiers: tuple[Token, ...], name: Token, parameters: tuple[str, ...], arity: Token
    ) -> declared.ControlDeclaration:
        words = list(map(str, modifiers))
        if len(set(words)) < len(words) or {"atomic", "passive"} <= set(words):
            hint = "a control is atomic, passive or, without a word, active"
            self.wrong("syntax", f"'{' '.join(words)}' does not go together", at, hint)
        status: Status = "atomic" if "atomic" in words else "passive" if "passive" in words else "active"
        return declared.ControlDeclaration(
            str(name), self.width(arity, 0), status, "ordered" in words, parameters, name.span
        )

    def constant(self, at: Span, type_: Token, name: Token, value: ValueExpression) -> Any:
        return declared.ConstantDeclaration(str(type_), self.named(name), value, at)

    def big(self, _at: Span, name: Token, arguments: syntax.Arguments | None, body: Expression) -> Any:
        return declared.BigDeclaration(self.named(name), body, (), arguments or (), name.span)

    def fun_big(self, _at: Span, name: Token, parameters: tuple[str, ...], body: Expression) -> Any:
        return declared.BigDeclaration(self.named(name), body, parameters, (), name.span)

    def react(self, _at: Span, name: Token, arguments: syntax.Arguments | None, change: _Change) -> Any:
        return declared.ReactDeclaration(self.named(name), *change, (), arguments or (), name.span)

    def fun_react(self, _at: Span, name: Token, parameters: tuple[str, ...], change: _Change) -> Any:
        return declared.ReactDeclaration(self.named(name), *change, parameters, (), name.span)

    def change(
        self, _at: Span, redex: Any, weight: Any, reactum: Any, sites: Any, conditions: Any
    ) -> _Change:
        return redex, reactum, sites, weight, conditions or ()

    def plain(self, _at: Span, _arrow: Token) -> None:
        return None

    def weighted(self, _at: Span, _left: Token, weight: ValueExpression, _right: Token) -> ValueExpression:
        return weight

    def conditions(self, _at: Span, *conditions: Any) -> tuple[declared.ConditionTerm, ...]:
        return tuple(condition for condition in conditions if condition is not None)

    def condition(self, at: Span, bang: Token | None, pattern: Expression, where: Token) -> Any:
        return declared.ConditionTerm(bang is None, pattern, str(where), at)

    def action(self, _at: Span, name: Token, reward: ValueExpression | None, *rules: Any) -> Any:
        return declared.ActionDeclaration(str(name), rules, reward, name.span)

    def controls(self, _at: Span, *names: Token | None) -> tuple[str, ...]:
        return tuple(str(name) for name in names if name is not None)

    def sort(self, at: Span, name: Token, controls: tuple[str, ...]) -> declared.SortDeclaration:
        return declared.SortDeclaration(str(name), controls, at)

    def place(self, at: Span, control: Token, content: tuple[str, ...]) -> declared.PlaceDeclaration:
        return declared.PlaceDeclaration(str(control), content, at)

    def link(self, at: Span, name: Token, *ports: Any) -> declared.LinkDeclaration:
        return declared.LinkDeclaration(str(name), ports, at)

    def port(self, _at: Span, control: Token, port: Token | None) -> tuple[str, int | None]:
        return str(control), None if port is None else self.whole(port)

    def call(self, at: Span, name: Token, arguments: syntax.Arguments | None) -> declared.Call:
        return declared.Call(str(name), arguments or (), None, at)

    def predicate(self, at: Span, name: Token, arguments: Any, reward: Any) -> declared.Call:
        return declared.Call(str(name), arguments or (), reward, at)

    def listed_action(self, _at: Span, name: Token, reward: Any, rules: tuple[str, ...]) -> Any:
        return declared.ActionTerm(str(name), rules, reward, name.span)

    def actions(self, _at: Span, *actions: declared.ActionTerm) -> tuple[declared.ActionTerm, ...]:
        return actions

    def predicates(self, _at: Span, *predicates: declared.Call) -> tuple[declared.Call, ...]:
        return predicates

    def calls(self, _at: Span, *calls: declared.Call) -> tuple[declared.Call, ...]:
        return calls

    def ordinary(self, at: Span, calls: tuple[declared.Call, ...]) -> declared.ClassTerm:
        return declared.ClassTerm(calls, False, at)

    def instantaneous(self, at: Span, calls: tuple[declared.Call, ...]) -> declared.ClassTerm:
        return declared.ClassTerm(calls, True, at)

    def classes(self, _at: Span, *classes: declared.ClassTerm | None) -> tuple[declared.ClassTerm, ...]:
        return tuple(each for each in classes if each is not None)

    def init(self, _at: Span, call: declared.Call) -> declared.Call:
        return call

    def single(self, at: Span, type_: Token, names: tuple[str, ...], value: ValueExpression) -> Any:
        return declared.ParameterDeclaration(str(type_), names, (value,), False, at)

    def several(self, at: Span, type_: Token, names: tuple[str, ...], values: syntax.Arguments) -> Any:
        return declared.ParameterDeclaration(str(type_), names, values, False, at)

    def range(self, at: Span, type_: Token, names: tuple[str, ...], *values: ValueExpression) -> Any:
        return declared.ParameterDeclaration(str(type_), names, values, True, at)

    def system(self, at: Span, kind: Token, *parts: Any) -> declared.SystemTerm:
        *parameters, init, classes, actions, predicates = parts
        return declared.SystemTerm(
            _KINDS.get(kind, str(kind)),
            init,
            classes,
            predicates or (),
            tuple(parameters),
            actions or (),
            at,
        )

    def model(self, _at: Span, *parts: Any) -> declared.Model:
        return declared.Model(parts[:-1], parts[-1])
