"""Generated bigraphs: small, over one signature that has every kind of control."""

from hypothesis import strategies as st

from bigraphs.bigraph import Bigraph, Node, assemble, normal
from bigraphs.interface import Interface
from bigraphs.relational_bigraphs import from_relations
from bigraphs.rules import ReactionRule, rule
from bigraphs.signature import Control, Signature

SIGNATURE = Signature(
    (
        Control("A", 0),
        Control("B", 1),
        Control("C", 2),
        Control("P", 0, "passive"),
        Control("U", 2, ordered=False),
        Control("Z", 1, "atomic", ordered=False),
    )
)
PLAIN = ("A", "B", "U", "Z")


def interfaces(max_width=2, names=("x", "y")):
    return st.builds(
        Interface, st.integers(0, max_width), st.lists(st.sampled_from(names), max_size=len(names)).map(tuple)
    )


@st.composite
def bigraphs(
    draw,
    inner=None,
    outer=None,
    *,
    max_nodes=4,
    max_edges=2,
    sharing=False,
    named=False,
    controls=tuple(control.name for control in SIGNATURE.controls),
):
    """Draw a bigraph from one interface to another, drawn too where not given."""
    outer = outer if outer is not None else draw(interfaces())
    inner = inner if inner is not None else draw(interfaces(2 if outer.width else 0, ("i", "j")))
    edges = draw(st.integers(0, max_edges))
    links = [*range(edges), *outer.names]
    nodes = []
    homes = [~region for region in range(outer.width)]
    parents = st.lists(st.integers(0, 1000), min_size=1, max_size=2 if sharing else 1)
    for _ in range(draw(st.integers(0, max_nodes)) if outer.width else 0):
        control = SIGNATURE[draw(st.sampled_from([c for c in controls if links or not SIGNATURE[c].arity]))]
        ports = tuple(draw(st.sampled_from(links)) for _ in range(control.arity or 0))
        within = tuple(sorted({homes[choice % len(homes)] for choice in draw(parents)}))
        name = f"n{len(nodes)}" if named else None
        nodes.append(Node(control.name, name, ports, within))
        if control.status != "atomic":
            homes.append(len(nodes) - 1)
    if inner.names and not links:
        edges, links = 1, [0]
    return assemble(
        SIGNATURE,
        nodes,
        regions=outer.width,
        sites=[{homes[choice % len(homes)] for choice in draw(parents)} for _ in range(inner.width)],
        edges=edges,
        inner_links={name: draw(st.sampled_from(links)) for name in inner.names},
        outer_names=outer.names,
    )


def grounds(**options):
    """Draw a bigraph without sites and inner names."""
    return st.integers(1, 2).flatmap(
        lambda width: bigraphs(Interface(), Interface(width, options.pop("names", ("x", "y"))), **options)
    )


@st.composite
def redexes(draw, *, max_nodes=3, sharing=False, names=("r", "s")):
    """Draw a bigraph whose regions all have a node, without inner names."""
    width = draw(st.integers(1, 2))
    outer = Interface(width, draw(st.lists(st.sampled_from(names), max_size=2).map(tuple)))
    inner = Interface(draw(st.integers(0, 2)))
    options = {"max_edges": 1, "sharing": sharing, "controls": PLAIN}
    found = draw(bigraphs(inner, outer, max_nodes=max_nodes, **options))
    inhabited = {parent for node in found.nodes for parent in node.parents}
    extra = [Node("A", None, (), (~region,)) for region in range(width) if ~region not in inhabited]
    return assemble(
        SIGNATURE,
        [*found.nodes, *extra],
        regions=width,
        sites=found.sites,
        edges=found.edges,
        outer_names=found.outer_names,
    )


@st.composite
def rules(draw) -> ReactionRule:
    """Draw a rule whose reactum keeps, drops, moves and copies sites."""
    redex = draw(redexes())
    width = draw(st.integers(0, 2)) if redex.sites else 0
    reactum = draw(bigraphs(Interface(width), redex.outer, max_nodes=3, max_edges=1, controls=PLAIN))
    sites = tuple(draw(st.integers(0, len(redex.sites) - 1)) for _ in range(width))
    return rule(redex, reactum, sites)


@st.composite
def shuffled(draw, bigraph: Bigraph) -> Bigraph:
    """Draw the same bigraph with its anonymous nodes in another order."""
    named = [number for number, node in enumerate(bigraph.nodes) if node.name is not None]
    anonymous = [number for number, node in enumerate(bigraph.nodes) if node.name is None]
    return normal(bigraph, [*named, *draw(st.permutations(anonymous))])


def cycle(size, start=0):
    """Return the edges of a ring."""
    return [(start + step, start + (step + 1) % size) for step in range(size)]


def from_graph(edges):
    """Return nodes whose ports are the ends of a graph's edges."""
    size = 1 + max(max(edge) for edge in edges)
    signature = from_relations({"a": "K"}, {}, {}).signature
    ports = [tuple(e for e, ends in enumerate(edges) if number in ends) for number in range(size)]
    return assemble(signature, [Node("K", None, each) for each in ports], edges=len(edges))


PRISM = [*cycle(3), *cycle(3, 3), (0, 3), (1, 4), (2, 5)]
UTILITY = [(a, b) for a in range(3) for b in range(3, 6)]
ALIKE_TO_REFINEMENT = [(cycle(6), [*cycle(3), *cycle(3, 3)]), (PRISM, UTILITY)]
"""Pairs of regular graphs that are not isomorphic."""
