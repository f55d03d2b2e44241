"""The operands of VIA, checked as far as possible for any host."""

from __future__ import annotations

from semantics.behaviours.expressions import Expression
from semantics.behaviours.reactions import MOST_VIA
from specs import syntax as s
from specs.codes import Code
from specs.elaboration.findings import Findings
from specs.writing import write


def check_way(action: s.MoveHost | s.Move, arguments: tuple[Expression, ...], findings: Findings) -> None:
    """Report a way that is too long, or that names something twice; `arguments` is all that the action names."""
    if len(action.via) > MOST_VIA:
        message = f"a move passes {MOST_VIA} places at the most, and {len(action.via)} are named"
        findings.add(Code.BAD_WAY, action.via[MOST_VIA], message, "make two moves of it")
        return
    destination, *via = arguments if isinstance(action, s.MoveHost) else arguments[1:]
    for number, (place, node) in enumerate(zip(via, action.via, strict=True)):
        if place == destination:
            message, hint = f"'{write(node)}' is where it goes", "leave it out: it comes last by itself"
        elif place in via[:number]:
            message, hint = f"'{write(node)}' is passed already", "come by a second time with another move"
        else:
            continue
        findings.add(Code.BAD_WAY, node, message, hint)
