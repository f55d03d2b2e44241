"""A mission in an editor: its text, its syntax tree and its mistakes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from bigactors.lsp.name_resolution import Occurrences, occurrences_of
from specs.diagnostics import MissionError, Source
from specs.elaboration import Diagnosis, diagnose
from specs.parser import read
from specs.recovery import Recovered
from specs.syntax import Mission, Node


@dataclass(frozen=True)
class Reading:
    """A text with its analyses, each computed at its first use.

    Attributes:
        source: The text and its name.
        directory: The folder of the files that it names.
    """

    source: Source
    directory: Path

    @property
    def text(self) -> str:
        """The text."""
        return self.source.text

    def written(self, node: Node) -> str:
        """Return the source text of a node in one line."""
        return " ".join(self.text[node.span.start : node.span.end].split())

    @cached_property
    def recovered(self) -> Recovered:
        """The parts that parse; none for a text beyond the limits."""
        try:
            return read(self.source)
        except MissionError as refused:
            return Recovered(Mission(None, ()), refused.diagnostics, ())

    @property
    def mission(self) -> Mission:
        """The syntax tree of the parts that parse."""
        return self.recovered.mission

    @cached_property
    def occurrences(self) -> Occurrences:
        """The resolved names of the tree."""
        return occurrences_of(self.mission)

    @cached_property
    def diagnosis(self) -> Diagnosis:
        """The elaborated mission, or all its mistakes."""
        return diagnose(self.recovered, self.source, self.directory)


def reading_of(name: str, text: str, directory: Path) -> Reading:
    """Return the reading of an editor's text. Line ends are replaced by others of equal length, so offsets stay."""
    plain = text.replace("\r\n", " \n").replace("\r", "\n")
    return Reading(Source(name, f" {plain[1:]}" if plain.startswith("\ufeff") else plain), directory)
