"""The two models of a configuration as separate pictures, for a page that steps through a run."""

from collections.abc import Hashable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Final

from bigactors.pictures.configuration_picture import Look, draw_logical, look_of
from bigactors.pictures.page import Page
from bigactors.pictures.region_marks import RegionMarks
from bigactors.pictures.scene import map_entities
from bigraphs.bigraph import Bigraph
from physical.drawing import MapEntity, draw_map
from physical.shape import Geometry
from physical.svg import Picture
from semantics.state.configuration import Configuration

MAP: Final = (440.0, 240.0)
INSET: Final = 6.0
"""The free space above the map and to its right."""

MAGNIFIED: Final = 1.15
"""The magnification of a bigraph."""


@dataclass(slots=True)
class Panels:
    """The pictures of a run; identical ones are drawn once.

    Attributes:
        within: All positions that must fit into the maps of the run.
        most: The most pictures of each model.
        marks: The regions that the maps of P show.
        logicals: The pictures of L, by their content.
        physicals: The maps of P, by their content.
    """

    within: tuple[Geometry, ...]
    most: int
    marks: RegionMarks | None = None
    logicals: dict[Hashable, Picture] = field(default_factory=dict)
    physicals: dict[Hashable, Picture] = field(default_factory=dict)

    @staticmethod
    def of(configurations: Sequence[Configuration], most: int, marks: RegionMarks | None = None) -> "Panels":
        """Return the panels of a run before anything is drawn."""
        entities = (entity for c in dict.fromkeys(configurations) for entity in map_entities(c))
        seen = (place for entity in entities for place in _places(entity))
        marked = () if marks is None else marks.positions(configurations)
        return Panels(tuple(dict.fromkeys((*seen, *marked))), most, marks)

    def logical(self, c: Configuration, before: Configuration | None) -> Picture | None:
        """Return the picture of L with changes since the configuration before glowing; None once there are `most`."""
        look, bigraph = look_of(c, before), c.structure.logical.bigraph()
        shown = (bigraph, look.glowing, look.marked)
        if shown not in self.logicals and len(self.logicals) < self.most:
            self.logicals[shown] = logical_picture(bigraph, look, "L")
        return self.logicals.get(shown)

    def physical(self, c: Configuration, before: Configuration | None) -> Picture | None:
        """Return the map of P with changes since the configuration before glowing; None once there are `most`."""
        look, entities = look_of(c, before, self.marks), map_entities(c)
        shown = (entities, look.glowing, look.marked, look.ways)
        if shown not in self.physicals and len(self.physicals) < self.most:
            self.physicals[shown] = self._map(entities, look)
        return self.physicals.get(shown)

    def _map(self, entities: Sequence[MapEntity], look: Look) -> Picture:
        page = Page(*MAP)
        drawn = draw_map(
            entities,
            (MAP[0] - INSET, MAP[1] - INSET),
            highlight=look.glowing,
            marked=look.marked,
            colours=look.palette.kinds,
            channel_colours=look.palette.channels,
            within=self.within,
            ways=look.ways,
        )
        page.put(drawn, (0.0, INSET))
        return page.picture("P")


def logical_picture(bigraph: Bigraph, look: Look, title: str) -> Picture:
    """Return the picture of a bigraph of L."""
    return draw_logical(bigraph, look).picture(title, MAGNIFIED)


def _places(entity: MapEntity) -> Iterator[Geometry]:
    if entity.geometry is not None and entity.carried_by is None:
        yield entity.geometry
    if entity.destination is not None:
        yield entity.destination
