"""The kinds of mistakes in a mission: their codes, their titles, and their explanations by `bigactors explain`."""

from __future__ import annotations

from enum import Enum
from typing import Final

from semantics.behaviours.commands import COMMANDS, WAY

RANGES: Final = {
    "LS0": "the file",
    "LS1": "syntax",
    "LS2": "names and kinds",
    "LS3": "world and geometry",
    "LS4": "behaviour",
    "LS5": "reaction rules",
    "LS6": "environment, checks and live runs",
    "LS7": "warnings: allowed, but probably not meant",
    "LS8": "timing",
}

_FORMS: Final = ", ".join(f"`{command.form}`" for command in COMMANDS.values())
_WAYS: Final = " and ".join(
    f"`{each.write(each.operands, WAY)}`" for each in COMMANDS.values() if each.travels
)


class Code(Enum):
    """A kind of mistake. A new one is one more member here: number, title, explanation."""

    def __init__(self, number: str, title: str, explanation: str) -> None:
        self.number = number
        self.title = title
        self.explanation = " ".join(explanation.split())

    # --- LS0: the file
    FILE_TOO_LARGE = (
        "LS001",
        "file too large",
        """A mission file has at most one megabyte. Put large worlds into GeoJSON files: `from
        "harbour.geojson"`.""",
    )
    NOT_UTF8 = (
        "LS002",
        "not UTF-8",
        """A mission file is text in UTF-8. The message gives the offset of the first byte that is not;
        save the file as UTF-8.""",
    )
    CONTROL_CHARACTER = (
        "LS003",
        "control character",
        """A mission file contains no control characters except tabs and line ends. Is it a mission file, and
        not in UTF-16?""",
    )
    WORD_TOO_LONG = (
        "LS004",
        "word too long",
        """A single name, number, string or rule body has at most ten kilobytes. Is a quote or a
        brace missing?""",
    )
    NESTED_TOO_DEEPLY = (
        "LS005",
        "nested too deeply",
        """Brackets, blocks and operators nest at most two hundred deep. Define behaviours with `def`, name
        values with `let`, and split long conditions.""",
    )
    TOO_MANY_WORDS = (
        "LS006",
        "too many words",
        """A mission file has at most sixty thousand words and symbols. Put large worlds into
        GeoJSON files: `from "harbour.geojson"`.""",
    )
    UNREADABLE_FILE = (
        "LS007",
        "unreadable file",
        """The mission file, or a file it names with `from`, is missing, is no file or may not be read.""",
    )
    # --- LS1: syntax
    UNEXPECTED = (
        "LS101",
        "unexpected word",
        """This word is not allowed here; the message lists the allowed ones. The mistake may be just before it.""",
    )
    UNEXPECTED_END = (
        "LS102",
        "the file ends too early",
        """The file ends inside a declaration. Usually a closing brace is missing; the hint names the open one.""",
    )
    UNCLOSED_BRACKET = (
        "LS103",
        "bracket never closed",
        """A bracket is opened and not closed before the bracket around it closes.""",
    )
    UNOPENED_BRACKET = (
        "LS104",
        "bracket never opened",
        """A closing bracket has no opening one: there is one too many, or the opening one is commented out.""",
    )
    UNCLOSED_STRING = (
        "LS105",
        "string never closed",
        """A string begins and ends with a double quote on the same line. Within it write `\\"` for a
        quote, `\\\\` for a backslash, `\\n` for a line end and `\\t` for a tab.""",
    )
    UNKNOWN_CHARACTER = (
        "LS106",
        "unknown character",
        """This character has no meaning here. Strings need straight double quotes. The operators are `+`, `-`,
        comparisons, `and`, `or`, `not`, `in` and `of`.""",
    )
    MISSING_ARROW = (
        "LS107",
        "branch without '=>'",
        """A case is written `case pattern => statements`, or `case pattern if condition => statements`, and the
        branch behind all cases of a `react` `after 10 min => statements`.""",
    )
    SINGLE_EQUALS = (
        "LS108",
        "'=' in a condition",
        """`==` compares; `=` gives a variable a value and is a statement of its own.""",
    )
    MISSING_DESTINATION = (
        "LS109",
        "control action without its destination",
        f"""Control actions are written {_FORMS}, `rule(arguments)` or `{{ redex -> reactum }}`.""",
    )
    MISSPELT_KEYWORD = (
        "LS110",
        "no word of the language",
        """This word is close to a known one (upper and lower case differ), or belongs to another language: the
        hint gives the form of this language.""",
    )
    RESERVED_WORD = (
        "LS111",
        "reserved word used as a name",
        """Words that begin statements or occur in expressions cannot be names. Choose another name.""",
    )
    BAD_NUMBER = (
        "LS112",
        "bad number",
        """Coordinates and lengths are finite decimal numbers, such as `37.04`, `-8.59` or `4e2`; counts and
        numbers in expressions are whole.""",
    )
    MISSING_RECIPIENT = (
        "LS113",
        "message without a recipient",
        """A message is sent with `send e to a`, or with `send(e, a)`.""",
    )
    REPEATED_CLAUSE = (
        "LS114",
        "repeated clause",
        """Each clause after a kind or an entity may be written once.""",
    )
    UNKNOWN_OPTION = (
        "LS115",
        "unknown option",
        """`scheduler` is program_order, unordered or fcfs; `control` is atomic or timed; the type of a
        pattern is Observation or Message.""",
    )
    MISSING_COMMA = (
        "LS116",
        "missing comma",
        """Items of a list, arguments and coordinates are separated by commas.""",
    )
    CHAINED_COMPARISON = (
        "LS117",
        "chained comparison",
        """Comparisons do not chain: write `a < b and b < c`.""",
    )
    MISSING_UNIT = (
        "LS118",
        "number without a unit",
        """Lengths have the units `400 m` and `1.5 km`, durations `100 ms`, `90 s`, `10 min` and `1.5 h`, speeds
        `18 m/s`, `65 km/h` and `35 kn`.""",
    )
    MISPLACED_STATEMENT = (
        "LS119",
        "statement outside a behaviour",
        """Statements belong in the body of a bigActor, `BigActor a hosted_at h with_behavior { ... }`, or of a
        behaviour, `def b() = { ... }`.""",
    )
    MISSING_BRACE = (
        "LS120",
        "missing '{'",
        """Sections, behaviours, blocks and rule bodies are enclosed in braces.""",
    )
    MISSING_HOST = (
        "LS121",
        "bigActor without a host",
        """A bigActor is written `BigActor name hosted_at host with_behavior { ... }`; the name may be
        left out.""",
    )
    MISSING_EQUALS = (
        "LS122",
        "definition without '='",
        """A behaviour is defined by `def name(parameters) = { ... }`, and a variable by `let name =
        value`.""",
    )
    MISSING_KIND = (
        "LS123",
        "entity without a kind",
        """An entity is declared with its kind, and then its placement: `uav0: UAV = point (37.08, -8.55)`. A
        parameter of a rule has a kind, too: `rule land(u: UAV, b: Location) { ... }`.""",
    )
    BAD_COORDINATE = (
        "LS124",
        "not a coordinate",
        """A coordinate is `(latitude, longitude)` in degrees, as in `point (37.08, -8.55)`.""",
    )
    REPEATED_HEADER = (
        "LS125",
        "misplaced header",
        """`mission name` is written once, before all declarations.""",
    )
    BAD_ESCAPE = (
        "LS126",
        "unknown escape",
        """In a string, a backslash is followed by a quote, a backslash, `n` or `t`.""",
    )
    MISPLACED_VIA = (
        "LS127",
        "'VIA' without a move",
        f"""Only a move has a way: {_WAYS}. VIA stands once, behind the destination.""",
    )
    MISPLACED_AFTER = (
        "LS128",
        "misplaced 'after' branch",
        """A `react` has at most one `after` branch, behind all its cases: `after 10 min => statements`.""",
    )
    # --- LS2: names and kinds
    UNKNOWN_NAME = (
        "LS201",
        "unknown name",
        """No entity, place, channel, bigActor, behaviour, rule, function or variable in scope has this
        name.""",
    )
    UNKNOWN_KIND = (
        "LS202",
        "unknown kind",
        """No signature declares this kind; only its first use is reported. `signature standard` declares Location,
        OilSpill, UAV, Vessel, Tanker, Drifter and Station. Others are declared by `signature { kind Tug driven }`, or
        beside those, `signature standard { kind Tug driven  kind Location contains Tug }`.""",
    )
    DUPLICATE_NAME = (
        "LS203",
        "name declared twice",
        """Entities, kinds, bigActors and channels all have different names; so do rules among each other, and
        behaviours. `region` and `unknown` are reserved for observations.""",
    )
    WRONG_SORT = (
        "LS204",
        "name of another sort",
        """The name belongs to something that is not allowed here: a bigActor where a node is expected, or a
        kind where an entity is.""",
    )
    UNUSABLE_NAME = (
        "LS205",
        "name that cannot be written",
        """An entity in a file has a name that a mission cannot have: letters, digits and `_`, a letter first,
        and no reserved word.""",
    )
    # --- LS3: world and geometry
    BAD_GEOMETRY = (
        "LS301",
        "no geometry on the earth",
        """Latitudes are between -90 and 90 degrees, longitudes between -180 and 180; borders do not cross
        themselves; a radius is positive; an altitude band begins with its lower end.""",
    )
    NO_WHEREABOUTS = (
        "LS302",
        "entity without one placement",
        """An entity has a placement (`= point (37.08, -8.55)`) or a carrier (`carried by vessel0`), or is
        `absent` until it appears.""",
    )
    BAD_CARRIER = (
        "LS303",
        "carrier that cannot carry",
        """A carrier must be in the world, and of a kind that carries the kind of its cargo: `kind Vessel carries
        Drifter`.""",
    )
    CYCLIC_NESTING = (
        "LS304",
        "cyclic nesting",
        """Nothing is inside itself, neither directly nor through others.""",
    )
    PLACES_OVERLAP = (
        "LS305",
        "places that do not nest",
        """Two places that never move, of kinds that may contain something, must nest or be disjoint: otherwise
        an entity in both has no unique parent.""",
    )
    BAD_FILE = (
        "LS306",
        "mistake in a world file",
        """A file named with `from` has a mistake, or the clauses after it do not fit its format.""",
    )
    TOO_MANY_ENTITIES = (
        "LS307",
        "too many entities",
        """A mission has at most two thousand entities, and 1.2 million pairs of an entity and a place. Reduce a
        file with `within` (an area), `keep` (some kinds) or `limit` (a number).""",
    )
    MISSING_EXTRA = (
        "LS308",
        "extra not installed",
        """AIS recordings are read with pyais, which the extra `ais` installs.""",
    )
    BAD_BELIEF = (
        "LS309",
        "impossible belief",
        """The initial L is a bigraph: each node is in the region or in a node of L whose kind may contain it,
        and in one place only.""",
    )
    # --- LS4: behaviour
    WRONG_ARITY = (
        "LS401",
        "wrong number of arguments",
        """A behaviour, rule or function is given more or fewer arguments than it has parameters.""",
    )
    UNBOUND_VARIABLE = (
        "LS402",
        "assignment to an unbound variable",
        """`x = e` assigns to a variable that is bound already. `let x = e` binds a new one.""",
    )
    UNBOUNDED_RECURSION = (
        "LS403",
        "recursion that is not a tail call",
        """A behaviour may call itself, or a behaviour that calls it, only as its last statement.""",
    )
    EMPTY_LOOP = (
        "LS404",
        "empty loop",
        """A `loop` without a statement runs for ever and does nothing.""",
    )
    NAMELESS_SPAWN = (
        "LS405",
        "spawned bigActor without a name",
        """A spawned bigActor has a name: `spawn b hosted_at h with_behavior visit(place0)`.""",
    )
    WRONG_QUERY = (
        "LS406",
        "query without an answer",
        """`HOSTED_AT(q)` yields bigActors, which have no parents, children or links: it can only be the
        outermost relation of a query.""",
    )
    WRONG_VALUE = (
        "LS407",
        "value of another type",
        """A value of this type is not allowed here: a condition is true or false, `size` counts a set or an
        observation, `MOVE_HOST_TO` needs an entity, `send` a bigActor. Types are inferred; a line in brackets
        gives the variable that value. It is a mistake only where no possible value is allowed.""",
    )
    BAD_FAMILY = (
        "LS408",
        "family that cannot be written out",
        """A family has a member for each entity of a kind, or of a set or a route that names each once:
        `BigActor patrol[i] for u in UAV ...`, `for u in [uav1, uav0]`. Written out, all members have at most a
        hundred thousand words together.""",
    )
    # --- LS5: reaction rules
    RULE_SYNTAX = (
        "LS501",
        "mistake in a rule body",
        """The body of a reaction rule is `redex -> reactum` in the notation of the paper's runtime:
        `name_Control[links].(children | $0)`, with `|` between neighbours and `||` between regions.""",
    )
    CREATES_OR_DELETES = (
        "LS502",
        "rule that creates or deletes",
        """Nothing creates or deletes a node. Both sides of a rule name the same nodes, and each node has a
        name.""",
    )
    MOVED_CONTENT = (
        "LS503",
        "rule that moves unknown content",
        """A site `$0` stands for the other contents of a node. Contents do not move: a site is under the same
        node on both sides.""",
    )
    UNPLACED_NODE = (
        "LS504",
        "node moved to no place",
        """A node that moves goes into a node of the rule, or beside a node that stays: `b.(u | $0) -> b.$0 | u`
        puts u beside b.""",
    )
    RULE_WITHOUT_HOST = (
        "LS505",
        "rule without its host",
        """A control involves the host of its bigActor: the redex names `HOST`, or a node that can be the host.""",
    )
    UNREALISABLE = (
        "LS506",
        "unrealisable control",
        """The control can never be carried out: the node is not driven, or its new place may not contain its
        kind or has no room for it.""",
    )
    KIND_MISMATCH = (
        "LS507",
        "node of another kind",
        """A node is written with a kind that is not its own: `uav0_Vessel` where uav0 is a UAV.""",
    )
    BAD_WAY = (
        "LS508",
        "way that cannot be taken",
        """VIA lists the places that a move passes: at most twenty, each named once, none of them the mover or its
        destination, and each of a kind that may contain the mover.""",
    )
    # --- LS6: environment and checks
    SAME_PLACEMENT = (
        "LS601",
        "placement listed twice",
        """All placements of a `drifts among` or `appears at` clause must be different.""",
    )
    TWO_DRIFTS = (
        "LS602",
        "entity with two drifts",
        """An entity has at most one `drifts` clause. List all its placements there.""",
    )
    INEXACT_DRIFT = (
        "LS603",
        "drift within that would not be exact",
        """`drifts within` replaces infinitely many placements by finitely many. That is exact for one entity
        among places that do not move. Otherwise list placements: `drifts among`.""",
    )
    POINTLESS_CLAUSE = (
        "LS604",
        "clause that can never apply",
        """The environment can never do this: bring in an entity that is present, or return an entity to a
        channel that it was never on.""",
    )
    NO_RECIPIENT = (
        "LS605",
        "'says' without a recipient",
        """`says` needs `to` and a bigActor, unless there is exactly one bigActor.""",
    )
    REPEATED_SETTING = (
        "LS606",
        "said twice",
        """`scheduler`, `control` and each property, channel drop, departure and precaution may be written once.""",
    )
    FORMULA_TOO_LARGE = (
        "LS607",
        "formula too large",
        """Quantifiers are written out, and `<->` doubles its sides. After that, the properties of a mission
        have at most fifty thousand atoms. Parts of `invariant`, `reachable` and `within` about entities alone
        are not written out, and may ask two hundred thousand atoms of a configuration.""",
    )
    NOT_QUANTIFIED = (
        "LS608",
        "comparison of two fixed names",
        """In properties, at least one side of `x == y` is a quantified name: `forall x: UAV . forall y: UAV .
        x == y or ...`.""",
    )
    NOT_CONSTANT = (
        "LS609",
        "value that is not constant",
        """A message of `says`, the value behind `=` in a pattern (`=uav0`), and a value that a property
        compares a variable with, are constants: texts, numbers, truth values, names, tuples or sets of
        these.""",
    )
    TOO_MANY_MISTAKES = (
        "LS610",
        "more mistakes",
        """At most a hundred mistakes are shown; the others are counted.""",
    )

    WRONG_LOGIC = (
        "LS611",
        "operator of another logic",
        """`invariant` and `reachable` are about single configurations. `ltl` is about every run: `[]`, `<>`, X,
        U, R, W and `taken`, without A and E. In `ctl` each path operator directly follows A or E. `env` and
        `say` are steps of no bigActor.""",
    )

    NOT_COMPARABLE = (
        "LS613",
        "comparison without a meaning",
        """`<`, `<=`, `>` and `>=` compare numbers. If a variable only has values of one type, compare it with a value
        of that type.""",
    )

    BAD_TIME_LIMIT = (
        "LS612",
        "time limit out of bounds",
        """The time of an `after` branch, and a time limit of the `live` section, is more than zero, and at most
        a week.""",
    )

    EMPTY_MISSION = (
        "LS614",
        "nothing to check",
        """The file declares nothing to check or to fly. Is it the right file?""",
    )

    NO_BIGACTOR = (
        "LS615",
        "mission without a bigActor",
        """A mission without bigActors can be shown, and recordings can be replayed in its places, but a verdict
        on it would be empty.""",
    )

    BAD_RANGE = (
        "LS616",
        "length out of bounds",
        """A distance between entities is above 0 m. `strays` is at most 100 km, and at least the diameter of
        the vehicle's circles.""",
    )

    NOT_A_PLACE = (
        "LS617",
        "place without an inside",
        """`possibly x in p` and `surely x in p` ask for a place p: an entity with an area, or one that carries
        x. For a point ask for a distance: `x at least 50 m from p`, `x within 3 km of p`.""",
    )

    NOT_UNDER_WAY = (
        "LS618",
        "region of control that takes no time",
        """`possibly`, `surely`, `at least` and `within` are about ways. With `control atomic` nothing is under
        way: write `control timed`.""",
    )

    TOO_MANY_MISSED = (
        "LS619",
        "too many entities to miss",
        """Each entity that `observe may miss` names doubles the answers of an observation. The clauses of a
        mission name at most eight entities.""",
    )
    # --- LS7: warnings
    NOTHING_QUANTIFIED = (
        "LS701",
        "quantifier over nothing",
        """A property quantifies over a kind that has no entity, or over bigActors that do not exist: `forall`
        is always true, `exists` never. Or a family has no member. Declare one (an entity may be `absent` at
        first), or quantify over others.""",
    )

    FAR_FROM_THE_REST = (
        "LS702",
        "far from everything else",
        """An entity is a thousand kilometres or more from all others; or a point is 50 km or more from all else, and
        twice as far as all else extends. Usually latitude and longitude are swapped, or a digit is wrong: missions use
        (latitude, longitude), GeoJSON uses [longitude, latitude].""",
    )

    TWO_TYPES = (
        "LS703",
        "variable of two types",
        """A variable has values of different types, and one of them is not allowed where the variable is used.
        It is no mistake if the other one is always there then; use a variable for each.""",
    )

    ALWAYS_THE_SAME = (
        "LS704",
        "comparison that is always the same",
        """Values of different types are never equal, and a set or an observation has no members of that type.
        `"base"` is a text, `base` the name of an entity.""",
    )

    NEVER_INSIDE = (
        "LS706",
        "containment that the signature forbids",
        """A formula asks whether one entity is in another, which is always false: the other kind neither
        contains nor carries it, nor anything that could contain it.""",
    )

    PROBABLY_SWAPPED = (
        "LS705",
        "probably all swapped",
        """Everything that floats (a Vessel, a Boat) stands on land, 100 km from any water, or everything is far
        out at sea and would be near a coast with latitude and longitude exchanged. Missions use (latitude,
        longitude), GeoJSON uses [longitude, latitude]. Rivers and canals are not known.""",
    )

    BOUNDS_NOTHING = (
        "LS707",
        "bound that is impossible or unused",
        """A line of `timing` is about a kind that has no entity; or a vehicle lasts for less than its shortest
        flight.""",
    )

    NEVER_WAITS = (
        "LS708",
        "loop that asks and never waits",
        """The requests of the loop pile up, and an exploration stops at 64 of one bigActor (`--max-pending`).
        Let each turn wait for its answer.""",
    )

    MAY_CROSS = (
        "LS709",
        "flight that may cross a forbidden place",
        """An invariant keeps a vehicle, or what it may carry, out of a place, and the straight way of one of its
        flights may lead through it. `check` warns only if a configuration is reached where it may be there.
        `actually` does not cover a vehicle in transit: ask for `not possibly uav0 in place0`. Or lead the flight around
        by VIA, or in several moves.""",
    )

    HIDES_AN_ENTITY = (
        "LS710",
        "pattern that takes anything for an entity's name",
        """A name in a pattern is a new variable, which takes any value, and hides an entity of that name.
        `=spill` compares; another name takes any value.""",
    )

    ONE_POINT = (
        "LS711",
        "two vehicles that may be sent to one point",
        """In a mission with properties about ways, two vehicles may be sent to one place, and so to one point. Neither
        their altitudes nor a property part them: `uav0 at least 50 m from uav1`. `check` warns only if both may be
        under way there, or there, at one time.""",
    )

    # --- LS8: timing
    BAD_DURATION = (
        "LS801",
        "duration or speed out of bounds",
        """Durations in `timing` and deadlines are whole numbers of ticks, and at most a week. A tick is a
        second unless the section sets another: `tick 100 ms`. Speeds are above 0 m/s.""",
    )
    EMPTY_INTERVAL = (
        "LS802",
        "interval that ends before it begins",
        """The shorter time, or the lower speed, comes first: `takes 1 s to 3 s`, `flies at 18 m/s to 25 m/s`, `after 10
        min, within 30 min`.""",
    )
    NOT_TIMED = (
        "LS803",
        "timing of control that takes no time",
        """With `control atomic` no flight takes any time. A mission with `timing` needs `control timed`.""",
    )
    NO_TIMING = (
        "LS804",
        "property of time in a mission without timing",
        """`within`, `endurance` and `time` ask when something happens. The section `timing` gives the durations.
        """,
    )
    UNTIMED_PROPERTY = (
        "LS805",
        "property that is not decided in time",
        """`ltl`, `ctl`, `progress` and `fairness` are about runs without times. With `timing`, ask for a
        bounded response, `within 5 min "answered": F leads to G`, or check the mission without that section.""",
    )
    NOT_IN_ENVIRONMENT = (
        "LS806",
        "time of an event that never happens",
        """The section `environment` lists the possible events, and `timing` how often, or when, they happen.""",
    )
    NOT_DRIVEN = (
        "LS807",
        "motion of an entity that is not driven",
        """Speeds and endurance are those of vehicles: of entities of a kind that is declared `driven`.""",
    )
    TAKES_ITS_WAY = (
        "LS808",
        "time of a flight",
        """The duration of a flight follows from the distances on the map and the speed of the vehicle: `UAV flies at
        18 m/s to 25 m/s`.""",
    )

    @property
    def range(self) -> str:
        """The subject of the mistakes whose numbers begin with the same digit."""
        return RANGES[self.number[:3]]


def find_code(number: str) -> Code | None:
    """Return the code with that number, in either case.

    >>> find_code("ls105").title
    'string never closed'
    """
    return next((code for code in Code if code.number == number.strip().upper()), None)


def explain(code: Code) -> str:
    """Return the text that `bigactors explain` prints for a code."""
    return f"{code.number}: {code.title} ({code.range})\n\n{code.explanation}\n"


def code_list() -> str:
    """Return all codes in Markdown, by their ranges, for the documentation."""
    codes = sorted(Code, key=lambda code: code.number)
    return "\n".join(
        f"## {number}xx: {subject}\n\n{''.join(map(_item, (code for code in codes if code.range == subject)))}"
        for number, subject in RANGES.items()
    )


def _item(code: Code) -> str:
    return f"- **{code.number}**, {code.title}: {code.explanation}\n"
