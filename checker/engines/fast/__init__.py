"""The fast explorer: rules learned as decision trees, which compiled loops evaluate on packed rows.

`explorer` loads numba: import it only where a mission is worth it.
"""
