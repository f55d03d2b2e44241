import pytest
from text_tables import rows

from bigactors.commands.big.temporal import Decider
from bigraphs.claims import ClaimOutcome
from bigraphs.errors import NotationError
from bigraphs.exploration import explore
from bigraphs.notation import read_system
from bigraphs.notation.formulas import MOST_WORDS
from checker.properties.temporal.claim_text import MOST_NESTED, claim_words_of, parse_claim

SYSTEM = read_system("""\
ctrl Room = 0; atomic ctrl Ball = 0; atomic fun ctrl Lamp(n) = 0;
fun big lit(n) = Lamp(n);
big start = Room.Ball;
big until = Ball;
big ball = Ball;
fun react light(n) = Ball --> Lamp(n);
react put = Room --> Room;
react clear = Ball | Ball --> Ball;
begin brs
  int n = {1, 2};
  init start;
  rules = [ (clear), {light(n), put} ];
  preds = { lit(n), until, ball };
end
""")
WORDS = claim_words_of(SYSTEM)


@pytest.mark.parametrize(
    ("logic", "text", "written"),
    [
        ("ltl", "ball", "ball"),
        ("ltl", "lit(1) or lit( 2 )", "lit(1) or lit(2)"),
        ("ltl", "ball leads to lit(1)", "[] (not ball or <> lit(1))"),
        ("ltl", "[] ball -> <> lit(1)", "not [] ball or <> lit(1)"),
        ("ltl", "always ball -> eventually lit(1)", "[] (not ball or <> lit(1))"),
        ("ltl", "infinitely often ball", "[] <> ball"),
        ("ltl", "not ball U lit(1) && X ball", "(not ball U lit(1)) and X ball"),
        ("ltl", "ball R lit(1) W ball", "ball R (lit(1) W ball)"),
        ("ltl", 'G "until" until ball', "[] until U ball"),
        ("ltl", "taken light leads to taken light(2)", "[] (not taken light or <> taken light(2))"),
        ("ltl", "true <-> enabled put", "(not true or enabled put) and (not enabled put or true)"),
        ("ctl", "AG EF ball", "A [] E <> ball"),
        ("ctl", "A (ball U lit(1)) or E X !ball", "A (ball U lit(1)) or E X not ball"),
        ("ctl", "ball leads to lit(1)", "A [] (not ball or A <> lit(1))"),
    ],
)
def test_formulas_are_read_as_in_missions(logic, text, written):
    assert str(parse_claim(text, logic, WORDS).formula) == written


MISTAKES = r"""
ltl <> bal  # 4+3 unknown predicate 'bal' | did you mean 'ball'?
ltl A ball  # 1+1 ltl is about every run, and has no 'A' | leave it out, or ask with --ctl
ctl E ball  # 3+4 'E' needs an operator of paths | write AG, EF, AX or A (F U G)
ctl [] ball  # 1+7 in ctl an operator of paths stands directly behind A or E | write AG, EF, AX or A (F U G)
ctl ball or X ball  # 9+6 in ctl an operator of paths stands directly behind A or E | write AG, EF, AX or A (F U G)
ctl taken put  # 7+3 ctl is about all possible steps, and so has no 'taken' | write it in ltl, or write enabled
ctl A infinitely often ball  # 3+16 'infinitely often' is two operators of paths | write AG AF F
ltl taken clear
    # 7+5 the rule 'clear' is instantaneous, so no step is its own | name the ordinary rule that it follows
ltl taken jump  # 7+4 unknown rule 'jump' | the rules are light, light(2), light(1), put
ltl (ball  # 6+1 the text ends, expected ')'
"""


@pytest.mark.parametrize(("asked", "said"), list(rows(MISTAKES)))
def test_mistakes_are_shown_where_they_are(asked, said):
    logic, _, text = asked.partition(" ")
    (at, message), hint = said.partition(" | ")[0].split(" ", 1), said.partition(" | ")[2]
    column, width = map(int, at.split("+"))
    with pytest.raises(NotationError) as found:
        parse_claim(text, logic, WORDS)
    place, shown, mark, *advice = found.value.render(f"--{logic}").split("\n")
    assert place == f"--{logic}:1:{column}: {message}"
    assert (shown, mark) == (f"    1 | {text}", f"      | {' ' * (column - 1)}{'^' * width}")
    assert advice == ([f"hint: {hint}"] if hint else [])


@pytest.mark.parametrize(
    ("logic", "text"),
    [
        ("ltl", "not " * MOST_WORDS + "ball"),
        ("ltl", "X" * 5000),
        ("ltl", "[] " * (MOST_NESTED + 1) + "ball"),
        ("ctl", "AX " * (MOST_NESTED + 1) + "ball"),
        ("ltl", "<->".join(["ball"] * 60)),
        ("ctl", "A (ball W " * 20 + "ball" + ")" * 20),
        ("ltl", "(" * 500),
    ],
)
def test_formulas_are_bounded(logic, text):
    with pytest.raises(NotationError):
        parse_claim(text, logic, WORDS)


def test_what_is_within_the_bounds_is_decided():
    formula = parse_claim("not " * (MOST_WORDS - 1) + "ball", "ltl", WORDS).formula
    verdict = Decider(explore(SYSTEM)).decide("ltl", "not " * (MOST_WORDS - 1) + "ball")
    assert str(formula).startswith("not not not")
    assert verdict.outcome is ClaimOutcome.VIOLATED
    longest = Decider(explore(SYSTEM)).decide("ctl", "AX " * MOST_NESTED + "(ball or not ball)")
    assert longest.outcome is ClaimOutcome.HOLDS
