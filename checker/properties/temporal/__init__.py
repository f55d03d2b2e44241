"""Temporal logic on explored graphs: linear time by automata, branching time by fixpoints, both under fairness.

All of it works on arrays (`checker.engines.graph`) and knows nothing of how they came to be;
`decide` alone knows missions. It is imported where a mission asks a temporal property, since numpy and scipy take their
time to load.
"""
