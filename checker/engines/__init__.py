"""Engines: ways to visit all reachable configurations. `contract` is their interface, `choose` selects one."""
