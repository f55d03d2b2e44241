"""Words and symbols of other languages, and the mission language's forms for them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final

from specs.codes import Code
from specs.diagnostics import Diagnostic
from specs.parse_error import ParsePoint, Word, word_before

_BEHAVIOUR: Final = "a behaviour is defined by def name(parameters) = { ... }"
_ACTOR: Final = "write BigActor name hosted_at host with_behavior { ... }"
_VARIABLE: Final = "a variable is bound by let x = ..., and given another value by x = ..."
_REACT: Final = "write react { case obs: Observation => ... case m: Message => ... }"
_WAIT: Final = (
    "time passes in a react: react { after 10 min => ... }, with cases for earlier messages and observations"
)
_SEND: Final = "write send message to bigActor"

DECLARED: Final[Mapping[str, str]] = {
    **dict.fromkeys(
        ("function", "fn", "fun", "behavior", "behaviour", "proc", "procedure", "sub"), _BEHAVIOUR
    ),
    **dict.fromkeys(("agent", "Agent", "actor", "Actor", "robot", "process", "bigactor"), _ACTOR),
    **dict.fromkeys(("property", "properties", "verify", "assert"), 'write check { invariant "name": ... }'),
    **dict.fromkeys(
        ("import", "include", "use"), 'entities come from files: world { from "places.geojson" }'
    ),
    **dict.fromkeys(("entities", "places", "map"), "write world { name: Kind = point (37.08, -8.55) }"),
    **dict.fromkeys(
        ("times", "time", "timings", "durations", "clock", "clocks"),
        "write timing { agents react within 1 s }",
    ),
    **dict.fromkeys(("kinds", "types", "kind", "type"), "write signature { kind UAV driven }"),
}
"""Words by which other languages begin a declaration."""

DONE: Final[Mapping[str, str]] = {
    **dict.fromkeys(("var", "const", "val", "int", "set"), _VARIABLE),
    **dict.fromkeys(("forever", "repeat", "do"), "write loop { ... }, or while condition { ... }"),
    "until": "write while not condition { ... }",
    "foreach": "write for x in collection { ... }",
    **dict.fromkeys(("receive", "await", "on", "when", "expect"), _REACT),
    **dict.fromkeys(("wait", "sleep", "delay", "pause", "timeout"), _WAIT),
    **dict.fromkeys(("switch", "select"), "write match value { case ... => ... }"),
    **dict.fromkeys(
        ("elif", "elseif", "elsif", "otherwise"), "write } else if condition { ... } or } else { ... }"
    ),
    **dict.fromkeys(("print", "println", "log", "echo", "show", "printf"), "write display(value)"),
    **dict.fromkeys(("emit", "tell", "post", "notify", "publish", "broadcast", "say"), _SEND),
    **dict.fromkeys(("move", "goto", "go", "fly"), "write control(MOVE_HOST_TO place)"),
    **dict.fromkeys(("sense", "look", "query"), "write observe(CHILDREN(PARENT(HOST)))"),
    **dict.fromkeys(("pass", "noop", "continue"), "write skip"),
    **dict.fromkeys(
        ("return", "break", "exit", "stop"), "a behaviour ends with its last statement; use if, while"
    ),
}
"""Words by which other languages begin a statement."""

CHOSEN: Final[Mapping[str, str]] = {
    **dict.fromkeys(("when", "on", "of"), "write case pattern => statements"),
    **dict.fromkeys(("default", "otherwise", "else"), "write case _ => statements"),
    **dict.fromkeys(("timeout", "wait", "delay", "within", "until"), "write after 10 min => statements"),
}
_OTHERS: Final = frozenset({"default", "otherwise", "else", "other", "others"})
"""Names of the default case in other languages."""
ASKED: Final[Mapping[str, str]] = {
    **dict.fromkeys(("always", "never", "safety", "assert"), 'write invariant "name": formula'),
    **dict.fromkeys(("sometime", "possible", "cover"), 'write reachable "name": formula'),
    **dict.fromkeys(
        ("eventually", "liveness", "leadsto"),
        'of some run: reachable "name": formula; of every run: ltl "name": eventually formula',
    ),
    **dict.fromkeys(("no_races", "races", "race"), "write race_freedom"),
    **dict.fromkeys(("deadlock", "deadlocks", "no_deadlock"), "write deadlock_freedom"),
    **dict.fromkeys(("before", "after", "deadline", "by", "until"), 'write within 5 min "name": formula'),
    **dict.fromkeys(("earliest", "latest", "when", "duration"), 'write time "name": formula'),
    **dict.fromkeys(("battery", "energy", "fuel", "range"), "write endurance"),
    "no": "write race_freedom or deadlock_freedom",
}
OF_A_KIND: Final = dict.fromkeys(
    ("moves", "moving", "mobile", "movable", "drives", "flies"),
    "controls move driven kinds: kind UAV driven",
)

CLAIMED: Final[Mapping[str, str]] = {
    **dict.fromkeys(("at", "inside", "within", "on", "over", "contained", "is"), "write in: uav0 in place0"),
    **dict.fromkeys(("connected", "joined"), "write linked: uav0 linked wifi"),
}
"""Words by which other languages claim an entity's place or link."""

