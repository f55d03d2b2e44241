"""Rules: from the paper's notation to patterns of relations, and to reactions with the values put in."""

import pytest
from elaborating import elaborated, told

from semantics.behaviours.expressions import Fault
from semantics.behaviours.reaction_rules import LinkVariable, NodeVariable, Pattern, PlaceVariable
from semantics.behaviours.values import Text

WORLD = """
signature {
  kind Area contains UAV, Boat, Box
  kind Boat driven carries Box contains UAV
  kind UAV driven carries Box
  kind Box
}
world {
  north0: Area = box (37.10, -8.60) (37.05, -8.50)
  south0: Area = box (37.04, -8.60) (37.00, -8.50)
  uav0: UAV = point (37.08, -8.55) linked wifi
  gcs_A: Box carried by uav0
}
"""


def reactions(text):
    return elaborated(WORLD + text).setting.program.reactions


def codes(text):
    return [code for code, *_ in told(WORLD + text)]


def reaction(rule, *arguments, host="uav0"):
    return reactions(f"rule r {rule}")["r"](host, *arguments)


def test_a_parameter_and_the_host_are_put_in():
    found = reaction("(b: Area) { HOST[c] || b.$0 -> b.(HOST[c] | $0) }", "south0")
    links = ((LinkVariable("c"), "uav0"),)
    assert found.redex == Pattern(("uav0", "south0"), (("uav0", PlaceVariable("region0")),), links, ("uav0",))
    assert found.reactum == Pattern(("south0", "uav0"), (("uav0", "south0"),), links)
    assert str(found) == "r(south0)"


def test_a_rule_written_in_place_prints_as_written_with_values():
    control = "control({ HOST_UAV || place.$0 -> place.(HOST_UAV | $0) })"
    text = f"BigActor a hosted_at uav0 with_behavior {{ let place = south0 {control} }}"
    found = reactions(text)
    assert str(found["rule#1"]("uav0", "south0")) == "uav0_UAV || south0.$0 -> south0.(uav0_UAV | $0)"


def test_what_is_no_entity_and_has_a_kind_is_a_variable():
    found = reaction("{ HOST || p_Area.(x_UAV[wifi] | $0) -> HOST || p_Area.(x_UAV | $0) }")
    p, x = NodeVariable("p", "Area"), NodeVariable("x", "UAV")
    assert found.redex.nodes == ("uav0", p, x)
    assert found.redex.links == (("wifi", x),)
    assert found.reactum.links == ()


def test_a_single_root_that_stays_needs_no_place():
    found = reaction("{ HOST.$0 || south0.$1 -> HOST.$0 || south0.$1 }")
    assert found.redex.parents == found.reactum.parents == found.redex.closed == ()


PLACE, BOAT, BOX = PlaceVariable("region0"), NodeVariable("x", "Boat"), NodeVariable("x", "Box")


@pytest.mark.parametrize(
    ("rule", "before", "after"),
    [
        ("HOST.(gcs_A | $0) -> HOST.(gcs_A | $0)", {("gcs_A", "uav0")}, {("gcs_A", "uav0")}),
        (
            "HOST | x_Boat.$0 -> x_Boat.$0 | HOST",
            {("uav0", PLACE), (BOAT, PLACE)},
            {("uav0", PLACE), (BOAT, PLACE)},
        ),
        (
            "HOST.(x_Box | $0) -> HOST.$0 | x_Box",
            {(BOX, "uav0"), ("uav0", PLACE)},
            {("uav0", PLACE), (BOX, PLACE)},
        ),
        ("HOST || x_Boat.$0 -> x_Boat.$0 || HOST", set(), set()),
    ],
    ids=[
        "a name that looks like a kind's",
        "one region",
        "a root that was nested",
        "single roots in another order",
    ],
)
def test_roots_of_one_region_share_their_parent_and_single_ones_have_none(rule, before, after):
    found = reaction(f"{{ {rule} }}")
    assert (set(found.redex.parents), set(found.reactum.parents)) == (before, after)


def test_two_regions_may_change_places():
    found = reaction("{ HOST | x_Boat.$0 || y_UAV -> y_UAV | x_Boat.$0 || HOST }")
    y = NodeVariable("y", "UAV")
    assert ("uav0", PlaceVariable("region0")) in found.redex.parents
    assert ("uav0", PlaceVariable("region1")) in found.reactum.parents
    assert (y, PlaceVariable("region0")) in found.reactum.parents


@pytest.mark.parametrize(
    ("rule", "code"),
    [
        ("{ HOST || x_UAV -> HOST | x_UAV }", "LS504"),  # whose place is meant?
        ("{ HOST || 1 -> HOST || x_UAV }", "LS502"),
        ("{ HOST || south0.$0 -> HOST || south0.1 }", "LS502"),
        ("{ HOST || south0.$0 || north0.$1 -> HOST || south0.($0 | $1) || north0 }", "LS503"),
        ("{ HOST | $0 || south0 -> HOST || south0.$0 }", "LS503"),
        ("{ HOST || x -> HOST || x }", "LS201"),
        ("{ HOST[wify] || uav0_UAV -> HOST[wife] || uav0_UAV }", "LS201"),
        ("{ HOST[control:gcs9] -> HOST[control:gcs9] }", "LS201"),
        ("{ HOST || uav0_Boat -> HOST || uav0_Boat }", "LS507"),
        ("{ HOST || uav0 || uav0_UAV -> HOST || uav0 || uav0_UAV }", None),
        ("{ HOST || south0.(x_Area | $0) -> HOST || south0.(x_Area | $0) }", "LS506"),
        ("{ HOST || gcs_A.(x_UAV | $0) -> HOST || gcs_A.$0 | x_UAV }", "LS506"),
        ("{ HOST.$0 || north0.$1 || south0.$2 -> HOST.$0 || south0.(north0.$1 | $2) }", "LS506"),
    ],
)
def test_what_a_rule_cannot_do_is_a_mistake(rule, code):
    found = codes(f"rule r {rule}")
    assert code is None or code in found


def test_an_argument_that_is_no_node_of_its_kind_is_a_fault():
    make = reactions("rule go(b: Area) { HOST || b.$0 -> b.(HOST | $0) }")["go"]
    for given, said in (
        ("uav0", "b is of kind Area, and uav0 is of kind UAV"),
        ("nowhere", "a node was expected for b, not nowhere"),
        (Text("uav0"), 'a node was expected for b, not "uav0"'),
    ):
        with pytest.raises(Fault, match=said):
            make("uav0", given)


def test_a_control_that_can_be_true_for_one_of_the_hosts_is_left_to_the_run():
    text = """
    def go(p) = {{ control(MOVE_HOST_TO p) }}
    BigActor a hosted_at uav0 with_behavior {{ control(MOVE_HOST_TO south0) {} }}
    """
    assert reactions(text.format("migrate(gcs_A)"))
    assert codes(text.format("control(MOVE_HOST_TO gcs_A)")) == ["LS506"]
    assert reactions(text.format("go(gcs_A)"))  # not known without a run
