from bigraphs.canonical_form import equal
from bigraphs.examples import example_text
from bigraphs.notation import read_system

ROOMS = """\
atomic ctrl Door = 2;
ctrl Room = 0;
big house = /x (Room.(Door{x, y} | Room.1) | Door{x, x});
begin brs init house; rules = []; end
"""


def test_a_bgm_file_becomes_a_big_file_unless_its_names_do_not(bigactors, missions):
    model = "%active A : 0;\nA -> A.A;\nA;\n%check;\n"
    (missions / "one.bgm").write_text(model, encoding="utf-8")
    (missions / "small.bgm").write_text(model.replace("A", "a"), encoding="utf-8")
    code, out, _ = bigactors("big", "convert", "one.bgm", "-")
    assert code == 0
    system = read_system(out)
    assert [node.control for node in system.initial.nodes] == ["A"]
    assert sum(1 for _ in system.rules()) == 1
    code, _, err = bigactors("big", "convert", "small.bgm", "small.big")
    assert (code, "no way to write the name 'a'" in err) == (2, True)


def test_a_system_that_ships_is_written_whole(bigactors):
    code, out, _ = bigactors("big", "convert", "mobile_ambients", "-")
    assert code == 0
    ours = read_system(example_text("mobile_ambients"))
    assert {rule.label for rule in read_system(out).rules()} == {rule.label for rule in ours.rules()}
    assert equal(read_system(out).initial, ours.initial)


PARAMETERS = """\
ctrl Room = 0; fun ctrl Badge(n) = 0;
float rate = 2.0;
fun react renew(n) = Badge(n) -[rate]-> Badge(n + 1);
fun big has(n) = Badge(n);
big s = Room.(Badge(1).1 | Badge(3).1);
begin sbrs int k = [1 : 1 : 3]; init s; rules = [ {renew(k)} ]; preds = { has(k), has(k + 3) }; end
"""


def test_parameters_are_written_as_they_were_read(done, missions):
    (missions / "badges.big").write_text(PARAMETERS, encoding="utf-8")
    out = done("big", "convert", "badges.big", "-", "--const", "rate=3.5")
    assert "fun react renew(n) = Badge(n) -[rate]-> Badge(n + 1);" in out
    assert read_system(out) == read_system(PARAMETERS, constants={"rate": 3.5})


def test_what_bigrapher_does_not_read_is_said(bigactors, missions):
    text = PARAMETERS.replace("ctrl Room", "passive ctrl Room")
    (missions / "badges.big").write_text(text, encoding="utf-8")
    code, _, err = bigactors("big", "convert", "badges.big", "badges2.big")
    assert code == 0
    assert "warning: BigraphER does not read 'passive ctrl Room'" in err
