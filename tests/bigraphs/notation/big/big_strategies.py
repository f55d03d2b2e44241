"""Generated syntax of `.big` files."""

from hypothesis import strategies as st

from bigraphs.notation.big.declarations import (
    ActionDeclaration,
    BigDeclaration,
    Call,
    ClassTerm,
    ConditionTerm,
    ConstantDeclaration,
    ControlDeclaration,
    LinkDeclaration,
    Model,
    ParameterDeclaration,
    PlaceDeclaration,
    ReactDeclaration,
    SortDeclaration,
    SystemTerm,
)
from bigraphs.notation.big.syntax import (
    Absolute,
    Arithmetic,
    Chain,
    Close,
    Identity,
    Ion,
    Literal,
    Negated,
    Nest,
    NewNames,
    Number,
    PlacingLiteral,
    Ref,
    Repeat,
    Share,
    Substitute,
    Variable,
    Wired,
)

words = st.sampled_from(["x", "y", "a_b", "net'"])
controls = st.sampled_from(["A", "Loc", "B'"])
some_names = st.lists(words, min_size=1, max_size=2).map(tuple)

literals = st.one_of(
    st.integers(0, 99),
    st.floats(0, 1e30, allow_nan=False, allow_infinity=False),
    st.just(float("inf")),
    st.sampled_from(["", "a", "it's b-2"]),
)


def _sums(operand):
    levels = st.sampled_from([("+", "-"), ("*", "/")])
    return levels.flatmap(
        lambda symbols: st.builds(
            Arithmetic,
            operand,
            st.lists(st.tuples(st.sampled_from(symbols), operand), min_size=1, max_size=2).map(tuple),
        )
    )


values = st.recursive(
    st.builds(Literal, literals) | st.builds(Variable, words),
    lambda inner: st.one_of(
        st.builds(Negated, inner),
        st.builds(Absolute, inner),
        _sums(inner),
        st.builds(Arithmetic, inner, st.tuples(st.tuples(st.just("^"), inner))),
    ),
    max_leaves=4,
)
arguments = st.lists(values, max_size=2).map(tuple)
ions = st.builds(Ion, controls, st.lists(words, max_size=2).map(tuple), arguments)
sets = st.lists(st.lists(st.integers(0, 3), max_size=2).map(tuple), max_size=3).map(tuple)
leaves = st.one_of(
    ions,
    st.builds(Ref, words, arguments),
    st.builds(Number, st.integers(0, 1)),
    st.builds(Identity, st.integers(0, 3), st.just(())),
    st.builds(Identity, st.integers(0, 3), some_names),
    st.builds(PlacingLiteral, sets, st.integers(0, 4)),
    st.builds(Close, some_names),
    st.builds(Substitute, words, some_names),
    st.builds(NewNames, some_names),
)
wires = st.lists(
    st.builds(Close, some_names) | st.builds(Substitute, words, some_names),
    min_size=1,
    max_size=2,
    unique=True,
)


def _chains(operand):
    levels = st.sampled_from([("|", "||"), ("+",), ("*",)])
    return levels.flatmap(
        lambda operators: st.builds(
            Chain,
            operand,
            st.lists(st.tuples(st.sampled_from(operators), operand), min_size=1, max_size=3).map(tuple),
        )
    )


expressions = st.recursive(
    leaves,
    lambda inner: st.one_of(
        st.builds(Nest, ions, inner),
        st.builds(Wired, wires.map(tuple), inner),
        _chains(inner),
        st.builds(Share, inner, inner, inner),
        st.builds(Repeat, st.sampled_from(["|", "||"]), values, inner),
    ),
    max_leaves=6,
)

conditions = st.builds(ConditionTerm, st.booleans(), expressions, st.sampled_from(["ctx", "param"]))


def reacts(parameters, given):
    return st.builds(
        ReactDeclaration,
        words,
        expressions,
        expressions,
        st.none() | st.just((0, 1)) | st.just(()),
        st.none() | values,
        st.lists(conditions, max_size=2).map(tuple),
        parameters,
        given,
    )


any_react = reacts(st.just(()), arguments) | reacts(some_names, st.just(()))
ports = st.tuples(controls, st.none() | st.integers(0, 2))
declarations = st.one_of(
    st.builds(
        ControlDeclaration,
        controls,
        st.integers(0, 9),
        st.sampled_from(["active", "passive", "atomic"]),
        st.booleans(),
        st.just(()) | some_names,
    ),
    st.builds(ConstantDeclaration, st.sampled_from(["int", "float", "string"]), words, values),
    st.builds(BigDeclaration, words, expressions, st.just(()), arguments),
    st.builds(BigDeclaration, words, expressions, some_names),
    any_react,
    st.builds(
        ActionDeclaration, words, st.lists(any_react, min_size=1, max_size=2).map(tuple), st.none() | values
    ),
    st.builds(SortDeclaration, controls, st.lists(controls, max_size=2).map(tuple)),
    st.builds(PlaceDeclaration, controls, st.lists(controls, max_size=2).map(tuple)),
    st.builds(LinkDeclaration, words, st.lists(ports, min_size=1, max_size=2).map(tuple)),
)
calls = st.builds(Call, words, arguments)
parameters = st.one_of(
    st.builds(
        ParameterDeclaration,
        st.sampled_from(["int", "float", "string"]),
        some_names,
        st.lists(values, min_size=1, max_size=3).map(tuple),
    ),
    st.builds(
        ParameterDeclaration,
        st.sampled_from(["int", "float"]),
        some_names,
        st.tuples(values, values, values),
        st.just(True),
    ),
)
systems = st.builds(
    SystemTerm,
    st.sampled_from(["brs", "pbrs", "sbrs", "nbrs"]),
    calls,
    st.lists(
        st.builds(ClassTerm, st.lists(calls, min_size=1, max_size=2).map(tuple), st.booleans()), max_size=2
    ).map(tuple),
    st.lists(st.builds(Call, words, arguments, st.none() | values), max_size=2).map(tuple),
    st.lists(parameters, max_size=2).map(tuple),
)
models = st.builds(Model, st.lists(declarations, max_size=3).map(tuple), st.none() | systems)
