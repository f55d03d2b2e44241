"""The vehicles of a bound: one by its name, or all of a kind."""

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
    if name.text in names.kinds:
        return (name.text,)
    found = tuple(sorted(each for each, of in names.kinds.items() if of == kind))
    if not found:
        message = f"there is no entity of kind {kind}: this bound has no effect"
        names.findings.warn(Code.BOUNDS_NOTHING, name, message, "declare one, or leave this out")
    return found
