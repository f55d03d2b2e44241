"""Generated rules and systems that the engine can run: redexes are solid."""

from bigraph_strategies import PLAIN, SIGNATURE, bigraphs, grounds, redexes
from hypothesis import strategies as st

from bigraphs.algebra import lean
from bigraphs.bigraph import assemble
from bigraphs.interface import Interface
from bigraphs.system import PriorityClass, Rule, System, SystemKind


def solid(redex):
    """Return the redex without idle links, sites in regions, and all but one of the sites that lie side by side."""
    sites = {tuple(p for p in parents if p >= 0) for parents in redex.sites} - {()}
    found = assemble(
        redex.signature,
        redex.nodes,
        regions=redex.regions,
        sites=sorted(sites),
        edges=redex.edges,
        outer_names={link for node in redex.nodes for link in node.ports if isinstance(link, str)},
    )
    return lean(found)


def solid_redexes(**options):
    return redexes(**options).map(solid)


@st.composite
def solid_rules(draw, *, sharing=False, max_nodes=3, copies=True):
    """Draw a rule whose reactum keeps, drops, moves and (unless places are shared) copies sites."""
    redex = draw(solid_redexes(sharing=sharing, max_nodes=max_nodes))
    width = draw(st.integers(0, 2)) if redex.sites else 0
    reactum = draw(
        bigraphs(Interface(width), redex.outer, max_nodes=3, max_edges=1, controls=PLAIN, sharing=sharing)
    )
    if copies:
        sites = tuple(draw(st.integers(0, len(redex.sites) - 1)) for _ in range(width))
    else:
        width = min(width, len(redex.sites))
        reactum = draw(
            bigraphs(Interface(width), redex.outer, max_nodes=3, max_edges=1, controls=PLAIN, sharing=sharing)
        )
        sites = tuple(draw(st.permutations(range(len(redex.sites))))[:width])
    return Rule(draw(st.sampled_from("abc")), redex, reactum, sites)


def system(initial, *rules, kind=SystemKind.BRS, **rest):
    return System(kind, SIGNATURE, initial, (PriorityClass(tuple(rules)),), **rest)


def targets(**options):
    return grounds(controls=(*PLAIN, "P"), **options)
