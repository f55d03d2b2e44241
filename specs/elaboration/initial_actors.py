"""The initial bigActors: those declared one by one, and the members of families."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Final

from semantics.behaviours.values import Value
from specs import syntax as s
from specs.codes import Code
from specs.elaboration.names import Names

MOST_WRITTEN: Final = 100_000
"""The largest number of syntax nodes of all family members together."""


@dataclass(frozen=True, slots=True)
class InitialActor:
    """An initial bigActor.

    Attributes:
        name: Its name; for a member `patrol[uav0]`.
        host: Its host.
        body: Its statements.
        where: Its declaration.
        family: The name of its family, empty if it is no member.
        constants: For a member, the names of its entity and its number, with their values.
    """

    name: str
    host: s.Name
    body: tuple[s.Statement, ...]
    where: s.Node
    family: str = ""
    constants: Mapping[str, Value] = field(default_factory=dict)


def first_actors(mission: s.Mission, names: Names) -> tuple[InitialActor, ...]:
    """Return the initial bigActors, families expanded; those without a name are bigActor0, bigActor1 and so on."""
    singles = mission.each(s.BigActor)
    taken = {actor.name.text for actor in singles if actor.name is not None}
    free = (name for number in range(len(singles) + len(taken)) if (name := f"bigActor{number}") not in taken)
    found, written = list[InitialActor](), 0
    for item in mission.declarations:
        if isinstance(item, s.BigActor):
            name = item.name.text if item.name is not None else next(free)
            found.append(InitialActor(name, item.host, item.body, item.name or item))
        elif isinstance(item, s.Family) and written <= MOST_WRITTEN:
            members = tuple(_members(item, names))
            written += len(members) * sum(1 for _ in s.walk(item))
            found += members
            if written > MOST_WRITTEN:
                message = f"written out, the families have more than {MOST_WRITTEN:,} words"
                hint = "let the members share a behaviour: def visit(u) = { ... }"
                names.findings.add(Code.BAD_FAMILY, item.range, message, hint)
    return tuple(found)


def _members(family: s.Family, names: Names) -> Iterator[InitialActor]:
    """Yield the members of a family, and declare it."""
    name, nodes = family.name.text, tuple(_nodes(family, names))
    if not nodes:
        kind = (
            f"entity of kind {family.range.text}"
            if isinstance(family.range, s.Name)
            else "entity to go through"
        )
        message = f"the family '{name}' has no member: there is no {kind}"
        hint = "declare one, absent if it is to appear later, or leave the family out"
        names.findings.warn(Code.NOTHING_QUANTIFIED, family.range, message, hint)
    if names.declare("family", name, family.name):
        names.families[name] = {node: f"{name}[{node}]" for node in nodes}
    for number, node in enumerate(nodes):
        own = family.host.text == family.variable.text
        host = s.Name(node, span=family.host.span) if own else family.host
        constants: dict[str, Value] = {family.index.text: number, family.variable.text: node}
        yield InitialActor(f"{name}[{node}]", host, family.body, family.name, name, constants)


def _nodes(family: s.Family, names: Names) -> Iterator[str]:
    """Yield the entities of a family's range, in order."""
    among = family.range
    if isinstance(among, s.Name) and among.text not in names.kinds:
        if names.kind(among):
            yield from sorted(name for name, kind in names.kinds.items() if kind == among.text)
    elif isinstance(among, s.SetLiteral | s.RouteLiteral):
        yield from _listed(among, names)
    else:
        hint = "write for u in UAV, or for u in [uav1, uav0]"
        names.findings.add(
            Code.BAD_FAMILY, among, "a family goes through a kind, or a set or route of entities", hint
        )


def _listed(among: s.SetLiteral | s.RouteLiteral, names: Names) -> Iterator[str]:
    nodes: dict[str, None] = {}
    for item in among.items:
        if not isinstance(item, s.Name):
            hint = "write their names: for u in [uav1, uav0]"
            names.findings.add(Code.BAD_FAMILY, item, "a family goes through entities", hint)
        elif names.entity(item) is not None:
            if item.text in nodes:
                message = f"'{item.text}' stands here twice, and a member is called by its entity"
                names.findings.add(Code.BAD_FAMILY, item, message, "leave one of the two out")
            nodes[item.text] = None
    yield from nodes if isinstance(among, s.RouteLiteral) else sorted(nodes)
