"""The parts of a live run's state: each is frozen, unchanged parts are shared, and one module changes each."""

import ast
from dataclasses import FrozenInstanceError, fields
from pathlib import Path

import pytest
from live_missions import BETWEEN, TOUR, boat, flying, seen

import adapters.live
from adapters.live.live_state import LiveState

GO = "BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO east0) }"
PARTS = ("sightings", "commanded", "overrides", "agents", "due", "reported", "watched")
MODULES = tuple(Path(adapters.live.__file__).parent.glob("*.py"))


def on_its_way():
    run = flying(TOUR + GO)
    run.turn(0.0, boat((37.03, -8.63), 0.0))
    return run


def parts_of(state):
    return {name: getattr(state, name) for name in PARTS}


def test_the_parts_are_all_of_the_state_but_the_configuration_and_the_number_of_steps():
    assert [each.name for each in fields(LiveState)] == ["configuration", "number", *PARTS]


@pytest.mark.parametrize("name", PARTS)
def test_a_part_is_frozen(name):
    part = parts_of(on_its_way().state)[name]
    field = fields(part)[0].name
    with pytest.raises(FrozenInstanceError):
        setattr(part, field, getattr(part, field))


def test_a_turn_in_which_nothing_happens_keeps_all_parts():
    run = on_its_way()
    run.turn(1.0)
    before = parts_of(run.state)
    run.turn(2.0)
    assert [name for name, part in parts_of(run.state).items() if part is not before[name]] == []


def test_a_position_on_the_way_changes_only_the_sightings():
    run = on_its_way()
    run.turn(1.0)
    before, newest = parts_of(run.state), dict(run.state.sightings.newest)
    run.turn(2.0, seen("uav0", BETWEEN, 2.0))
    assert [name for name, part in parts_of(run.state).items() if part is not before[name]] == ["sightings"]
    assert before["sightings"].newest == newest


@pytest.mark.parametrize("module", MODULES, ids=lambda path: path.stem)
def test_a_part_is_changed_only_by_methods_of_its_module(module):
    """Other modules assign to a part of a turn only the result of one of its own methods."""
    for node in ast.walk(ast.parse(module.read_text())):
        if not isinstance(node, ast.Assign):
            continue
        for target in node.targets:
            if (
                isinstance(target, ast.Attribute)
                and target.attr in PARTS
                and module.stem != "turn_in_progress"
            ):
                assert isinstance(node.value, ast.Call), ast.unparse(node)
                assert isinstance(node.value.func, ast.Attribute), ast.unparse(node)
                owner = ast.unparse(node.value.func.value)
                assert owner in (ast.unparse(target), "before"), ast.unparse(node)
