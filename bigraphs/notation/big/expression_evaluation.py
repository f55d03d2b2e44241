"""Evaluation of expressions to bigraphs; errors of the algebra are reported at their position."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final, Literal, TypeAlias

from bigraphs import algebra
from bigraphs.bigraph import Bigraph
from bigraphs.errors import BigraphError, counted
from bigraphs.interface import Interface
from bigraphs.notation.big.declarations import BigDeclaration, ReactDeclaration
from bigraphs.notation.big.scope import NESTED, CallFrame, FileScope
from bigraphs.notation.big.syntax import (
    MAX_SIZE,
    Chain,
    Close,
    Expression,
    Identity,
    Ion,
    Nest,
    NewNames,
    Number,
    PlacingLiteral,
    Ref,
    Repeat,
    Share,
    Substitute,
    Wire,
    Wired,
)
from bigraphs.notation.big.templates import Part, SymbolicScope, Template
from bigraphs.notation.lalr import Span
from bigraphs.signature import Control, Signature
from bigraphs.system import Value

Declared: TypeAlias = BigDeclaration | ReactDeclaration
MAX_WORK: Final = 1_000_000
"""The total size of all bigraphs, over all steps, at which a file is refused."""
MAX_DEPTH: Final = 220
"""The nesting limit of expressions, bigraphs that they name included."""


class Evaluation:
    """The bigraphs of one file; `value` returns None after a recorded mistake, so that the evaluation finds all."""

    def __init__(self, scope: FileScope, known: Mapping[str, Bigraph] | None = None) -> None:
        self.scope = scope
        self.controls: dict[str, Control] = {}
        self._known: dict[str, Bigraph | None] = dict(known or {})
        self._templates: dict[tuple[object, ...], Template | Literal[False] | None] = {}
        self._under_way: set[str] = set()
        self._work = 0
        self._depth = 0

    def named(self, name: str, given: tuple[Value, ...], span: Span, frame: CallFrame) -> Bigraph | None:
        """Return a declared bigraph for these arguments."""
        declaration = self._declaration(name, given, span)
        if declaration is None:
            return None
        parameters = declaration.parameters
        if parameters and not self.scope.fits(name, parameters, given, span, frame):
            return None
        inner = self.scope.entered(declaration, given, span, frame)
        if inner is None:
            return None
        key = inner.key(name, given)
        if key in self._under_way:
            self.scope.add("cycle", f"'{name}' is made of itself", span, frame)
        elif key not in self._known and frame.depth >= NESTED:
            self.scope.add("too-deep", f"bigraphs use each other more than {NESTED} deep", span, frame)
        elif key not in self._known:
            self._under_way.add(key)
            made = self.instance(declaration, inner, [(declaration.body, _itself)])
            found = self._known[key] = made[0] if made else self.value(declaration.body, inner)
            if found is not None:
                self.is_well(declaration, inner)
            self._under_way.discard(key)
        return self._known.get(key)

    def instance(
        self, declaration: Declared, frame: CallFrame, parts: Sequence[Part]
    ) -> list[Bigraph] | None:
        """Return the bigraphs of a declaration's parts from a template; None if they must be evaluated as written."""
        key = _instances(declaration, frame)
        if self._templates.get(key, False) is None:
            self._templates[key] = self._template(tuple(frame.values), parts)
        made = self._templates.get(key)
        found = made.instance(tuple(frame.values.values())) if made else None
        if not found or not self._affordable(sum(map(_size, found[0])), declaration.span, frame):
            return None
        self.controls.update((control.name, control) for control in found[1])
        return found[0]

    def is_well(self, declaration: Declared, frame: CallFrame) -> None:
        """Record an evaluation without a mistake, so that a template may make other instances."""
        if declaration.parameters and not isinstance(self.scope, SymbolicScope):
            self._templates.setdefault(_instances(declaration, frame), None)

    def _template(self, parameters: Sequence[str], parts: Sequence[Part]) -> Template | Literal[False]:
        """Return the template of expressions, False if their form depends on the parameters."""
        symbolic = SymbolicScope(self.scope, parameters)
        evaluation = Evaluation(symbolic)
        found = [(evaluation.value(expression, symbolic.frame), finish) for expression, finish in parts]
        bigraphs = [finish(bigraph) for bigraph, finish in found if bigraph is not None]
        whole = len(bigraphs) == len(found) and not len(symbolic.findings)
        return symbolic.template(bigraphs, self.scope) if whole else False

    def _declaration(self, name: str, given: tuple[Value, ...], span: Span) -> BigDeclaration | None:
        found = self.scope.names.bigs.get(name)
        if found is not None and found.arguments:
            return self.scope.instance(self.scope.names.given_bigs[name], given, span)
        return found if found is not None and len(found.parameters) == len(given) else None

    def value(self, expression: Expression, frame: CallFrame) -> Bigraph | None:
        """Return the bigraph of an expression."""
        if self._depth >= MAX_DEPTH:
            self.scope.add("too-deep", f"expressions nest deeper than {MAX_DEPTH}", expression.span, frame)
            return None
        self._depth += 1
        try:
            found = self._evaluated(expression, frame)
        except BigraphError as error:
            self.scope.add(error.code, error.message, expression.span, frame, error.hint)
            return None
        finally:
            self._depth -= 1
        return found if found is None or self._affordable(_size(found), expression.span, frame) else None

    def _affordable(self, size: int, span: Span, frame: CallFrame) -> bool:
        self._work += size
        if size > MAX_SIZE:
            self.scope.add("too-large", f"a bigraph of more than {MAX_SIZE} parts", span, frame)
        elif self._work > MAX_WORK:
            message = f"reading this file takes bigraphs of more than {MAX_WORK} parts in all"
            self.scope.findings.add("too-large", message, Span(span.start, span.start + 1))
        return size <= MAX_SIZE and self._work <= MAX_WORK

    def _evaluated(self, expression: Expression, frame: CallFrame) -> Bigraph | None:
        match expression:
            case Ref(name, arguments):
                given = self.scope.arguments(arguments, frame)
                return None if given is None else self.named(name, given, expression.span, frame)
            case Ion():
                return self._ion(expression, frame)
            case Nest(ion, inside):
                return self._nested(ion, inside, frame)
            case Wired(wires, body):
                return self._wired(wires, self.value(body, frame), frame)
            case Chain():
                return self._chain(expression, frame)
            case Share():
                return self._shared(expression, frame)
            case Repeat():
                return self._repeated(expression, frame)
            case _:
                return _element(expression)

    def _ion(self, ion: Ion, frame: CallFrame) -> Bigraph | None:
        control = self.scope.control(ion, frame)
        if control is None:
            return None
        self.controls[control.name] = control
        make = algebra.atom if control.status == "atomic" else algebra.ion
        return make(Signature((control,)), control.name, ion.links)

    def _nested(self, ion: Ion, inside: Expression, frame: CallFrame) -> Bigraph | None:
        around, content = self._ion(ion, frame), self.value(inside, frame)
        if around is None or content is None or not around.sites:
            return None
        if content.regions != 1:
            found = f"'{ion.control}' has room for one region, this has {content.regions}"
            self.scope.add("interface", found, inside.span, frame, "join its contents by '|'")
            return None
        return algebra.nest(around, content)

    def _wired(self, wires: Sequence[Wire], found: Bigraph | None, frame: CallFrame) -> Bigraph | None:
        for wire in reversed(_once(wires)):
            if found is None or not self._has_names(wire, found, frame):
                return None
            found = _wire(wire, found)
        return found

    def _has_names(self, wire: Wire, body: Bigraph, frame: CallFrame) -> bool:
        names = wire.names if isinstance(wire, Close) else wire.inner
        missing = sorted(set(names) - set(body.outer_names))
        if missing:
            shown = f"the expression behind it has {', '.join(body.outer_names) or 'no names'}"
            self.scope.add("name", f"there is no outer name '{missing[0]}' here", wire.span, frame, shown)
        elif isinstance(wire, Substitute) and wire.outer in set(body.outer_names) - set(names):
            hint = f"to join them, write {wire.outer}/{{{', '.join((wire.outer, *names))}}}"
            self.scope.add("name", f"the name '{wire.outer}' is there already", wire.span, frame, hint)
            return False
        return not missing

    def _chain(self, chain: Chain, frame: CallFrame) -> Bigraph | None:
        """Evaluate a chain from the left; a run of one operator is joined pairwise, as each is associative."""
        written = [chain.first, *(operand for _, operand in chain.rest)]
        operands = [self.value(operand, frame) for operand in written]
        known = [operand for operand in operands if operand is not None]
        if len(known) < len(operands) or not self._affordable(sum(map(_size, known)), chain.span, frame):
            return None
        operators = [operator for operator, _ in chain.rest]
        found, start = known[0], 0
        while start < len(operators):
            end = next(
                (n for n in range(start, len(operators)) if operators[n] != operators[start]), len(operators)
            )
            run = [found, *known[start + 1 : end + 1]]
            if not self._joinable(operators[start], run, written[start : end + 1], frame):
                return None
            found = _joined(operators[start], run)
            start = end
        return found

    def _joinable(
        self, operator: str, run: Sequence[Bigraph], written: Sequence[Expression], frame: CallFrame
    ) -> bool:
        """Check the interfaces of operands in order, and record the first that does not fit."""
        outer, inner = set(run[0].outer_names), {name for name, _ in run[0].inner_links}
        for place, operand in enumerate(run[1:], 1):
            face = Interface(0, operand.inner.names)
            if operator == "*":
                wrong = _misfit(run[place - 1], operand)
            elif operator == "+" and outer & set(operand.outer_names):
                wrong = _named_twice("outer", outer & set(operand.outer_names)), "use '||' to share names"
            elif inner & set(face.names):
                wrong = _named_twice("inner", inner & set(face.names)), "give one of them another name"
            else:
                wrong = None
            if wrong:
                self.scope.add("interface", wrong[0], written[place].span, frame, wrong[1])
                return False
            outer |= set(operand.outer_names)
            inner |= set(face.names)
        return True

    def _shared(self, share: Share, frame: CallFrame) -> Bigraph | None:
        what, by, where = (self.value(part, frame) for part in (share.what, share.by, share.where))
        if what is None or by is None or where is None:
            return None
        if by.nodes or by.outer_names or by.inner_links:
            hint = "write, for example, ([{0, 1}, {1}], 2)"
            self.scope.add(
                "interface", "'by' takes a placing, without nodes and names", share.by.span, frame, hint
            )
        elif len(by.sites) != what.regions:
            found = f"this places {counted(len(by.sites), 'region')}, and {what.regions} are shared"
            self.scope.add("interface", found, share.by.span, frame, "list places for each region")
        elif by.regions != len(where.sites):
            found = f"this has {counted(len(where.sites), 'site')}, and the placing is over {by.regions}"
            self.scope.add("interface", found, share.where.span, frame)
        elif lacking := sorted({name for name, _ in where.inner_links} - set(what.outer_names)):
            found = f"this needs the name '{lacking[0]}', which the shared bigraph lacks"
            self.scope.add("interface", found, share.where.span, frame)
        elif stuck := sorted(set(what.outer_names) - {name for name, _ in where.inner_links}):
            found = f"this does not pass on the name '{stuck[0]}' of the shared bigraph"
            self.scope.add(
                "interface", found, share.where.span, frame, f"write '|| id{{{', '.join(stuck)}}}' in it"
            )
        else:
            return _share(what, by, where)
        return None

    def _repeated(self, repeat: Repeat, frame: CallFrame) -> Bigraph | None:
        times = self.scope.value(repeat.times, frame)
        body = self.value(repeat.body, frame)
        if times is None or body is None:
            return None
        if not isinstance(times, int) or times < 0:
            self.scope.add(
                "number", f"it is repeated {times!r} times, not a whole number", repeat.times.span, frame
            )
            return None
        if times > MAX_SIZE or not self._affordable(times * max(_size(body), 1), repeat.span, frame):
            self.scope.add("too-large", f"a bigraph of more than {MAX_SIZE} parts", repeat.span, frame)
            return None
        run = [algebra.identity(Interface()), *[body] * times]
        if not self._joinable(repeat.operator, run[:3], [repeat.body] * 3, frame):
            return None
        return _joined(repeat.operator, run) if times else run[0]


