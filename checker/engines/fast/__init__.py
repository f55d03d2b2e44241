"""The fast explorer: the rules are learned as decision trees, and compiled loops walk them over packed rows.

`explorer` loads numba: import it only where a mission is worth it.
"""
