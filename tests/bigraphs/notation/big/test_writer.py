from dataclasses import replace

import pytest
from hypothesis import given
from scale import examples
from system_strategies import canonical_system, systems

from bigraphs.errors import BigraphError
from bigraphs.notation import read_system, write_system
from bigraphs.properties import SystemProperty, TerminalState

SMALL = """
ctrl A = 0;
ordered passive ctrl B = 2;
fun ctrl K(n) = 1;
place A = {K, B};
link radio = {B.0, K};
big s = /x (A.K(1){x}.1 | A.B{x, y}.1);
fun react r(n) = A.(K(n){x} | id) --> A.(K(n + 1){x} | id);
fun big p(n) = K(n){x};
begin brs
  int n = {1, 2};
  init s;
  rules = [ {r(n)} ];
  preds = { p(n)[3] };
end
"""


@examples(60)
@given(systems())
def test_a_system_is_read_back_as_written(system):
    assert canonical_system(read_system(write_system(system))) == canonical_system(system)


def test_a_written_system_has_a_line_for_each_rule_with_its_parameters():
    assert write_system(read_system(SMALL)) == (
        "ctrl A = 0;\n"
        "passive ordered ctrl B = 2;\n"
        "fun ctrl K(p0) = 1;\n"
        "place A = {B, K};\n"
        "link radio = {B.0, K};\n"
        "fun big p(p0) = K(p0){x}.id;\n"
        "big initial = /e0 (A.K(1){e0}.1 | A.B{e0, y}.1);\n"
        "fun react r(p0) = A.(K(p0){x}.id | id) --> A.(K(p0 + 1){x}.id | id);\n"
        "begin brs\n"
        "  init initial;\n"
        "  rules = [{r(2), r(1)}];\n"
        "  preds = {p(2)[3], p(1)[3]};\n"
        "end\n"
    )


def test_what_cannot_be_written_is_refused():
    system = read_system(SMALL)
    with pytest.raises(BigraphError, match="no way to write properties"):
        write_system(replace(system, properties=(SystemProperty("p", TerminalState()),)))
    ((rule, *_),) = (each.rules for each in system.classes)
    constant = replace(rule, link_constants=frozenset({"x"}))
    with pytest.raises(BigraphError, match="names of a rule that stand for themselves"):
        write_system(replace(system, classes=(replace(system.classes[0], rules=(constant,)),)))
    with pytest.raises(BigraphError, match="the name 'in'"):
        write_system(
            replace(system, classes=(replace(system.classes[0], rules=(replace(rule, name="in"),)),))
        )


def test_two_rules_of_one_name_are_refused():
    system = read_system(SMALL)
    one, other = system.classes[0].rules
    same = replace(other, parameters=one.parameters)
    with pytest.raises(BigraphError, match=r"two different 'r\(2\)'"):
        write_system(replace(system, classes=(replace(system.classes[0], rules=(one, same)),)))


def test_places_that_nest_too_deeply_to_be_read_are_not_written():
    text = "ctrl A = 0; big s = " + "A * " * 500 + "1; begin brs init s; rules = []; end"
    with pytest.raises(BigraphError, match="places nest deeper than 90"):
        write_system(read_system(text))


def test_the_deepest_places_that_are_written_are_read():
    for inside in ("1", "(share (A || A) by ([{0}, {0, 1}], 2) in (A | A)) * (1 || 1)"):
        text = f"ctrl A = 0; big s = {'A * ' * 80}({inside}); begin brs init s; rules = []; end"
        system = read_system(text)
        assert canonical_system(read_system(write_system(system))) == canonical_system(system)
