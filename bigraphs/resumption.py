"""Resumption: a saved search becomes the state of an exploration again, if it agrees with the system.

The search is repeated for some seconds, and must find the same. All further states are distinct and well-formed, and
some random ones are expanded again. So a small search is compared as a whole.
"""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from itertools import islice
from random import Random
from typing import Final

from bigraphs.engine.decoding import from_key
from bigraphs.engine.frontier import Frontier
from bigraphs.engine.intern_tables import REFERENCE
from bigraphs.engine.machine import Machine
from bigraphs.engine.occurrences import Spot
from bigraphs.engine.state_arrays import codes_in, to_key
from bigraphs.errors import BigraphError
from bigraphs.saved_search import MOST_NODES, SavedSearch, SearchContent, read
from bigraphs.state_store import StateStore
from bigraphs.transitions import TransitionKind

REPEATED: Final = 2.0
"""The seconds for which the search is repeated."""
SAMPLED: Final = 2.0
"""The seconds for which random states are expanded again."""
MOST_SAMPLED: Final = 100_000


def resume(store: StateStore, saved: SavedSearch, place: str) -> float:
    """Continue in a new store from a saved search; return the seconds that it has taken.

    Raises:
        BigraphError: It is damaged, or the system cannot run.
    """
    try:
        return _resume(store, saved)
    except BigraphError:
        raise
    except (ValueError, IndexError, KeyError, TypeError, OverflowError) as error:
        message, hint = f"{place}: this checkpoint is damaged: {error}", "leave --resume out to begin anew"
        raise BigraphError("checkpoint", message, hint) from error


def _resume(store: StateStore, saved: SavedSearch) -> float:
    found = read(store.machine, saved)
    if store.max_states is not None and len(found.keys) > store.max_states:
        raise ValueError(f"it has {len(found.keys):,} states, more than the limit of {store.max_states:,}")
    store.begin()
    _repeat(store, found)
    if store.expanded < found.expanded:
        _check_states(store, found)
        _check_sample(store, found)
        _take_over(store, found)
    elif (len(store), store.occurrences) != (len(found.keys), found.occurrences):
        raise ValueError("it has other states than its system")
    return found.seconds


def _repeat(store: StateStore, found: SearchContent) -> None:
    """Repeat the beginning of a search; raise ValueError if the saved one differs."""
    end = time.monotonic() + REPEATED
    while store.expanded < found.expanded and time.monotonic() < end:
        if not store.expand_next():
            break
    rows, states, transitions = store.machine.world.rows, len(store), len(store.targets)
    same = (
        found.rows[: len(rows)] == rows
        and found.keys[:states] == list(store.keys)
        and found.holding[:states] == list(store.holding)
        and found.first[: len(store.first)] == store.first
        and found.targets[:transitions] == store.targets
        and found.kinds[:transitions] == list(store.kinds)
    )
    if not same:
        raise ValueError("its first states are not those of its system")


def _check_states(store: StateStore, found: SearchContent) -> None:
    """Raise ValueError unless each key is that of a state of this world, and none is too large."""
    world, sizes, refers = store.machine.world, list[int](), list[frozenset[int]]()
    for label, ports, kids, _ in found.rows:
        sizes.append(1 + sum(sizes[kid] for kid in kids))
        if world.sharing:
            own = frozenset(ports if label == REFERENCE else ())
            refers.append(own.union(*(refers[kid] for kid in kids)))
    for key in found.keys:
        store.machine.pause()
        parts = codes_in(world, key)
        if to_key(world, parts) != key or sum(sizes[code] for codes in parts for code in codes) > MOST_NODES:
            raise ValueError("a state has too many nodes, or a wrong key")
        if world.sharing:
            *regions, shared = parts
            tops = [code for codes in regions for code in codes]
            if any(found.rows[code][3] for code in tops) or not all(found.rows[code][3] for code in shared):
                raise ValueError("a shared node is in no place")
            inside = {found.rows[code][3]: refers[code] for code in shared}
            _check_sharing(frozenset[int]().union(*(refers[code] for code in tops)), inside)


