import pytest
from bigraph_strategies import SIGNATURE, bigraphs, interfaces
from hypothesis import given
from hypothesis import strategies as st

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
    names,
    nest,
    parallel,
    placing,
    rename,
    substitution,
    symmetry,
    tensor,
)
from bigraphs.bigraph import find
from bigraphs.canonical_form import equal
from bigraphs.errors import BigraphError
from bigraphs.interface import Interface

X = ("x", "y")
LEFT, RIGHT = ("x", "y"), ("z", "w")
INNER_LEFT, INNER_RIGHT = ("i", "j"), ("k", "l")


@st.composite
def composable(draw, count=3, names_of=X, inner_names=("i", "j"), max_nodes=3):
    """Draw bigraphs each of which fits into the one before."""
    faces = [draw(interfaces(2, names_of)) for _ in range(count)]
    faces.append(draw(interfaces(2, inner_names)))
    for outer in range(count - 1, -1, -1):  # what has width inside has width outside
        if faces[outer + 1].width and not faces[outer].width:
            faces[outer] = Interface(1, faces[outer].names)
    return [draw(bigraphs(faces[n + 1], faces[n], max_nodes=max_nodes, sharing=True)) for n in range(count)]


def apart(count=1):
    """Draw two chains of composable bigraphs that share no name."""
    return st.tuples(composable(count, LEFT, INNER_LEFT, 2), composable(count, RIGHT, INNER_RIGHT, 2))


@given(composable(3))
def test_composition_is_associative(parts):
    f, g, h = parts
    assert equal(f @ (g @ h), (f @ g) @ h)


@given(bigraphs(sharing=True))
def test_identities_are_neutral_for_composition(bigraph):
    assert identity(bigraph.outer) @ bigraph == bigraph
    assert equal(bigraph @ identity(bigraph.inner), bigraph)


@given(apart(), composable(1, ("u",), ("v",), 2))
def test_tensor_is_associative_with_nothing_as_unit(pair, third):
    (f,), (g,) = pair
    (h,) = third
    assert equal((f * g) * h, f * (g * h))
    assert identity(Interface()) * f == f == f * identity(Interface())


@given(apart(2))
def test_composition_and_tensor_interchange(pair):
    (f, f_inside), (g, g_inside) = pair
    assert equal((f * g) @ (f_inside * g_inside), (f @ f_inside) * (g @ g_inside))


@given(interfaces(2, LEFT), interfaces(2, RIGHT))
def test_tensor_of_identities_is_an_identity(one, other):
    assert identity(one) * identity(other) == identity(one * other)


@given(apart())
def test_symmetry_is_natural(pair):
    (f,), (g,) = pair
    inside, outside = (f.inner, g.inner), (f.outer, g.outer)
    assert equal(swap(*outside) @ (f * g), (g * f) @ swap(*inside))


@given(st.integers(0, 3), st.integers(0, 3), st.integers(0, 3))
def test_symmetries_are_inverse_and_coherent(k, m, n):
    width = Interface
    assert symmetry(m, k) @ symmetry(k, m) == identity(width(k + m))
    two_steps = (identity(width(m)) * symmetry(k, n)) @ (symmetry(k, m) * identity(width(n)))
    assert symmetry(k, m + n) == two_steps
    assert symmetry(k, 0) == identity(width(k))


def swap(one, other):
    return symmetry(one.width, other.width) * names([*one.names, *other.names])


def test_closures_of_substitutions_and_idle_names_are_as_milner_says():
    assert closure("x") @ substitution("x", ["a", "b"]) == closure("q") @ substitution("q", ["a", "b"])
    assert lean(closure("x") @ substitution("x", [])) == identity(Interface())
    assert substitution("y", ["z"]) @ substitution("z", ["a", "b"]) == substitution("y", ["a", "b"])
    assert substitution("x", ["x"]) == names(["x"])


def test_merge_is_associative_commutative_and_has_one_as_unit():
    wire = identity(Interface(1))
    assert merge(1) == wire
    assert merge(2) @ (merge(0) * wire) == wire
    assert merge(2) @ (merge(2) * wire) == merge(3) == merge(2) @ (wire * merge(2))
    assert merge(2) @ symmetry(1, 1) == merge(2)


