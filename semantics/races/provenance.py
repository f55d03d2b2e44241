"""Provenance: the observations that a value or a step rests on, and who has changed what in them since.

The race monitor's memory. A stored observation is a dependency with no question yet; testing it asks one.
"""

from collections.abc import Collection, Iterable
from dataclasses import dataclass, replace

from semantics.behaviours.observations import AGENT, Observation, Query, Steps
from semantics.state.signature import Name

Key = tuple[str, ...]
"""One thing that an observation may be asked, or one slot of A(P): `("in", "uav0")`, `("parent", "uav0")`."""

SLOT = "slot "
"""How the first word of a key begins that names a slot of A(P) instead of an answer."""

EVERYTHING: Key = ("all",)
"""The question whose answer is the whole observation."""

MEMBERS: Key = ("members",)
"""The question which names the observation shows, wherever and on whichever links they were seen."""

SIZE: Key = ("size",)
"""The question how many they are."""

ANY: Name = "*"
"""Stands, in a key or among agents, for every name."""

OTHERS: Name = ""
"""Stands, as an author, for whoever will never hold what rests on what it has changed."""

Mark = tuple[Key, Name]
"""What was changed, and by whom."""


@dataclass(frozen=True, slots=True)
class Dependency:
    """One observation, by its query.

    Attributes:
        query: What was asked of A(P).
        steps: The query as it was resolved at the `sense`: `PARENT(HOST)` is the place where the host was then.
        changed: Which answers and slots of A(P) have been changed since the `sense`, and by whom; sorted.
        asked: What was tested of it; None for the observation as it is stored.
        computed: Whether a value was computed from it, or is it; otherwise it only decided what was done.
    """

    query: Query
    steps: Steps
    changed: tuple[Mark, ...] = ()
    asked: Key | None = None
    computed: bool = False

    @property
    def stale(self) -> bool:
        """Whether another has changed the tested answer, whoever may come to hold this: nothing else matters then."""
        return (self.asked, OTHERS) in self.changed

    def testing(self, key: Key) -> "Dependency":
        """Return the dependency on one answer of this observation."""
        return replace(self, asked=key).having(self.changed)

    def having(self, marks: Iterable[Mark]) -> "Dependency":
        """Return the dependency with these marks, forgetting what nobody asks any more.

        Of what was tested that is all but the answer itself and the slots, which a redex may use.
        """
        changed = tuple(sorted({mark for mark in marks if self.asked in (None, mark[0]) or is_slot(mark[0])}))
        if self.asked is not None and (self.asked, OTHERS) in changed:
            return replace(self, steps=(), changed=((self.asked, OTHERS),))
        return replace(self, changed=changed)

    def deciding(self) -> "Dependency":
        """Return the dependency of what was only done because of it."""
        return replace(self, computed=False)

    def held(self, holder: Name, heirs: Collection[Name]) -> "Dependency":
        """Return the dependency as an agent holds it, from whom its heirs may come to hold it.

        What it has changed itself it knows: that is remembered only of answers that a value was computed from, for who
        is told that value. Who else changed something matters only if that is one of the heirs.
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
    """Tell whether a key names a slot of A(P), and no answer."""
    return key[0].startswith(SLOT)


def asking(provenance: Provenance, keys: tuple[Key, ...]) -> Provenance:
    """Return what a test rests on: of stored observations the answers asked, of computed values all they came from."""
    stored = [each for each in provenance if each.asked is None]
    return provenance.difference(stored) | {each.testing(key) for each in stored for key in keys}


def deciding(provenance: Provenance) -> Provenance:
    """Return what a decision rests on: only answers, since an observation that is merely held decides nothing."""
    return frozenset(each.deciding() for each in provenance if each.asked is not None)


def computed(provenance: Provenance) -> Provenance:
    """Return what a value rests on, as what it was computed from."""
    return frozenset(replace(each, computed=True) for each in provenance)


def told_because(provenance: Provenance) -> Provenance:
    """Return what it rests on that a message was sent, or an observation asked for, whatever it says."""
    return frozenset(each for each in provenance if not each.computed)


def held(provenance: Provenance, holder: Name, heirs: Collection[Name]) -> Provenance:
    """Return what something rests on in the hands of an agent, from whom its heirs may come to hold it."""
    return frozenset(each.held(holder, heirs) for each in provenance)


def differences(
    before: Observation, after: Observation, names: Iterable[Name] | None = None
) -> frozenset[Key]:
    """Return the questions that two observations of one query answer differently.

    Where it is known about which `names` alone they may differ, if they swept the same, only those are compared.
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
