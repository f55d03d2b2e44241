"""Which names mean the same: the oracle is the elaborator, to which a renamed mission is the same mission."""

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bigactors.lsp.edited_mission import Reading
from bigactors.lsp.renaming import RenameRefused, renamable, rename, replaced
from specs import Source
from specs.elaboration import diagnose
from specs.parser import read

ROOT = Path(__file__).parents[3]
MISSIONS = sorted((ROOT / "specs/missions").glob("*.mission"))
CORPUS = ROOT / "tests/corpus/ok"
GOOD = [*MISSIONS, *sorted(CORPUS.glob("*.mission"))]
RENAMED = [
    *(
        ROOT / "specs/missions" / f"{name}.mission"
        for name in ("convoy", "harbour_watch", "oil_spill", "takeover", "two_gates")
    ),
    *(CORPUS / f"{name}.mission" for name in ("everything", "rules")),
]


def reading_of(text, directory=ROOT / "specs/missions"):
    return Reading(Source("m", text), directory)


def load(path):
    return reading_of(path.read_text(encoding="utf-8"), path.parent)


def marked(text):
    """Return a reading of a text without its mark ^, and where that was."""
    at = text.index("^")
    return reading_of(text.replace("^", "")), at


def words_at(text):
    """Return the names that mean the same as the one behind the mark, each with its line."""
    reading, at = marked(text)
    found = reading.occurrences.at(at)
    return [reading.source.line(each.span.start) for each in reading.occurrences.of(found.symbol)]


BODY = "BigActor a hosted_at u with_behavior {{\n{}\n}}\n"


@pytest.mark.parametrize(
    ("statements", "lines"),
    [
        ("let ^x = 1\nlet y = x\nlet x = x\ndisplay(x)", [2, 3, 4]),
        ("let x = 1\nlet y = x\nlet ^x = x\ndisplay(x)", [4, 5]),
        ("let x = 1\nif x == 2 {\nlet ^x = 3\ndisplay(x)\n}\ndisplay(x)", [4, 5]),
        ("let ^x = 1\nif x == 2 {\nlet x = 3\ndisplay(x)\n}\ndisplay(x)", [2, 3, 7]),
        ("let ^x = 1\nloop {\nx = x + 1\n}", [2, 4, 4]),
        ("let x = {u}\nfor ^x in x {\ndisplay(x)\n}", [3, 4]),
        ("let ^x = {u}\nfor x in x {\ndisplay(x)\n}", [2, 3]),
        ("react {\ncase ^x if u in x => display(x)\ncase x => display(x)\n}", [3, 3, 3]),
        ('match u {\ncase ("a", (^x, y)) if y == x =>\ndisplay(x)\n}', [3, 3, 4]),
        ("choose ^x in {u} {\ndisplay(x)\n}\nlet x = 1", [2, 3]),
    ],
)
def test_a_variable_is_seen_where_it_is_bound(statements, lines):
    assert words_at(BODY.format(statements)) == lines


FAMILY = """BigActor f[{}i] for {}u in {}UAV hosted_at u with_behavior {{
send i to {}f[u]
let x = i
}}
signature {{ kind UAV }}
check {{
invariant "i": forall y: f . f[0].x == i and waiting y
invariant "j": forall y: agents hosted_at UAV . ended y
}}
"""


@pytest.mark.parametrize(
    ("marks", "lines"),
    [("^...", [1, 2, 3]), (".^..", [1, 1, 2]), ("..^.", [1, 5, 8]), ("...^", [1, 2, 7, 7])],
)
def test_a_family_binds_its_number_and_its_entity_in_its_body(marks, lines):
    assert words_at(FAMILY.format(*(mark.strip(".") for mark in marks))) == lines


@pytest.mark.parametrize(
    ("name", "lines"), [("^x, y: UAV", [2, 3]), ("x, ^y: UAV", [2, 3]), ("x, y: ^UAV", [1, 2])]
)
def test_names_that_are_quantified_together_share_what_they_go_through(name, lines):
    text = f'signature {{ kind UAV }} check {{\ninvariant "i": forall {name} .\nx in y }}\n'
    assert words_at(text) == lines


