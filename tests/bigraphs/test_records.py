import copy
import pickle

import pytest

from bigraphs.notation.big.syntax import Absolute, Literal, Negated, Span
from bigraphs.properties import TerminalState


def test_records_are_equal_if_they_are_of_one_class_and_say_the_same_wherever_they_stand():
    one, other = Negated(Literal(1), Span(0, 2)), Negated(Literal(1), Span(5, 7))
    assert one == other
    assert hash(one) == hash(other)
    assert one != Negated(Literal(2))
    assert one != Absolute(Literal(1))
    assert one != 1
    assert len({one, other, Absolute(Literal(1)), TerminalState(), TerminalState()}) == 3


def test_records_show_all_their_fields():
    assert repr(Negated(Literal("a"), Span(0, 2))) == (
        "Negated(operand=Literal(value='a', span=Span(start=0, end=0)), span=Span(start=0, end=2))"
    )
    assert repr(TerminalState()) == "TerminalState()"


def test_records_are_frozen():
    record = Literal(1)
    with pytest.raises(AttributeError, match="cannot assign to field 'value'"):
        record.value = 2
    with pytest.raises(AttributeError, match="cannot delete field 'value'"):
        del record.value
    assert record == Literal(1)


def test_records_take_their_fields_by_name_and_refuse_others():
    assert Literal(value=1) == Literal(1)
    for arguments in ((), (1, Span(), 3)):
        with pytest.raises(TypeError, match="argument"):
            Literal(*arguments)


def test_records_are_matched_copied_and_pickled():
    record = Negated(Literal(1), Span(0, 2))
    match record:
        case Negated(Literal(value)):
            assert value == 1
        case _:
            pytest.fail("it is not matched")
    for same in (copy.deepcopy(record), pickle.loads(pickle.dumps(record))):
        assert same == record
        assert same.span == Span(0, 2)
