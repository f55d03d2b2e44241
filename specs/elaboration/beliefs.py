"""The beliefs phase: the differences of L₀ from A(P₀)."""

from __future__ import annotations

from semantics.state.configuration import Configuration
from semantics.state.initial import Beliefs
from semantics.state.signature import REGION
from specs import syntax as s
from specs.codes import Code
from specs.elaboration.mission_mistakes import a
from specs.elaboration.names import Names


def elaborate_beliefs(mission: s.Mission, names: Names) -> Beliefs:
    """Return the beliefs of the mission; reports impossible ones."""
    parents: dict[str, str | None] = {}
    links: dict[str, tuple[str, ...]] = {}
    for belief in _beliefs(mission):
        kind = names.entity(belief.entity)
        said: dict[str, object] = links if isinstance(belief, s.BelievedLinked) else parents  # type: ignore[assignment]  # only its keys are asked for
        if belief.entity.text in said:
            message = f"'{belief.entity.text}' has two beliefs"
            names.findings.add(Code.BAD_BELIEF, belief, message, "leave out one of the two")
        if isinstance(belief, s.BelievedLinked):
            links[belief.entity.text] = _links(belief, names)
        elif isinstance(belief, s.BelievedUnknown):
            parents[belief.entity.text] = None
        else:
            parents[belief.entity.text] = _place(belief, kind, names)
    _check_known(mission, parents, names)
    return Beliefs(parents, links)


def _beliefs(mission: s.Mission) -> list[s.Belief]:
    return [belief for section in mission.each(s.Believes) for belief in section.beliefs]


def _links(belief: s.BelievedLinked, names: Names) -> tuple[str, ...]:
    return tuple(sorted({channel.text for channel in belief.channels if names.channel(channel)}))


def _place(belief: s.BelievedIn, kind: str | None, names: Names) -> str:
    if belief.place is None:
        return REGION
    around = names.entity(belief.place)
    if kind is not None and around is not None and not names.signature[around].may_contain(kind):
        message = f"'{belief.entity.text}' cannot be in '{belief.place.text}': {a(around)} contains no {kind}"
        names.findings.add(Code.BAD_BELIEF, belief, message, f"declare it: kind {around} contains {kind}")
    return belief.place.text


def _check_known(mission: s.Mission, parents: dict[str, str | None], names: Names) -> None:
    for belief in _beliefs(mission):
        if isinstance(belief, s.BelievedIn) and belief.place is not None:
            place = belief.place.text
            if place in parents and parents[place] is None:
                message = f"'{belief.entity.text}' is believed in '{place}', which is believed not to exist"
                names.findings.add(
                    Code.BAD_BELIEF, belief, message, f"write '{belief.entity.text} in region'"
                )


def settled(beliefs: Beliefs, actual: Configuration) -> Beliefs:
    """Complete beliefs: a node in a place outside L goes to the next place around it that is in L.

    `actual` is the initial configuration without beliefs.
    """
    unknown = {name for name, parent in beliefs.parents.items() if parent is None}
    logical = actual.structure.logical
    parents = dict(beliefs.parents)
    for name in logical.nodes():
        place = logical.parent(name)
        if name not in parents and place in unknown:
            around = (other for other in logical.ancestors(name) if other not in unknown)
            parents[name] = next(around, REGION)
    return Beliefs(parents, beliefs.links)


def check_forest(mission: s.Mission, c: Configuration, names: Names) -> None:
    """Report beliefs that nest an entity inside itself, or in a place outside L."""
    logical = c.structure.logical
    for belief in _beliefs(mission):
        if not isinstance(belief, s.BelievedIn):
            continue
        start, place, seen = belief.entity.text, logical.parent(belief.entity.text), set[str]()
        while place is not None and place not in (REGION, start) and place not in seen:
            seen.add(place)
            place = logical.parent(place)
        if place == start:
            message = f"cyclic nesting: '{start}' is believed inside itself"
            hint = "its content has to be believed elsewhere"
            names.findings.add(Code.CYCLIC_NESTING, belief, message, hint)
        elif place is None:
            around = belief.place.text if belief.place else REGION
            message = f"'{start}' is believed in '{around}', which is not in L"
            names.findings.add(
                Code.BAD_BELIEF, belief, message, f"give '{around}' a place too: '{around} in region'"
            )
