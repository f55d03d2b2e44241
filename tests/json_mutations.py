"""JSON texts that are almost right: a part of a valid one is replaced, left out, doubled, nested or damaged."""

import json

from hypothesis import strategies as st

DEEP = "[" * 900 + "]" * 900
ODD = (
    *("null", "true", "false", "0", "-1", "1", "1.5", "1e15", "1e300", "1e999", "-1e999", "NaN", "Infinity"),
    *("1" + "0" * 20, "1" + "0" * 290, "1" + "0" * 350, "-" + "9" * 5_000),
    *(
        '""',
        '" "',
        '"a"',
        r'"\n"',
        r'"\ud800"',
        r'"\u0000"',
        '"\N{RIGHT-TO-LEFT OVERRIDE}"',
        '"x"',
        '"y\u00e9"',
    ),
    *("[]", "[[]]", "{}", '{"a": 1}', '{"a": 1, "a": 2}', "[1, 2]", '["a"]'),
    *(DEEP, "[" * 100_000, '{"a":' * 900 + "1" + "}" * 900, f'"{"x" * 3_000}"', f"[{'1,' * 3_000}1]"),
)
"""JSON of all sorts, and some that is none."""

HOLE = "\N{OBJECT REPLACEMENT CHARACTER}"


def places(value, path=()):
    """Yield the paths of all parts of a value."""
    yield path
    if isinstance(value, dict | list):
        for key, part in value.items() if isinstance(value, dict) else enumerate(value):
            yield from places(part, (*path, key))


def replaced(value, path, part):
    """Return a value with another part at a path."""
    if not path:
        return part
    copied = dict(value) if isinstance(value, dict) else list(value)
    copied[path[0]] = replaced(copied[path[0]], path[1:], part)
    return copied


@st.composite
def mutated(draw, values):
    """Return the bytes of a valid value with one to three faults."""
    value, holes = draw(st.sampled_from(values)), []
    for number in range(draw(st.integers(1, 3))):
        path = draw(st.sampled_from(list(places(value))))
        parent = value
        for key in path[:-1]:
            parent = parent[key]
        if path and isinstance(parent, dict) and draw(st.booleans()):
            renamed = draw(st.sampled_from([*parent, "other", "a\n"]))
            kept = {renamed if key == path[-1] else key: part for key, part in parent.items()}
            if draw(st.booleans()):
                kept.pop(renamed)
            value = replaced(value, path[:-1], kept)
        else:
            value = replaced(value, path, f"{HOLE}{number}")
            holes.append(number)
    text = json.dumps(value, ensure_ascii=False)
    for number in holes:
        text = text.replace(f'"{HOLE}{number}"', draw(st.sampled_from(ODD)))
    if draw(st.integers(0, 5)) == 0:
        text = text.replace("{", '{"n": 1, ', 1)  # perhaps a repeated key
    data = text.encode("utf-8", "surrogatepass")
    if draw(st.integers(0, 5)) == 0:
        at = draw(st.integers(0, len(data)))
        data = data[:at] + draw(st.binary(max_size=3)) + data[at + draw(st.integers(0, 3)) :]
    return data
