"""The parser with kept tables is the parser that is made, and no start makes what is kept."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from scale import IS_WHOLE

from bigraphs.notation.parse_tables import parser_with_tables
from specs.diagnostics import MissionError, Source
from specs.grammar import callbacks, make_parser
from specs.missions import shipped_missions
from specs.parser import parse

ROOT = Path(__file__).parents[3]
FILES = sorted([*shipped_missions().values(), *(ROOT / "tests" / "corpus").rglob("*.mission")])


@pytest.fixture(scope="module")
def made():
    """Return the parser that is made from the grammar, which takes seconds."""
    return make_parser()


@pytest.fixture
def tables(tmp_path, made):
    parser_with_tables(tmp_path / "tables.json", "1", lambda: made, callbacks())
    return tmp_path / "tables.json"


def never():
    raise AssertionError("the tables are made again")


def said(path):
    """Return what a mission says, or what is wrong with it."""
    try:
        return parse(Source("m", path.read_bytes().decode("utf-8", "replace")))
    except MissionError as error:
        return str(error)


def test_kept_tables_make_the_same_of_every_mission_and_every_mistake(tables, made, monkeypatch):
    kept = parser_with_tables(tables, "1", never, callbacks())
    for file in FILES if IS_WHOLE else FILES[::4]:
        monkeypatch.setattr("specs.grammar.grammar", lambda: made)
        expected = said(file)
        monkeypatch.setattr("specs.grammar.grammar", lambda: kept)
        assert said(file) == expected


def test_what_could_come_next_is_the_same_with_kept_tables(tables, made):
    kept = parser_with_tables(tables, "1", never, callbacks())
    runs = [parser.parse_interactive("mission m\nworld { uav0: UAV = ") for parser in (kept, made)]
    for run in runs:
        run.exhaust_lexer()
    assert runs[0].accepts() == runs[1].accepts() > {"POINT"}


def test_tables_of_another_grammar_are_made_again(tables, made):
    before = tables.read_bytes()
    parser_with_tables(tables, "2", lambda: made, callbacks())
    assert tables.read_bytes() != before
    parser_with_tables(tables, "2", never, callbacks())


@pytest.mark.parametrize("broken", [b"", b"\xff", b"[]", b'{"identity": 1}', b'{"identity"'])
def test_a_file_that_holds_no_tables_is_replaced_and_nothing_else_is_left_beside_it(tables, made, broken):
    tables.write_bytes(broken)
    parser_with_tables(tables, "1", lambda: made, callbacks())
    parser_with_tables(tables, "1", never, callbacks())
    assert [path.name for path in tables.parent.iterdir()] == [tables.name]
    assert set(json.loads(tables.read_bytes())) == {"identity", "data", "memo"}


def test_tables_that_cannot_be_kept_are_made(tmp_path, made):
    file = tmp_path / "no folder" / "tables.json"
    assert parser_with_tables(file, "1", lambda: made, callbacks()).rules
    assert not file.parent.exists()


def test_a_second_start_makes_no_tables(tmp_path):
    start = f"import pathlib, specs.grammar as g; g.TABLES = pathlib.Path({str(tmp_path)!r}, 'tables.json');"
    for program in ("g.grammar()", "g.make_parser = None; g.grammar()"):
        subprocess.run([sys.executable, "-c", f"{start} {program}"], check=True, cwd=ROOT)
