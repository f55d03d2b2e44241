"""The notation of the paper's runtime, as syntax: `l0_Location.(u0_UAV[network] | $0) || l1_Location.$1`.

A node is `name_Control[links].children`; name or control may be missing. The control follows the last underscore and
begins with a capital: `my_uav_UAV` is a `UAV` named `my_uav`, `_UAV` is an anonymous one and `search_area` has no
control. `||` separates regions, `|` neighbours, `->` redex and reactum; `1` is the empty region.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cache
from typing import Any, Final, TypeAlias

from lark import Lark, Token, Transformer, v_args

from bigraphs.errors import BigraphError, NotationError
from bigraphs.notation.bounded_parsing import read

GRAMMAR: Final = r"""
rule: regions "->" regions
regions: region ("||" region)*
region: element ("|" element)*
?element: node | site | "1" -> empty | "(" region ")" -> group
node: WORD [links] ["." below]
links: "[" [LINK ("," LINK)*] "]"
?below: node | site | "1" -> empty | "(" region ")" -> group
site: SITE

WORD: /[^\W\d]\w*|\d\w+/
LINK: /\w+([.:\-]+\w+)*/
SITE: /\$[0-9]{1,4}/
%ignore /[ \t\r\n\f]+/
"""
_WORDS: Final = {
    "WORD": "a node",
    "LINK": "a link name",
    "SITE": "a site such as $0",
    "__ANON_0": "'->'",
    "__ANON_1": "'||'",
    "VBAR": "'|'",
    "LPAR": "'('",
    "RPAR": "')'",
    "LSQB": "'['",
    "RSQB": "']'",
    "COMMA": "','",
    "DOT": "'.'",
    "$END": "the end",
}
_NAME: Final = re.compile(r"[^\W\d]\w*|\d\w+")
_NAMED: Final = re.compile(r"\w+")  # before a control
_LINK: Final = re.compile(r"\w+([.:\-]+\w+)*")
_CONTROL: Final = re.compile(r"[A-Z][^\W_]*")
_SPLIT: Final = re.compile(r"(?P<name>.*)_(?P<control>[A-Z][^\W_]*)", re.DOTALL)


@dataclass(frozen=True, slots=True)
class SiteTerm:
    """A site `$index`; `offset` is its position in the text."""

    index: int
    offset: int = field(default=0, compare=False)

    def __str__(self) -> str:
        return f"${self.index}"


@dataclass(frozen=True, slots=True)
class NodeTerm:
    """A node as written: absent parts are None or empty; `offset` is the position of its first character."""

    name: str | None
    control: str | None = None
    links: tuple[str, ...] = ()
    children: tuple[Term, ...] = ()
    offset: int = field(default=0, compare=False)

    def __str__(self) -> str:
        return format_term(self)


Term: TypeAlias = NodeTerm | SiteTerm
RegionTerm: TypeAlias = tuple[Term, ...]


@dataclass(frozen=True, slots=True)
class RuleTerm:
    """A rule as written: the regions of its redex and of its reactum."""

    redex: tuple[RegionTerm, ...]
    reactum: tuple[RegionTerm, ...]

    def __str__(self) -> str:
        return f"{format_regions(self.redex)} -> {format_regions(self.reactum)}"


def parse_rule(text: str) -> RuleTerm:
    """Parse `redex -> reactum`; raises NotationError, whose offset counts characters of `text`.

    >>> print(parse_rule("l0_Location.(u0_UAV[net]|$0) || l1_Location.$1 -> l0_Location.$0 || l1_Location.(u0|$1)"))
    l0_Location.(u0_UAV[net] | $0) || l1_Location.$1 -> l0_Location.$0 || l1_Location.(u0 | $1)
    """
    rule: RuleTerm = read(_parser(), text, _WORDS, "rule")
    _check_side(rule.redex, text)
    _check_names(rule.reactum, text)
    known = {site.index for site in sites(rule.redex)}
    for site in sites(rule.reactum):
        if site.index not in known:
            message = f"site {site} is not in the redex"
            raise NotationError(
                "site", message, text, site.offset, length=len(str(site)), hint=f"write {site} there too"
            )
    return rule


def parse_regions(text: str) -> tuple[RegionTerm, ...]:
    """Parse `region || region`; raises NotationError, also for a repeated site or name."""
    regions: tuple[RegionTerm, ...] = read(_parser(), text, _WORDS, "regions")
    _check_side(regions, text)
    return regions


def nodes(regions: tuple[RegionTerm, ...]) -> Iterator[NodeTerm]:
    """Yield every node, parents before children, in source order."""
    return (term for term in _walk(regions) if isinstance(term, NodeTerm))


def sites(regions: tuple[RegionTerm, ...]) -> Iterator[SiteTerm]:
    """Yield every site in source order."""
    return (term for term in _walk(regions) if isinstance(term, SiteTerm))


def _walk(regions: tuple[RegionTerm, ...]) -> Iterator[Term]:
    waiting: list[Term] = [term for region in reversed(regions) for term in reversed(region)]
    while waiting:
        term = waiting.pop()
        yield term
        if isinstance(term, NodeTerm):
            waiting.extend(reversed(term.children))


def format_regions(regions: tuple[RegionTerm, ...]) -> str:
    """Return the text of regions, which `parse_regions` reads; raises BigraphError for an unwritable name."""
    return " || ".join(_format_region(region) for region in regions)


def format_term(term: Term) -> str:
    """Return the text of one node or site; raises BigraphError for an unwritable name."""
    if isinstance(term, SiteTerm):
        return str(term)
    links = f"[{','.join(_writable(link, _LINK) for link in term.links)}]" if term.links else ""
    if not term.children:
        return _word(term) + links
    below = _format_region(term.children)
    return f"{_word(term)}{links}.({below})" if len(term.children) > 1 else f"{_word(term)}{links}.{below}"


def _format_region(region: RegionTerm) -> str:
    return " | ".join(format_term(term) for term in region) or "1"


def _word(term: NodeTerm) -> str:
    if term.control is not None:
        name = _writable(term.name, _NAMED) if term.name is not None else ""
        return f"{name}_{_writable(term.control, _CONTROL)}"
    if term.name is None or _SPLIT.fullmatch(term.name):
        raise BigraphError("name", f"the node name {term.name!r} needs a control to be written")
    return _writable(term.name, _NAME)


def _writable(word: str, pattern: re.Pattern[str]) -> str:
    if not pattern.fullmatch(word):
        hint = "use letters, digits and '_', a capital first in controls, in links also ':', '-' and '.'"
        raise BigraphError("name", f"{word!r} cannot be written in this notation", hint)
    return word


def _check_side(regions: tuple[RegionTerm, ...], text: str) -> None:
    _check_names(regions, text)
    seen: set[int] = set()
    for site in sites(regions):
        if site.index in seen:
            hint = "give each site of a redex its own number"
            raise NotationError(
                "site", f"site {site} is written twice", text, site.offset, length=len(str(site)), hint=hint
            )
        seen.add(site.index)


def _check_names(regions: tuple[RegionTerm, ...], text: str) -> None:
    seen: set[str] = set()
    for node in nodes(regions):
        if node.name in seen:
            hint = "a name means one node; give the other one another name"
            message = f"node '{node.name}' is written twice"
            raise NotationError("name", message, text, node.offset, length=len(node.name), hint=hint)
        if node.name is not None:
            seen.add(node.name)


@cache
def _parser() -> Lark:
    return Lark(
        GRAMMAR, parser="lalr", start=["rule", "regions"], transformer=_Build(), maybe_placeholders=True
    )


@v_args(inline=True)
class _Build(Transformer[Token, Any]):
    """Builds terms while lark reads; a parenthesised or empty part is a tuple, spliced into its region."""

    def rule(self, redex: tuple[RegionTerm, ...], reactum: tuple[RegionTerm, ...]) -> RuleTerm:
        return RuleTerm(redex, reactum)

    def regions(self, *regions: RegionTerm) -> tuple[RegionTerm, ...]:
        return regions

    def region(self, *elements: Term | RegionTerm) -> RegionTerm:
        return tuple(term for element in elements for term in _several(element))

    def group(self, region: RegionTerm) -> RegionTerm:
        return region

    def empty(self) -> RegionTerm:
        return ()

    def links(self, *names: Token | None) -> tuple[str, ...]:
        return tuple(str(name) for name in names if name is not None)

    def node(self, word: Token, links: tuple[str, ...] | None, below: Term | RegionTerm | None) -> NodeTerm:
        split = _SPLIT.fullmatch(word)
        name, control = (split["name"] or None, split["control"]) if split else (str(word), None)
        return NodeTerm(name, control, links or (), _several(below) if below else (), word.start_pos or 0)

    def site(self, word: Token) -> SiteTerm:
        return SiteTerm(int(word[1:]), word.start_pos or 0)


def _several(element: Term | RegionTerm) -> RegionTerm:
    return element if isinstance(element, tuple) else (element,)
