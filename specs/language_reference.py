"""The reference of the mission language, generated from the grammar and the docstrings of the syntax tree."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from typing import Final, get_args, get_type_hints

from semantics.behaviours.commands import COMMANDS, WAY, Command
from specs import syntax as s
from specs.grammar import RESERVED, Build, grammar_text
from specs.standard_signature import STANDARD

INTRODUCTION: Final = """\
# The mission language

This page has every construct of a mission: its form and meaning, its grammar, and an example. The examples are parts of
one mission, [whole.mission](whole.mission), in the layout of `bigactors fmt`; that of [timing](#timing) is a part of
`endurance`, which ships. [codes.md](codes.md) lists the mistakes, with their remedies.

A mission is one text file in UTF-8, of at most one megabyte. Outside strings, white space only separates words. `//`
and `#` begin comments, which end with the line. `;` may separate declarations and statements. Line numbers in front of
a program, such as those of the paper's Figure 8, are ignored.

The grammar is in EBNF: words in quotes are literal, `[x]` is optional, `x*` repeats any number of times, `x+` at least
once.
"""

REGIONS: Final = """\
## Regions

The *region* of an entity is all points where it may be while a configuration lasts. `possibly`, `surely`, `at least`
and `within` ask for regions, in missions with `control timed`. Rules never do: configurations and runs are the same.

- Where the mission or a clause puts an entity, and no control could have, its region is that point or shape.
- An entity that drifts within a place may be anywhere in its face of that place.
- A vehicle that a control has left in a place may be anywhere in that place.
- A vehicle on its way may be on every shortest line from its place, by its VIA, to its destination: it may begin
  and end anywhere in these places. If one of them may move, it may be on a line between any two points of them.
- With `strays at most D`, a vehicle keeps within D of the shortest lines between its waypoints, and of its last one.
  Without it, D is the diameter of its circles (`circles 80 m` of radius), or 0, and a way is as wide as its places.
- Cargo has the region of its carrier.
- The altitudes of an entity are its own band, from take-off to landing, and all altitudes without a band. On the way
  from or to a carrier, the carrier's altitudes belong to the band.

In doubt `possibly` is true, and the other three are false. The doubt is 0.5 m for regions within 500 km of their
middle, and 5 m within 1,000 km. A circle, drawn as a polygon of 64 corners, adds 0.12 % of its radius. Farther regions,
and regions over a pole, are refused. Places, and entities with a certain position, are compared exactly.

Two vehicles that were sent to one place are not apart, unless their altitudes are: both go to one point.
"""

MISSES: Final = """\
## Observations that miss

With `observe may miss OilSpill` each observation has one answer for each set of spills that it may leave out: `sense`
is a choice among them. The trace names it: `missing oilSpill0`.

- The answer is that of a world from which the missed entities have vanished with their cargo: L_q = q(A(P ∖ M)). So
  `L ⊕ L_q` sends a missed entity to the region if it was believed in a searched place, and the content of a missed
  place is seen in the place around it.
- Only entities that the answer would show are missed: one observation of n of them has 2ⁿ answers. A mission may name
  eight entities (LS619).
- No agent misses its own host, or its host's carrier. `HOSTED_AT` alone misses no agent.
- An entity that an observation shows is there. Nothing bounds how often one is missed, and no fairness ends it.
- Every observer may miss the entity. A race is about the world's answer: a miss by itself makes no test stale.
"""

PLACES: Final = """\
## A file of places

The file `harbour.geojson`, which the world of the examples names:

<!-- file: harbour.geojson -->
```json
{
  "type": "FeatureCollection",
  "features": [
    {
      "type": "Feature",
      "properties": {"name": "harbour0", "kind": "Location"},
      "geometry": {
        "type": "Polygon",
        "coordinates": [[[-8.54, 37.14], [-8.52, 37.14], [-8.52, 37.12], [-8.54, 37.12], [-8.54, 37.14]]]
      }
    },
    {
      "type": "Feature",
      "properties": {"name": "buoy0", "kind": "Drifter"},
      "geometry": {"type": "Point", "coordinates": [-8.53, 37.13]}
    }
  ]
}
```
"""

WORDS: Final = r"""A name is a letter, followed by letters, digits and underscores. A channel's name may begin with a
digit and contain `:`, `-` and `.` between its parts: `control:gcs0`, `3g`, `wifi-1`. A number is decimal: `37.04`,
`4e2`. A string is written in double quotes, with the escapes `\"`, `\\`, `\n` and `\t`. These words cannot be names:
"""

# An example for some headings of the grammar: a part of a mission with the constructs under the heading.
EXAMPLES: Final[dict[str, str]] = {
    "Signature": """\
signature {
  kind Location contains Location, OilSpill, UAV, Vessel, Drifter, Station
  kind OilSpill contains UAV, Drifter
  kind UAV driven
  kind Vessel driven carries Drifter
  kind Drifter
  kind Station
}
""",
    "World": """\
world {
  searchArea0: Location = box (37.04, -8.59) (36.94, -8.79)  // (latitude, longitude)
  base0: Location = circle (37.14, -8.58) radius 900 m
  northGate0: Location = circle (37.1, -8.6) radius 500 m
  southGate0: Location = circle (37.06, -8.6) radius 500 m
  oilSpill0: OilSpill = circle (37, -8.7) radius 400 m
  uav0: UAV = point (37.14, -8.58) altitude 100 m to 300 m linked control:gcs0, wifi
  uav1: UAV = point (37.08, -8.55) linked control:gcs0
  uav2: UAV = point (37.08, -8.56) linked control:gcs0
  gcs0: Station = point (37.145, -8.58) linked control:gcs0, wifi
  gcs1: Station = point (37.12, -8.54) linked control:gcs1, wifi
  vessel0: Vessel = point (37.05, -8.5)
  drifter0: Drifter carried by vessel0
  tanker0: Vessel absent
  from "harbour.geojson"
}
""",
    "Beliefs": """\
believes {
  oilSpill0 unknown
  vessel0 in region
  gcs1 linked wifi
  tanker0 unlinked
}
""",
    "Reaction rules": """\
rule land(u: UAV, b: Location) { u[c] || b.$0 -> b.(u[c] | $0) }
""",
    "Behaviours and bigActors": """\
def visit(place) = {
  control(MOVE_HOST_TO place)
  observe(CHILDREN(PARENT(HOST)))
}

BigActor a hosted_at uav0 with_behavior {
  visit(searchArea0)
  react {
    case obs: Observation if oilSpill0 in obs =>
      let found = true
      control(MOVE_HOST_TO oilSpill0)
    case "home" => patrol({searchArea0, base0})
  }
}

BigActor patrol[i] for u in [uav1, uav0] hosted_at u with_behavior {
  for place in [searchArea0, base0] {
    visit(place)
  }
  send ("round", u, i) to patrol[uav1]
}
""",
    "Control actions": """\
BigActor pilot hosted_at uav1 with_behavior {
  control(MOVE_HOST_TO searchArea0 VIA northGate0, southGate0)
  observe(PARENT(HOST))
  react {
    case obs => control(land(HOST, base0))
  }
}

BigActor op hosted_at gcs0 with_behavior {
  control(MOVE uav1 TO base0 VIA southGate0)
  control(HAND uav1 TO gcs1)
}
""",
    "Statements": """\
def patrol(places) = {
  for place in places {
    choose {
      case => control(MOVE_HOST_TO place)
      case => skip
    }
    observe(CHILDREN(PARENT(HOST)))
    react {
      case obs: Observation =>
        let seen = obs of OilSpill
        if not empty(seen) {
          send ("seen", first(seen)) to op
        } else {
          display(obs)
        }
    }
  }
}
""",
    "Environment": """\
environment {
  oilSpill0 drifts among circle (37, -8.7) radius 400 m, circle (37.01, -8.72) radius 400 m
  buoy0 drifts within harbour0
  wifi drops and returns
  uav0 leaves wifi
  tanker0 appears at point (37, -8.7) linked ais
  says "home" to a at most 3 times
  uav0 arrives
}
""",
    "Live runs": """\
live {
  on broken assumption: return
  on broken property: hold
  FLY a within 10 min: return
  anyone within 1 min: continue
}
""",
    "Checks": """\
check {
  local_consistency
  race_freedom
  invariant "one at a time": forall x: UAV . x in base0 -> not pending op
  reachable "found": uav0 in oilSpill0 and a.found == true
  reachable "all done": forall x: agents with_behavior visit . ended x
  progress
  ltl "answered" under weak fairness of agents: pending OBS a leads to taken sense a
  ltl "watched" under strong fairness of actuate a and weak fairness of op, environment:
      [] <> actually uav0 in oilSpill0
  ctl "can always go home": AG EF uav0 in base0
}
""",
}

# A timed mission is checked by other properties, so its example belongs to a shipped mission, not to the whole one.
TIMED_FRAME: Final = "endurance"
TIMED_EXAMPLE: Final = """\
timing {
  tick 10 s
  UAV flies at 18 m/s to 25 m/s, climbs at 2 m/s to 5 m/s, circles 80 m
  uav0 lasts 45 min, restored in airfield0 after 20 min
  agents react within 10 s
  sense takes 10 s to 30 s
  HAND within 10 s
}

check {
  endurance
  within 40 min "home": ended patrol and actually uav0 in airfield0
  within 5 min "answered": pending OBS patrol leads to not pending OBS patrol
  invariant "in range": uav0 within 60 km of gcs0
  time "in the north": actually uav0 in north0
}
"""

_RULE_NAME: Final = re.compile(r"^\??(\w+)(?=:)|-> (\w+)$", re.MULTILINE)
_HEADING: Final = re.compile(r"^//: (.+)$", re.MULTILINE)
_RULE_CLEANUPS: Final = (
    (re.compile(r' \| ";"'), ""),  # separators
    (re.compile(r" -> \w+"), ""),  # names of alternatives
    (re.compile(r"\((\w+)\)([*+])"), r"\1\2"),
    (re.compile(r"(?<![\w\"])[?_](?=[a-z])"), ""),  # prefixes that only shape the tree
)


def language_reference() -> str:
    """Return the reference page in Markdown."""
    parts = [INTRODUCTION]
    for heading, rules in grammar_parts():
        if NODES[heading]:
            parts += [f"## {heading}\n", *_constructs(heading), _fenced(rules, "ebnf")]
        if heading == "Signature":
            parts += ["`signature standard` declares:\n", _fenced(STANDARD, "mission")]
        if heading == "Timing":
            parts += [f"Example:\n\n<!-- frame: {TIMED_FRAME} -->", _fenced(TIMED_EXAMPLE, "mission")]
        if heading == "Formulas":
            parts += [REGIONS, MISSES]
        if heading in EXAMPLES:
            parts += ["Example:\n", "<!-- frame: whole.mission -->", _fenced(EXAMPLES[heading], "mission")]
    reserved = ", ".join(f"`{word}`" for word in sorted(RESERVED))
    parts += ["## Words\n", WORDS, f"{reserved}\n"]
    return "\n".join([*parts, PLACES])


def whole_mission() -> str:
    """Return the mission of the examples."""
    return "\n".join(EXAMPLES.values())


def grammar_parts() -> Iterator[tuple[str, str]]:
    """Yield the headings of the grammar with their rules in readers' notation."""
    for heading, rules in _parts():
        shown = rules
        for pattern, replacement in _RULE_CLEANUPS:
            shown = pattern.sub(replacement, shown)
        yield heading, shown.strip() + "\n"


def _parts() -> Iterator[tuple[str, str]]:
    _, *parts = _HEADING.split(grammar_text())
    return zip(parts[::2], parts[1::2], strict=True)


def _built() -> dict[str, tuple[type[s.Node], ...]]:
    """Return the constructs built by the rules under each heading; each construct under its first heading only."""
    first: dict[type[s.Node], str] = {}
    for heading, rules in _parts():
        methods = (getattr(Build, rule or alias, None) for rule, alias in _RULE_NAME.findall(rules))
        for built in (get_type_hints(method)["return"] for method in methods if method is not None):
            for each in get_args(built) or (built,):
                if issubclass(each, s.Node):
                    first.setdefault(each, heading)
    return {heading: tuple(each for each in first if first[each] == heading) for heading, _ in _parts()}


NODES: Final = _built()
"""The constructs shown under each heading of the grammar."""


def forms(node: type[s.Node]) -> tuple[str, ...]:
    """Return the concrete syntax in the first line of a node's docstring."""
    return tuple(re.findall(r"`([^`]+)`", _documentation(node).split("\n", 1)[0]))


def _constructs(heading: str) -> Iterator[str]:
    for node in NODES[heading]:
        if node is s.Command:
            yield from map(_command, COMMANDS.values())
        shown, _, _ = _documentation(node).partition("\n\nAttributes:")  # attributes describe the tree
        yield f"- {' '.join(shown.split())}"
    yield ""


def _command(command: Command) -> str:
    told = inspect.getdoc(command.sides) or ""
    way = f" or `{command.write(command.operands, WAY)}`" if command.travels else ""
    return f"- `{command.form}`{way}: {told[:1].lower()}{told[1:]}"


def _documentation(node: type[s.Node]) -> str:
    return inspect.getdoc(node) or ""


def _fenced(text: str, language: str) -> str:
    return f"```{language}\n{text}```\n"
