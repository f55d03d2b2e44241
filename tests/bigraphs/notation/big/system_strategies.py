"""Generated systems of every kind, with all that the notation can say, and their comparison."""

from dataclasses import replace

from bigraph_strategies import SIGNATURE, bigraphs, grounds, redexes
from hypothesis import strategies as st

from bigraphs.algebra import lean
from bigraphs.canonical_form import canonical
from bigraphs.interface import Interface
from bigraphs.notation.big.solidity import faults, pattern_of
from bigraphs.notation.big.systems import bigraphs_of
from bigraphs.signature import Control, Signature
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

INSTANCES = ["K(1)", "K(-2)", "K(30)"]
WIDE = Signature(
    (
        *SIGNATURE.controls,
        *(Control(name, 0, "active") for name in INSTANCES),
        *(Control(name, 0, "active") for name in ('S("a b",0.5)', 'S("",-1e-09)')),
    )
)
PLAIN = [control for control in WIDE.controls if "(" not in control.name]
parameters = st.sampled_from([(), (1,), (-3,), (2,)])
weights = st.sampled_from([0.25, 1.0, 3e-7, 40.0])


@st.composite
def varied(draw, bigraph):
    """Draw the same bigraph with some nodes without ports given the parameters of another control."""
    choices = st.sampled_from([control.name for control in WIDE.controls if control not in PLAIN])
    bigraph = lean(bigraph)
    nodes = [
        replace(node, control=draw(choices)) if node.control == "A" and draw(st.booleans()) else node
        for node in bigraph.nodes
    ]
    return replace(bigraph, signature=WIDE, nodes=tuple(nodes))


def patterns(**options):
    return redexes(**options).map(pattern_of).filter(lambda found: not list(faults(found))).flatmap(varied)


@st.composite
def rules(draw, name, kind, *, instantaneous=False, action=None):
    redex = draw(patterns(max_nodes=3, sharing=draw(st.booleans())))
    width = draw(st.integers(0, 2)) if redex.sites else 0
    reactum = draw(bigraphs(Interface(width), redex.outer, max_nodes=3, max_edges=1).flatmap(varied))
    conditions = draw(
        st.lists(
            st.builds(Condition, st.booleans(), patterns(max_nodes=2), st.sampled_from(Where)), max_size=2
        )
    )
    weighted = float("inf") if instantaneous and kind is SystemKind.SBRS else draw(weights)
    return Rule(
        name,
        redex,
        reactum,
        tuple(draw(st.integers(0, len(redex.sites) - 1)) for _ in range(width)),
        None if kind is SystemKind.BRS else weighted,
        None if action is None else action.name,
        0 if action is None else action.reward,
        tuple(conditions),
        draw(parameters),
    )


@st.composite
def systems(draw):
    """Draw a system whose signature has just the instances that are used."""
    kind = draw(st.sampled_from(SystemKind))
    actions = [Action("go", draw(st.sampled_from([0, 3, -2.5]))), Action("stay")]
    chosen = actions[: draw(st.integers(1, 2))] if kind is SystemKind.NBRS else [None]
    first = [draw(rules(f"r{place}", kind, action=action)) for place, action in enumerate(chosen)]
    classes = [PriorityClass(tuple(first))]
    if kind is not SystemKind.NBRS and draw(st.booleans()):
        fast = draw(rules("fast", kind, instantaneous=True))
        classes.insert(0, PriorityClass((fast,), instantaneous=True))
    predicates = [
        Predicate(f"p{place}", pattern, draw(st.none() | st.integers(-2, 5)), draw(parameters))
        for place, pattern in enumerate(draw(st.lists(patterns(max_nodes=2), max_size=2)))
    ]
    initial = draw(grounds(max_nodes=4, sharing=draw(st.booleans())).flatmap(varied))
    found = System(
        kind,
        WIDE,
        initial,
        tuple(classes),
        tuple(predicates),
        () if chosen == [None] else tuple(chosen),
    )
    return with_used_controls(found)


def with_used_controls(system):
    used = {node.control for bigraph in bigraphs_of(system) for node in bigraph.nodes}
    kept = Signature(tuple(each for each in WIDE.controls if each in PLAIN or each.name in used))
    return mapped(replace(system, signature=kept), lambda bigraph: replace(bigraph, signature=kept))


def mapped(system, change):
    """Return the system with each of its bigraphs changed."""

    def rule(each):
        conditions = tuple(replace(one, pattern=change(one.pattern)) for one in each.conditions)
        return replace(each, redex=change(each.redex), reactum=change(each.reactum), conditions=conditions)

    return replace(
        system,
        initial=change(system.initial),
        classes=tuple(replace(each, rules=tuple(map(rule, each.rules))) for each in system.classes),
        predicates=tuple(replace(each, pattern=change(each.pattern)) for each in system.predicates),
    )


def canonical_system(system):
    """Return the system with its bigraphs in canonical form: equal ones are the same system."""
    return mapped(system, canonical)
