"""Mistakes that a newcomer makes, in the missions that ship: each is told at its place, once, with a remedy."""

import re
from pathlib import Path

import pytest
from elaborating import mistakes, shown, told
from geojson import collection, feature
from text_tables import rows

from specs.diagnostics import Source
from specs.elaboration.mission import diagnose
from specs.parser import read

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
    (r"\bflies at\b", "flies"),
    (r"\bflies at\b", "speed"),
    (r"\blasts\b", "endures"),
    (r"\breact within\b", "within"),
    (r"\bsense within\b", "sense in"),
    (r"\bmessages over\b", "messages"),
    (r"\bat most every\b", "every"),
    (r" m/s", " mps"),
    (r" min\b", " minutes"),
    (r"\brestored in\b", "charged in"),
    (r"\btime(?= \")", "when"),
    (r"\btiming\b", "times"),
    (r"\bendurance$", "battery"),
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


@pytest.mark.parametrize(
    ("pattern", "replacement"), MISTAKES, ids=[f"{each} to {to}" for each, to in MISTAKES]
)
def test_a_plausible_mistake_is_told_once_where_it_is_with_a_remedy(pattern, replacement):
    tried = 0
    for name, text in mistaken(pattern, replacement):
        (found,) = mistakes(text, MISSIONS)
        changed = next(at for at, (old, new) in enumerate(zip(TEXTS[name], text, strict=False)) if old != new)
        assert found.hint, found
        assert abs(text.count("\n", 0, found.span.start) - text.count("\n", 0, changed)) <= 1, found
        tried += 1
    assert tried


