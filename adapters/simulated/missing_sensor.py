"""A simulated sensor: at random, with a seed, it sees each of some entities or misses it for a while."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from random import Random
from typing import Final

from adapters.listening_plugin import Feed
from adapters.plugin import Gone, World
from physical import PhysicalProperty

EVERY: Final = 10.0
"""Seconds between two looks of the sensor."""


class MissingSensor(Feed):
    """A plugin that publishes entities that never move, and takes each back with a probability.

    Arguments:
        there: The entities, as they are all the time.
        share: The probability that one look misses an entity.
        seed: Determines the looks.
    """

    def __init__(self, there: Sequence[PhysicalProperty], share: float, seed: int) -> None:
        super().__init__("simulated sensor", "was seen by a simulated sensor")
        self._there = there
        self._share = share
        self._random = Random(seed)

    async def run(self, world: World) -> None:
        """Look until cancelled."""
        while True:
            for each in self._there:
                missed = self._random.random() < self._share
                world.publish(Gone(each.entity, world.now(), self.name) if missed else each)
            await asyncio.sleep(EVERY)
