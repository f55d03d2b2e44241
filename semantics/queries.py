"""Queries, the observations L_q that they yield, and L ⊕ L_q.

A query denotes a set of nodes of A(P), composed pointwise. Its observation says what is shown, and every answer that
was got on the way: a yes is a pair, a no follows from a place or link that was enumerated.
"""

from collections.abc import Callable
from dataclasses import dataclass

from semantics.cells import NAMES, Cells, Changes
from semantics.logical_model import LogicalModel
from semantics.physical_model import PhysicalModel
from semantics.signature import REGION, Name
from semantics.structure import Linked, Parent, Relation


@dataclass(frozen=True, slots=True)
class Nodes:
    """The nodes of these names; `HOST` resolved, a name, or the value of a variable."""

    names: tuple[Name, ...]

    def __str__(self) -> str:
        return self.names[0] if len(self.names) == 1 else f"{{{', '.join(self.names)}}}"


@dataclass(frozen=True, slots=True)
class All:
    """Everything."""

    def __str__(self) -> str:
        return "ALL"


@dataclass(frozen=True, slots=True)
class Of:
    """`PARENT(q)`, `CHILDREN(q)`, `LINKED_TO(q)` or `HOSTED_AT(q)`, by the operator's name."""

    operator: str
    of: "Query"

    def __str__(self) -> str:
        return f"{self.operator}({self.of})"


Query = Nodes | All | Of


@dataclass(frozen=True, slots=True)
class Observation:
    """L_q: what a query showed, with the answers it got.

    Attributes:
        shown: The nodes denoted, with the places whose children were asked for; sorted.
        agents: The agents denoted (`HOSTED_AT`), sorted.
        relations: Every pair of σ_{A(P)} that was answered with yes, in canonical order.
        enumerated: Places whose children were all listed: who is not among the pairs is not there.
        looked: Nodes whose links were all listed.
        swept: Links whose points were all listed.
    """

    shown: tuple[Name, ...] = ()
    agents: tuple[Name, ...] = ()
    relations: tuple[Relation, ...] = ()
    enumerated: tuple[Name, ...] = ()
    looked: tuple[Name, ...] = ()
    swept: tuple[Name, ...] = ()

    def __str__(self) -> str:
        return f"{{{', '.join((*self.shown, *self.agents))}}}"

    def __contains__(self, name: object) -> bool:
        return name in self.shown or name in self.agents

    def parent(self, node: Name) -> Name | None:
        """Return the parent that was seen of a node."""
        seen = (pair.place for pair in self.relations if isinstance(pair, Parent) and pair.node == node)
        return next(seen, None)

    def children(self, place: Name) -> frozenset[Name]:
        """Return the children that were seen of a place."""
        return frozenset(
            pair.node for pair in self.relations if isinstance(pair, Parent) and pair.place == place
        )

    def links(self, node: Name) -> frozenset[Name]:
        """Return the links on which a node was seen."""
        return frozenset(
            pair.link for pair in self.relations if isinstance(pair, Linked) and pair.node == node
        )

    def nodes(self) -> tuple[Name, ...]:
        """Return dom(L_q), sorted: what was shown, and every node of a pair."""
        related = {pair.node for pair in self.relations}
        places = {pair.place for pair in self.relations if isinstance(pair, Parent)} - {REGION}
        return tuple(sorted(related | places | set(self.shown)))


