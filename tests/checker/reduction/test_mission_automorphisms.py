"""What a transposition changes is looked for where it is mentioned; the whole mission, renamed, says the same."""

from itertools import combinations

import pytest
from shipped import UNTIMED

from checker.reduction.alpha_equivalence import Pairing, Unlike
from checker.reduction.configuration_renaming import Renaming, requested_keys
from checker.reduction.mission_automorphisms import Automorphisms, restated
from specs.elaboration import load_mission

OF_THE_WORLD = ("they are not in the same place", "they are on different channels", "the initial state of")


def pairings(c):
    """Return the pairing of each two agents or entities that have one."""
    found = []
    agents = sorted(c.alpha.names())
    for one, other in (
        *combinations(agents, 2),
        *combinations(sorted(set(c.setting.kinds) - set(agents)), 2),
    ):
        pairing = Pairing(c)
        try:
            pairing.agents(one, other) if one in agents else pairing.pair(pairing.names, one, other)
            found.append(pairing)
        except Unlike:
            continue
    return found


def both(pairs):
    return {**pairs, **{other: one for one, other in pairs.items()}}


def text_is_kept(c, renaming):
    """Tell whether each statement of a program, renamed, is the statement of the renamed number."""
    statements = c.setting.program.statements
    return all(
        restated(renaming, statement) == statements[renaming.numbers.get(number, number)]
        for number, statement in enumerate(statements)
    )


@pytest.mark.parametrize("name", UNTIMED)
def test_the_whole_mission_renamed_gives_the_same_verdict(name):
    c = load_mission(name).initial
    automorphisms = Automorphisms(c)
    for pairing in pairings(c):
        plain = Renaming(both(pairing.names), both(pairing.numbers), both(pairing.variables))
        try:
            found = automorphisms.transposition(pairing)
            assert text_is_kept(c, found)
            assert found.configuration(c) == c
        except Unlike as reason:
            if str(reason).startswith("the text distinguishes them"):
                assert not text_is_kept(c, plain)
            elif str(reason).startswith(OF_THE_WORLD):
                assert plain.configuration(c) != c


def test_a_look_is_asked_for_all_that_a_renaming_may_move():
    c = load_mission("spill_watch").initial
    cell, placement = next((cell, value) for cell, value in c.state.items() if cell[0] == "placement")
    things = requested_keys(
        lambda renaming: (renaming.cell(cell), renaming.content(cell, placement, unordered=False))
    )
    assert cell in things
    assert cell[1] in things
