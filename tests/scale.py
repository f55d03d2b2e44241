"""How much of a test with many cases is run: a part by `make test`, more by `make test-long`, all by `make fuzz`."""

import os

import pytest
from hypothesis import settings

IS_WHOLE = "BIGACTORS_FUZZ" in os.environ
IS_LONG = "BIGACTORS_LONG" in os.environ
PART = 3
SHORTER = 2


def examples(most, part=PART, **more):
    """Return the settings of a property that is tried with so many examples.

    `make test-long` divides them by `part`, and `make test` by two more.
    """
    share = most // part if IS_LONG else most // (part * SHORTER)
    return settings(max_examples=most if IS_WHOLE else max(1, share), **more)


FOLDED = "folded"
"""A word in the keys of variations with compressed rows: under reductions, their loops take long to compile."""


def some_of(variations, long):
    """Return the variations to draw from; `make test` leaves out those whose key has the word `long`."""
    is_all = IS_WHOLE or IS_LONG
    return [each for key, each in variations.items() if is_all or long not in key.split()]


PERIOD, SHORT = 9, {0, 5, 7}
"""A third of all places, with all remainders by two and by three, so that these leave out no kind of variation."""


def crossed(names, variations, long=None):
    """Decorate a test of every `name` under every `variation`.

    Without `make fuzz`, each name is taken once, with the next variation. Two thirds of these are long, and those of a
    variation whose key has the word `long`.
    """
    numbered = [
        (place, name, at, key) for place, name in enumerate(names) for at, key in enumerate(variations)
    ]
    pairs = [
        pytest.param(
            *(name, variations[key]),
            id=f"{name}-{key}",
            marks=long_if(place % PERIOD not in SHORT or long in key.split()),
        )
        for place, name, at, key in numbered
        if IS_WHOLE or at == place % len(variations)
    ]
    return lambda test: pytest.mark.fuzz(pytest.mark.parametrize(("name", "variation"), pairs)(test))


def seeds(most, part):
    """Decorate a test of generated cases by their number: `make fuzz` takes all, else a part; half of them are long."""
    numbers = some_long(range(most if IS_WHOLE else part), every=SHORTER)
    return lambda test: pytest.mark.fuzz(pytest.mark.parametrize("seed", numbers)(test))


def some_long(cases, every=3):
    """Return the cases of a test, each a value or a tuple of several; all but each `every`-th are long."""
    return [_case(case, long_if(place % every != 0)) for place, case in enumerate(cases)]


def long_ones(*cases):
    """Return cases of a test that only `make test-long` runs: larger ones, or more of what another case tries."""
    return [_case(case, long_if(True)) for case in cases]


def _case(case, marks):
    return pytest.param(*case if isinstance(case, tuple) else (case,), marks=marks)


def long_if(is_long):
    """Return the marks of a case."""
    return pytest.mark.long if is_long else ()


def soak(test):
    """Mark a test that only `make fuzz` runs: of what a shorter one tells, over a long time."""
    return pytest.mark.fuzz(pytest.mark.skipif(not IS_WHOLE, reason="a long run: `make fuzz`")(test))
