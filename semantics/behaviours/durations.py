"""Durations in their written form: `100 ms`, `90 s`, `10 min`, `1.5 h`."""

UNITS = {"h": 3600, "min": 60, "s": 1, "ms": 0.001}
"""The units, in seconds, the longest first."""


def duration_text(seconds: float) -> str:
    """Return a duration in the longest unit that divides it, at least in seconds.

    >>> duration_text(600.0), duration_text(90.0), duration_text(0.5), duration_text(0.0)
    ('10 min', '90 s', '0.5 s', '0 s')
    """
    whole = (unit for unit in ("h", "min") if seconds and seconds % UNITS[unit] == 0)
    unit = next(whole, "s")
    return f"{seconds / UNITS[unit]:g} {unit}"
