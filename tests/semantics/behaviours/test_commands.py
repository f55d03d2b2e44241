"""The commands of the language: what each asks for, and that the table says all of them."""

import inspect

import pytest
from small_missions import aboard, logical_of

from semantics.behaviours import commands
from semantics.behaviours.commands import COMMANDS
from semantics.behaviours.reaction_rules import Sides, matches, moved, relinked, stays_forest

move_host_to, hand = COMMANDS["MOVE_HOST_TO"], COMMANDS["HAND"]


def test_the_table_has_every_command_that_is_defined_beside_it():
    defined = {
        each
        for _, each in inspect.getmembers(commands, inspect.isfunction)
        if inspect.signature(each).return_annotation == Sides
    }
    assert {command.sides for command in COMMANDS.values()} == defined


@pytest.mark.parametrize("command", COMMANDS.values(), ids=COMMANDS)
def test_a_command_has_an_operand_for_each_argument_and_involves_the_host(command):
    assert len({*command.operands}) == len(command.operands) == len(command.parts) - len(command.words)
    assert command.parts[0] in command.words
    assert commands.HOST in command.open.redex.nodes
    assert set(command.operands) <= set(command.open.redex.nodes)
    assert str(command.open) == command.form


def test_what_a_command_moves_follows_from_its_reaction():
    moves = {name: [(str(node), str(place)) for node, place in c.open.moves] for name, c in COMMANDS.items()}
    assert {name: pairs for name, pairs in moves.items() if pairs} == {
        "MOVE_HOST_TO": [("HOST", "place")],
        "MOVE": [("entity", "place")],
        "PUT": [("entity", "place")],
    }
    assert [name for name, command in COMMANDS.items() if command.travels] == ["MOVE_HOST_TO", "MOVE"]


def test_moving_to_where_the_host_is_believed_is_the_identity():
    logical = logical_of("base", "u0")
    reaction = move_host_to("u0", "base")
    (match,) = matches(reaction.redex, logical)
    assert moved(reaction, match) == ()


def test_a_host_does_not_move_into_itself_or_into_what_is_inside_it():
    logical = logical_of("sea", "ship", "crate", placed={"crate": aboard("ship", "crate")})
    assert matches(move_host_to("ship", "ship").redex, logical) == ()
    reaction = move_host_to("ship", "crate")
    (match,) = matches(reaction.redex, logical)
    assert not stays_forest(reaction, match, logical)


HANDED = {"gcs0": ["control:0"], "gcs1": ["control:1"]}


def test_handing_over_is_the_identity_if_the_vehicle_is_on_that_channel_already():
    logical = logical_of("u0", "gcs0", "gcs1", channels=HANDED | {"u0": ["control:0", "control:1"]})
    reaction = hand("gcs0", "u0", "gcs1")
    found = matches(reaction.redex, logical)
    assert found
    assert all(not lost for match in found for _, lost, _ in relinked(reaction, match, logical))


def test_handing_over_changes_the_vehicles_channel_and_nothing_else():
    logical = logical_of("u0", "gcs0", "gcs1", channels=HANDED | {"u0": ["control:0", "wifi"]})
    reaction = hand("gcs0", "u0", "gcs1")
    (match,) = matches(reaction.redex, logical)
    assert relinked(reaction, match, logical) == (("u0", frozenset({"control:0"}), frozenset({"control:1"})),)


def test_who_has_no_authority_cannot_hand_over():
    logical = logical_of("u0", "gcs0", "gcs1", channels=HANDED | {"u0": ["control:1"]})
    assert matches(hand("gcs0", "u0", "gcs1").redex, logical) == ()


def test_every_command_prints_as_it_is_written():
    shown = [str(COMMANDS[name]("h", *"uv"[: len(COMMANDS[name].operands)])) for name in sorted(COMMANDS)]
    assert shown == [
        "CONNECT_HOST_TO u",
        "DISCONNECT_HOST_FROM u",
        "HAND u TO v",
        "MOVE u TO v",
        "MOVE_HOST_TO u",
        "PUT u IN v",
    ]


def test_moves_print_their_ways_and_name_them_as_context():
    moving = COMMANDS["MOVE_HOST_TO"]("u0", "area", "base", "sea")
    assert str(moving) == "MOVE_HOST_TO area VIA base, sea"
    assert str(COMMANDS["MOVE"]("gcs0", "u0", "area", "base")) == "MOVE u0 TO area VIA base"
    assert moving.via == ("base", "sea")
    assert moving.redex.nodes == moving.reactum.nodes == ("u0", "area", "base", "sea")
    straight = move_host_to("u0", "area")
    assert (moving.redex.parents, moving.reactum.parents) == (
        straight.redex.parents,
        straight.reactum.parents,
    )


@pytest.mark.parametrize("way", [("area",), ("u0",), ("base", "base"), ("nowhere",)])
def test_a_way_by_what_is_named_twice_or_not_believed_matches_nothing(way):
    logical = logical_of("sea", "base", "area", "u0")
    assert matches(move_host_to("u0", "area", "sea").redex, logical)
    assert matches(move_host_to("u0", "area", *way).redex, logical) == ()
