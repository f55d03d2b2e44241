import pytest
from hypothesis import given
from hypothesis import strategies as st

from bigraphs.errors import BigraphError, NotationError
from bigraphs.notation.paper import (
    NodeTerm,
    RuleTerm,
    SiteTerm,
    format_regions,
    format_term,
    nodes,
    parse_regions,
    parse_rule,
)

RULE = "l0_Location.(u0_UAV[network] | $0) || l1_Location.$1 -> l0_Location.$0 || l1_Location.(u0_UAV[network] | $1)"

controls = st.sampled_from(["UAV", "Location", "K2"])
link_names = st.sampled_from(["net", "control:gcs0", "a-b", "x.y", "_"])


@st.composite
def regions(draw):
    """Draw syntax with distinct names and sites."""
    fresh = iter(range(1000))

    def term(depth):
        kind = draw(st.integers(0, 4 if depth else 2))
        if kind == 0:
            return SiteTerm(next(fresh))
        name = draw(st.sampled_from(["uav", "my_area", "n_"])) + str(next(fresh))
        links = tuple(draw(st.lists(link_names, max_size=2)))
        control = draw(st.none() | controls)
        name = name if control is None or draw(st.booleans()) else None
        return NodeTerm(name, control, links, several(depth - 1) if kind > 2 else ())

    def several(depth):
        return tuple(term(depth) for _ in range(draw(st.integers(0, 3))))

    return tuple(several(3) for _ in range(draw(st.integers(1, 3))))


@given(regions())
def test_parsing_reads_back_what_printing_writes(found):
    assert parse_regions(format_regions(found)) == found


@given(regions())
def test_rules_are_read_back_too(found):
    term = RuleTerm(found, found)
    assert parse_rule(str(term)) == term


def test_the_rule_of_the_paper_is_read_as_written():
    rule = parse_rule(RULE)
    uav = NodeTerm("u0", "UAV", ("network",))
    assert rule.redex == (
        (NodeTerm("l0", "Location", (), (uav, SiteTerm(0))),),
        (NodeTerm("l1", "Location", (), (SiteTerm(1),)),),
    )
    assert rule.reactum[1] == (NodeTerm("l1", "Location", (), (uav, SiteTerm(1))),)
    assert str(rule) == RULE


def test_offsets_are_those_of_the_text():
    for node in nodes(parse_rule(RULE).redex):
        assert RULE[node.offset :].startswith(f"{node.name}_{node.control}")


@pytest.mark.parametrize(
    ("text", "name", "control"),
    [
        ("my_uav_UAV", "my_uav", "UAV"),
        ("_UAV", None, "UAV"),
        ("search_area0", "search_area0", None),
        ("searchArea0", "searchArea0", None),
        ("244670316_Vessel", "244670316", "Vessel"),
        ("1_Vessel", "1", "Vessel"),
    ],
)
def test_a_control_follows_the_last_underscore_and_begins_with_a_capital(text, name, control):
    ((node,),) = parse_regions(text)
    assert (node.name, node.control) == (name, control)
    assert str(node) == text


def test_spaces_lines_groups_and_empty_regions_are_read():
    assert parse_regions("a.(b|(c|1)|$0)\n|| 1") == parse_regions("a . ( b | c | $0 ) || 1")
    assert parse_regions("a.1 || 1") == ((NodeTerm("a"),), ())


@pytest.mark.parametrize(
    ("text", "rendered"),
    [
        (
            "a | a -> b",
            "node 'a' is written twice|hint: a name means one node; give the other one another name",
        ),
        ("a.$0 -> b.$1", "site $1 is not in the redex|hint: write $1 there too"),
        ("$0 | $0 -> 1", "site $0 is written twice|hint: give each site of a redex its own number"),
        ("a.( -> b", "found '->', expected '(', a node or a site such as $0"),
        ("a", "the text ends, expected '->'"),
        ("a[ -> b", "found '->', expected ']' or a link name"),
        ("a ? b", "found '?', expected ')', '->', '.', '[', '|' or '||'"),
    ],
)
def test_mistakes_are_told_in_the_users_words(text, rendered):
    with pytest.raises(NotationError) as found:
        parse_rule(text)
    assert (
        "|".join([found.value.message, *(["hint: " + found.value.hint] if found.value.hint else [])])
        == rendered
    )


def test_a_mistake_is_rendered_with_its_line_and_a_caret():
    with pytest.raises(NotationError) as found:
        parse_rule("l0_Location.$0\n  -> l0_Location.(UAV | | $0)")
    assert found.value.render("move.rule") == (
        "move.rule:2:25: found '|', expected '(', a node or a site such as $0\n"
        "    2 |   -> l0_Location.(UAV | | $0)\n"
        "      |                         ^"
    )


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("(" * 10_000, "nesting deeper than 200"),
        ("a." * 10_000 + "a", "nesting deeper than 200"),
        ("a" * 11_000, "a word is longer than 10 kB"),
        ("a | " * 300_000, "the text is longer than 1 MB"),
        ("\ud800 -> 1", "found '\\ud800', expected '(', a node or a site such as $0"),
    ],
)
def test_input_out_of_bounds_is_refused(text, message):
    with pytest.raises(NotationError) as found:
        parse_rule(text)
    assert found.value.message == message


@given(st.text(st.sampled_from("ab_A[]().|$01->, \n"), max_size=30))
def test_any_text_is_read_or_refused_with_a_place_in_it(text):
    try:
        assert str(parse_rule(text))
    except NotationError as error:
        found = error
    else:
        return
    assert 0 <= found.offset <= len(text)
    assert found.render()


@pytest.mark.parametrize("term", [NodeTerm(None), NodeTerm("a_B"), NodeTerm("a b", "K"), NodeTerm("a", "k")])
def test_what_cannot_be_written_is_refused(term):
    with pytest.raises(BigraphError):
        format_term(term)
