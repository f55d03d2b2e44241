"""The missions that ship."""

from pathlib import Path


def shipped_missions() -> dict[str, Path]:
    """Return the missions that ship, by name."""
    return {path.stem: path for path in sorted(Path(__file__).parent.glob("*.mission"))}
