"""From BigraphER's notation to bigraphs, rules and systems."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Final

from bigraphs import algebra
from bigraphs.bigraph import Bigraph
from bigraphs.errors import BigraphError, NotationError
from bigraphs.interface import Interface
from bigraphs.notation.big_parser import parse_expression, parse_model
from bigraphs.notation.big_syntax import (
    BigDeclaration,
    Chain,
    Close,
    ControlDeclaration,
    Expression,
    Identity,
    Ion,
    Model,
    Nest,
    NewNames,
    Number,
    Placed,
    ReactDeclaration,
    Ref,
    Share,
    Substitute,
    System,
    Wired,
)
from bigraphs.rules import ReactionRule, rule
from bigraphs.signature import Control, Signature, Status

MAX_SIZE: Final = 20_000


@dataclass(frozen=True, slots=True)
class Theory:
    """What a `.big` file declares: its signature, bigraphs and rules by name in the order written, and its system."""

    signature: Signature
    bigraphs: tuple[tuple[str, Bigraph], ...]
    rules: tuple[ReactionRule, ...]
    system: System | None


def read_theory(text: str) -> Theory:
    """Read a `.big` file; raises NotationError for what does not parse, or does not make sense."""
    model = parse_model(text)
    signature = _signature(model, text)
    reader = _Elaboration(signature, text, {})
    for declaration in model.declarations:
        if isinstance(declaration, BigDeclaration):
            reader.refuse_again(declaration.name, declaration.offset)
            reader.known[declaration.name] = reader.whole(declaration.body)
    reacts = [declaration for declaration in model.declarations if isinstance(declaration, ReactDeclaration)]
    rules = tuple(reader.rule(declaration) for declaration in reacts)
    theory = Theory(signature, tuple(reader.known.items()), rules, model.system)
    _check_system(theory, text)
    return theory


def read_big(text: str, signature: Signature, known: Mapping[str, Bigraph] | None = None) -> Bigraph:
    """Read one expression over a signature; `known` gives the bigraphs that it may name."""
    return _Elaboration(signature, text, dict(known or {})).whole(parse_expression(text))


def _signature(model: Model, text: str) -> Signature:
    controls: dict[str, Control] = {}
    for declaration in model.declarations:
        if isinstance(declaration, ControlDeclaration):
            name = declaration.name
            if name in controls:
                raise _error("control", f"control '{name}' is declared twice", text, declaration.offset, name)
            status: Status = "atomic" if declaration.atomic else "active"
            controls[name] = Control(name, declaration.arity, status, ordered=False)
    return Signature(tuple(controls.values()))


def _check_system(theory: Theory, text: str) -> None:
    if theory.system is None:
        return
    bigraphs, rules = dict(theory.bigraphs), {rule.name for rule in theory.rules}
    _check_named(theory.system.init, theory.system.offset, bigraphs, "bigraph", text)
    for each in theory.system.rules:
        for name in each.rules:
            _check_named(name, each.offset, rules, "rule", text)
    for name in theory.system.predicates:
        _check_named(name, theory.system.offset, bigraphs, "bigraph", text)


def _check_named(
    name: str, offset: int, known: Mapping[str, object] | set[str], what: str, text: str
) -> None:
    if name not in known:
        raise _error(
            "name", f"unknown {what} '{name}'", text, offset, name, hint="declare it above the system"
        )


def _error(
    code: str, message: str, text: str, offset: int, word: str = "", *, hint: str = ""
) -> NotationError:
    return NotationError(code, message, text, offset, length=len(word), hint=hint)


@dataclass(frozen=True, slots=True)
class _Elaboration:
    """Evaluation of expressions; what the algebra refuses is reported where it is written."""

    signature: Signature
    text: str
    known: dict[str, Bigraph]

    def refuse_again(self, name: str, offset: int) -> None:
        if name in self.known:
            raise _error("name", f"bigraph '{name}' is declared twice", self.text, offset, name)

    def rule(self, declaration: ReactDeclaration) -> ReactionRule:
        redex, reactum = self.whole(declaration.redex), self.whole(declaration.reactum)
        try:
            return rule(redex, reactum, declaration.instantiation, name=declaration.name)
        except BigraphError as error:
            raise self.at(error, declaration.offset) from None

    def whole(self, expression: Expression) -> Bigraph:
        """Return the bigraph of an expression, over all controls and not only those that it uses."""
        return replace(self.value(expression), signature=self.signature)

    def value(self, expression: Expression) -> Bigraph:
        """Return the bigraph of an expression."""
        try:
            return self.evaluate(expression)
        except NotationError:
            raise
        except BigraphError as error:
            raise self.at(error, expression.offset) from None

    def at(self, error: BigraphError, offset: int) -> NotationError:
        return NotationError(error.code, error.message, self.text, offset, hint=error.hint)

    def evaluate(self, expression: Expression) -> Bigraph:
        match expression:
            case Ref():
                return self.referred(expression)
            case Ion(control, links):
                kind = self.signature[control]
                make = algebra.atom if kind.status == "atomic" else algebra.ion
                return make(self.signature, control, links)
            case Nest(ion, inside):
                return algebra.nest(self.value(ion), self.value(inside))
            case Wired(wires, body):
                found = self.value(body)
                for wire in reversed(wires):
                    found = _wire(wire, found)
                return found
            case Chain():
                return self.chain(expression)
            case Share(what, by, where):
                return _share(self.value(what), self.value(by), self.value(where))
            case _:
                return _element(expression)

    def referred(self, ref: Ref) -> Bigraph:
        if ref.name not in self.known:
            hint = "declare it above, with 'big'"
            raise _error("name", f"unknown bigraph '{ref.name}'", self.text, ref.offset, ref.name, hint=hint)
        return self.known[ref.name]

    def chain(self, chain: Chain) -> Bigraph:
        """Evaluate from the left; a run of one operator is halved, as all of them are associative."""
        operands = [self.value(chain.first), *(self.value(operand) for _, operand in chain.rest)]
        if sum(map(_size, operands)) > MAX_SIZE:
            raise _error("too-large", f"a bigraph of more than {MAX_SIZE} parts", self.text, chain.offset)
        operators = [operator for operator, _ in chain.rest]
        found, start = operands[0], 0
        while start < len(operators):
            end = next(
                (n for n in range(start, len(operators)) if operators[n] != operators[start]), len(operators)
            )
            found = _halved(_OPERATORS[operators[start]], [found, *operands[start + 1 : end + 1]])
            start = end
        return found


_OPERATORS: Final[Mapping[str, Callable[[Bigraph, Bigraph], Bigraph]]] = {
    "|": algebra.merge_product,
    "||": algebra.parallel,
    "+": algebra.tensor,
    "*": algebra.compose,
}


def _halved(operator: Callable[[Bigraph, Bigraph], Bigraph], operands: list[Bigraph]) -> Bigraph:
    while len(operands) > 1:
        pairs = zip(operands[::2], operands[1::2], strict=False)
        operands = [*(operator(left, right) for left, right in pairs), *operands[len(operands) // 2 * 2 :]]
    return operands[0]


def _size(bigraph: Bigraph) -> int:
    return (
        len(bigraph.nodes) + bigraph.regions + len(bigraph.sites) + len(bigraph.outer_names) + bigraph.edges
    )


def _element(expression: Number | Identity | Placed | Close | Substitute | NewNames | Expression) -> Bigraph:
    match expression:
        case Number(0):
            return algebra.identity(Interface())
        case Number(1):
            return algebra.merge(0)
        case Identity(width, names):
            return algebra.identity(Interface(width, names))
        case Placed(parents, regions):
            return algebra.placing(parents, regions)
        case Close(names):
            return _closing(names)
        case Substitute(outer, inner):
            return algebra.substitution(outer, inner)
        case NewNames(names):
            return _halved(algebra.parallel, [algebra.substitution(name, ()) for name in names])
        case _:
            raise BigraphError(
                "syntax", "a number is no bigraph", "write 0 for nothing, 1 for an empty region"
            )


def _closing(names: tuple[str, ...]) -> Bigraph:
    return algebra.compose(algebra.closure(names[0]), algebra.substitution(names[0], names))


def _wire(wire: Close | Substitute, body: Bigraph) -> Bigraph:
    names = wire.names if isinstance(wire, Close) else wire.inner
    missing = sorted(set(names) - set(body.outer_names))
    if missing:
        raise BigraphError("name", f"there is no outer name '{missing[0]}' here")
    if isinstance(wire, Substitute):
        return algebra.rename(body, dict.fromkeys(wire.inner, wire.outer))
    joined = algebra.rename(body, dict.fromkeys(names, names[0]))
    return algebra.close(joined, names[0])


def _share(what: Bigraph, by: Bigraph, where: Bigraph) -> Bigraph:
    """Put each region of what into the sites of where that the placing says; names that where lacks pass by it."""
    passing = algebra.names(set(what.outer_names) - set(where.inner.names))
    placed = algebra.compose(algebra.tensor(by, algebra.names(what.outer_names)), what)
    return algebra.compose(algebra.parallel(where, passing), placed)
