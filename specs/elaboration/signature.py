"""The signature phase: kinds, and one error for each undeclared kind."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from bigraphs.notation.spelling import listed
from semantics.state.signature import Kind, Signature
from specs import syntax as s
from specs.codes import Code
from specs.elaboration.mission_mistakes import shorten
from specs.elaboration.names import AGENTS, Names
from specs.elaboration.proposed_signature import proposed
from specs.standard_signature import standard_kinds

_MOST_NAMED: Final = 8

Kinds = dict[str, Kind]
Uses = dict[str, list[s.Name]]


def elaborate_signature(mission: s.Mission, names: Names) -> None:
    """Declare the kinds of a mission; undeclared ones are reported, and defined as in the proposed signature."""
    kinds = _declared(mission, names)
    uses = _undeclared(mission, kinds)
    if uses and not mission.each(s.Signature):
        kinds = _lacking_signature(mission, uses, names)
    elif uses:
        kinds = _lacking_kinds(mission, kinds, uses, names)
    names.signature = Signature.of(kinds.values())


def _declared(mission: s.Mission, names: Names) -> Kinds:
    sections = mission.each(s.Signature)
    standard = next((section for section in sections if section.standard), None)
    if standard is None:
        base = Kinds()
    else:
        base = _standard()
        for name in base:
            names.declare("kind", name, standard)
    found = dict(base)
    for kind in (kind for section in sections for kind in section.kinds):
        name = kind.name.text
        if name in base:
            found[name] = _extended(base.pop(name), _kind(kind))
        elif names.declare("kind", name, kind.name):
            found[name] = _kind(kind)
    return found


def _standard() -> Kinds:
    return {kind.name.text: _kind(kind) for kind in standard_kinds()}


def _kind(kind: s.Kind) -> Kind:
    contains = frozenset(other.text for other in kind.contains)
    carries = frozenset(other.text for other in kind.carries)
    return Kind(kind.name.text, contains, carries, kind.driven, kind.passive)


def _extended(kind: Kind, by: Kind) -> Kind:
    """Return a kind with the clauses of another declaration added."""
    contains, carries = kind.contains | by.contains, kind.carries | by.carries
    return Kind(kind.name, contains, carries, kind.driven or by.driven, kind.passive or by.passive)


# --- undeclared kinds


def _undeclared(mission: s.Mission, kinds: Kinds) -> Uses:
    """Return the uses of each undeclared kind, in text order; bodies of rules are examined later."""
    found, others = Uses(), _not_kinds(mission)
    used = (name for node in s.walk(mission) for name in _kinds_in(node, others))
    for name in sorted(used, key=lambda name: name.span):
        if name.text not in kinds and name.text not in others:
            found.setdefault(name.text, []).append(name)
    return found


def _not_kinds(mission: s.Mission) -> frozenset[str]:
    """Return the names in ranges of quantifiers and families that are no kinds: bigActors, families, entities."""
    named = (node for node in s.walk(mission) if isinstance(node, s.Family | s.Entity))
    return frozenset({AGENTS, *(each.name.text for each in named)})


def _kinds_in(node: s.Node, others: frozenset[str]) -> tuple[s.Name, ...]:
    match node:
        case s.Entity() | s.Parameter() | s.OfKind() | s.Keep():
            return (node.kind,)
        case s.Quantified(range=s.Name() as among) | s.Family(range=s.Name() as among):
            return () if among.text in others else (among,)
        case s.Kind():
            return (*node.contains, *node.carries)
        case _:
            return ()


def _lacking_signature(mission: s.Mission, uses: Uses, names: Names) -> Kinds:
    """Report the missing signature, and propose one."""
    standard = _standard() if uses.keys() & _standard().keys() else Kinds()
    own = proposed(mission, tuple(kind for kind in uses if kind not in standard))
    holding = [kind for kind in uses if own and kind in standard and standard[kind].contains]
    own = (*(Kind(kind, frozenset(each.name for each in own)) for kind in holding), *own)
    shown = [shorten(kind) for kind in uses]
    shown = shown if len(shown) <= _MOST_NAMED else [*shown[:_MOST_NAMED], "others"]
    few = shown[0] if len(shown) == 1 else f"{', '.join(shown[:-1])} and {shown[-1]}"
    body = [f"{{ {'  '.join(map(_written, own))} }}"] if own else []
    remedy = " ".join(["signature", *(["standard"] if standard else []), *body])
    where = next(iter(uses.values()))[0]
    names.findings.add(Code.UNKNOWN_KIND, where, f"no signature declares {few}", f"write: {remedy}")
    return standard | {kind.name: _extended(kind, standard.get(kind.name, kind)) for kind in own}


def _lacking_kinds(mission: s.Mission, kinds: Kinds, uses: Uses, names: Names) -> Kinds:
    """Report each undeclared kind; afterwards, every kind that contains anything contains it."""
    own = {kind.name: kind for kind in proposed(mission, tuple(uses))}
    entities = {node.kind.text for node in s.walk(mission) if isinstance(node, s.Entity)}
    for kind, where in uses.items():
        times = f", used {len(where)} times" if len(where) > 1 else ""
        otherwise = f"declare it: signature {{ {_written(own[kind])} }}"
        if kind not in entities:
            otherwise = f"{listed(kinds, 'kinds')}; or {otherwise}"
        hint = names.findings.suggest(kind, (*kinds, AGENTS)) or otherwise
        names.findings.add(Code.UNKNOWN_KIND, where[0], f"unknown kind '{shorten(kind)}'{times}", hint)
        names.lacking.add(kind)
    holding = {
        name: replace(kind, contains=kind.contains | own.keys()) if kind.contains else kind
        for name, kind in kinds.items()
    }
    return holding | own


def _written(kind: Kind) -> str:
    clauses = [f"contains {', '.join(sorted(kind.contains))}"] if kind.contains else []
    clauses += ["driven"] if kind.driven else []
    clauses += [f"carries {', '.join(sorted(kind.carries))}"] if kind.carries else []
    return " ".join(["kind", kind.name, *clauses])
