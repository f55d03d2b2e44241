"""The encoding beside a direct interpreter of the calculus.

A process is a sorted tuple of (kind, name, process): `amb` n[P], and the prefixes `in`, `out` and `open`.
"""

from dataclasses import replace

from exploring import explored
from hypothesis import given
from hypothesis import strategies as st
from scale import examples

from bigraphs.algebra import parallel, substitution
from bigraphs.canonical_form import canonical
from bigraphs.examples import example_text
from bigraphs.notation import read_big, read_system

SYSTEM = read_system(example_text("mobile_ambients"))
CONTROLS = {"amb": "Amb", "in": "In", "out": "Out", "open": "Open"}
NAMES = ("m", "n")


def process(*parts):
    return tuple(sorted(parts))


def without(whole, part):
    rest = list(whole)
    rest.remove(part)
    return tuple(rest)


def reductions(whole):
    """Yield what a process reduces to, by the three axioms and under ambients."""
    for part in set(whole):
        rest = without(whole, part)
        kind, name, body = part
        if kind == "amb":
            yield from entries(part, rest)
            yield from exits(part, rest)
            for reduced in reductions(body):
                yield process(*rest, (kind, name, reduced))
        if kind == "open":
            for other in set(rest):
                if other[:2] == ("amb", name):
                    yield process(*without(rest, other), *body, *other[2])


def entries(ambient, rest):
    """n[in m.P | Q] | m[R] --> m[n[P | Q] | R]"""
    _, name, body = ambient
    for prefix in set(body):
        for host in set(rest):
            if prefix[0] == "in" and host[:2] == ("amb", prefix[1]):
                moved = ("amb", name, process(*without(body, prefix), *prefix[2]))
                yield process(*without(rest, host), ("amb", host[1], process(*host[2], moved)))


def exits(host, rest):
    """m[n[out m.P | Q] | R] --> n[P | Q] | m[R]"""
    _, name, body = host
    for inner in set(body):
        for prefix in set(inner[2]) if inner[0] == "amb" else ():
            if prefix[:2] == ("out", name):
                moved = ("amb", inner[1], process(*without(inner[2], prefix), *prefix[2]))
                yield process(*rest, moved, ("amb", name, without(body, inner)))


def reachable(start):
    found, waiting = {start}, [start]
    steps = set()
    while waiting:
        now = waiting.pop()
        for following in set(reductions(now)):
            steps.add((now, following))
            if following not in found:
                found.add(following)
                waiting.append(following)
    return found, steps


def written(whole):
    return " | ".join(f"{CONTROLS[kind]}{{{name}}}.({written(body)})" for kind, name, body in whole) or "1"


def encoded(whole):
    bigraph = read_big(written(whole), SYSTEM.signature)
    return canonical(parallel(bigraph, *(substitution(name, ()) for name in NAMES)))


def processes():
    parts = st.deferred(lambda: st.tuples(st.sampled_from(sorted(CONTROLS)), st.sampled_from(NAMES), inner))
    inner = st.deferred(lambda: st.lists(parts, max_size=2).map(lambda found: process(*found)))
    return st.lists(parts, min_size=2, max_size=3).map(lambda found: process(*found)).filter(small)


def small(whole):
    return 2 <= size(whole) <= 6


def size(whole):
    return sum(1 + size(body) for _, _, body in whole)


def same_reductions(start):
    states, steps = explored(replace(SYSTEM, initial=encoded(start)))
    wanted, between = reachable(start)
    return states == set(map(encoded, wanted)) and steps == {(encoded(a), encoded(b)) for a, b in between}


@examples(40)
@given(processes())
def test_a_process_reduces_as_its_own_semantics_says(start):
    assert same_reductions(start)


def test_each_axiom_is_a_step():
    enter = process(("amb", "n", (("in", "m", ()), ("open", "n", ()))), ("amb", "m", (("amb", "n", ()),)))
    leave = process(("amb", "m", (("amb", "n", (("out", "m", (("in", "m", ()),)),)),)))
    dissolve = process(("open", "m", (("amb", "n", ()),)), ("amb", "m", (("open", "n", ()),)))
    for start, states in ((enter, 2), (leave, 3), (dissolve, 3)):
        assert same_reductions(start)
        assert len(reachable(start)[0]) == states
