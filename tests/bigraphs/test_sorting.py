import pytest

from bigraphs.errors import NotationError
from bigraphs.notation import read_system
from bigraphs.rewriting import successors
from bigraphs.sorting import LinkSort, Sorting, unkept, violations


def port(
    reaction, sorts="place Harbour = {Vessel}; place Vessel = {Crew}; link radio = {Vessel.1, Station};"
):
    """Return a file about vessels with two ordered ports, their key and their radio."""
    return (
        "ctrl Harbour = 0; ordered ctrl Vessel = 2; atomic ctrl Crew = 0; atomic ctrl Station = 1;\n"
        f"sort Afloat = {{Vessel}};\n{sorts}\n"
        "big s = /k /r (Harbour.Vessel{k, r}.Crew | Harbour.1 | Station{r});\n"
        f"react r = {reaction};\n"
        "begin brs init s; rules = [ {r} ]; end\n"
    )


def refused(text):
    with pytest.raises(NotationError) as found:
        read_system(text)
    return [mistake.message for mistake in found.value.mistakes if mistake.code == "sort"]


MOVE = "Harbour.(Vessel{k, r} | id) | Harbour.id --> Harbour.id | Harbour.(Vessel{k, r} | id) @ [1, 0, 2]"


def test_sorts_are_read_as_controls_and_ports():
    system = read_system(port(MOVE, "place Harbour = {Afloat}; link radio = {Vessel.1, Station};"))
    assert system.sorting == Sorting(
        (("Harbour", ("Vessel",)),), (LinkSort("radio", (("Station", None), ("Vessel", 1))),)
    )


def test_rules_that_keep_sorts_lead_to_sorted_states():
    system = read_system(port(MOVE))
    (rule,) = system.rules()
    found = [state for _, state in successors(rule.reaction(), system.initial)]
    assert found
    assert not [message for state in found for message in violations(state, system.sorting)]


def test_a_first_state_against_its_sorts_is_refused():
    assert "in the first state, Vessel is in Harbour, which may not hold it" in refused(
        port(MOVE, "place Harbour = {Crew};")
    )
    assert "in the first state, the link /1 joins ports of sort none and radio" in refused(
        port(MOVE, "link radio = {Station};")
    )


def test_a_rule_that_puts_a_node_where_it_may_not_be_is_refused():
    (found,) = refused(port("Harbour.(Vessel{k, r} | id) --> Harbour.(Crew | {k} | {r} | id) @ [1]"))
    assert found == "'r' may break sorts: in the reactum, Crew is in Harbour, which may not hold it"


def test_a_rule_that_moves_a_site_where_its_content_may_not_be_is_refused():
    found = refused(port("Harbour.Vessel{k, r}.id --> Harbour.(id | {k} | {r})"))
    assert found == ["'r' may break sorts: site 0 may hold Crew, and is put into Harbour, which may not"]


def test_a_rule_that_leaves_a_node_where_its_redex_may_be_is_refused():
    found = refused(port("Vessel{k, r} --> Vessel{k, r} | Crew"))
    assert found == [
        "'r' may break sorts: the redex may be in Harbour, which may not hold the Crew of the reactum"
    ]


def test_a_rule_that_changes_the_sort_of_a_link_is_refused():
    found = refused(port("Vessel{k, r} --> Vessel{r, k}"))
    assert found == [
        "'r' may break sorts: the link k joins ports of sort none before, of radio after",
        "'r' may break sorts: the link r joins ports of sort radio before, of none after",
    ]


def test_a_parametrised_control_is_sorted_by_its_name():
    text = (
        "ctrl A = 0; fun ctrl K(n) = 0; place A = {K}; place K = {};\n"
        "fun react r(n) = K(n).1 --> K(n).K(n + 1).1; big s = A.K(1).1;\n"
        "begin brs init s; rules = [ {r(1)} ]; end"
    )
    assert refused(text) == ["'r(1)' may break sorts: in the reactum, K(2) is in K(1), which may not hold it"]


def test_unsorted_systems_ask_nothing():
    system = read_system(port(MOVE, ""))
    assert not list(unkept(next(system.rules()).reaction(), system.signature, system.sorting))
