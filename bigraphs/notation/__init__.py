"""Notations of bigraphs, read and written: BigraphER's, BigMC's and the paper's. Only this package uses lark."""

from bigraphs.notation.bgm.systems import read_bgm
from bigraphs.notation.big.expression_of import write_big
from bigraphs.notation.big.fragments import Theory, read_big, read_theory
from bigraphs.notation.big.parser import parse_expression, parse_model
from bigraphs.notation.big.printer import format_expression, format_model
from bigraphs.notation.big.systems import read_system
from bigraphs.notation.big.writer import write_system
from bigraphs.notation.files import load_system
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
    "load_system",
    "parse_expression",
    "parse_model",
    "parse_regions",
    "parse_rule",
    "read_bgm",
    "read_big",
    "read_bigraph",
    "read_rule",
    "read_system",
    "read_theory",
    "write_big",
    "write_bigraph",
    "write_rule",
    "write_system",
]
