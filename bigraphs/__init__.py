"""Bigraphs: places nested in places, links across them, and rules that rewrite both.

Values, algebra, rules, matching, rewriting, canonical forms and drawings; whole systems, explored, run and decided by
`bigraphs.engine`; notations are read and written by `bigraphs.notation`, transition systems written by
`bigraphs.exports`. This room knows nothing of missions, vehicles, the earth or agents.
"""

from bigraphs.algebra import (
    atom,
    close,
    closure,
    compose,
    identity,
    ion,
    lean,
    merge,
    merge_product,
    merged,
    names,
    nest,
    parallel,
    placing,
    rename,
    substitution,
    symmetry,
    tensor,
)
from bigraphs.bigraph import Bigraph, Link, Node, Place, assemble, children, find, links, points, sites_in
from bigraphs.canonical import canonical, equal
from bigraphs.decomposition import Parts, recompose, take_apart
from bigraphs.drawing import draw_bigraph, save_bigraph
from bigraphs.errors import BigraphError, NotationError
from bigraphs.exploration import explore
from bigraphs.interface import Interface
from bigraphs.labels import link_label, node_labels
from bigraphs.layout import Layout, layout
from bigraphs.matching import Match, find_matches
from bigraphs.networkx_graphs import to_networkx
from bigraphs.relations import from_relations
from bigraphs.rewriting import rewrite, successors
from bigraphs.rules import ReactionRule, matches, rule
from bigraphs.signature import Control, Signature, open_signature
from bigraphs.simulation import Bounds, Stage, simulate
from bigraphs.system import (
    Action,
    Condition,
    Predicate,
    PriorityClass,
    Rule,
    System,
    SystemKind,
    Where,
)
from bigraphs.text import draw_text
from bigraphs.transitions import Transition, TransitionSystem

__all__ = [
    "Action",
    "Bigraph",
    "BigraphError",
    "Bounds",
    "Condition",
    "Control",
    "Interface",
    "Layout",
    "Link",
    "Match",
    "Node",
    "NotationError",
    "Parts",
    "Place",
    "Predicate",
    "PriorityClass",
    "ReactionRule",
    "Rule",
    "Signature",
    "Stage",
    "System",
    "SystemKind",
    "Transition",
    "TransitionSystem",
    "Where",
    "assemble",
    "atom",
    "canonical",
    "children",
    "close",
    "closure",
    "compose",
    "draw_bigraph",
    "draw_text",
    "equal",
    "explore",
    "find",
    "find_matches",
    "from_relations",
    "identity",
    "ion",
    "layout",
    "lean",
    "link_label",
    "links",
    "matches",
    "merge",
    "merge_product",
    "merged",
    "names",
    "nest",
    "node_labels",
    "open_signature",
    "parallel",
    "placing",
    "points",
    "recompose",
    "rename",
    "rewrite",
    "rule",
    "save_bigraph",
    "simulate",
    "sites_in",
    "substitution",
    "successors",
    "symmetry",
    "take_apart",
    "tensor",
    "to_networkx",
]
