"""The codes of mistakes in `.big` and `.bgm` files, and their meanings."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

CODES: Final[Mapping[str, str]] = {
    "arguments": "A bigraph, rule or control has the wrong number of arguments.",
    "arity": "A node's number of links differs from its control's ports.",
    "atomic": "An atomic node has content.",
    "cycle": "A constant or a bigraph is defined by itself.",
    "initial": "The first state has sites or inner names.",
    "interface": "Two bigraphs don't fit: sites and regions, or names, differ.",
    "name": "A name is undeclared or declared twice, or a closed or renamed name does not exist.",
    "number": "A number is too large or undefined, or a step is not above 0.",
    "parent": "A site of a placing is in no existing region.",
    "pattern": "A predicate or a condition has inner names, or no node.",
    "property": "A property has no meaning.",
    "redex": "A redex is not solid.",
    "rule": "The two sides of a rule, or its instantiation map, don't fit.",
    "site": "A site is written twice on one side, or the redex lacks it.",
    "sort": "The first state violates the declared sorts, or a rule may violate them.",
    "syntax": "A word or sign is not allowed where it stands.",
    "system": "The system is missing, or does not match its kind.",
    "too-deep": "Brackets, operators or definitions nest too deeply.",
    "too-large": "A bigraph, a range or a number of instances exceeds its limit.",
    "too-long": "The text, or a word in it, is too long.",
    "type": "A value has the wrong type.",
    "weight": "A rule lacks the weight that its system requires, or has an invalid one.",
}
