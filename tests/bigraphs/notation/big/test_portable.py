"""What `convert` writes means what was read, is read again, and is BigraphER's language where that has the words."""

from dataclasses import replace

import pytest
from bigrapher_grammar import parses
from hypothesis import given
from lark.exceptions import LarkError
from scale import examples
from system_strategies import canonical_system, mapped, systems

from bigraphs.errors import BigraphError
from bigraphs.examples import example_names, example_text
from bigraphs.notation import read_system, write_system
from bigraphs.notation.big.parser import parse_model
from bigraphs.notation.big.portable import portable, unportable
from bigraphs.notation.big.printer import format_model
from bigraphs.signature import Signature

EVERYTHING = """
big office = /a z/{b, y} /c /c (
  Room.(Person{a} | Badge(1){a} | Person{c} | Person{b} | Person{y} | Two{w, w}.1) | Room.1);
react move = Room.(Person{p} | id) | Room -[hurry]-> Room | Room.(Person{p} | id) @ [1, 0];
fun react renew(n, m) = Badge(n){p} -[1]-> Badge(m){p} if !Person{p} in ctx;
big one(1) = two || {q, r};
big two = Room.Badge(k){x};
big one(2) = two || {q, r};
ctrl Room = 0;
ctrl Two = 2;
atomic ctrl Person = 1;
atomic fun ctrl Badge(n) = 1;
float hurry = 2.0;
int k = j + 1;
int j = 0;
big together = /{p, q} (Room.(Person{p} | Badge(2){q} | id));
big open = Two{w, w}.(Person{v} || /{s, t} * (Person{s} | Person{t}));
begin sbrs
  int n = [1 : 1 : 3];
  init office;
  rules = [ {move, renew(n, n + 1)} ];
  preds = { together, one(1), one(2) };
end
""".replace("big open = Two{w, w}.(Person{v} || /{s, t} * (Person{s} | Person{t}));\n", "")


def carried(text, **constants):
    """Return a file as it is converted, and what that means."""
    system = read_system(text, constants=constants)
    model = portable(parse_model(text), system, constants)
    written = format_model(model)
    assert canonical_system(read_system(written)) == canonical_system(system)
    return written, unportable(model)


def relaxed(system):
    """Return a system whose controls BigraphER has."""
    signature = Signature(
        tuple(
            replace(each, ordered=False, status="atomic" if each.status == "atomic" else "active")
            for each in system.signature.controls
        )
    )
    found = replace(system, signature=signature)
    return mapped(found, lambda bigraph: replace(bigraph, signature=signature))


@examples(60)
@given(systems())
def test_a_system_is_written_in_bigraphers_language_where_that_has_the_words(system):
    written, unknown = carried(write_system(relaxed(system)))
    if not unknown:
        parses(written)


def test_what_only_the_language_here_has_is_written_otherwise():
    with pytest.raises(LarkError):
        parses(EVERYTHING)
    written, unknown = carried(EVERYTHING)
    assert unknown == []
    parses(written)


def test_constants_that_are_given_are_written():
    written, _ = carried(EVERYTHING, hurry=3.5)
    assert "float hurry = 3.5;" in written
    assert "-[hurry]->" in written


@pytest.mark.parametrize("name", example_names())
def test_systems_that_ship_are_carried(name):
    written, unknown = carried(example_text(name))
    if not unknown:
        parses(written)


def test_listed_actions_become_declared_ones():
    written, unknown = carried("""
    ctrl A = 0; ctrl B = 0; big s = A.1;
    react r = A -[1]-> B; react t = B -[1]-> A;
    begin abrs init s; rules = [ {r, t} ]; actions = [ go[2] = {r}, back = {t} ]; end
    """)
    assert unknown == []
    assert "action go[2]\n  react r" in written
    assert "begin nbrs" in written
    parses(written)


def test_what_bigrapher_has_no_words_for_is_named():
    _, unknown = carried("""
    passive ordered ctrl A = 2; fun ctrl K(s) = 0; atomic ctrl B = 0; place K = {A};
    big _s = K("a b").(A{x, y}.1) | B; int n = abs(-1);
    big f(1) = B; big f(2) = B | B | B; react r = B --> B;
    begin brs init _s; rules = [ {r} ]; preds = { f(1), f(2) }; end
    """)
    assert set(unknown) == {
        "'passive ordered ctrl A'",
        "'place K'",
        "'big f(...)' for given arguments",
        "'abs'",
        'the string "a b"',
        "the name '_s'",
    }


def test_a_system_that_would_not_be_read_again_is_refused():
    text = "ctrl A = 0; big s = par(9000, A.1); begin brs init s; rules = []; end"
    written, _ = carried(text)
    assert len(written) < 200
    system = text[text.index("begin") :]
    wide = f"fun ctrl K(a, b, c, d, e, f, g, h, i) = 0; big s = par(9900, K(1, 2, 3, 4, 5, 6, 7, 8, 9).1); {system}"
    with pytest.raises(BigraphError, match="would not be read again: the text has more than 200000 words"):
        write_system(read_system(wide))


@pytest.mark.parametrize("closed", ["/x /y /x A{x, y}.1", "/x /x (/y A{x, y}.1)", "/y /x /y /x A{x, y}.1"])
def test_a_name_that_is_closed_twice_is_closed(closed):
    text = "ctrl A = 2; big s = %s; begin brs init s; rules = []; end"
    assert canonical_system(read_system(text % closed)) == canonical_system(
        read_system(text % "/x /y A{x, y}.1")
    )


@pytest.mark.parametrize("closed", ["/x (/x A{x, x}.1)", "/x y/{x} /x A{x, x}.1", "/z A{x, x}.1"])
def test_a_name_that_is_not_there_is_not_closed(closed):
    with pytest.raises(BigraphError, match="there is no outer name"):
        read_system(f"ctrl A = 2; big s = {closed}; begin brs init s; rules = []; end")
