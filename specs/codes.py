"""Every mistake a mission can contain: its code, its title, and what `bigactors explain` says of it."""

from __future__ import annotations

from enum import Enum
from typing import Final

RANGES: Final = {
    "LS0": "the file",
    "LS1": "syntax",
    "LS2": "names and kinds",
    "LS3": "world and geometry",
    "LS4": "behaviour",
    "LS5": "reaction rules",
    "LS6": "environment and checks",
}


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
        """A mission file holds one megabyte at the most. Large worlds belong into GeoJSON files: `from
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
        """A mission file has no NUL bytes and no other control characters than tabs and line ends: it is
        probably not a mission file, or in UTF-16.""",
    )
    WORD_TOO_LONG = (
        "LS004",
        "word too long",
        """A single name, number, string or rule body holds ten kilobytes at the most. Is a quote or a
        brace missing?""",
    )
    NESTED_TOO_DEEPLY = (
        "LS005",
        "nested too deeply",
        """Brackets, blocks and operators nest two hundred levels deep at the most. Define behaviours
        with `def`, name values with `let`, and split long conditions.""",
    )
    TOO_MANY_WORDS = (
        "LS006",
        "too many words",
        """A mission file holds a hundred and fifty thousand words and symbols at the most. Large worlds
        belong into GeoJSON files: `from "harbour.geojson"`.""",
    )
    UNREADABLE_FILE = (
        "LS007",
        "unreadable file",
        """The mission file, or a file it names with `from`, is missing, is not a file or may not be
        read.""",
    )
    # --- LS1: syntax
    UNEXPECTED = (
        "LS101",
        "unexpected word",
        """Something stands where it cannot; the message lists what can stand there. The mistake may be
        just before it.""",
    )
    UNEXPECTED_END = (
        "LS102",
        "the file ends too early",
        """The file ends inside a declaration. Mostly a closing brace is missing; the hint says which one
        is open.""",
    )
    UNCLOSED_BRACKET = (
        "LS103",
        "bracket never closed",
        """A bracket is opened and not closed before the bracket around it closes.""",
    )
    UNOPENED_BRACKET = (
        "LS104",
        "bracket never opened",
        """A closing bracket has no opening one. Mostly there is one too many, or the opening one was
        commented out.""",
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
        """A character that has no meaning in a mission. Quotes pasted from a document are often the
        typographic ones: strings take straight double quotes.""",
    )
    MISSING_ARROW = (
        "LS107",
        "case without '=>'",
        """A case is written `case pattern => statements`, with a guard `case pattern if condition =>
        statements`.""",
    )
    SINGLE_EQUALS = (
        "LS108",
        "'=' in a condition",
        """`==` compares; `=` gives a variable a value and is a statement of its own.""",
    )
    MISSING_DESTINATION = (
        "LS109",
        "control action without its destination",
        """Control actions are written `MOVE_HOST_TO place`, `MOVE entity TO place`, `CONNECT_HOST_TO
        node`, `DISCONNECT_HOST_FROM node`, `HAND entity TO station`, `PUT entity IN place`,
        `rule(arguments)` or `{ redex -> reactum }`.""",
    )
    MISSPELT_KEYWORD = (
        "LS110",
        "misspelt keyword",
        """A word stands where the language has words of its own, and it nearly is one of them. Case
        matters.""",
    )
    RESERVED_WORD = (
        "LS111",
        "reserved word used as a name",
        """The words that begin statements or stand in expressions cannot be names. Choose another name.""",
    )
    BAD_NUMBER = (
        "LS112",
        "bad number",
        """Coordinates and lengths are finite decimal numbers, such as `37.04`, `-8.59` or `4e2`; counts
        and the numbers of expressions are whole.""",
    )
    MISSING_RECIPIENT = (
        "LS113",
        "message without a recipient",
        """A message is sent with `send e to a`, or with `send(e, a)`.""",
    )
    REPEATED_CLAUSE = (
        "LS114",
        "repeated clause",
        """Each of the clauses that may follow a kind or an entity is written once.""",
    )
    UNKNOWN_OPTION = (
        "LS115",
        "unknown option",
        """`scheduler` is program_order, unordered or fcfs; `control` is atomic or timed; a pattern's
        type is Observation or Message.""",
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
        "length without a unit",
        """Lengths are in metres or kilometres: `400 m`, `1.5 km`.""",
    )
    MISPLACED_STATEMENT = (
        "LS119",
        "statement outside a behaviour",
        """Statements stand in the body of a bigActor, `BigActor a hosted_at h with_behavior { ... }`, or
        of a behaviour, `def b() = { ... }`.""",
    )
    MISSING_BRACE = (
        "LS120",
        "missing '{'",
        """Sections, behaviours, blocks and rule bodies stand in braces.""",
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
        """An entity is declared as `name: Kind`, then where it is: `uav0: UAV = point (37.08, -8.55)`. A
        rule's parameter has a kind too: `rule land(u: UAV, b: Location) { ... }`.""",
    )
    BAD_COORDINATE = (
        "LS124",
        "not a coordinate",
        """A coordinate is `(latitude, longitude)` in degrees, as in `point (37.08, -8.55)`.""",
    )
    REPEATED_HEADER = (
        "LS125",
        "misplaced header",
        """`mission name` stands once, before all declarations.""",
    )
    BAD_ESCAPE = (
        "LS126",
        "unknown escape",
        """In a string, a backslash stands before a quote, a backslash, `n` or `t`.""",
    )
    # --- LS2: names and kinds
    # --- LS3: world and geometry
    # --- LS4: behaviour
    # --- LS5: reaction rules
    RULE_SYNTAX = (
        "LS501",
        "mistake in a rule body",
        """The body of a reaction rule is `redex -> reactum` in the notation of the paper's runtime:
        `name_Control[links].(children | $0)`, with `|` between neighbours and `||` between regions.""",
    )
    # --- LS6: environment and checks

    @property
    def range(self) -> str:
        """What the first digit of the number says it is about."""
        return RANGES[self.number[:3]]


def find_code(number: str) -> Code | None:
    """Return the code with that number, in either case.

    >>> find_code("ls105").title
    'string never closed'
    """
    return next((code for code in Code if code.number == number.strip().upper()), None)


def explain(code: Code) -> str:
    """Return what `bigactors explain` prints of a code."""
    return f"{code.number}: {code.title} ({code.range})\n\n{code.explanation}\n"


def code_table() -> str:
    """Return the table of all codes in Markdown, for the documentation."""
    rows = sorted((code.number, code.title, code.explanation) for code in Code)
    lines = [f"| {number} | {title} | {_cell(text)} |" for number, title, text in rows]
    return "\n".join(["| code | mistake | meaning and remedy |", "| --- | --- | --- |", *lines]) + "\n"


def _cell(text: str) -> str:
    return text.replace("|", "\\|")