def test_a_variable_in_a_property_is_that_of_the_bigactor_and_of_what_it_calls():
    text = (
        "def f(y) = {\nlet ^x = y\n}\n"
        "BigActor a hosted_at u with_behavior {\nf(1)\nlet x = 2\n}\n"
        "BigActor b hosted_at u with_behavior {\nlet x = 2\n}\n"
        'check {\ninvariant "i": a.x == 1 or bound a.x\n}\n'
    )
    assert words_at(text) == [2, 6, 12, 12]


def test_names_in_the_body_of_a_rule_are_kinds_nodes_parameters_and_channels():
    text = (
        "signature {\nkind UAV driven\nkind Location contains UAV\n}\n"
        "world {\nb0: Location absent\nu0: UAV absent linked wifi\n}\n"
        "rule land(u: UAV) {\nu[wifi] || b0_Location.$0 ->\nu[wifi] || b0_Location.$0\n}\n"
    )
    assert words_at(text.replace("b0: L", "^b0: L")) == [6, 10, 11]
    assert words_at(text.replace("land(u", "land(^u")) == [9, 10, 11]
    assert words_at(text.replace("kind Location", "kind ^Location")) == [3, 6, 10, 11]
    assert words_at(text.replace("linked wifi", "linked ^wifi")) == [7, 10, 11]


@pytest.mark.parametrize("path", GOOD, ids=lambda path: path.stem)
def test_every_name_that_the_elaborator_knows_is_found(path):
    reading = load(path)
    declared = {(symbol.sort, symbol.name) for symbol in reading.occurrences.declared}
    elaborated = reading.diagnosis.elaborated
    if elaborated is None:
        return
    spans = elaborated.spans.items()
    written = {key for key, span in spans if reading.text[span.start : span.end] == key[1]}
    assert {("agent" if sort == "family" else sort, name) for sort, name in written} <= declared


REFUSED = {"harbour_watch": ["Vessel"]}  # the recording says Vessel too


@pytest.mark.long
@pytest.mark.parametrize("path", RENAMED, ids=lambda path: path.stem)
def test_a_mission_with_everything_renamed_is_the_same_mission(path):
    reading = load(path)
    before, refused = reading.diagnosis, []
    for number, symbol in enumerate(reading.occurrences.declared):
        name = f"{'Kind' if symbol.sort == 'kind' else 'renamed'}{number}"
        place = list(reading.occurrences.declared.values())[number].start
        try:
            spans = rename(reading, place, name)
        except RenameRefused:
            refused.append(symbol.name)
        else:
            reading = reading_of(replaced(reading.text, spans, name), path.parent)
    assert refused == REFUSED.get(path.stem, [])
    assert [str(found) for found in reading.diagnosis.mistakes] == []
    one, other = before.elaborated, reading.diagnosis.elaborated
    assert len(one.setting.program.statements) == len(other.setting.program.statements)
    assert [prop.kind for prop in one.properties] == [prop.kind for prop in other.properties]


@settings(max_examples=20, deadline=None)
@given(st.sampled_from(MISSIONS), st.data())
def test_a_name_that_is_taken_is_refused_and_any_other_is_not(path, data):
    reading = load(path)
    spans = sorted(reading.occurrences.declared.values())
    one = data.draw(st.sampled_from(spans))
    other = data.draw(st.sampled_from(spans))
    name = reading.text[other.start : other.end]
    try:
        changed = replaced(reading.text, rename(reading, one.start, name), name)
    except RenameRefused:
        return
    after = diagnose(read(Source("m", changed)), Source("m", changed), path.parent)
    assert [str(found) for found in after.mistakes] == []


@pytest.mark.parametrize("name", ["loop", "3x", "a b", "", "x:y", "HOST"])
def test_a_word_that_cannot_be_a_name_is_refused(name):
    reading, at = marked(BODY.format("let ^x = 1"))
    with pytest.raises(RenameRefused):
        rename(reading, at, name)


def test_a_name_is_not_changed_while_a_part_of_the_text_cannot_be_read():
    reading, at = marked(BODY.format("let ^x = 1\nlet y = x +"))
    with pytest.raises(RenameRefused, match="syntax"):
        renamable(reading, at)
