"""What a trace rests on: a step changes something of its agent, or the queue, so that only who changed is asked."""

import pytest
from shipped import ALL

from checker import Engine, Limits, explore
from semantics.successors import expand
from specs.elaboration import load_mission


@pytest.mark.parametrize("name", ALL)
def test_an_agents_step_changes_a_cell_of_that_agent_or_of_nobody(name):
    found = explore(load_mission(name).initial, engine=Engine.REFERENCE, limits=Limits(configurations=150))
    for source in found.configurations:
        expansion = expand(source)
        for step in expansion.transitions + expansion.out_of_turn:
            changed = step.target.state.changed(source.state)
            named = {part for cell in changed for part in cell[1:]}
            of_nobody = not changed or any(len(cell) == 1 for cell in changed)
            assert step.label.agent is None or step.label.agent in named or of_nobody
