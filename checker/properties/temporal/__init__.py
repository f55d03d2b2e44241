"""Temporal logic on explored graphs: linear time by automata, branching time by fixpoints, both under fairness.

The package works on arrays (`checker.engines.graph`) and is independent of their origin; only `decide` knows missions.
It is imported on demand, since numpy loads slowly.
"""