BEGINNING: Final[Mapping[str, str]] = {
    **dict.fromkeys(("globally", "henceforth", "invariantly"), "write always"),
    **dict.fromkeys(("finally", "sometime", "future"), "write eventually"),
    **dict.fromkeys(("distance", "dist", "near", "altitude", "size", "count"), "formulas have no functions"),
}
"""Words by which other languages begin a formula, where a name is possible too."""

JOINED: Final[Mapping[str, str]] = {
    **dict.fromkeys(("implies", "then", "if"), "write ->"),
    **dict.fromkeys(("iff", "equals"), "write <->"),
    "but": "write and",
    "unless": "write W",
    "releases": "write R",
}
"""Words by which other languages join formulas."""

HAPPENING: Final[Mapping[str, str]] = {
    **dict.fromkeys(
        ("moves", "wanders", "flows", "floats"), "write drifts within place0, or drifts among place0, place1"
    ),
    **dict.fromkeys(("disappears", "dies", "sinks", "crashes"), "write vanishes"),
    **dict.fromkeys(("lands", "returns"), "write arrives: its flights end"),
    **dict.fromkeys(("enters", "comes", "spawns", "shows"), "write appears at place0"),
}
"""Verbs of entities in other languages."""

BELIEVED: Final = dict.fromkeys(("not", "unseen", "unlocated", "hidden"), "write unknown: boat0 unknown")
WHEREABOUTS: Final = dict.fromkeys(
    ("in", "at", "on", "inside", "within"),
    "write = point (37.08, -8.55): its position decides its place; or carried by an entity",
)
ENTRIES: Final = dict.fromkeys(("link", "network", "radio", "comm", "bus"), "write channel name")
GEOMETRIES: Final[Mapping[str, str]] = {
    **dict.fromkeys(
        ("rect", "rectangle", "square", "bbox", "bounds"),
        "write box (37.13, -8.5) (37.05, -8.7): two corners",
    ),
    **dict.fromkeys(("disc", "disk", "round", "buffer"), "write circle (37.08, -8.55) radius 400 m"),
    **dict.fromkeys(
        ("poly", "area", "region", "shape", "ring"), "write polygon (37.1, -8.6) (37.1, -8.5) (37.0, -8.5)"
    ),
    **dict.fromkeys(
        ("pos", "position", "location", "coordinate", "coordinates", "at", "latlon", "gps", "marker"),
        "write point (37.08, -8.55)",
    ),
}
"""Names of geometries in other languages."""

OPERATORS: Final[Mapping[str, str]] = {
    **dict.fromkeys(("*", "/", "%", "^"), "numbers are only added and subtracted: + and -"),
    "&": "write and, or &&",
    "|": "write or, or ||",
    **dict.fromkeys(("~", "¬"), "write not"),
    **dict.fromkeys(("∧",), "write and"),
    **dict.fromkeys(("∨",), "write or"),
    **dict.fromkeys(("→", "⇒"), "write -> in a formula, => behind a case"),
    **dict.fromkeys(("∈",), "write in"),
    **dict.fromkeys(("≠",), "write !="),
    **dict.fromkeys(("≤", "≥"), "write <= or >="),
    "?": "write if condition { ... } else { ... }",
    "contains": "write element in collection",
    "has": "write element in collection",
    "is": "write == to compare",
}


def foreign_word(at: ParsePoint) -> Diagnostic | None:
    """`function visit() { ... }`, `var n = 3`, `receive { ... }`, `elif x { ... }`."""
    for applies, words in _CONTEXTS:
        if applies(at) and at.found.text in words:
            return _instead(at.found, words)
    for stands_before, words in _NAMED:
        if stands_before(at) and at.before.text in words:
            return _instead(at.before, words)
    return None


_BEFORE: Final[Mapping[str, str]] = {**OPERATORS, **DONE}

_NAMED: Final[tuple[tuple[Callable[[ParsePoint], bool], Mapping[str, str]], ...]] = (
    (lambda at: at.accepted >= {"directly", "linked"}, BEGINNING),
    (lambda at: at.accepted == {":"}, ENTRIES),
    (lambda at: at.accepted == {"=", "("}, _BEFORE),
)
"""Contexts in which the parser read a foreign word as a name and stopped after it."""

_CONTEXTS: Final[tuple[tuple[Callable[[ParsePoint], bool], Mapping[str, str]], ...]] = (
    (lambda at: at.at_declaration and not at.at_statement, DECLARED),
    (lambda at: {"case", "}"} <= at.accepted and not at.at_statement, CHOSEN),
    (lambda at: "invariant" in at.accepted, ASKED),
    (lambda at: "polygon" in at.accepted, GEOMETRIES),
    (lambda at: {"absent", "="} <= at.accepted, WHEREABOUTS),
    (lambda at: {"unknown", "unlinked"} <= at.accepted, BELIEVED),
    (lambda at: {"directly", "linked"} <= at.accepted, CLAIMED),
    (lambda at: "<->" in at.accepted, JOINED),
    (lambda at: "vanishes" in at.accepted, HAPPENING),
    (lambda at: "driven" in at.accepted, OF_A_KIND),
    (lambda at: at.at_statement or at.in_expression, DONE),
)


