"""Reduction by the plain rewriting of the room: small systems, exhaustively."""

from collections import deque

from bigraphs.canonical_form import canonical
from bigraphs.rewriting import successors


def one_step(rules, state):
    """Return the states one step further, up to isomorphism."""
    return {canonical(found) for rule in rules for _, found in successors(rule, state)}


def settled(rules, state):
    """Apply instantaneous rules until none applies: they lead to one state, whichever is taken."""
    while following := one_step(rules, state):
        state = min(following, key=repr)
    return state


def explored(system):
    """Return states and steps between them, no state in which an instantaneous rule applies."""
    fast = [rule.reaction() for each in system.classes if each.instantaneous for rule in each.rules]
    slow = [rule.reaction() for each in system.classes if not each.instantaneous for rule in each.rules]
    first = settled(fast, canonical(system.initial))
    states, steps, waiting = {first}, set(), deque([first])
    while waiting:
        state = waiting.popleft()
        for found in {settled(fast, each) for each in one_step(slow, state)}:
            steps.add((state, found))
            if found not in states:
                states.add(found)
                waiting.append(found)
    return states, steps
