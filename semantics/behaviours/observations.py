"""Queries as values, and the observations L_q that they yield, with every tested answer."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import Any, Literal, NamedTuple

from semantics.state.relations import Linked, Parent, Relation
from semantics.state.signature import REGION, Name


class QueryOperator(StrEnum):
    """The operators on the nodes that a query denotes, by their words."""

    PARENT = "PARENT"
    CHILDREN = "CHILDREN"
    LINKED_TO = "LINKED_TO"
    HOSTED_AT = "HOSTED_AT"


@dataclass(frozen=True, slots=True)
class Nodes:
    """The nodes of these names: the resolved `HOST`, a name, or the value of a variable."""

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
    """An operator applied to the nodes that another query denotes."""

    operator: QueryOperator
    of: "Query"

    def __str__(self) -> str:
        return f"{self.operator}({self.of})"


Query = Nodes | All | Of


@dataclass(frozen=True, slots=True)
class Fact:
    """The part of an observation about one node, or one agent.

    Attributes:
        shown: Whether the query denotes it.
        parent: Its observed parent.
        links: The links on which it was observed, sorted.
    """

    shown: bool = False
    parent: Name | None = None
    links: tuple[Name, ...] = ()


NOTHING_SEEN = Fact()


@dataclass(frozen=True, slots=True)
class Swept:
    """The exhaustively listed parts of an observation: a node not seen there is absent.

    Attributes:
        places: Places with all children listed; sorted, as the others are.
        nodes: Nodes with all links listed.
        links: Links with all points listed.
        around: Places whose children are the answer; they are shown too, but are not members of it by themselves.
    """

    places: tuple[Name, ...] = ()
    nodes: tuple[Name, ...] = ()
    links: tuple[Name, ...] = ()
    around: tuple[Name, ...] = ()


NOTHING_SWEPT = Swept()


class Observation:
    """L_q: the result of a query, with its answers name by name.

    Attributes:
        family: The fact about each name; agents under `agent_key`.
        swept: The exhaustively listed parts.
    """

    __slots__ = ("_facts", "_places", "family", "swept")

    def __init__(self, family: Mapping[Name, Fact], swept: Swept = NOTHING_SWEPT) -> None:
        self.family = family
        self.swept = swept
        self._facts: tuple[tuple[Name, Fact], ...] | None = None
        self._places: frozenset[Name | None] | None = None

    @staticmethod
    def of(
        shown: Iterable[Name] = (),
        agents: Iterable[Name] = (),
        relations: Iterable[Relation] = (),
        swept: Swept = NOTHING_SWEPT,
    ) -> "Observation":
        """Return the observation of these names, agents and relations."""
        facts: dict[Name, Fact] = {}

        def say(name: Name, **news: Any) -> None:
            facts[name] = replace(facts.get(name, NOTHING_SEEN), **news)

        for name in (*shown, *map(agent_key, agents)):
            say(name, shown=True)
        for pair in relations:
            if isinstance(pair, Parent):
                say(pair.node, parent=pair.place)
            else:
                links = facts.get(pair.node, NOTHING_SEEN).links
                say(pair.node, links=tuple(sorted({*links, pair.link})))
        return Observation(facts, swept)

    @property
    def facts(self) -> tuple[tuple[Name, Fact], ...]:
        """All facts, sorted by name."""
        if self._facts is None:
            told = ((name, self.family[name]) for name in sorted(self.family))
            self._facts = tuple((name, fact) for name, fact in told if fact != NOTHING_SEEN)
        return self._facts

    def fact(self, name: Name) -> Fact:
        """Return the fact about one name."""
        return self.family.get(name, NOTHING_SEEN)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Observation) and (self.facts, self.swept) == (other.facts, other.swept)

    def __hash__(self) -> int:
        return hash((self.facts, self.swept))

    def __repr__(self) -> str:
        return f"Observation({dict(self.facts)!r}, {self.swept!r})"

    def __str__(self) -> str:
        return f"{{{', '.join((*self.shown, *self.agents))}}}"

    def __contains__(self, name: object) -> bool:
        return isinstance(name, str) and (self.fact(name).shown or self.fact(agent_key(name)).shown)

    @property
    def shown(self) -> tuple[Name, ...]:
        """The nodes denoted, and the places whose children were requested; sorted."""
        return tuple(name for name, fact in self.facts if fact.shown and not name.startswith(AGENT))

    @property
    def members(self) -> tuple[Name, ...]:
        """The nodes that answer the query, sorted: for `CHILDREN(x)` the children, without x."""
        return tuple(filter(self.has_member, self.shown))

    def has_member(self, node: Name) -> bool:
        """Whether a node is shown as an answer, and not only as a place whose children were requested."""
        fact = self.fact(node)
        return fact.shown and (node not in self.swept.around or fact.parent in self.swept.around)

    @property
    def agents(self) -> tuple[Name, ...]:
        """The agents denoted (`HOSTED_AT`), sorted."""
        denoted = (name for name, fact in self.facts if fact.shown and name.startswith(AGENT))
        return tuple(name.removeprefix(AGENT) for name in denoted)

    @property
    def relations(self) -> tuple[Relation, ...]:
        """Every pair of σ_{A(P)} that was answered with yes, in canonical order."""
        pairs: list[Relation] = [Linked(link, name) for name, fact in self.facts for link in fact.links]
        pairs += [Parent(name, fact.parent) for name, fact in self.facts if fact.parent is not None]
        return tuple(sorted(pairs, key=str))

    def parent(self, node: Name) -> Name | None:
        """Return the observed parent of a node."""
        return self.fact(node).parent

    def children(self, place: Name) -> frozenset[Name]:
        """Return the observed children of a place."""
        return frozenset(name for name, fact in self.facts if fact.parent == place)

    def is_parent(self, place: Name, of: Iterable[Name]) -> bool:
        """Whether a place is the observed parent of one of these nodes, which must be all nodes of the observation.

        A plain family is indexed once for all places. A recording family is read node by node, so that each read is
        recorded.
        """
        if not isinstance(self.family, dict):
            return any(self.parent(node) == place for node in of)
        if self._places is None:
            self._places = frozenset(fact.parent for fact in self.family.values())
        return place in self._places

    def links(self, node: Name) -> frozenset[Name]:
        """Return the links on which a node was observed."""
        return frozenset(self.fact(node).links)

    def nodes(self) -> tuple[Name, ...]:
        """Return dom(L_q), sorted: the shown nodes, and every node of a pair."""
        places = {fact.parent for _, fact in self.facts if fact.parent is not None} - {REGION}
        return tuple(sorted(places.union(name for name, _ in self.facts if not name.startswith(AGENT))))


AGENT = "agent "
"""The prefix of an agent's name in an observation."""


def agent_key(agent: Name) -> Name:
    """Return the key of an agent in an observation, distinct from that of a node with the same name."""
    return AGENT + agent


Applied = QueryOperator | Literal["", "ALL"]


class QueryStep(NamedTuple):
    """One operator of a query, with its argument.

    Attributes:
        operator: The operator; `ALL`, or empty, for the nodes at the start of a query.
        names: The argument: nodes, sorted.
    """

    operator: Applied
    names: tuple[Name, ...]


Steps = tuple[QueryStep, ...]
"""A query as resolved at its evaluation: its operators, innermost first, and hence the slots that it looked at."""
