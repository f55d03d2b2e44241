"""The fast explorer: the rules are learned as decision trees, and compiled loops walk them over packed rows.

Importing it loads numba: do so only where a mission is worth it.
"""

from checker.fast.explorer import explore_fast

__all__ = ["explore_fast"]
