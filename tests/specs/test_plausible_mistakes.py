"""Mistakes that a newcomer makes, in the missions that ship: each is told at its place, once, with a remedy."""

import re
from pathlib import Path

import pytest

from specs.diagnostics import MissionError
from specs.elaboration import elaborate
from specs.parser import parse_bytes

MISSIONS = Path(__file__).parents[2] / "specs" / "missions"
COMMENT = re.compile(r"//[^\n]*")
TEXTS = {
    path.stem: COMMENT.sub("", path.read_text(encoding="utf-8"))
    for path in sorted(MISSIONS.glob("*.mission"))
}
OF_THREE = slice(None, None, 7)
MISTAKES = [
    (r"\{", ""),
    (r"\(", ""),
    (r"\)", ""),
    (r",", ""),
    (r"=>", ""),
    (r":(?= [A-Z])", ""),
    (r" = (?=[{pbc])", " "),
    (r" = (?=[pbc])", " == "),
    (r" = (?=[pbc])", " := "),
    (r"=>", "->"),
    (r"=>", "="),
    (r"=>", ":"),
    (r" or ", " | "),
    (r" and ", " & "),
    (r"\bnot ", "~"),
    (r" -> ", " => "),
    (r'"([^"\n]*)"', r"'\1'"),
    (r'"([^"\n]*)"', "\u201c\\1\u201d"),
    (r'"([^"\n ]*)"(?=:)', r"\1"),
    (r",(?= [A-Z])", ";"),
    (r",", ",,"),
    (r"\)", ",)"),
    (r"\{", "["),
    (r"\(", "["),
    (r"\{\n", ":\n"),
    (r"\bdrops\b", "drop"),
    (r"\breturns\b", "return"),
    (r"\bdrifts\b", "drift"),
    (r"\bappears\b", "appear"),
    (r"\blinked(?= \w+$)", "links"),
    (r"\bcontains\b", "contain"),
    (r"\bcarried by\b", "carried"),
    (r"\bhosted_at\b", "hosted at"),
    (r"\bhosted_at\b", "at"),
    (r"\bwith_behavior\b", "with_behaviour"),
    (r"\bwith_behavior\b", "with behavior"),
    (r"\bBigActor\b", "bigActor"),
    (r"\bBigActor\b", "agent"),
    (r"\bloop\b", "forever"),
    (r"\bwhile\b", "until"),
    (r"\breact\b", "receive"),
    (r"\breact\b", "match"),
    (r"\bcase\b", "when"),
    (r"\blet (\w+) = ", r"var \1 = "),
    (r"\blet (\w+) = ", r"\1 = "),
    (r"\bdef (\w+)\(", r"function \1("),
    (r"\bdef (\w+)\(([^)]*)\) =", r"def \1(\2)"),
    (r" if ", " when "),
    (r" if ", " && "),
    (r"\bcontrol\(([^()\n]*)\)", r"control \1"),
    (r"\bcontrol\(([^()\n]*)\)", r"\1"),
    (r"\bcontrol\(", "contol("),
    (r"\bobserve\(([^\n]*)\)\n", r"observe \1\n"),
    (r"MOVE_HOST_TO (\w+)", r"MOVE_TO \1"),
    (r"MOVE_HOST_TO (\w+)", r"move_host_to \1"),
    (r"CHILDREN\((\w+)\)", r"CHILDREN \1"),
    (r"PARENT\(HOST\)", "PARENT HOST"),
    (r"PARENT\(HOST\)", "PARENT()"),
    (r"send (\S+|\([^()]*\)) to (\w+)", r"send \2 \1"),
    (r'send ("\w+") to (\w+)', r"send(\2, \1)"),
    (r"send (\S+|\([^()]*\)) to (\w+)", r"\2.send(\1)"),
    (r"send (\S+|\([^()]*\)) to (\w+)", r"\2 ! \1"),
    (r"radius (\d+) m", r"radius \1"),
    (r"radius (\d+) m", r"radius \1 meters"),
    (r"radius (\d+) m", r"radius = \1 m"),
    (r"radius (\d+) m", r"\1 m"),
    (r"point \(([^()]*)\)", r"\1"),
    (r"point \(([^()]*)\)", r"(\1)"),
    (r"box \(([^()]*)\) \(", r"box (\1), ("),
    (r"box \(([^()]*)\) \(([^()]*)\)", r"box (\1, \2)"),
    (r"kind (\w+)", r"\1"),
    (r"kind (\w+)", r"kind \1:"),
    (r"driven", "drivable"),
    (r"driven", "moves"),
    (r"contains (\w+), ", r"contains \1 and "),
    (r'invariant "', r'invariant: "'),
    (r"invariant", "always"),
    (r"reachable", "eventually"),
    (r"deadlock_freedom", "deadlock_free"),
    (r"race_freedom", "no_races"),
    (r"actually (\w+) in (\w+)", r"actually \2 contains \1"),
    (r"if (\w+) in (\w+)", r"if in(\1, \2)"),
    (r"actually (\w+) in (\w+)", r"actual(\1 in \2)"),
    (r"ended (\w+)", r"\1 ended"),
    (r"ended (\w+)", r"ended(\1)"),
    (r"says", "say"),
    (r"arrives", "arrive"),
    (r"at most once", "once"),
    (r"Observation", "Observe"),
    (r"HOST\)", "hots)"),
    (r"SELF", "self"),
    (r"control timed", "control: timed"),
]