def _check_sharing(tops: frozenset[int], inside: dict[int, frozenset[int]]) -> None:
    """Raise ValueError unless each shared node is in some place, and none is inside itself."""
    if tops.union(*inside.values()) != set(inside):
        raise ValueError("a shared node is in no place")
    while inside:
        outer = set(inside) - frozenset[int]().union(*inside.values())
        if not outer:
            raise ValueError("a shared node is inside itself")
        inside = {each: within for each, within in inside.items() if each not in outer}


def _check_sample(store: StateStore, found: SearchContent) -> None:
    """Expand random states again, in a world of their own; raise ValueError if the saved ones differ."""
    machine = Machine(store.machine.system, store.machine.pause)
    for number, row in enumerate(found.rows):
        if machine.world.code(row) != number:
            raise ValueError("it has a subtree twice")
    end, states = time.monotonic() + SAMPLED, len(found.keys)
    for state in Random().sample(range(states), min(states, MOST_SAMPLED)):
        if time.monotonic() > end:
            return
        spot = Spot(from_key(machine.world, found.keys[state]), machine.index)
        if tuple(sorted(machine.holding(spot.state))) != found.holding[state]:
            raise ValueError(f"other predicates hold in state {state:,}")
        if state < found.expanded and not _is_expansion(machine, spot, found, state):
            raise ValueError(f"state {state:,} has other transitions")


def _is_expansion(machine: Machine, spot: Spot, found: SearchContent, state: int) -> bool:
    """Return whether the transitions of a state are the saved ones, in any order."""
    again = StateStore(machine)
    again.waiting = Frontier(spot)
    again.expand(spot, 0)
    mine = {
        (again.visited.texts[target], kind.action): kind
        for target, kind in zip(again.targets, again.kinds, strict=True)
    }
    leaving = range(found.first[state], found.first[state + 1])
    theirs = {
        (
            machine.labelling.canonical_of(found.keys[found.targets[number]]),
            found.kinds[number].action,
        ): number
        for number in leaving
    }
    return len(theirs) == len(leaving) == len(mine) and all(
        key in mine and _is_alike(mine[key], found.kinds[number]) for key, number in theirs.items()
    )


def _is_alike(one: TransitionKind, other: TransitionKind) -> bool:
    """Return whether two transitions are equal; the order of occurrences affects the last digits of a weight."""
    return math.isclose(one.weight, other.weight) and one[1:] == other[1:]


def _take_over(store: StateStore, found: SearchContent) -> None:
    """Add the rest of a saved search to a store; raise ValueError for an equal subtree or state."""
    world, states, transitions = store.machine.world, len(store), len(store.targets)
    for row in islice(found.rows, len(world.rows), None):
        world.code(row)
    for state in range(states, len(found.keys)):
        store.machine.pause()
        raw = found.keys[state]
        key = store.machine.labelling.canonical_of(raw)
        if store.visited.find(key) >= 0:
            raise ValueError("it has a state twice")
        store.add(key, raw, found.found_from[state], found.holding[state])
    for number in range(transitions, len(found.kinds)):
        store.kinds.append(found.kinds[number])
    store.targets.extend(found.targets[transitions:])
    store.first.extend(found.first[len(store.first) :])
    counted = sum(kind.occurrences for kind in found.kinds)
    if found.occurrences < counted or (found.occurrences > counted and not store.machine.instantaneous):
        raise ValueError("its counts are wrong")
    store.occurrences = found.occurrences
    store.waiting = Frontier(store.start)
    for spot in _waiting(store, found):
        store.waiting.append(spot)


def _waiting(store: StateStore, found: SearchContent) -> Iterator[Spot]:
    """Yield the waiting states, each with its nodes in their slots."""
    machine, slots = store.machine, iter(found.slots)
    for number in range(found.expanded, len(found.keys)):
        machine.pause()
        state = from_key(machine.world, found.keys[number], slots)
        if state.key() != found.keys[number]:
            raise ValueError("a waiting state has its nodes in wrong slots")
        yield Spot(state, machine.index)
    if next(slots, None) is not None:
        raise ValueError("it has too many slots")
