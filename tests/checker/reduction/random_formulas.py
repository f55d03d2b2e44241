"""Random formulas of linear and branching time, and whether a shown run violates one."""

import numpy as np
from hypothesis import strategies as st

from checker.engines.graph import STUTTER, Graph
from checker.properties.temporal.lasso_evaluation import is_true_on
from checker.properties.temporal.lassos import Lasso
from checker.properties.temporal.truth import FormulaTruth, valuation
from semantics.properties.propositions import (
    And,
    Ended,
    HasPending,
    Inside,
    LinkedWith,
    Not,
    Or,
    Present,
    Waiting,
)
from semantics.properties.temporal import (
    Both,
    Denied,
    Either,
    Enabled,
    Eventually,
    Globally,
    Next,
    Now,
    OnAllPaths,
    OnSomePath,
    Release,
    Steps,
    Taken,
    Until,
    WeakUntil,
    atoms,
)
from semantics.successors import expand

RULES = (
    "req_obs",
    "sense",
    "rcv_obs",
    "req_ctr",
    "command",
    "actuate",
    "commit",
    "snd",
    "rcv_msg",
    "env",
    "fun",
)


def places_of(initial):
    """Return the entities that may contain others."""
    kinds, signature = initial.setting.kinds, initial.setting.signature
    return [name for name in sorted(kinds) if signature[kinds[name]].contains]


def atoms_of(initial):
    """Return a strategy of propositions about a mission's entities and agents."""
    name, place = st.sampled_from(sorted(initial.setting.kinds)), st.sampled_from(places_of(initial))
    agent = st.sampled_from(initial.alpha.names())
    return st.one_of(
        st.builds(Inside, name, place, st.booleans()),
        st.builds(LinkedWith, name, name, st.booleans()),
        st.builds(Present, name),
        *(st.builds(atom, agent) for atom in (Ended, Waiting, HasPending)),
    )


def shared_atoms_of(initial):
    """Return a strategy of propositions about any or all of the entities of a kind, and about any or all agents."""
    kinds = initial.setting.kinds
    ranges = [[name for name in sorted(kinds) if kinds[name] == kind] for kind in sorted(set(kinds.values()))]
    place, agents = st.sampled_from(places_of(initial)), initial.alpha.names()
    join = st.sampled_from([And, Or])
    places = st.builds(
        lambda join, names, place, actually: join(tuple(Inside(each, place, actually) for each in names)),
        join, st.sampled_from(ranges), place, st.booleans(),
    )  # fmt: skip
    states = st.builds(
        lambda join, atom: join(tuple(map(atom, agents))), join, st.sampled_from([Ended, Waiting, HasPending])
    )
    return st.one_of(places, states)


def steps_of(initial):
    agents = st.sampled_from([None, None, *initial.alpha.names()])
    return st.builds(Steps, st.sampled_from(RULES).map(lambda rule: (rule,)), agents)


def propositions(atom):
    more = st.one_of(atom, st.builds(Not, atom))
    return st.one_of(
        more, st.builds(lambda a, b: And((a, b)), more, more), st.builds(lambda a, b: Or((a, b)), more, more)
    )


def linear(initial, atom, *, counting=False):
    """Return a strategy of formulas of linear time; `counting` ones have next and enabled, too."""
    steps = steps_of(initial)
    leaves = [propositions(atom).map(Now)] * 3 + [steps.map(Taken)] + counting * [steps.map(Enabled)]
    unary = [
        Denied,
        Eventually,
        Globally,
        lambda a: Globally(Eventually(a)),
        lambda a: Eventually(Globally(a)),
    ]
    binary = [
        Both,
        Either,
        Until,
        WeakUntil,
        Release,
        lambda a, b: Globally(Either(Denied(a), Eventually(b))),
    ]
    return st.recursive(
        st.one_of(leaves),
        lambda inner: st.one_of(
            *(st.builds(make, inner) for make in unary + counting * [Next]),
            *(st.builds(make, inner, inner) for make in binary),
        ),
        max_leaves=4,
    )


def branching(initial, atom, *, counting=False):
    """Return a strategy of formulas of branching time; `counting` ones have next and enabled, too."""
    leaves = [propositions(atom).map(Now)] * 3 + counting * [steps_of(initial).map(Enabled)]

    def larger(inner):
        paths = st.one_of(
            *(st.builds(make, inner) for make in [Eventually, Globally] + counting * [Next]),
            *(st.builds(make, inner, inner) for make in (Until, WeakUntil, Release)),
        )
        return st.one_of(
            *(st.builds(quantifier, paths) for quantifier in (OnAllPaths, OnSomePath)),
            st.builds(Denied, inner),
            st.builds(Both, inner, inner),
            st.builds(Either, inner, inner),
        )

    return st.recursive(st.one_of(leaves), larger, max_leaves=4)


def violates(trace, formula):
    """Return whether a shown run violates a formula of linear time; one without a loop is continued somehow."""
    configurations, labels, loop = (
        list(trace.configurations),
        [each.label for each in trace.steps],
        trace.loop,
    )
    while loop is None:
        taken = expand(configurations[-1]).transitions
        if not taken:
            loop = len(labels)
        elif taken[0].target in configurations:
            labels.append(taken[0].label)
            loop = configurations.index(taken[0].target)
            configurations.append(configurations[loop])
        else:
            labels.append(taken[0].label)
            configurations.append(taken[0].target)
    stays = loop == len(labels)
    size, numbers = len(configurations), {label: number for number, label in enumerate(dict.fromkeys(labels))}
    actions = [*(numbers[label] for label in labels), STUTTER]
    targets = [*range(1, size), size - 1]
    graph = Graph(np.arange(size + 1), np.array(targets), np.array(actions), tuple(numbers))
    asked = [atom.proposition for atom in atoms(formula) if isinstance(atom, Now)]
    truth = FormulaTruth(graph, valuation(configurations, asked))
    edges = (size - 1,) if stays else tuple(range(loop, size - 1))
    return not is_true_on(Lasso(tuple(range(size - 1 if stays else loop)), edges), formula, truth)
