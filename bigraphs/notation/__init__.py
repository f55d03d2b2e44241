"""Texts of bigraphs, read and written: the paper's notation and BigraphER's. This room alone knows lark."""

from bigraphs.notation.big_elaboration import Theory, read_big, read_theory
from bigraphs.notation.big_expression import write_big
from bigraphs.notation.big_parser import parse_expression, parse_model
from bigraphs.notation.big_printer import format_expression, format_model
from bigraphs.notation.paper import (
    NodeTerm,
    RegionTerm,
    RuleTerm,
    SiteTerm,
    Term,
    format_regions,
    format_term,
    parse_regions,
    parse_rule,
)
from bigraphs.notation.paper_bigraphs import read_bigraph, read_rule, write_bigraph, write_rule

__all__ = [
    "NodeTerm",
    "RegionTerm",
    "RuleTerm",
    "SiteTerm",
    "Term",
    "Theory",
    "format_expression",
    "format_model",
    "format_regions",
    "format_term",
    "parse_expression",
    "parse_model",
    "parse_regions",
    "parse_rule",
    "read_big",
    "read_bigraph",
    "read_rule",
    "read_theory",
    "write_big",
    "write_bigraph",
    "write_rule",
]
