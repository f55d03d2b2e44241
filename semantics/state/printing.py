"""Configurations in the paper's notation: ⟨α | S | η⟩, and the changes between two."""

from collections.abc import Iterator
from textwrap import indent

from bigraphs import draw_text
from semantics.behaviours.statements import Statement
from semantics.behaviours.values import show
from semantics.state.agents import written
from semantics.state.brief import cut
from semantics.state.cell_values import AGENTS, MONITOR, NAMES, QUEUE, Cell
from semantics.state.configuration import Configuration
from semantics.state.physical_model import Carried, InTransit, PhysicalModel, Placement
from semantics.state.requests import READY
from semantics.state.signature import Name


def print_agent(c: Configuration, a: Name) -> str:
    """Return an agent as text: its name, host, next statement, variables and mailbox."""
    agents, code = c.alpha, c.alpha.code(a)
    line = c.setting.program.lines[code[0]] if code and c.setting.program.lines else None
    at = word_of(c.setting.program.statements[code[0]]) if code else "ended"
    held = (f"{written(name)} = {show(value)}" for name, value in agents.store(a) if written(name))
    variables = ", ".join(dict.fromkeys(held))
    mail = ", ".join(map(show, agents.mailbox(a)))
    parts = [f"{a}@{agents.host(a)}", f"at {at}" + (f" (line {line})" if line else "") if code else at]
    return " ".join(
        [*parts, *([f"[{variables}]"] if variables else []), *([f"mail [{mail}]"] if mail else [])]
    )


def word_of(statement: Statement) -> str:
    """Return the keyword that a statement begins with."""
    words = {
        "ControlBy": "control",
        "Tested": "guard",
        "ForEach": "for",
        "ChooseFrom": "choose",
        "Assign": "let",
    }
    name = type(statement).__name__
    return words.get(name, name.lower())


def print_configuration(c: Configuration) -> str:
    """Return a configuration as text in three parts: the agents, the logical model as a tree, the pending requests."""
    alpha = "\n".join(f"  {print_agent(c, a)}" for a in c.alpha.names())
    eta = "\n".join(f"  {each.request}" for each in c.eta.all()) or "  ∅"
    tree = indent(draw_text(c.structure.logical.bigraph()), "  ")
    return f"⟨ α\n{alpha}\n| L\n{tree}\n| η\n{eta}\n⟩"


LONGEST_PART = 60
"""Characters of each part of a configuration on one line."""


def print_briefly(c: Configuration) -> str:
    """Return a configuration on one line of bounded length: agents, believed parents, pending requests."""
    nodes = c.structure.logical.bigraph().nodes
    alpha = ", ".join(print_agent(c, a) for a in c.alpha.names())
    within = ", ".join(f"{node.name} in {nodes[at].name}" for node in nodes for at in node.parents if at >= 0)
    eta = ", ".join(str(each.request) for each in c.eta.all())
    return f"⟨{' | '.join(cut(part, LONGEST_PART) or '∅' for part in (alpha, within, eta))}⟩"


def print_changes(before: Configuration, after: Configuration) -> tuple[str, ...]:
    """Return the differences between two configurations, a line for each cell, without the monitor's cells."""
    lines: list[str] = []
    for cell, value in sorted(_cells(after).items()):
        old = before.read(cell)
        if old != value:
            lines += _change(before, after, cell)
    return tuple(lines)


def _cells(c: Configuration) -> dict[Cell, object]:
    return dict(c.state.items())  # type: ignore[attr-defined]  # only stored configurations are printed


def _change(before: Configuration, after: Configuration, cell: Cell) -> Iterator[str]:
    what, whose = cell[0], cell[-1]
    if what in (MONITOR, "store") or cell in (AGENTS, NAMES):
        return
    if what == "code":
        yield f"α  {print_agent(after, whose)}"
    elif what in ("host", "mailbox"):
        shown = (
            after.alpha.host(whose)
            if what == "host"
            else ", ".join(map(show, after.alpha.mailbox(whose))) or "∅"
        )
        yield f"α  {what}({whose}) = {shown}"
    elif what in ("parent", "links"):
        yield f"L  {what}({whose}) : {_slot(before.read(cell))} ↦ {_slot(after.read(cell))}"
    elif what in ("placement", "channels", "down"):
        yield f"P  {_physical(before, after, what, whose)}"
    elif what in ("line", "sends") or cell == QUEUE:
        yield f"η  {whose + ': ' if cell != QUEUE else ''}{_requests(after, cell)}"
    elif what == "says":
        yield f"   may still be said: {after.read(cell)}"


def _requests(c: Configuration, cell: Cell) -> str:
    return ", ".join(_short(request) for request in c.read(cell)) or "∅"


def _short(request: object) -> str:
    return f"READY({request.agent}, {request.observation})" if isinstance(request, READY) else str(request)


def _slot(value: object) -> str:
    if isinstance(value, tuple):
        return f"{{{', '.join(map(str, value))}}}"
    return "none" if value is None else str(value)


def _physical(before: Configuration, after: Configuration, what: str, whose: Name) -> str:
    if what == "down":
        return f"{whose} is {'down' if after.structure.physical.is_down(whose) else 'up'}"
    if what == "channels":
        return f"channels({whose}) = {_slot(after.read(('channels', whose)))}"
    old, new = (_where(c.structure.physical, whose) for c in (before, after))
    return f"{whose} : {old} ↦ {new}"


def _where(physical: PhysicalModel, name: Name) -> str:
    placement: Placement | None = physical.placement(name)
    if placement is None:
        return "absent"
    if isinstance(placement, InTransit):
        return f"in transit to {placement.to}"
    if isinstance(placement, Carried):
        return f"carried by {placement.by}"
    return f"in {physical.abstract_parent(name)}"
