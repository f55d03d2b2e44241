"""Elaboration of declarations without a system, and of single expressions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from bigraphs.bigraph import Bigraph
from bigraphs.notation.big.declarations import BigDeclaration, ControlDeclaration, Model
from bigraphs.notation.big.expressions import Evaluation
from bigraphs.notation.big.file_mistakes import Findings
from bigraphs.notation.big.name_check import SyntaxWalk, survey
from bigraphs.notation.big.names import Names, index
from bigraphs.notation.big.parser import parse_expression, parse_model
from bigraphs.notation.big.rules import RuleElaborator
from bigraphs.notation.big.scope import CallFrame, FileScope, control_of
from bigraphs.notation.big.syntax import NOWHERE, Identity
from bigraphs.notation.big.systems import check_declared
from bigraphs.rules import ReactionRule
from bigraphs.signature import Signature
from bigraphs.sorting import base


@dataclass(frozen=True, slots=True)
class Theory:
    """The declarations of a `.big` file without parameters: bigraphs and rules by name, in source order."""

    signature: Signature
    bigraphs: tuple[tuple[str, Bigraph], ...]
    rules: tuple[ReactionRule, ...]


def read_theory(text: str) -> Theory:
    """Read the declarations of a `.big` file and ignore its system; raises NotationError with all mistakes."""
    findings = Findings(text)
    model = Model(parse_model(text).declarations)
    names = index(model, findings)
    survey(model, names, findings)
    scope = FileScope(names, findings, {})
    evaluation = Evaluation(scope)
    rules = RuleElaborator(evaluation, None)
    check_declared(names, scope, evaluation, rules)
    findings.raise_any()
    return _theory(names, evaluation, rules)


def _theory(names: Names, evaluation: Evaluation, rules: RuleElaborator) -> Theory:
    plain = [control_of(each, ()) for each in names.controls.values() if not each.parameters]
    every = {control.name: control for control in (*plain, *evaluation.controls.values())}
    signature = Signature(tuple(every.values()))
    bigs = [big.name for big in names.bigs.values() if not big.parameters and not big.arguments]
    found = [(name, evaluation.named(name, (), NOWHERE, CallFrame())) for name in bigs]
    reacts = [react.name for react in names.reacts.values() if not react.parameters and not react.arguments]
    known = [rule for name in reacts if (rule := rules.named(name, (), NOWHERE, CallFrame())) is not None]
    return Theory(
        signature,
        tuple((name, replace(big, signature=signature)) for name, big in found if big is not None),
        tuple(_widened(rule.reaction(), signature) for rule in known),
    )


def _widened(rule: ReactionRule, signature: Signature) -> ReactionRule:
    redex, reactum = (replace(side, signature=signature) for side in (rule.redex, rule.reactum))
    return replace(rule, redex=redex, reactum=reactum)


def read_big(text: str, signature: Signature, known: Mapping[str, Bigraph] | None = None) -> Bigraph:
    """Read one expression over a signature; it may use the bigraphs in `known` by name."""
    expression = parse_expression(text)
    findings = Findings(text)
    names = _names_of(signature, known or {})
    SyntaxWalk(names, findings, frozenset()).expression(expression)
    evaluation = Evaluation(FileScope(names, findings, {}), known)
    found = evaluation.value(expression, CallFrame())
    findings.raise_any()
    if found is None:
        raise AssertionError("no bigraph, and no mistake")
    return replace(found, signature=signature)


def _names_of(signature: Signature, known: Mapping[str, Bigraph]) -> Names:
    names = Names()
    for control in signature.controls:
        name = base(control.name)
        count = control.name.count(",") + 1 if "(" in control.name else 0
        parameters = tuple(f"p{place}" for place in range(count))
        names.controls[name] = ControlDeclaration(
            name, control.arity, control.status, control.ordered, parameters
        )
    names.bigs.update((name, BigDeclaration(name, Identity(0))) for name in known)
    return names
