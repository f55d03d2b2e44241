"""Which of several states comes first: the same one in each world, whatever was seen before."""

from bigraph_strategies import PLAIN, grounds, shuffled
from hypothesis import given
from hypothesis import strategies as st

from bigraphs.canonical_form import canonical
from bigraphs.engine import state_digests
from bigraphs.engine.decoding import to_bigraph
from bigraphs.engine.intern_tables import InternTables
from bigraphs.engine.labelling import Labelling
from bigraphs.engine.state_arrays import make_state
from bigraphs.engine.state_digests import Outlines
from bigraphs.notation import read_system


def first_of(bigraphs, names=("x", "y")):
    """Return the state that comes first in a world that sees these in order, canonical."""
    world = InternTables(bigraphs[0].signature, names, bigraphs[0].regions, sharing=True)
    states = [make_state(world, each) for each in bigraphs]
    return canonical(to_bigraph(states[Outlines(Labelling(world)).least(states)]))


@given(
    st.lists(
        grounds(max_nodes=5, controls=PLAIN, sharing=True).filter(lambda each: each.regions == 1),
        min_size=1,
        max_size=4,
    ),
    st.data(),
)
def test_the_first_of_several_states_does_not_depend_on_their_order(several, data):
    others = [data.draw(shuffled(each)) for each in data.draw(st.permutations(several))]
    assert first_of(others) == first_of(several)


def test_a_canonical_form_is_made_only_of_states_with_equal_outlines(monkeypatch):
    made, form = [], state_digests.history_free
    monkeypatch.setattr(state_digests, "history_free", lambda state: made.append(1) or form(state))
    text = "ctrl K = 1; big s = %s; react r = K{x} --> K{x}; begin brs init s; rules = [{r}]; end"
    ring, pairs, other = (
        read_system(text % written).initial
        for written in (
            "/a /b /c (K{a}.K{b}.1 | K{b}.K{c}.1 | K{c}.K{a}.1)",
            "/a /b /c (K{a}.K{a}.1 | K{b}.K{b}.1 | K{c}.K{c}.1)",
            "/a /b (K{a}.1 | K{b}.K{a}.K{b}.1 | K{a}.K{a}.1)",
        )
    )
    assert first_of([ring, other], ()) == first_of([other, ring], ())
    assert made == []
    assert first_of([ring, pairs], ()) == first_of([pairs, ring], ())
    assert len(made) == 4
