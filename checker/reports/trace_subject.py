"""The subject of a trace in a file: the violation that it ends in, or the property to whose case it leads."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

from checker.reports.causes import Cause, causes_of, formulas_of, headline_of
from checker.traces import Trace
from checker.verdicts import Violation
from semantics.properties.property import Property
from semantics.state.brief import cut

MOST_CHARACTERS: Final = 2_000
"""The longest text of a violation in a file; a longer one is cut when it is written."""

MOST_DETAILS: Final = 200
"""The most details of a violation in a file."""


@dataclass(frozen=True, slots=True)
class TraceSubject:
    """The reason why a trace was written.

    Attributes:
        asked: The property.
        violation: The way in which it fails at the end of the trace; None for a run to a case that it is about.
    """

    asked: Property
    violation: Violation | None = None

    @property
    def headline(self) -> str:
        """The subject in plain words."""
        if self.violation is None:
            return f"{self.asked.name}: a run to a case that it is about"
        return headline_of(self.asked, self.violation.kind)

    @property
    def about(self) -> str:
        """The subject in the notation of reports."""
        if self.violation is None:
            return f"{self.asked.name}: a witness"
        return f"{self.asked.name} violated: {self.violation.kind}: {self.violation.message}"

    @property
    def details(self) -> tuple[str, ...]:
        """More lines on the violation."""
        return () if self.violation is None else self.violation.told

    def causes(self, trace: Trace) -> tuple[Cause, ...]:
        """Return the causes of the violation."""
        return () if self.violation is None else causes_of(trace, self.violation, formulas_of(self.asked))

    def json(self) -> dict[str, Any]:
        """Return the members of a trace's file that `subject_of` reads."""
        name, violation = self.asked.name, self.violation
        if violation is None:
            return {"witness": name}
        texts = {"kind": violation.kind, "message": violation.message, "subject": violation.subject}
        told = {"property": name, **{key: cut(text, MOST_CHARACTERS) for key, text in texts.items()}}
        details = [cut(each, MOST_CHARACTERS) for each in violation.details[:MOST_DETAILS]]
        return {"violation": told | {"details": details}}


def subject_of(data: Any, trace: Trace, properties: Sequence[Property]) -> TraceSubject | None:
    """Return the subject that a trace's file names, None if it names none; the trace itself is not asked.

    Raises:
        ValueError: The file's subject is malformed, or about a property that the mission does not have.
    """
    if "violation" not in data:
        return TraceSubject(_named(data, "witness", properties)) if "witness" in data else None
    said = data["violation"]
    if not isinstance(said, dict):
        raise ValueError("'violation' should be an object")
    details = said.get("details", [])
    if not isinstance(details, list) or len(details) > MOST_DETAILS:
        raise ValueError(f"'details' of a violation should be a list of at most {MOST_DETAILS} texts")
    kind, message, subject = (
        _text(said.get(key, default), key)
        for key, default in (("kind", None), ("message", None), ("subject", ""))
    )
    told = tuple(_text(each, "details") for each in details)
    return TraceSubject(_named(said, "property", properties), Violation(kind, message, trace, told, subject))


def _named(said: dict[str, Any], key: str, properties: Sequence[Property]) -> Property:
    found = next((each for each in properties if each.name == said.get(key)), None)
    if found is None:
        raise ValueError(f"'{key}' should be the name of one of the mission's properties")
    return found


def _text(said: object, key: str) -> str:
    if not isinstance(said, str) or len(said) > MOST_CHARACTERS:
        raise ValueError(f"'{key}' of a violation should be a text of at most {MOST_CHARACTERS:,} characters")
    return said