class _Looking:
    """The answers that one evaluation collects."""

    def __init__(self, physical: PhysicalModel, hosted: Callable[[Name], tuple[Name, ...]]) -> None:
        self.physical = physical
        self.hosted = hosted
        self.relations: set[Relation] = set()
        self.enumerated: set[Name] = set()
        self.looked: set[Name] = set()
        self.swept: set[Name] = set()
        self.agents: set[Name] = set()

    def ask(self, query: Query) -> set[Name]:
        """Return the denotation of a query: nodes, and the region where a PARENT leads there."""
        if isinstance(query, Nodes):
            return {name for name in query.names if name in self.physical}
        if isinstance(query, All):
            return self.everything()
        answer = OPERATORS[query.operator]
        return {found for name in sorted(self.ask(query.of)) for found in answer(self, name)}

    def everything(self) -> set[Name]:
        entities = self.physical.entities()
        for place in (REGION, *entities):
            self.children(place)
        for name in entities:
            self.linked_to(name)
        return set(entities)

    def parent(self, name: Name) -> set[Name]:
        if name == REGION:
            return {REGION}
        place = self.physical.abstract_parent(name)
        self.relations.add(Parent(name, place))
        return {place}

    def children(self, name: Name) -> set[Name]:
        found = self.physical.children(name)
        self.relations.update(Parent(child, name) for child in found)
        self.enumerated.add(name)
        return {name, *found}

    def linked_to(self, name: Name) -> set[Name]:
        links = () if name == REGION else self.physical.links(name)
        self.looked.update({name} - {REGION})
        self.swept.update(links)
        points = {link: self.physical.points(link) for link in links}
        self.relations.update(Linked(link, point) for link, found in points.items() for point in found)
        return {name, *(point for found in points.values() for point in found)}

    def hosted_at(self, name: Name) -> set[Name]:
        self.agents.update(self.hosted(name))
        return set()


OPERATORS: dict[str, Callable[[_Looking, Name], set[Name]]] = {
    "PARENT": _Looking.parent,
    "CHILDREN": _Looking.children,
    "LINKED_TO": _Looking.linked_to,
    "HOSTED_AT": _Looking.hosted_at,
}


def evaluate(
    query: Query, physical: PhysicalModel, hosted: Callable[[Name], tuple[Name, ...]]
) -> Observation:
    """Return q(A(P)); `hosted` gives the agents at a node. An absent host gives the empty observation."""
    looking = _Looking(physical, hosted)
    shown = looking.ask(query) - {REGION}
    return Observation(
        shown=tuple(sorted(shown)),
        agents=tuple(sorted(looking.agents)),
        relations=tuple(sorted(looking.relations, key=str)),
        enumerated=tuple(sorted(looking.enumerated)),
        looked=tuple(sorted(looking.looked)),
        swept=tuple(sorted(looking.swept)),
    )


def overlay(logical: LogicalModel, seen: Observation, cells: Cells) -> Changes:
    """Return the writes of L ⊕ L_q: the answers that the query got, and no more.

    A yes sets the relation. A no removes only the relation denied: a node believed under an enumerated place and not
    seen there goes to the region, a link looked at and seen without n loses n. A new node that was not placed goes to
    the region; where a cycle would arise, its nodes whose slot was not looked at do. So L_q ⊆ L ⊕ L_q.
    """
    names: tuple[Name, ...] = cells.read(NAMES)
    answered = {pair.node: pair.place for pair in seen.relations if isinstance(pair, Parent)}
    shown = frozenset(seen.nodes())
    parents = {name: _new_parent(name, logical.parent(name), answered, seen, name in shown) for name in names}
    _break_cycles(parents, answered)
    changes: Changes = {}
    for name in names:
        place = parents[name]
        if place is not None and place != logical.parent(name):
            changes |= logical.nesting(name, place)
        links = _new_links(name, frozenset(logical.links(name)), seen)
        if links != frozenset(logical.links(name)):
            changes |= logical.linking(name, links)
    return changes


def _new_parent(
    name: Name, believed: Name | None, answered: dict[Name, Name], seen: Observation, shown: bool
) -> Name | None:
    if name in answered:
        return answered[name]
    if believed in seen.enumerated or (believed is None and shown):
        return REGION
    return believed


def _new_links(name: Name, believed: frozenset[Name], seen: Observation) -> frozenset[Name]:
    denied = believed if name in seen.looked else believed.intersection(seen.swept)
    return (believed - denied) | seen.links(name)


def _break_cycles(parents: dict[Name, Name | None], answered: dict[Name, Name]) -> None:
    """Send to the region what lies on a cycle and was not looked at; A(P) is a forest: each cycle has such a node."""
    for start in parents:
        path: list[Name] = []
        place: Name | None = start
        while place in parents and place not in path:
            path.append(place)
            place = parents[place]
        if place in path:
            for node in path[path.index(place) :]:
                if node not in answered:
                    parents[node] = REGION
