import pytest
from big_files import mistakes

from bigraphs import bigraph
from bigraphs.notation import read_system
from bigraphs.notation.big.expression_evaluation import Evaluation

CELLS = """
ctrl Room = 0; fun ctrl Cell(n) = 0; atomic fun ctrl Badge(n, s) = 1; atomic ctrl Lamp = 1;
fun big badge(n, s) = Badge(n + 1, s){l};
fun big many(n) = par(n, Lamp{l});
fun big nested(n) = /l (badge(n, "x") | badge(2 * n, "x") | Lamp{l} | badge(1, "y"));
big few(1) = Lamp{l}; big few(2) = Lamp{l} | Lamp{l}; big few(3) = badge(3, "z");
big start = Room.(Cell(1).1 | nested(1));
fun react up(n, s) = Cell(n).id | badge(n, s) -[1.0 / n]-> /x (Cell(n + 1).(id | Lamp{x})) | badge(n - 1, s)
  if Cell(n) in ctx, !nested(n) in param;
fun react grow(n) = Cell(n).id | Lamp{l} -[n]-> Cell(n).id | many(n);
fun react pick(n) = Cell(n) || Lamp{l} -[1]-> Cell(n) || few(n);
begin pbrs
  int n = [1 : 1 : COUNT];
  init start;
  rules = [ {up(n, "a"), up(n, "b"), grow(n)}, {pick(n)} ];
  preds = { nested(n), badge(n, "q") };
end
"""


def test_instances_of_a_template_are_those_that_are_evaluated_as_written(monkeypatch):
    text = CELLS.replace("COUNT", "3")
    from_templates = read_system(text)
    monkeypatch.setattr(Evaluation, "instance", lambda *_: None)
    assert read_system(text) == from_templates


def test_the_algebra_runs_once_for_all_instances(monkeypatch):
    text = CELLS.replace("{pick(n)}", "{pick(1)}").replace(", grow(n)", "")
    made = []
    checked = bigraph.check
    monkeypatch.setattr(bigraph, "check", lambda each: made.append(each) or checked(each))
    read_system(text.replace("COUNT", "2"))
    few, _ = len(made), made.clear()
    read_system(text.replace("COUNT", "40"))
    assert len(made) == few


@pytest.mark.parametrize(
    ("declaration", "rules", "found"),
    [
        ("fun react r(n) = Cell(6 / (n - 3)) --> Cell(n);", "r(n)", "division by zero"),
        (
            "fun react r(n) = Cell(1).1 --> many(n - 3);",
            "r(n)",
            "it is repeated -2 times, not a whole number",
        ),
        (
            "fun react r(n) = Cell(n) --> Cell(n); fun react q(s) = Cell(s) --> Cell(s);",
            'r(n), q("a")',
            "'n' of 'Cell' is of type int, this is the string \"a\"",
        ),
    ],
)
def test_a_mistake_of_one_instance_is_told(declaration, rules, found):
    text = f"""
        ctrl Room = 0; fun ctrl Cell(n) = 0; fun big many(n) = par(n, Room.1);
        big start = Room; {declaration}
        begin brs int n = [1 : 1 : 4]; init start; rules = [ {{{rules}}} ]; end
    """.replace("big start = Room;", "big start = Room.1;")
    assert found in [mistake.message.split(", in ")[0] for mistake in mistakes(text)]
