"""The encoding beside a direct interpreter of the calculus.

A process is a tuple of `("send", x, y)` and `("get", x, z, process)`, side by side; every bound name differs from
all others, as the generator gives them out.
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

SYSTEM = read_system(example_text("asynchronous_pi"))
FREE = ("a", "b")


def substituted(whole, new, old):
    """P{new/old}; bound names differ from all others, so nothing is captured."""

    def name(each):
        return new if each == old else each

    return tuple(
        ("send", name(part[1]), name(part[2]))
        if part[0] == "send"
        else ("get", name(part[1]), part[2], substituted(part[3], new, old))
        for part in whole
    )


def reductions(whole):
    """x<y> | x(z).P --> P{y/z}, at the top only."""
    for sent, message in enumerate(whole):
        for received, listener in enumerate(whole):
            if message[0] == "send" and listener[0] == "get" and message[1] == listener[1]:
                rest = tuple(part for place, part in enumerate(whole) if place not in (sent, received))
                yield rest + substituted(listener[3], message[2], listener[2])


def written(whole):
    return " | ".join(map(written_part, whole)) or "1"


def written_part(part):
    if part[0] == "send":
        return f"Send{{{part[1]}, {part[2]}}}"
    _, subject, bound, body = part
    return f"/{bound} Get{{{subject}, {bound}}}.({written(body)})"


def encoded(whole):
    bigraph = read_big(f"Run.({written(whole)})", SYSTEM.signature)
    return canonical(parallel(bigraph, *(substitution(name, ()) for name in FREE)))


def reachable(start):
    """Return the encodings of what a process reduces to, and the steps between them: up to alpha."""
    found, steps, waiting = {encoded(start)}, set(), [start]
    while waiting:
        now = waiting.pop()
        for following in reductions(now):
            steps.add((encoded(now), encoded(following)))
            if encoded(following) not in found:
                found.add(encoded(following))
                waiting.append(following)
    return found, steps


@st.composite
def processes(draw, depth=2, known=FREE, path="z"):
    found = []
    for place in range(draw(st.integers(0 if depth < 2 else 2, 3 if depth == 2 else 2))):
        names = st.sampled_from(known)
        if depth and draw(st.booleans()):
            bound = f"{path}{place}"
            body = draw(processes(depth - 1, (*known, bound), bound))
            found.append(("get", draw(names), bound, body))
        else:
            found.append(("send", draw(names), draw(names)))
    return tuple(found)


@examples(40)
@given(processes())
def test_a_process_reduces_as_its_own_semantics_says(start):
    assert explored(replace(SYSTEM, initial=encoded(start))) == reachable(start)