def mistaken(pattern, replacement):
    """Yield three missions with the mistake once, the first time that it can be made."""
    made = (
        (name, re.sub(pattern, replacement, text, count=1, flags=re.MULTILINE))
        for name, text in TEXTS.items()
    )
    yield from [(name, text) for name, text in made if text != TEXTS[name]][OF_THREE]


def found_in(name, text):
    source, mission = parse_bytes(f"{name}.mission", text.encode())
    elaborate(mission, source, MISSIONS)


@pytest.mark.parametrize(
    ("pattern", "replacement"), MISTAKES, ids=[f"{each} to {to}" for each, to in MISTAKES]
)
def test_a_plausible_mistake_is_told_once_where_it_is_with_a_remedy(pattern, replacement):
    tried = 0
    for name, text in mistaken(pattern, replacement):
        with pytest.raises(MissionError) as caught:
            found_in(name, text)
        (found,) = caught.value.diagnostics
        changed = next(at for at, (old, new) in enumerate(zip(TEXTS[name], text, strict=False)) if old != new)
        line, wrong = caught.value.source.line(found.span.start), caught.value.source.line(changed)
        assert found.hint, str(caught.value)
        assert abs(line - wrong) <= 1, str(caught.value)
        tried += 1
    assert tried


LISTED = [
    ("environment { wifi drop }", "drop", "did you mean 'drops'?"),
    ("environment { wifi:land drop and returns }", "drop", "did you mean 'drops'?"),
    ("def f() = { contol(MOVE_HOST_TO r0) }", "contol", "write control(MOVE_HOST_TO place)"),
    ("def f() = { let n = 2 * 3 }", "*", "numbers are only added and subtracted: + and -"),
    (
        "def f(t) = { if x in (CHILDREN(t)) { skip } }",
        "CHILDREN",
        "write observe(CHILDREN...), and ask what is received: react { case obs if x in obs => ... }",
    ),
    (
        """signature standard world { r0: Location = point (0, 0) }
        BigActor a hosted_at r0 with_behavior { let who = r0 react { case ("clear", =who) => skip } }""",
        "=who",
        "take the value, and compare it in a guard: case x if x == who => ...",
    ),
]


@pytest.mark.parametrize(("text", "place", "hint"), LISTED, ids=[row[1] for row in LISTED])
def test_what_a_session_met_is_told_better(text, place, hint):
    with pytest.raises(MissionError) as caught:
        found_in("m", text)
    (found,) = caught.value.diagnostics
    assert text[found.span.start : found.span.end] == place
    assert found.hint == hint
