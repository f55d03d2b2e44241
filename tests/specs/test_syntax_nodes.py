"""Nodes of the syntax tree are values: compared, hashed and shown by what they say."""

from dataclasses import FrozenInstanceError, replace

import pytest

from specs.syntax import Name, RuleBody, Span, TextLiteral


def test_nodes_are_equal_when_they_say_the_same_wherever_they_were_written():
    here, there = Name("uav0", span=Span(0, 4)), Name("uav0", span=Span(9, 13))
    assert here == there
    assert len({here, there}) == 1
    assert replace(here, text="uav1") != here


def test_nodes_of_different_kinds_are_different_whatever_they_say():
    assert Name("uav0") != TextLiteral("uav0")
    assert Name("uav0") != "uav0"


def test_a_node_shows_what_it_says_and_not_how_it_was_written():
    assert (
        repr((Name("%r"), RuleBody("a => b", raw="a  => b"))) == "(Name(text='%r'), RuleBody(text='a => b'))"
    )
    assert RuleBody("a => b", raw="a  => b") == RuleBody("a => b")


def test_a_node_cannot_be_changed():
    with pytest.raises(FrozenInstanceError):
        Name("uav0").text = "uav1"