@given(
    bigraphs(Interface(), Interface(1, X)),
    bigraphs(Interface(), Interface(1, X)),
    bigraphs(Interface(), Interface(1, X)),
)
def test_merge_product_is_a_commutative_monoid_on_prime_grounds(one, two, three):
    assert equal(one | two, two | one)
    assert equal((one | two) | three, one | (two | three))
    assert equal(one | merge(0), one)


@given(composable(1), composable(1, X, ("k", "l")), composable(1, X, ("m", "n")))
def test_parallel_product_is_associative_and_shares_names(one, two, three):
    (f,), (g,), (h,) = one, two, three
    assert equal((f // g) // h, f // (g // h))
    assert (f // g).outer == f.outer | g.outer


@given(bigraphs(outer=Interface(1, X)))
def test_closing_two_names_does_not_depend_on_their_order(bigraph):
    assert equal(close(bigraph, "x", "y"), close(close(bigraph, "y"), "x"))
    assert close(bigraph, "x").outer == Interface(1, ("y",))
    assert close(bigraph, "x").edges == bigraph.edges + 1


@given(bigraphs(outer=Interface(1, X)))
def test_renaming_there_and_back_changes_nothing_and_joining_makes_one_link(bigraph):
    assert rename(rename(bigraph, {"x": "q"}), {"q": "x"}) == bigraph
    assert rename(bigraph, {"x": "y", "y": "x"}).outer == bigraph.outer
    assert rename(bigraph, {"x": "y"}).outer.names == ("y",)


def test_nesting_puts_inside_and_shares_links():
    inner = atom(SIGNATURE, "B", ["x"], name="b")
    found = nest(ion(SIGNATURE, "B", ["x"], name="a"), inner)
    assert found.nodes[find(found, "b")].parents == (find(found, "a"),)
    assert found.outer == Interface(1, ("x",))


def test_operators_are_the_products():
    one, two = atom(SIGNATURE, "B", ["x"], name="a"), atom(SIGNATURE, "B", ["x"], name="b")
    assert one | two == merge_product(one, two)
    assert one // two == parallel(one, two)
    assert one * rename(two, {"x": "y"}) == tensor(one, rename(two, {"x": "y"}))
    assert merge(1) @ atom(SIGNATURE, "A") == compose(merge(1), atom(SIGNATURE, "A"))


def test_composing_through_a_shared_site_makes_a_shared_node():
    places = atom(SIGNATURE, "A", name="p") * atom(SIGNATURE, "A", name="q")
    open_places = ion(SIGNATURE, "A", name="p") * ion(SIGNATURE, "A", name="q")
    shared = open_places @ placing([{0, 1}], 2) @ atom(SIGNATURE, "A", name="s")
    assert places.inner.width == 0
    assert len(shared.nodes[find(shared, "s")].parents) == 2


@pytest.mark.parametrize(
    ("attempt", "message"),
    [
        (lambda: merge(2) @ merge(0), "a context for <2, {}> does not fit a content of <1, {}>"),
        (lambda: names(["x"]) * names(["x"]), "both sides have the name x"),
        (lambda: close(merge(0), "x"), "there is no outer name 'x' to close"),
        (lambda: nest(substitution("x", ["x"]), merge(0)), "nesting needs an outside without inner names"),
        (
            lambda: atom(SIGNATURE, "A", name="a") | atom(SIGNATURE, "A", name="a"),
            "node 'a' is there 2 times",
        ),
    ],
)
def test_what_does_not_fit_is_refused(attempt, message):
    with pytest.raises(BigraphError) as found:
        attempt()
    assert found.value.message == message


def test_idle_edges_are_removed_by_lean_only():
    loose = close(atom(SIGNATURE, "B", ["x"]) * substitution("y", []), "x", "y")
    assert loose.edges == 2
    assert lean(loose).edges == 1
    assert lean(lean(loose)) == lean(loose)
