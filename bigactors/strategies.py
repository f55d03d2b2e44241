"""Hypothesis strategies that generate missions, for tests of your own rules and tools (extra `strategies`).

>>> from hypothesis import given
>>> from bigactors.strategies import configurations, missions

`configurations()` generates reachable configurations, `missions()` missions for `check`. `worlds`, `structures`,
`programs`, `queries` and `reactions` generate their parts. Failures shrink to few entities, statements and steps.
"""

from physical.wordings import install_extra

try:
    from semantics.hypothesis_strategies import (
        GeneratedMission,
        World,
        beliefs,
        commands,
        configurations,
        environments,
        initial_configurations,
        missions,
        patterns,
        programs,
        queries,
        reactions,
        signatures,
        structures,
        worlds,
    )
except ModuleNotFoundError as error:
    raise ImportError(f"strategies need hypothesis: {install_extra('strategies')}") from error

__all__ = [
    "GeneratedMission",
    "World",
    "beliefs",
    "commands",
    "configurations",
    "environments",
    "initial_configurations",
    "missions",
    "patterns",
    "programs",
    "queries",
    "reactions",
    "signatures",
    "structures",
    "worlds",
]
