import pytest

from bigraphs.canonical import equal
from bigraphs.examples import example_text
from bigraphs.notation import read_system

ROOMS = """\
atomic ctrl Door = 2;
ctrl Room = 0;
big house = /x (Room.(Door{x, y} | Room.1) | Door{x, x});
begin brs init house; rules = []; end
"""
RULES = """\
ctrl A = 0;
big s = A.1;
react r = A.1 --> A.1 | A.1;
big p = A.1;
begin brs init s; rules = [ {r} ]; preds = { p }; end
"""
HOLED = """\
<m:BBigraph xmlns:m="http://example.org" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance">
  <bRoots><bChild xsi:type="m:BSite"/></bRoots>
</m:BBigraph>
"""


@pytest.fixture
def rooms(missions):
    for name, text in (
        ("rooms.big", ROOMS),
        ("rules.big", RULES),
        ("holed.xmi", HOLED),
        ("rooms.text", ROOMS),
    ):
        (missions / name).write_text(text, encoding="utf-8")
    return missions


@pytest.mark.usefixtures("rooms")
def test_a_state_goes_to_the_framework_and_back(bigactors):
    code, _, err = bigactors("big", "convert", "rooms.big", "rooms.xmi")
    assert code == 0
    assert "places not active: Door\n" in err
    code, out, _ = bigactors("big", "convert", "rooms.xmi", "-", "--to", "big")
    assert code == 0
    ours = ROOMS.replace("atomic ctrl Door", "ordered ctrl Door").replace("}", "}.1")
    assert equal(read_system(out).initial, read_system(ours).initial)
    assert bigactors("big", "full", "rooms.big")[0] == 0


def test_rules_and_predicates_are_not_lost_in_silence(bigactors, rooms):
    code, _, err = bigactors("big", "convert", "rules.big", "rules.xmi")
    assert code == 2
    assert "rules (1), predicates (1)" in err
    assert "--initial" in err
    assert not (rooms / "rules.xmi").exists()
    assert bigactors("big", "convert", "rules.big", "rules.xmi", "--initial")[0] == 0
    assert "<bChild" in (rooms / "rules.xmi").read_text(encoding="utf-8")


def test_a_bgm_file_becomes_a_big_file_unless_its_names_do_not(bigactors, missions):
    model = "%active A : 0;\nA -> A.A;\nA;\n%check;\n"
    (missions / "one.bgm").write_text(model, encoding="utf-8")
    (missions / "small.bgm").write_text(model.replace("A", "a"), encoding="utf-8")
    code, out, _ = bigactors("big", "convert", "one.bgm", "-", "--to", "big")
    assert code == 0
    system = read_system(out)
    assert [node.control for node in system.initial.nodes] == ["A"]
    assert sum(1 for _ in system.rules()) == 1
    code, _, err = bigactors("big", "convert", "small.bgm", "small.big")
    assert (code, "no way to write the name 'a'" in err) == (2, True)


def test_a_system_that_ships_is_written_whole(bigactors):
    code, out, _ = bigactors("big", "convert", "mobile_ambients", "-", "--to", "big")
    assert code == 0
    ours = read_system(example_text("mobile_ambients"))
    assert {rule.label for rule in read_system(out).rules()} == {rule.label for rule in ours.rules()}
    assert equal(read_system(out).initial, ours.initial)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("holed.xmi", "x.big"), "site 0"),
        (("rooms.big", "x.json"), "the ending of 'x.json' names no format"),
        (("rooms.text", "x.xmi"), "the ending of 'rooms.text' names no format"),
        (("nowhere.text", "x.xmi"), "'nowhere.text' cannot be read"),
        (("rooms.big", "-"), "give --to big or xmi"),
        (("holed.xmi", "x.big", "--const", "n=1"), "a .xmi file has no constants"),
        (("rooms.big", "x.xmi", "--from", "xmi"), "this is no XML"),
        (("rooms.big", "nowhere/x.xmi"), "there is no such folder"),
    ],
)
def test_what_cannot_be_converted_is_told(bigactors, rooms, words, message):
    code, _, err = bigactors("big", "convert", *words)
    assert code == 2
    assert message in err
    assert not (rooms / "x.big").exists()


PARAMETERS = """\
ctrl Room = 0; fun ctrl Badge(n) = 0;
float rate = 2.0;
fun react renew(n) = Badge(n) -[rate]-> Badge(n + 1);
fun big has(n) = Badge(n);
big s = Room.(Badge(1).1 | Badge(3).1);
begin sbrs int k = [1 : 1 : 3]; init s; rules = [ {renew(k)} ]; preds = { has(k), has(k + 3) }; end
"""


def test_parameters_are_written_as_they_were_read(bigactors, missions):
    (missions / "badges.big").write_text(PARAMETERS, encoding="utf-8")
    code, out, err = bigactors("big", "convert", "badges.big", "-", "--to", "big", "--const", "rate=3.5")
    assert (code, err) == (0, "")
    assert "fun react renew(n) = Badge(n) -[rate]-> Badge(n + 1);" in out
    assert read_system(out) == read_system(PARAMETERS, constants={"rate": 3.5})


def test_what_bigrapher_does_not_read_is_said(bigactors, missions):
    text = PARAMETERS.replace("ctrl Room", "passive ctrl Room")
    (missions / "badges.big").write_text(text, encoding="utf-8")
    code, _, err = bigactors("big", "convert", "badges.big", "badges2.big")
    assert code == 0
    assert "warning: BigraphER does not read 'passive ctrl Room'" in err
