"""Elaborated reaction rules: a pattern on each side, with free host and parameters."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Final

from semantics.behaviours.commands import HOST, Command
from semantics.behaviours.expressions import Fault
from semantics.behaviours.reaction_rules import (
    NodeTerm,
    NodeVariable,
    Pattern,
    PlaceTerm,
    PlaceVariable,
    Reaction,
)
from semantics.behaviours.values import Value, show
from semantics.state.signature import Name
from specs import syntax as s

_WORD: Final = re.compile(r"[^\W\d]\w*")


@dataclass(frozen=True, slots=True)
class SchemaParameter:
    """A parameter of a rule: its name in the patterns (`u#`), and its kind, if known."""

    name: str
    kind: str | None

    @property
    def shown(self) -> str:
        """The parameter as the programmer wrote it."""
        return self.name.removesuffix("#")


@dataclass(frozen=True, slots=True)
class Moved:
    """A node that gets another parent, with its position in the reactum."""

    node: NodeTerm
    place: PlaceTerm
    where: s.Span


@dataclass(frozen=True)
class Schema:
    """A rule that is open in `HOST` and its parameters.

    Attributes:
        name: Its name; empty for an inline rule.
        text: The body of an inline rule.
        words: For each open word of that text, the name that it denotes, and the rest of the word.
        kinds: The kind of each term of the redex, if known.
    """

    name: str
    text: str
    parameters: tuple[SchemaParameter, ...]
    redex: Pattern
    reactum: Pattern
    moves: tuple[Moved, ...] = ()
    words: Mapping[str, tuple[str, str]] = field(default_factory=dict)
    kinds: Mapping[NodeTerm, str | None] = field(default_factory=dict)

    @cached_property
    def mentions(self) -> frozenset[str]:
        """The constant words of its text and patterns: names, and parts of channels' names."""
        open_terms = {HOST, *(each.name for each in self.parameters)}
        said = [self.text if not self.name else ""]
        for pattern in (self.redex, self.reactum):
            said += [node for node in (*pattern.nodes, *pattern.closed) if isinstance(node, str)]
            said += [term for pair in pattern.parents for term in pair if isinstance(term, str)]
            said += [term for pair in pattern.links for term in pair if isinstance(term, str)]
        return frozenset(word for each in said if each not in open_terms for word in _WORD.findall(each))

    def involves(self, host: Name, kind: str, arguments: Mapping[str, Name]) -> bool:
        """Whether the redex can involve a host of a kind, given the known arguments."""
        for term in self.redex.nodes:
            if isinstance(term, NodeVariable):
                if term.kind in (None, kind):
                    return True
            elif arguments.get(term, term) == host or self._may_be(term, kind, arguments):
                return True
        return False

    def _may_be(self, term: Name, kind: str, arguments: Mapping[str, Name]) -> bool:
        """Whether a term is the host, or an unknown argument that may be a node of the host's kind."""
        unknown = term.endswith("#") and term not in arguments
        return term == HOST or (unknown and self.kinds.get(term) in (None, kind))


@dataclass(frozen=True, slots=True, eq=False)
class CommandReactions:
    """Makes the reactions of a command of the language; it fails if an argument is no node.

    Attributes:
        command: The command.
        kinds: The kind of each node.
    """

    command: Command
    kinds: Mapping[Name, str]

    def __call__(self, host: Name, *arguments: Value) -> Reaction:
        """Return R ⇒ R'.

        Raises:
            Fault: An argument is no node.
        """
        nodes = (_node(value, self.kinds, f"{self.command.name} needs a node, not") for value in arguments)
        return self.command(host, *nodes)

    def made_from(self, reaction: Reaction, host: Name) -> tuple[Name, ...] | None:
        """Return the host and the arguments of a reaction; None if another command or rule made it."""
        return self.command.made_from(reaction, host)


@dataclass(frozen=True, slots=True)
class Maker:
    """Makes the reactions of a schema: the entry of `Program.reactions` for a rule."""

    schema: Schema
    kinds: Mapping[Name, str]

    @property
    def mentions(self) -> frozenset[str]:
        """The names that it mentions for any host and arguments; it treats all other names of a kind alike."""
        return self.schema.mentions

    def __call__(self, host: Name, *arguments: Value) -> Reaction:
        """Return R ⇒ R'.

        Raises:
            Fault: An argument is no node, or one of another kind.
        """
        schema = self.schema
        given = zip(schema.parameters, arguments, strict=True)
        values = {parameter.name: self._node(parameter, value) for parameter, value in given} | {HOST: host}
        text = self._text(values)
        return Reaction(text, _put(schema.redex, values), _put(schema.reactum, values))

    def made_from(self, reaction: Reaction, host: Name) -> tuple[Name, ...] | None:
        """Return the host and the arguments of a reaction; None if another command or rule made it."""
        schema, values = self.schema, {HOST: host}
        if schema.name:
            inside = reaction.text.removeprefix(f"{schema.name}(").removesuffix(")")
            values |= {
                each.name: word for each, word in zip(schema.parameters, inside.split(", "), strict=False)
            }
        values |= _stand_for(schema.redex, reaction.redex) | _stand_for(schema.reactum, reaction.reactum)
        try:
            found = (values[HOST], *(values[each.name] for each in schema.parameters))
            return found if self(*found) == reaction else None
        except (KeyError, Fault):
            return None

    def _node(self, parameter: SchemaParameter, value: Value) -> Name:
        node = _node(value, self.kinds, f"a node was expected for {parameter.shown}, not")
        if parameter.kind is not None and self.kinds[node] != parameter.kind:
            raise Fault(
                f"{parameter.shown} is of kind {parameter.kind}, and {show(value)} is of kind {self.kinds[node]}"
            )
        return node

    def _text(self, values: Mapping[str, Name]) -> str:
        schema = self.schema
        if schema.name:
            return f"{schema.name}({', '.join(values[each.name] for each in schema.parameters)})"

        def word(found: re.Match[str]) -> str:
            stands, rest = schema.words.get(found[0], ("", ""))
            return values[stands] + rest if stands else found[0]

        return _WORD.sub(word, schema.text)


def _node(value: Value, kinds: Mapping[Name, str], otherwise: str) -> Name:
    """Return a value that is a node; raises Fault for any other."""
    if not isinstance(value, str) or value not in kinds:
        raise Fault(f"{otherwise} {show(value)}")
    return value


def _put(pattern: Pattern, values: Mapping[str, Name]) -> Pattern:
    def node(term: NodeTerm) -> NodeTerm:
        return values.get(term, term) if isinstance(term, str) else term

    def place(term: PlaceTerm) -> PlaceTerm:
        return term if isinstance(term, PlaceVariable) else node(term)

    return Pattern(
        tuple(map(node, pattern.nodes)),
        tuple((node(child), place(parent)) for child, parent in pattern.parents),
        tuple((link, node(point)) for link, point in pattern.links),
        tuple(map(node, pattern.closed)),
    )


def _stand_for(schema: Pattern, pattern: Pattern) -> dict[str, Name]:
    """Return the names in a pattern at the positions of a schema's names."""
    mine, theirs = _node_terms(schema), _node_terms(pattern)
    pairs = zip(mine, theirs, strict=False)
    return {term: name for term, name in pairs if isinstance(term, str) and isinstance(name, str)}


def _node_terms(pattern: Pattern) -> list[PlaceTerm]:
    """Return the node and place terms of a pattern, in a fixed order."""
    related: list[PlaceTerm] = [term for pair in pattern.parents for term in pair]
    return [*pattern.nodes, *pattern.closed, *related, *(point for _, point in pattern.links)]