PORT = """signature standard
world {
  base: Location = circle (37.14, -8.58) radius 900 m
  sea: Location = box (37.13, -8.5) (37.05, -8.7)
  gcs: Station = point (37.142, -8.58) linked control:gcs
  uav: UAV = point (37.14, -8.58) linked control:gcs
  boat: Vessel = point (37.1, -8.6) linked control:gcs, vhf
}
"""
ALONE = "BigActor p hosted_at uav with_behavior { skip }\n"
REMEDIES = r"""
environment { someone says go to p }  # go | a text stands in quotes: "go"
environment { wifi drop }  # drop | did you mean 'drops'?
environment { wifi:land drop and returns }  # drop | did you mean 'drops'?
def f() = { contol(MOVE_HOST_TO r0) }  # contol | write control(MOVE_HOST_TO place)
def f() = { let n = 2 * 3 }  # * | numbers are only added and subtracted: + and -
def f(t) = { if x in (CHILDREN(t)) { skip } }
    # CHILDREN | write observe(CHILDREN...), and test the answer: react { case obs if x in obs => ... }
BigActor q hosted_at uav with_behavior { let who = uav react { case ("clear", =who) => skip } }
    # =who | take the value, and compare it in a guard: case x if x == who => ...
world { lake: Lake = point (37.1, -8.6) }  # Lake | declare it: signature { kind Lake }
check { invariant "i": forall u: Drone . u in base }
    # Drone | the kinds are Drifter, Location, OilSpill, Station, Tanker, UAV and Vessel; or declare it: signature
    { kind Drone }
environment { radio drops and returns }
    # radio | the channels are control:gcs and vhf; or declare it: world { channel radio }
BigActor q hosted_at uav with_behavior { send "a" to me }  # me | the bigActors are p and q
BigActor q hosted_at plane with_behavior { skip }  # plane | the entities are base, boat, gcs, sea and uav
BigActor q hosted_at uva with_behavior { skip }  # uva | did you mean 'uav'?
BigActor q hosted_at uav with_behavior { control(land(base)) }
    # land | control actions are MOVE_HOST_TO place, MOVE entity TO place, PUT entity IN place, HAND entity TO
    station, CONNECT_HOST_TO node, DISCONNECT_HOST_FROM node
BigActor q hosted_at uav with_behavior { control(FLY_TO sea) }
    # FLY_TO | a vehicle is sent to an entity: declare target: Kind = circle (37.08, -8.55) radius 100 m, and write
    control(MOVE_HOST_TO target)
BigActor q hosted_at uav with_behavior { display(nothing) }
    # nothing | a variable is bound by let nothing = ...; a text is written "nothing"
BigActor q hosted_at uav with_behavior { control(MOVE_HOST_TO gcs) }
    # MOVE_HOST_TO gcs | name a place that may contain a UAV: base, sea
world { cell: Location = box (37.13, -8.5) (37.08, -8.6) }
    # cell | a place inside another touches no border: make sea a little larger
BigActor q hosted_at uav with_behavior { for c in base, sea { skip } }  # , | write for c in [base, sea] { ... }
BigActor q hosted_at uav with_behavior { choose c in base, sea { skip } }  # , | write choose c in [base, sea] { ... }
environment { vhf drops and comes back }  # comes | write returns instead of comes back
environment { vhf drops and recovers }  # recovers | write returns instead of recovers
world { raft: Drifter carried_by boat }  # carried_by | write carried by
BigActor q hosted_at uav with_behavior { wait 10 min }
    # wait | time passes in a react: react { after 10 min => ... }, with cases for earlier messages and observations
BigActor q hosted_at uav with_behavior { sleep 10 s }
    # sleep | time passes in a react: react { after 10 min => ... }, with cases for earlier messages and observations
world { cell: Location = rect (37.1, -8.6) (37.0, -8.5) }  # rect | write box (37.13, -8.5) (37.05, -8.7): two corners
BigActor q hosted_at uav with_behavior { print(3) }  # print | write display(value)
environment { boat drifts to sea }  # to | write drifts within sea, or drifts among sea, others
environment { boat appears in sea }  # in | write at instead of in
environment { boat moves }  # moves | write drifts within place0, or drifts among place0, place1
environment { boat drops vhf }
    # } | an event is written wifi drops, uav0 leaves wifi, boat0 drifts within place0, boat0 appears at place0
BigActor q hosted_at uav with_behavior { observe(NEIGHBOURS(base)) }
    # NEIGHBOURS | queries are PARENT(...), CHILDREN(...), LINKED_TO(...), HOSTED_AT(...), HOST and ALL
BigActor q hosted_at uav with_behavior { react { timeout 10 s => skip } }
    # timeout | write after 10 min => statements
BigActor q hosted_at uav with_behavior { for c in Location { skip } }
    # Location | list those that are meant: {base, sea}
BigActor q hosted_at base with_behavior { control(MOVE_HOST_TO sea) }
    # MOVE_HOST_TO sea | these entities are driven: boat, uav
world { x: UAV in base }
    # in | write = point (37.08, -8.55): its position decides its place; or carried by an entity
check { invariant "i": uav inside sea }  # inside | write in: uav0 in place0
check { invariant "i": uav in sea implies boat in sea }  # implies | write ->
check { invariant "i": for all u: UAV . u in sea }  # for | write forall u: Kind . formula
check { ltl "l": globally uav in sea }  # globally | write always
check { ltl "l" under fairness: eventually uav in sea }
    # fairness | write under weak fairness of environment, or of the name of a bigActor
BigActor q hosted_at uav with_behavior { control(MOVE_HOST_TO PARENT(boat)) }
    # PARENT | go where it was seen: observe(ALL) react { case obs: Observation if boat in obs =>
    control(MOVE_HOST_TO parent(boat, obs)) }
world { raft: Drifter = point (37.1, -8.6) linked to vhf }  # to | write linked vhf
check { invariant "i": uav at base }  # at | write in: uav in base
check { invariant "i": actually uav linked to vhf }  # to | write linked vhf
check { invariant "i": always uav in sea }  # always uav in sea | leave the operator in front out
check { invariant "i": G uav in sea }  # G uav in sea | leave the operator in front out
check { ltl "l" under strong fairness of send: eventually uav in sea }
    # send | write snd, its delivery; or req_snd, its request
check { progress under weak fairness of p, observe p }  # observe | write sense, its answer; or req_obs, its request
world { jet: UAW = point (37.1, -8.6) } BigActor f[u] for u in UAV hosted_at u with_behavior { send "a" to f[jet] }
    # UAW | did you mean 'UAV'?
BigActor q hosted_at uav with_behavior { observe(boat.children) }  # . | write CHILDREN(boat)
BigActor q hosted_at uav with_behavior { observe(CHILDREN(HOST.place)) }  # . | write PARENT(HOST)
check { invariant "i": uav.altitude < 100 }
    # uav | only bigActors have variables; write uav in place, uav linked channel
check { invariant "i": ended uav }  # uav | name the bigActor that it hosts: p
check { invariant "i": forall u: UAV u in base }  # u | write forall u: UAV . formula
check { invariant "i": exists u: UAV, u in base }  # , | write exists u: UAV . formula
check { invariant "i": forall u, v: UAV u in v }  # u | write forall u, v: UAV . formula
check { invariant "i": forall u, v in UAV . u in v }  # in | write forall u, v: UAV . formula
check { invariant "i": forall u v: UAV . u in v }  # v | write forall u, v: Kind . formula
check { invariant "i": forall u in UAV: u in base }  # in | write forall u: UAV . formula
check { invariant "i": actually uav = boat }  # = | ask where it is: uav in place, or of its links: uav linked channel
BigActor q hosted_at uav with_behavior { if uav in base { skip } }
    # base | observe it first: observe(CHILDREN(base)) react { case obs: Observation if x in obs => ... }
BigActor q hosted_at uav with_behavior { let x == 3 }  # == | a single = gives a value, == compares
"""


