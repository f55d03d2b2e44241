"""The syntax tree of declarations and whole `.big` files."""

from __future__ import annotations

from typing import TypeAlias

from bigraphs.notation.big.syntax import NOWHERE, Arguments, Expression, ValueExpression
from bigraphs.notation.lalr import Span
from bigraphs.records import Record
from bigraphs.signature import Status


class ControlDeclaration(Record):
    """`ctrl K = 1;`, after `atomic` or `passive`, `ordered` and `fun`; `parameters` are those of `fun ctrl`.

    The arity is None (any number) only in a control from a signature; the notation has no syntax for it.
    """

    name: str
    arity: int | None
    status: Status = "active"
    ordered: bool = False
    parameters: tuple[str, ...] = ()
    span: Span = NOWHERE


class ConstantDeclaration(Record):
    """`int n = 3;`, `float f = 0.5;` or `string s = "a";`."""

    type: str
    name: str
    value: ValueExpression
    span: Span = NOWHERE


class BigDeclaration(Record):
    """`big b = expression;`, or `fun big b(n) = expression;`.

    `big b(1) = expression;` defines the bigraph for particular arguments; the writer uses it for systems with
    parameters.
    """

    name: str
    body: Expression
    parameters: tuple[str, ...] = ()
    arguments: Arguments = ()
    span: Span = NOWHERE


class ConditionTerm(Record):
    """`[!] pattern in ctx|param`."""

    positive: bool
    pattern: Expression
    where: str
    span: Span = NOWHERE


class ReactDeclaration(Record):
    """`react r = redex --> reactum @ [sites] if conditions;`, or `fun react r(n) = ...;`.

    `instantiation` is None if it is not written; `weight` is the expression in `-[w]->`.
    """

    name: str
    redex: Expression
    reactum: Expression
    instantiation: tuple[int, ...] | None = None
    weight: ValueExpression | None = None
    conditions: tuple[ConditionTerm, ...] = ()
    parameters: tuple[str, ...] = ()
    arguments: Arguments = ()
    span: Span = NOWHERE


class ActionDeclaration(Record):
    """`action a[reward] react ...; end`."""

    name: str
    rules: tuple[ReactDeclaration, ...]
    reward: ValueExpression | None = None
    span: Span = NOWHERE


class SortDeclaration(Record):
    """`sort S = {K, L};`: a name for a set of controls."""

    name: str
    controls: tuple[str, ...]
    span: Span = NOWHERE


class PlaceDeclaration(Record):
    """`place K = {L, S};`: the permitted content of a K; empty braces permit none."""

    control: str
    content: tuple[str, ...]
    span: Span = NOWHERE


class LinkDeclaration(Record):
    """`link radio = {K, L.0};`: ports that only links of this sort may join."""

    name: str
    ports: tuple[tuple[str, int | None], ...]
    span: Span = NOWHERE


class Call(Record):
    """A call of a rule, a predicate or an initial state: `r`, `r(n, 2)`; only a predicate has a `reward`."""

    name: str
    arguments: Arguments = ()
    reward: ValueExpression | None = None
    span: Span = NOWHERE


class ParameterDeclaration(Record):
    """`int n, m = {1, 2};`: the values of parameters of a system.

    `values` lists the set, holds the single value, or, if `ranged`, first value, step and last value.
    """

    type: str
    names: tuple[str, ...]
    values: tuple[ValueExpression, ...]
    ranged: bool = False
    span: Span = NOWHERE


class ClassTerm(Record):
    """A priority class, `{r, s(n)}`, or an instantaneous one, `(r)`."""

    rules: tuple[Call, ...]
    instantaneous: bool = False
    span: Span = NOWHERE


class ActionTerm(Record):
    """`a[reward] = {r, s}`: an action that lists its rules, within a system."""

    name: str
    rules: tuple[str, ...]
    reward: ValueExpression | None = None
    span: Span = NOWHERE


class SystemTerm(Record):
    """`begin brs ... end`."""

    kind: str
    init: Call
    classes: tuple[ClassTerm, ...] = ()
    predicates: tuple[Call, ...] = ()
    parameters: tuple[ParameterDeclaration, ...] = ()
    actions: tuple[ActionTerm, ...] = ()
    span: Span = NOWHERE


Declaration: TypeAlias = (
    ControlDeclaration
    | ConstantDeclaration
    | BigDeclaration
    | ReactDeclaration
    | ActionDeclaration
    | SortDeclaration
    | PlaceDeclaration
    | LinkDeclaration
)


class Model(Record):
    """A `.big` file as written."""

    declarations: tuple[Declaration, ...]
    system: SystemTerm | None = None
