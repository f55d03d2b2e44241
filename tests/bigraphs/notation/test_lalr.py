"""Texts are read without lark as lark reads them, to the character."""

import sys
from subprocess import run

import pytest
from hypothesis import given
from hypothesis import strategies as st
from lark import Token, Tree, UnexpectedInput
from scale import examples

from bigraphs.examples import example_names, example_text
from bigraphs.notation import lalr
from bigraphs.notation.bgm import parser as bgm
from bigraphs.notation.big.build_syntax import Build
from bigraphs.notation.big.parser import GRAMMAR, OPTIONS, make_parser, tables
from bigraphs.notation.lalr import ParsingStopped, Span, kept_tables

TEXTS = [example_text(name) for name in example_names()]


def read_by_lark(text, start="model"):
    """Return what the builder makes of lark's own tree, or None where lark finds that the text does not fit."""
    try:
        tree = make_parser().parse(text, start=start)
    except UnexpectedInput:
        return None
    build = Build(text)
    return outcome(build, built(build, tree))


def built(build, tree):
    if isinstance(tree, Token):
        token = lalr.Token(tree)
        token.start = tree.start_pos
        return token
    if not isinstance(tree, Tree):
        return tree
    at = Span() if tree.meta.empty else Span(tree.meta.start_pos, tree.meta.end_pos)
    return getattr(build, tree.data)(at, *[built(build, child) for child in tree.children])


def read_by_tables(text, start="model", by=None):
    build = Build(text)
    try:
        return outcome(build, (by or tables()).read(text, start, build))
    except ParsingStopped:
        return None


def outcome(build, found):
    """Return what was read with all places (which equality leaves out), and the mistakes found on the way."""
    return repr(found), [str(mistake) for mistake in build.mistakes]


@pytest.mark.parametrize("text", TEXTS)
def test_every_example_is_read_as_lark_reads_it(text):
    found = read_by_tables(text)
    assert found == read_by_lark(text)
    assert found is not None


@examples(300)
@given(st.data())
def test_damaged_files_are_read_or_refused_as_by_lark(data):
    text = data.draw(st.sampled_from(TEXTS))
    start = data.draw(st.integers(0, len(text)))
    end = data.draw(st.integers(start, min(len(text), start + 6)))
    put = data.draw(
        st.sampled_from(["", " ", "|", "||", ".", "1", "1.5", "id", "in", "ident", "{x}", "par(2, A)", "#"])
    )
    damaged = text[:start] + put + text[end:]
    assert read_by_tables(damaged) == read_by_lark(damaged)


EXPRESSION = """
K L{x} a id(2) id {x,y} /x x/{y} ( ) | || + * . , [ ] 1 1_0 2.5e1 inf infinite par(2,A) parfum ppar share by in merge(2)
split ([{0},{}],1) abs(-1) K(1+2^n) K("s") - ^ # begin end ctrl if @ ! --> -[ ]->
"""
WORDS = st.sampled_from(EXPRESSION.split())


@examples(500)
@given(st.lists(WORDS, max_size=12), st.sampled_from(["", " "]))
def test_words_in_any_order_are_read_or_refused_as_by_lark(words, between):
    text = between.join(words)
    assert read_by_tables(text, "expression") == read_by_lark(text, "expression")


def test_kept_tables_are_those_that_are_made_and_are_made_once(tmp_path):
    file = tmp_path / "tables.json"
    grammar = f"{GRAMMAR}{OPTIONS}"
    made, kept = kept_tables(file, grammar, make_parser), kept_tables(file, grammar, never)
    for text in TEXTS:
        assert read_by_tables(text, by=kept) == read_by_tables(text, by=made) is not None


def never():
    raise AssertionError("the tables are made again")


@pytest.mark.parametrize("broken", [b"", b"\xff", b"[]", b'{"grammar": "another"}'])
def test_broken_tables_are_made_again(tmp_path, broken):
    file = tmp_path / "tables.json"
    file.write_bytes(broken)
    assert read_by_tables(TEXTS[0], by=kept_tables(file, "g", make_parser)) == read_by_tables(TEXTS[0])
    kept_tables(file, "g", never)


def test_tables_that_cannot_be_written_are_made_at_each_start(tmp_path):
    file = tmp_path / "no folder" / "tables.json"
    assert read_by_tables(TEXTS[0], by=kept_tables(file, "g", make_parser)) == read_by_tables(TEXTS[0])


def test_a_file_without_mistakes_is_read_without_lark():
    program = (
        "import sys; from bigraphs.notation.big.systems import read_system; from bigraphs.examples import example_text;"
        "read_system(example_text('actors')); print('lark' in sys.modules)"
    )
    tables()  # so that they are kept
    assert (
        run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout == "False\n"
    )


OF_BIGMC = """
a B %active %passive %outer %inner %name x : 2 ; %rule r %property p -> | || . [ ] , - nil nile $0 $this $terminal
( ) ! == >= && if then else matches() size() equal(A) #
"""
BGM_WORDS = st.sampled_from(OF_BIGMC.split())


@examples(500)
@given(st.lists(BGM_WORDS, max_size=14), st.sampled_from(["", " "]))
def test_words_of_bigmc_in_any_order_are_read_or_refused_as_by_lark(words, between):
    text = between.join(words)
    try:
        expected = built(bgm._Build(text), bgm.make_parser().parse(text, start="file"))
    except UnexpectedInput:
        with pytest.raises(ParsingStopped):
            bgm.tables().read(text, "file", bgm._Build(text))
        return
    assert repr(bgm.tables().read(text, "file", bgm._Build(text))) == repr(expected)
