"""Provenance: the observations that a value or a step depends on, and the changes to them since, with their authors.

It is the race monitor's memory. A stored observation is a dependency without a question; a test adds the question.
"""

from collections.abc import Collection, Iterable
from dataclasses import dataclass, replace

from semantics.behaviours.observations import AGENT, Observation, Query, Steps
from semantics.state.signature import Name

Key = tuple[str, ...]
"""A question to an observation, or a slot of A(P): `("in", "uav0")`, `("parent", "uav0")`."""

SLOT = "slot "
"""The prefix of a key that names a slot of A(P) instead of a question."""

EVERYTHING: Key = ("all",)
"""The question for the whole observation."""

MEMBERS: Key = ("members",)
"""The question for the names that the observation shows, regardless of their places and links."""

SIZE: Key = ("size",)
"""The question for the number of these names."""

ANY: Name = "*"
"""Stands, in a key or among agents, for every name."""

OTHERS: Name = ""
"""The author of changes by any agent that can never hold the dependency itself."""

Mark = tuple[Key, Name]
"""A changed key, and the author of the change."""


@dataclass(frozen=True, slots=True)
class Dependency:
    """A dependency on one observation.

    Attributes:
        query: The query about A(P).
        steps: The query as resolved at the `sense`: `PARENT(HOST)` is the host's place at that time.
        changed: The answers and slots of A(P) changed since the `sense`, with the authors; sorted.
        asked: The tested question; None for a stored observation.
        computed: Whether a value was computed from it, or is it; otherwise it only decided a step.
    """

    query: Query
    steps: Steps
    changed: tuple[Mark, ...] = ()
    asked: Key | None = None
    computed: bool = False

    @property
    def stale(self) -> bool:
        """Whether an agent that can never hold it has changed the tested answer; no other change matters then."""
        return (self.asked, OTHERS) in self.changed

    def testing(self, key: Key) -> "Dependency":
        """Return the dependency on one answer of this observation."""
        return replace(self, asked=key).having(self.changed)

    def having(self, marks: Iterable[Mark]) -> "Dependency":
        """Return the dependency with these marks, without those that no later question needs.

        A tested dependency keeps only the marks of the tested answer, and of slots, which a redex may use.
        """
        changed = tuple(sorted({mark for mark in marks if self.asked in (None, mark[0]) or is_slot(mark[0])}))
        if self.asked is not None and (self.asked, OTHERS) in changed:
            return replace(self, steps=(), changed=((self.asked, OTHERS),))
        return replace(self, changed=changed)

    def deciding(self) -> "Dependency":
        """Return the dependency of a step that it only decided."""
        return replace(self, computed=False)

    def held(self, holder: Name, heirs: Collection[Name]) -> "Dependency":
        """Return the dependency as its holder keeps it, given the heirs: the agents that may come to hold it too.

        The holder knows its own changes. Their marks are kept only for answers that a value was computed from, for
        receivers of that value. The name of any other author is kept only if it is an heir.
        """
        named = {holder, *heirs}
        return self.having(
            (key, author if author in named or ANY in named else OTHERS)
            for key, author in self.changed
            if author != holder or (self.computed and not is_slot(key))
        )


Provenance = frozenset[Dependency]
NOTHING: Provenance = frozenset()


def is_slot(key: Key) -> bool:
    """Whether a key names a slot of A(P), and not a question."""
    return key[0].startswith(SLOT)


def asking(provenance: Provenance, keys: tuple[Key, ...]) -> Provenance:
    """Return the provenance of a test: tested answers of stored observations, all dependencies of computed values."""
    stored = [each for each in provenance if each.asked is None]
    return provenance.difference(stored) | {each.testing(key) for each in stored for key in keys}


def deciding(provenance: Provenance) -> Provenance:
    """Return the provenance of a decision: only tested answers, since a merely stored observation decides nothing."""
    return frozenset(each.deciding() for each in provenance if each.asked is not None)


def computed(provenance: Provenance) -> Provenance:
    """Return the provenance of a value that is computed from dependencies."""
    return frozenset(replace(each, computed=True) for each in provenance)


def causal_dependencies(provenance: Provenance) -> Provenance:
    """Return the dependencies that only caused a message or an observation, regardless of its content."""
    return frozenset(each for each in provenance if not each.computed)


def held(provenance: Provenance, holder: Name, heirs: Collection[Name]) -> Provenance:
    """Return the provenance as its holder keeps it, given the heirs (`Dependency.held`)."""
    return frozenset(each.held(holder, heirs) for each in provenance)


def differences(
    before: Observation, after: Observation, names: Iterable[Name] | None = None
) -> frozenset[Key]:
    """Return the questions with different answers in two observations of one query.

    If both swept the same and can differ only about `names`, only those names are compared.
    """
    everywhere = names is None or before.swept != after.swept
    about = {name for name, _ in (*before.facts, *after.facts)} if everywhere else frozenset(names or ())
    keys: set[Key] = set()
    gained = 0
    for name in sorted(about):
        old, new = before.fact(name), after.fact(name)
        was, now = before.has_member(name), after.has_member(name)
        if old.shown != new.shown:
            keys.add(("in", name.removeprefix(AGENT)))
        if was != now:
            keys.add(MEMBERS)
            gained += now - was
        if old.parent != new.parent:
            places = {place for place in (old.parent, new.parent) if place is not None}
            keys |= {("parent", name), *(("children", place) for place in places)}
        if old.links != new.links:
            keys.add(("links", name))
    if gained:
        keys.add(SIZE)
    return frozenset(keys | {EVERYTHING}) if keys or before.swept != after.swept else frozenset()