def _instead(word: Word, words: Mapping[str, str]) -> Diagnostic:
    message = f"{word.shown} is not a word of the language here"
    return Diagnostic(Code.MISSPELT_KEYWORD, word.span, message, words[word.text])


def foreign_operator(at: ParsePoint) -> Diagnostic | None:
    """`2 * 3`, `a & b`, `obs contains uav0`, `a => b`, `n += 1`, `x := 3`, `b.send(m)`, `b ! m`."""
    found, behind = at.found.text, at.prepared.text[at.found.span.end : at.found.span.end + 1]
    hint = OPERATORS.get(found, "")
    symbol = not found.isidentifier()
    in_formula = "<->" in at.accepted
    if found == "=>" and in_formula:
        hint = "an implication is written ->"
    elif at.accepted == {"=", "("} and found in ("+", "-") and behind in ("=", found):
        hint = f"write {at.before.text} = {at.before.text} {found} 1"
    elif at.accepted == {"=", "("} and found in (".", "!"):
        hint = f"a message is sent: send message to {at.before.text}"
    elif found == "." and at.in_expression:
        asked = (
            "an observation gives an entity's place: parent(uav0, obs); functions are called like size(obs)"
        )
        ranges = "there are no ranges of numbers: for goes through a set, {a, b}, or a route, [a, b]"
        hint = ranges if behind == "." else asked
    elif found == ">" and at.before.text == "=" and at.before.span.end == at.found.span.start:
        return _arrow(at)
    elif found == ":" and behind == "=" and "=" in at.accepted:
        hint = "write ="
    elif found == "=" and at.before.text == "=" and at.before.span.end == at.found.span.start:
        hint, both = "a single = gives a value, == compares", at.before.span.to(at.found.span)
        return Diagnostic(Code.UNKNOWN_CHARACTER, both, "'==' has no meaning here", hint)
    elif not hint or not (symbol or at.in_expression or in_formula or at.accepted & {"=>", "directly"}):
        return None
    return at.mistake(Code.UNKNOWN_CHARACTER if symbol else Code.MISSPELT_KEYWORD, _no_operator(at), hint)


def _arrow(at: ParsePoint) -> Diagnostic:
    """`default => skip`, where the parser read a word as a variable in an assignment."""
    word = word_before(at.prepared.text, at.before.span.start)
    both = at.before.span.to(at.found.span)
    if word.text in _OTHERS:
        message = f"{word.shown} is not a word of the language here"
        return Diagnostic(Code.MISSPELT_KEYWORD, word.span, message, "write case _ => statements")
    hint = "write case pattern => statements"
    return Diagnostic(Code.UNEXPECTED, both, f"'=>' stands behind a case, and {word.shown} is none", hint)


def foreign_form(at: ParsePoint) -> Diagnostic | None:
    """`let o = observe(HOST)`, `send "x" -> b`, `for (p in route)`, `uav0: UAV = base0`, `point (0, 0) at 90 m`."""
    hint = ""
    if at.at_expression and at.found.text in ("observe", "react"):
        hint = "a react receives the observation: observe(HOST) react { case obs: Observation => ... }"
    elif at.at_expression and at.found.text == "after":  # match { after 10 s => ... }
        hint = "only a react waits: react { case obs: Observation => ... after 10 s => ... }"
    elif "to" in at.accepted and at.in_expression and at.found.text in ("->", "→", "=>"):
        hint = _SEND
    elif at.found.text == "(" and at.before.text in ("for", "choose") and at.sorts == {"NAME"}:
        hint = f"write {at.before.text} {at.following.text} in ..., without brackets"
    elif "polygon" in at.accepted and "someone" not in at.accepted and at.found.is_name:
        hint = "write point (37.08, -8.55), box, circle or polygon: its position decides its place"
    elif "altitude" in at.accepted and at.found.text in ("at", "alt", "height") and at.following.is_number:
        hint = f"write altitude {at.following.text} m"
    return at.mistake(Code.UNEXPECTED, f"{at.found.shown} is not written here", hint) if hint else None


def _no_operator(at: ParsePoint) -> str:
    return f"{at.found.shown} has no meaning here"


def operator_first(at: ParsePoint) -> Diagnostic | None:
    """`in(a, obs)`: an operator called like a function; `&& found { ... }` as a statement."""
    if at.at_statement and at.found.text in ("&&", "||", "and", "or"):
        hint = "write if condition { ... }, or case pattern if condition => ..."
        return at.mistake(Code.UNEXPECTED, f"expected a statement, found {at.found.shown}", hint)
    if at.at_expression and at.found.text in ("in", "of", "and", "or"):
        hint = f"write it between the two: a {at.found.text} b"
        return at.mistake(Code.UNEXPECTED, f"expected an expression, found {at.found.shown}", hint)
    return None
