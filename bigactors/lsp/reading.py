"""A mission as an editor has it: its text, what could be read of it, and what is wrong with it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from bigactors.lsp.occurrences import Occurrences, occurrences_of
from specs.diagnostics import MissionError, Source
from specs.elaboration import Diagnosis, diagnose
from specs.parser import read
from specs.recovery import Recovered
from specs.syntax import Mission, Node


@dataclass(frozen=True)
class Reading:
    """A text, and what it comes to; each part is worked out when it is asked for first.

    Attributes:
        source: The text and its name.
        directory: Where the files are that it names.
    """

    source: Source
    directory: Path

    @property
    def text(self) -> str:
        """The text."""
        return self.source.text

    def written(self, node: Node) -> str:
        """Return what a node says as it is written, in one line."""
        return " ".join(self.text[node.span.start : node.span.end].split())

    @cached_property
    def recovered(self) -> Recovered:
        """What could be read; nothing of a text that passes a bound."""
        try:
            return read(self.source)
        except MissionError as refused:
            return Recovered(Mission(None, ()), refused.diagnostics, ())

    @property
    def mission(self) -> Mission:
        """The syntax tree of what could be read."""
        return self.recovered.mission

    @cached_property
    def occurrences(self) -> Occurrences:
        """The names in it."""
        return occurrences_of(self.mission)

    @cached_property
    def diagnosis(self) -> Diagnosis:
        """What it means, or all that is wrong with it."""
        return diagnose(self.recovered, self.source, self.directory)


def reading_of(name: str, text: str, directory: Path) -> Reading:
    """Return the reading of an editor's text, in which every offset stays: its line ends take no other space."""
    plain = text.replace("\r\n", " \n").replace("\r", "\n")
    return Reading(Source(name, f" {plain[1:]}" if plain.startswith("\ufeff") else plain), directory)
