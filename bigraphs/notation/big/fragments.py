"""Elaboration of single expressions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from bigraphs.bigraph import Bigraph
from bigraphs.notation.big.declarations import BigDeclaration, ControlDeclaration
from bigraphs.notation.big.expression_evaluation import Evaluation
from bigraphs.notation.big.file_mistakes import Findings
from bigraphs.notation.big.name_check import SyntaxWalk
from bigraphs.notation.big.names import Names
from bigraphs.notation.big.parser import parse_expression
from bigraphs.notation.big.scope import CallFrame, FileScope
from bigraphs.notation.big.syntax import Identity
from bigraphs.signature import Signature
from bigraphs.sorting import base


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
