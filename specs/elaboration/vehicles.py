"""The entities or vehicles of a clause: one by its name, or all of a kind."""

from __future__ import annotations

from bigraphs.notation.spelling import listed
from specs import syntax as s
from specs.codes import Code
from specs.elaboration.mission_mistakes import a
from specs.elaboration.names import Names


def named_vehicles(names: Names, name: s.Name, what: str) -> tuple[str, ...]:
    """Return the vehicles of a kind, or the named vehicle; reports any other name, and kinds that are not driven."""
    kind = names.kinds.get(name.text, name.text)
    if kind not in names.signature.kinds:
        among = [*names.signature.kinds, *names.kinds]
        driven = [each for each, of in names.kinds.items() if names.signature[of].driven]
        otherwise = listed(driven, "vehicles")
        names.findings.unknown(name, among, sort="vehicle or kind of vehicles", otherwise=otherwise)
        return ()
    if not names.signature[kind].driven:
        message = f"'{name.text}' {what}, and {a(kind)} is not driven"
        names.findings.add(Code.NOT_DRIVEN, name, message, f"declare it: kind {kind} driven")
        return ()
    return entities_of(names, name)


def entities_of(names: Names, name: s.Name) -> tuple[str, ...]:
    """Return the entities of a declared kind, or the named entity; warns of a kind without entities."""
    if name.text in names.kinds:
        return (name.text,)
    found = tuple(sorted(each for each, of in names.kinds.items() if of == name.text))
    if not found:
        message = f"there is no entity of kind {name.text}: this has no effect"
        names.findings.warn(Code.BOUNDS_NOTHING, name, message, "declare one, or leave this out")
    return found
