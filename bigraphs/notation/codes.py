"""Every kind of mistake in a `.big` or `.bgm` file: its code, and what it means."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

CODES: Final[Mapping[str, str]] = {
    "arguments": "A bigraph, rule or control gets another number of arguments than it is declared with.",
    "arity": "A node has another number of links than its control has ports.",
    "atomic": "Something is put into a node whose control is atomic.",
    "cycle": "A constant or a bigraph is made of itself.",
    "initial": "The first state has sites or inner names, so it is only a part of one.",
    "interface": "Two bigraphs don't fit: sites and regions, or inner and outer names, are not the same.",
    "name": "A name is not declared, declared twice, or not there to be closed or renamed.",
    "number": "A number is too large, or there is none: a division by zero, a step that is not more than 0.",
    "parent": "A site of a placing is in no region, or in one that is not there.",
    "pattern": "A predicate or a condition has no node, so it would always occur, or inner names.",
    "property": "A property says something that has no meaning.",
    "redex": "A redex does not tell its occurrences apart: it must be solid, as BigraphER has it.",
    "rule": "The sides of a rule don't fit each other, or its instantiation map does not fit them.",
    "site": "A site is written twice on one side, or the redex lacks it.",
    "sort": "The first state is against the declared sorts, or a rule may break them.",
    "syntax": "Something stands where it cannot.",
    "system": "There is no system, or it does not go with its kind.",
    "too-deep": "Brackets, operators or definitions nest too deeply.",
    "too-large": "A bigraph, a range or a number of instances is larger than what is read.",
    "too-long": "The text, or a word in it, is too long.",
    "type": "A number is given where a string is expected, a float where an int is, or the other way round.",
    "weight": "A rule lacks the weight that its system's kind asks for, or has one that is none.",
}