@pytest.mark.parametrize(("written", "said"), list(rows(REMEDIES)))
def test_a_remedy_is_what_was_meant_or_what_there_is(written, said):
    assert [f"{place} | {hint}" for place, _, hint in shown(PORT + ALONE + written)] == [said]


@pytest.mark.parametrize(
    ("written", "said"),
    [
        ("world { s: Vessel = point (37.15 N, 8.50 W) }", "N | write 37.15: south and west are negative"),
        ("world { s: Vessel = point (37.15, 8.50 W) }", "W | write -8.50: south and west are negative"),
        ("world { s: Vessel = point (37.1, -8.5) linked control gcs }",
         "control | a control authority is written control:gcs"),
        ("live { CTR within 5 min: return }",
         "within | write anyone within 5 min, or name the bigActor whose requests are limited"),
        ("timing { boat drifts every 10 min to 20 min }",
         "every | write at most every 10 min: the least time between two of them"),
        ("timing { vhf drops every 10 min }",
         "every | write at most every 10 min: the least time between two of them"),
        ("live { on broken assumption return }", "return | write assumption: return"),
        ("live { CTR p within 5 min hold }", "hold | write min: hold"),
        ("timing { boat drifts at most every 10 min to 20 min }",
         "to | leave the longer one out: at most every 10 min"),
        ("check { invariant my rule: uav in sea }", 'my | write it in double quotes: "my rule"'),
    ],
)  # fmt: skip
def test_a_remedy_has_the_words_that_were_meant(written, said):
    assert [f"{place} | {hint}" for place, _, hint in shown(PORT + ALONE + written)] == [said]


def test_a_place_with_a_bad_border_is_not_said_to_be_a_point_too():
    ferry = "signature { kind Box kind Boat driven carries Box kind Location contains Box, Boat }"
    text = f"""{ferry}
world {{
  dock0: Location = circle (37.02, -8.62) radius -500 m
  boat0: Boat = point (37.10, -8.60)
  box0: Box carried by boat0
}}
BigActor a hosted_at boat0 with_behavior {{ control(PUT box0 IN dock0) }}"""
    source = Source("m", text)
    assert [each.code.number for each in diagnose(read(source), source, Path()).mistakes] == ["LS301"]


FROM_FILE = """signature standard world { from "port.geojson" }
BigActor a hosted_at tug with_behavior { control(MOVE_HOST_TO dock) send "x" to b }
environment { vhf drops }
check { invariant "i": tug in dock }"""
KINDLESS = "feature 1 (dock): the feature has no kind; feature 2 (tug): the feature has no kind"
NO_QUAY = "the file has entities of a kind 'Quay' that the signature does not have"


@pytest.mark.parametrize(("kind", "code", "message"), [("", "LS306", KINDLESS), ("Quay", "LS202", NO_QUAY)])
def test_names_that_a_bad_file_would_have_given_are_not_told_as_unknown(tmp_path, kind, code, message):
    places = collection(*(feature(name, kind, [10.0, 54.0]) for name in ("dock", "tug")))
    (tmp_path / "port.geojson").write_text(places.replace(', "kind": ""', ""), encoding="utf-8")
    assert [each[:2] for each in told(FROM_FILE, tmp_path)] == [(code, message)]


@pytest.mark.parametrize(
    ("properties", "places"),
    [
        ("deadlock_fredom race_free", ["deadlock_fredom", "race_free"]),
        ("invariant foo: uav in base\n always uav in base", ["foo", "always"]),
        ('invariant "a": uav inn base reachable "b": uav inn sea', ["inn", "inn"]),
        (
            'ltl "f": AG uav in base\n ctl "g": always EF uav in base\n ltl "h": <> (forall u in UAV: u in base)',
            ["AG uav in base", "always EF uav in base", "in"],
        ),
        ('invariant "a": uav in base and\n boat inn base and\n uav in sea ltl "b": X X', ["inn", "}"]),
        ('invariant "a": ended q invariant "b": present r', ["q", "r"]),
    ],
)
def test_every_mistake_of_a_check_section_is_told(properties, places):
    whole = f"{PORT}{ALONE}check {{ {properties} }}"
    source = Source("m", whole)
    found = diagnose(read(source), source, MISSIONS).mistakes
    assert [whole[each.span.start : each.span.end] for each in found] == places