def _instances(declaration: Declared, frame: CallFrame) -> tuple[object, ...]:
    """Return the key of instances that share a template: the same declaration, with values of the same types."""
    return (
        type(declaration),
        declaration.name,
        tuple((name, type(each)) for name, each in frame.values.items()),
    )


def _itself(bigraph: Bigraph) -> Bigraph:
    return bigraph


def _misfit(context: Bigraph, content: Bigraph) -> tuple[str, str] | None:
    if context.inner == content.outer:
        return None
    found = f"this shows {content.outer}, and its context is for {context.inner}"
    return found, "extend one of them with an identity such as id(1, {x})"


def _named_twice(which: str, names: set[str]) -> str:
    return f"the {which} name '{min(names)}' is on both sides"


def _joined(operator: str, operands: list[Bigraph]) -> Bigraph:
    """Join operands by one associative operator."""
    if operator == "*":
        return _halved(operands)
    found = algebra.parallel(*operands)
    return algebra.merged(found) if operator == "|" else found


def _halved(operands: list[Bigraph]) -> Bigraph:
    """Compose neighbours pairwise, so that the work on long runs stays balanced."""
    while len(operands) > 1:
        pairs = zip(operands[::2], operands[1::2], strict=False)
        composed = [algebra.compose(left, right) for left, right in pairs]
        operands = [*composed, *operands[len(operands) // 2 * 2 :]]
    return operands[0]


def _size(bigraph: Bigraph) -> int:
    return (
        len(bigraph.nodes) + bigraph.regions + len(bigraph.sites) + len(bigraph.outer_names) + bigraph.edges
    )


def _element(expression: Expression) -> Bigraph:
    match expression:
        case Number(0):
            return algebra.placing([()], 0)
        case Number(1):
            return algebra.merge(0)
        case Identity(width, names):
            return algebra.identity(Interface(width, names))
        case PlacingLiteral(parents, regions):
            return algebra.placing(parents, regions)
        case Close(names):
            return algebra.compose(algebra.closure(names[0]), algebra.substitution(names[0], names))
        case Substitute(outer, inner):
            return algebra.substitution(outer, inner)
        case NewNames(names):
            return algebra.parallel(*(algebra.substitution(name, ()) for name in names))
        case _:
            hint = "write 0 for a site without a region, 1 for an empty region"
            raise BigraphError("syntax", "a number is no bigraph", hint)


def _once(wires: Sequence[Wire]) -> list[Wire]:
    """Return wires; in a run of closures, those of one name count once, as in BigraphER."""
    found: list[Wire] = []
    closed: set[str] = set()
    for wire in reversed(wires):
        name = wire.names[0] if isinstance(wire, Close) and len(wire.names) == 1 else None
        if name is None:
            closed.clear()
        elif name in closed:
            continue
        else:
            closed.add(name)
        found.append(wire)
    return found[::-1]


def _wire(wire: Wire, body: Bigraph) -> Bigraph:
    if isinstance(wire, Substitute):
        return algebra.rename(body, dict.fromkeys(wire.inner, wire.outer))
    joined = algebra.rename(body, dict.fromkeys(wire.names, wire.names[0]))
    return algebra.close(joined, wire.names[0])


def _share(what: Bigraph, by: Bigraph, where: Bigraph) -> Bigraph:
    """Put each region of `what` into the sites of `where` that the placing assigns."""
    placed = algebra.compose(algebra.tensor(by, algebra.names(what.outer_names)), what)
    return algebra.compose(where, placed)
