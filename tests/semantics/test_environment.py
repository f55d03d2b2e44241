"""The clauses of the environment section: what each allows, and what it leaves alone."""

from small_missions import SHAPES, aboard, mission

from semantics.environment import Appears, Drifts, Drops, Leaves, Vanishes
from semantics.state.physical_model import InTransit


def effects(c, clause):
    return list(clause.effects(c.structure.physical))


def after(c, clause, number=0):
    return c.with_(effects(c, clause)[number][1])


SPOTS = (SHAPES["crate"], SHAPES["u0"], SHAPES["spill"])
DRIFT = Drifts("crate", SPOTS, ("x", "y", "z"), ((1,), (0, 2), (1,)), (1,))


def test_a_drift_goes_from_each_placement_to_those_that_may_follow_it():
    c = mission(["sea", "base", "crate"])
    assert [words for words, _ in effects(c, DRIFT)] == ["crate drifts to y"]
    assert [words for words, _ in effects(after(c, DRIFT), DRIFT)] == [
        "crate drifts to x",
        "crate drifts to z",
    ]


def test_a_drift_begins_with_its_first_placements():
    c = mission(["sea", "crate"], placed={"crate": SHAPES["u1"]})
    assert [words for words, _ in effects(c, DRIFT)] == ["crate drifts to y"]


def test_what_is_absent_carried_or_in_transit_does_not_drift():
    for placement in (None, aboard("ship", "crate"), InTransit(SHAPES["crate"], "sea")):
        assert effects(mission(["sea", "ship", "crate"], placed={"crate": placement}), DRIFT) == []


def test_what_a_drifting_carrier_holds_goes_along():
    drift = Drifts("ship", (SHAPES["ship"], SHAPES["boat"]), ("x", "y"), ((1,), (0,)), ())
    c = after(mission(["sea", "ship", "crate"], placed={"crate": aboard("ship", "crate")}), drift)
    assert c.structure.physical.position("crate") == SHAPES["boat"]


def test_a_channel_drops_and_returns_only_if_it_says_so():
    for returns, number in ((True, 1), (False, 0)):
        clause = Drops("w", returns)
        c = mission(["u0"], channels={"u0": ["w"]}, environment=(clause,))
        dropped = after(c, clause)
        assert dropped.structure.physical.links("u0") == ()
        assert len(effects(dropped, clause)) == number
    assert after(dropped, Drops("w", returns=True)).structure.physical.links("u0") == ("w",)


def test_an_entity_leaves_one_channel_and_returns_only_if_it_says_so():
    clause = Leaves("u0", "w", returns=True)
    c = mission(["u0", "u1"], channels={"u0": ["v", "w"], "u1": ["w"]}, environment=(clause,))
    left = after(c, clause)
    assert (left.structure.physical.links("u0"), left.structure.physical.links("u1")) == (("v",), ("w",))
    assert after(left, clause) == c
    assert effects(left, Leaves("u0", "w", returns=False)) == []


def test_an_entity_does_not_return_to_a_channel_that_it_never_left():
    clause = Leaves("u0", "w", returns=True)
    assert effects(mission(["u0"], channels={"u0": ["v"]}, environment=(clause,)), clause) == []


def test_what_a_control_has_brought_back_and_taken_off_does_not_return():
    clause = Leaves("u0", "w", returns=True)
    c = after(mission(["u0"], channels={"u0": ["v", "w"]}, environment=(clause,)), clause)
    for channels in (("v", "w"), ("v",)):
        c = c.with_(c.structure.physical.joining("u0", frozenset(channels)))
    assert effects(c, clause) == []


def test_an_absent_entity_appears_with_its_channels_and_a_present_one_does_not():
    clause = Appears("u0", (SHAPES["u0"], SHAPES["u1"]), ("w",))
    c = mission(["base", "u0"], placed={"u0": None})
    assert [words for words, _ in effects(c, clause)] == ["u0 appears (1)", "u0 appears (2)"]
    there = after(c, clause)
    assert there.structure.physical.links("u0") == ("w",)
    assert "u0" not in there.structure.logical
    assert effects(there, clause) == []


def test_nothing_appears_on_a_carrier_that_is_absent():
    clause = Appears("crate", (aboard("ship", "crate"),))
    assert effects(mission(["ship", "crate"], placed={"crate": None, "ship": None}), clause) == []
    assert len(effects(mission(["ship", "crate"], placed={"crate": None}), clause)) == 1


def test_what_is_absent_does_not_vanish():
    c = mission(["base", "u0"])
    assert effects(after(c, Vanishes("u0")), Vanishes("u0")) == []
