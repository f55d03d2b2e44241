"""Missions from their texts: what they come to, and what is told of those that are refused."""

from pathlib import Path

import pytest

from semantics.successors import successors
from specs.diagnostics import MissionError
from specs.elaboration import elaborate
from specs.elaboration.variation import AS_WRITTEN
from specs.parser import parse_bytes


def elaborated(text, folder=Path(), variation=AS_WRITTEN):
    source, mission = parse_bytes("test.mission", text.encode())
    return elaborate(mission, source, folder, variation)


def mistakes(text, folder=Path(), variation=AS_WRITTEN):
    """Return what is told of a mission that is refused."""
    with pytest.raises(MissionError) as refused:
        elaborated(text, folder, variation)
    return refused.value.diagnostics


def told(text, folder=Path()):
    """Return the codes, messages and hints of a mission that is refused."""
    return [(each.code.number, each.message, each.hint) for each in mistakes(text, folder)]


def shown(text, folder=Path()):
    """Return the words at which a mission is refused, each with its message and hint."""
    found = mistakes(text, folder)
    return [(text[each.span.start : each.span.end], each.message, each.hint) for each in found]


def reachable(mission):
    """Return the configurations that are reachable, by the rules alone, and how many transitions lead to them."""
    seen, front, transitions = {mission.initial}, [mission.initial], 0
    while front:
        for step in successors(front.pop()):
            transitions += 1
            if step.target not in seen:
                seen.add(step.target)
                front.append(step.target)
    return seen, transitions
