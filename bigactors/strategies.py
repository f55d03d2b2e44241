"""Hypothesis strategies for tests of one's own rules and tools, over generated missions (extra `strategies`).

>>> from hypothesis import given
>>> from bigactors.strategies import configurations, missions

`configurations()` yields configurations that a run reaches, `missions()` what `check` takes. `worlds`, `structures`,
`programs`, `queries` and `reactions` yield their parts. What fails is shrunk to few entities, statements and steps.
"""

from physical.messages import install_extra

try:
    from semantics.strategies import (
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
