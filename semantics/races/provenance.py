"""Provenance: the observations that a value or a step rests on, and what others have changed in them.

The race monitor's memory. A stored observation is a dependency with no question yet; testing it asks one.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace

from semantics.behaviours.observations import AGENT, Observation, Query, Steps
from semantics.state.signature import Name

Key = tuple[str, ...]
"""One thing that an observation may be asked, or one slot of A(P): `("in", "uav0")`, `("parent", "uav0")`."""

SLOT = "slot "
"""How the first word of a key begins that names a slot of A(P) instead of an answer."""

EVERYTHING: Key = ("all",)
"""The question whose answer is the whole observation."""


@dataclass(frozen=True, slots=True)
class Dependency:
    """One observation, by its query.

    Attributes:
        query: What was asked of A(P).
        steps: The query as it was resolved at the `sense`: `PARENT(HOST)` is the place where the host was then.
        changed: Which answers and slots of A(P) others than its holder have changed since the `sense`; sorted.
        asked: What was tested of it; None for the observation as it is stored.
        own: Of what a value was computed from, which answers its holder has changed itself; sorted. None for what only
            decided what was done: that its holder knows.
    """

    query: Query
    steps: Steps
    changed: tuple[Key, ...] = ()
    asked: Key | None = None
    own: tuple[Key, ...] | None = None

    @property
    def stale(self) -> bool:
        """Whether the tested answer has been changed."""
        return self.asked in self.changed

    def testing(self, key: Key) -> "Dependency":
        """Return the dependency on one answer of this observation."""
        return replace(self, asked=key).having(self.changed, self.own)

    def having(self, changed: Iterable[Key], own: Iterable[Key] | None) -> "Dependency":
        """Return the dependency with what others, and its holder, have changed, forgetting what nobody asks any more.

        Of what was tested that is all but the answer itself and the slots, which a redex may use; once the answer has
        been changed nothing else matters either.
        """
        kept, known, steps = frozenset(changed), frozenset(own or ()), self.steps
        if self.asked in kept:
            kept, known, steps = frozenset({self.asked}), frozenset(), ()
        elif self.asked is not None:
            kept = frozenset(key for key in kept if key[0].startswith(SLOT))
            known &= {self.asked}
        keys = None if own is None else tuple(sorted(known))
        return replace(self, steps=steps, changed=tuple(sorted(kept)), own=keys)

    def deciding(self) -> "Dependency":
        """Return the dependency of what was only done because of it."""
        return replace(self, own=None)

    def handed(self) -> "Dependency":
        """Return the dependency as another agent gets it, to whom all that was changed is others' doing."""
        return self if self.own is None else self.having({*self.changed, *self.own}, ())


Provenance = frozenset[Dependency]
NOTHING: Provenance = frozenset()


def asking(provenance: Provenance, keys: tuple[Key, ...]) -> Provenance:
    """Return what a test rests on: of stored observations the answers asked, of computed values all they came from."""
    stored = [each for each in provenance if each.asked is None]
    return provenance.difference(stored) | {each.testing(key) for each in stored for key in keys}


def deciding(provenance: Provenance) -> Provenance:
    """Return what a decision rests on: only answers, since an observation that is merely held decides nothing."""
    return frozenset(each.deciding() for each in provenance if each.asked is not None)


def told_because(provenance: Provenance) -> Provenance:
    """Return what it rests on that a message was sent, whatever it says."""
    return frozenset(each for each in provenance if each.own is None)


def handed(provenance: Provenance) -> Provenance:
    """Return what a value rests on in the hands of another agent than the one that computed it."""
    return frozenset(each.handed() for each in provenance)


def differences(
    before: Observation, after: Observation, names: Iterable[Name] | None = None
) -> frozenset[Key]:
    """Return the questions that two observations of one query answer differently.

    Where it is known about which `names` alone they may differ, if they swept the same, only those are compared.
    """
    everywhere = names is None or before.swept != after.swept
    about = {name for name, _ in (*before.facts, *after.facts)} if everywhere else frozenset(names or ())
    keys: set[Key] = set()
    for name in sorted(about):
        old, new = before.fact(name), after.fact(name)
        if old.shown != new.shown:
            keys.add(("in", name.removeprefix(AGENT)))
        if old.parent != new.parent:
            places = {place for place in (old.parent, new.parent) if place is not None}
            keys |= {("parent", name), *(("children", place) for place in places)}
        if old.links != new.links:
            keys.add(("links", name))
    return frozenset(keys | {EVERYTHING}) if keys or before.swept != after.swept else frozenset()
