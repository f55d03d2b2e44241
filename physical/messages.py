"""Wordings that messages of all rooms share: a count with its noun, and how a missing extra is installed."""


def counted(count: int, one: str, many: str = "") -> str:
    """Return a count with its noun.

    >>> counted(1, "step"), counted(1234, "step"), counted(0, "vertex", "vertices")
    ('1 step', '1,234 steps', '0 vertices')
    """
    return f"{count:,} {one if count == 1 else many or one + 's'}"


def install_extra(extra: str) -> str:
    """Return a hint that fits however bigactors was installed: by pip, uv or pipx, by its name or from a clone."""
    return (
        f"install bigactors as you did, with [{extra}] behind its name or its folder, such as "
        f"pip install 'bigactors[{extra}]', or pip install -e '.[{extra}]' in a clone"
    )
