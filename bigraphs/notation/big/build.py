"""Build declarations and files from lark's trees, without recursion."""

from __future__ import annotations

from typing import Any, Final, TypeAlias

from lark import Token, v_args
from lark.tree import Meta

from bigraphs.notation.big import declarations as declared
from bigraphs.notation.big import syntax
from bigraphs.notation.big.build_expressions import Expressions
from bigraphs.notation.big.build_values import span_of, token_span
from bigraphs.notation.big.syntax import Expression, ValueExpression
from bigraphs.signature import Status

_KINDS: Final = {"abrs": "nbrs"}
"""What BigraphER called kinds of systems before its version 1.9.3, and files still do."""
_Change: TypeAlias = tuple[Any, Any, Any, Any, Any]


@v_args(inline=True, meta=True)
class Build(Expressions):
    """Declarations and files."""

    def modifier(self, _meta: Meta, word: Token) -> Token:
        return word

    def control(self, meta: Meta, *parts: Any) -> declared.ControlDeclaration:
        return self.declared_control(meta, parts[:-2], parts[-2], (), parts[-1])

    def fun_control(self, meta: Meta, *parts: Any) -> declared.ControlDeclaration:
        return self.declared_control(meta, parts[:-3], parts[-3], parts[-2], parts[-1])

    def declared_control(
        self, meta: Meta, modifiers: tuple[Token, ...], name: Token, parameters: tuple[str, ...], arity: Token
    ) -> declared.ControlDeclaration:
        words = list(map(str, modifiers))
        if len(set(words)) < len(words) or {"atomic", "passive"} <= set(words):
            hint = "a control is atomic, passive or, without a word, active"
            self.wrong("syntax", f"'{' '.join(words)}' does not go together", span_of(meta), hint)
        status: Status = "atomic" if "atomic" in words else "passive" if "passive" in words else "active"
        at = token_span(name)
        return declared.ControlDeclaration(
            str(name), self.width(arity, 0), status, "ordered" in words, parameters, at
        )

    def constant(self, meta: Meta, type_: Token, name: Token, value: ValueExpression) -> Any:
        return declared.ConstantDeclaration(str(type_), self.named(name), value, span_of(meta))

    def big(self, _meta: Meta, name: Token, arguments: syntax.Arguments | None, body: Expression) -> Any:
        return declared.BigDeclaration(self.named(name), body, (), arguments or (), token_span(name))

    def fun_big(self, _meta: Meta, name: Token, parameters: tuple[str, ...], body: Expression) -> Any:
        return declared.BigDeclaration(self.named(name), body, parameters, (), token_span(name))

    def react(self, _meta: Meta, name: Token, arguments: syntax.Arguments | None, change: _Change) -> Any:
        return declared.ReactDeclaration(self.named(name), *change, (), arguments or (), token_span(name))

    def fun_react(self, _meta: Meta, name: Token, parameters: tuple[str, ...], change: _Change) -> Any:
        return declared.ReactDeclaration(self.named(name), *change, parameters, (), token_span(name))

    def change(
        self, _meta: Meta, redex: Any, weight: Any, reactum: Any, sites: Any, conditions: Any
    ) -> _Change:
        return redex, reactum, sites, weight, conditions or ()

    def plain(self, _meta: Meta, _arrow: Token) -> None:
        return None

    def weighted(self, _meta: Meta, _left: Token, weight: ValueExpression, _right: Token) -> ValueExpression:
        return weight

    def conditions(self, _meta: Meta, *conditions: Any) -> tuple[declared.ConditionTerm, ...]:
        return tuple(condition for condition in conditions if condition is not None)

    def condition(self, meta: Meta, bang: Token | None, pattern: Expression, where: Token) -> Any:
        return declared.ConditionTerm(bang is None, pattern, str(where), span_of(meta))

    def action(self, _meta: Meta, name: Token, reward: ValueExpression | None, *rules: Any) -> Any:
        return declared.ActionDeclaration(str(name), rules, reward, token_span(name))

    def controls(self, _meta: Meta, *names: Token | None) -> tuple[str, ...]:
        return tuple(str(name) for name in names if name is not None)

    def sort(self, meta: Meta, name: Token, controls: tuple[str, ...]) -> declared.SortDeclaration:
        return declared.SortDeclaration(str(name), controls, span_of(meta))

    def place(self, meta: Meta, control: Token, content: tuple[str, ...]) -> declared.PlaceDeclaration:
        return declared.PlaceDeclaration(str(control), content, span_of(meta))

    def link(self, meta: Meta, name: Token, *ports: Any) -> declared.LinkDeclaration:
        return declared.LinkDeclaration(str(name), ports, span_of(meta))

    def port(self, _meta: Meta, control: Token, port: Token | None) -> tuple[str, int | None]:
        return str(control), None if port is None else self.whole(port)

    def call(self, meta: Meta, name: Token, arguments: syntax.Arguments | None) -> declared.Call:
        return declared.Call(str(name), arguments or (), None, span_of(meta))

    def predicate(self, meta: Meta, name: Token, arguments: Any, reward: Any) -> declared.Call:
        return declared.Call(str(name), arguments or (), reward, span_of(meta))

    def listed_action(self, _meta: Meta, name: Token, reward: Any, rules: tuple[str, ...]) -> Any:
        return declared.ActionTerm(str(name), rules, reward, token_span(name))

    def actions(self, _meta: Meta, *actions: declared.ActionTerm) -> tuple[declared.ActionTerm, ...]:
        return actions

    def predicates(self, _meta: Meta, *predicates: declared.Call) -> tuple[declared.Call, ...]:
        return predicates

    def calls(self, _meta: Meta, *calls: declared.Call) -> tuple[declared.Call, ...]:
        return calls

    def ordinary(self, meta: Meta, calls: tuple[declared.Call, ...]) -> declared.ClassTerm:
        return declared.ClassTerm(calls, False, span_of(meta))

    def instantaneous(self, meta: Meta, calls: tuple[declared.Call, ...]) -> declared.ClassTerm:
        return declared.ClassTerm(calls, True, span_of(meta))

    def classes(self, _meta: Meta, *classes: declared.ClassTerm | None) -> tuple[declared.ClassTerm, ...]:
        return tuple(each for each in classes if each is not None)

    def init(self, _meta: Meta, call: declared.Call) -> declared.Call:
        return call

    def single(self, meta: Meta, type_: Token, names: tuple[str, ...], value: ValueExpression) -> Any:
        return declared.ParameterDeclaration(str(type_), names, (value,), False, span_of(meta))

    def several(self, meta: Meta, type_: Token, names: tuple[str, ...], values: syntax.Arguments) -> Any:
        return declared.ParameterDeclaration(str(type_), names, values, False, span_of(meta))

    def range(self, meta: Meta, type_: Token, names: tuple[str, ...], *values: ValueExpression) -> Any:
        return declared.ParameterDeclaration(str(type_), names, values, True, span_of(meta))

    def system(self, meta: Meta, kind: Token, *parts: Any) -> declared.SystemTerm:
        *parameters, init, classes, actions, predicates = parts
        return declared.SystemTerm(
            _KINDS.get(kind, str(kind)),
            init,
            classes,
            predicates or (),
            tuple(parameters),
            actions or (),
            span_of(meta),
        )

    def model(self, _meta: Meta, *parts: Any) -> declared.Model:
        return declared.Model(parts[:-1], parts[-1])
