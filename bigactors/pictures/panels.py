"""The two models of a configuration as separate pictures, for a page that steps through a run."""

from collections.abc import Hashable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Final

from bigactors.pictures.configuration import Look, draw_logical, logical_layout, look_of
from bigactors.pictures.page import Page, plain_style
from bigactors.pictures.scene import map_entities
from bigactors.pictures.vector import svg_file, svg_of
from bigraphs.bigraph import Bigraph
from bigraphs.drawing import MARGIN as BIGRAPH_MARGIN
from physical.drawing import MapEntity, draw_map
from physical.shape import Geometry
from semantics.state.configuration import Configuration

MAP: Final = (600.0, 400.0)
LATITUDES: Final = 46.0
LONGITUDES: Final = 16.0
MAGNIFIED: Final = 1.15
"""The magnification of a bigraph."""


@dataclass(frozen=True, slots=True)
class Picture:
    """The shapes of an SVG, and its size in points."""

    key: str
    width: float
    height: float
    shapes: str


@dataclass(slots=True)
class Panels:
    """The pictures of a run; identical ones are drawn once.

    Attributes:
        within: All positions that must fit into the maps of the run.
        most: The most pictures of each model.
        logicals: The pictures of L, by their content.
        physicals: The maps of P, by their content.
    """

    within: tuple[Geometry, ...]
    most: int
    logicals: dict[Hashable, Picture] = field(default_factory=dict)
    physicals: dict[Hashable, Picture] = field(default_factory=dict)

    @staticmethod
    def of(configurations: Sequence[Configuration], most: int) -> "Panels":
        """Return the panels of a run before anything is drawn."""
        entities = (entity for c in dict.fromkeys(configurations) for entity in map_entities(c))
        seen = (place for entity in entities for place in _places(entity))
        return Panels(tuple(dict.fromkeys(seen)), most)

    def logical(self, c: Configuration, before: Configuration | None) -> Picture | None:
        """Return the picture of L with changes since the configuration before glowing; None once there are `most`."""
        look, bigraph = look_of(c, before), c.structure.logical.bigraph()
        shown = (bigraph, look.glowing, look.marked)
        if shown not in self.logicals and len(self.logicals) < self.most:
            self.logicals[shown] = self._logical(bigraph, look, f"L{len(self.logicals)}")
        return self.logicals.get(shown)

    def physical(self, c: Configuration, before: Configuration | None) -> Picture | None:
        """Return the map of P with changes since the configuration before glowing; None once there are `most`."""
        look, entities = look_of(c, before), map_entities(c)
        shown = (entities, look.glowing, look.marked)
        if shown not in self.physicals and len(self.physicals) < self.most:
            self.physicals[shown] = self._physical(entities, look, f"P{len(self.physicals)}")
        return self.physicals.get(shown)

    def _logical(self, bigraph: Bigraph, look: Look, key: str) -> Picture:
        with plain_style():
            page = logical_page(bigraph, look)
            return Picture(key, page.width, page.height, svg_of(page.figure, key))

    def _physical(self, entities: Sequence[MapEntity], look: Look, key: str) -> Picture:
        with plain_style():
            page = Page(*MAP)
            self._draw(page, entities, look)
            return Picture(key, *MAP, svg_of(page.figure, key))

    def _draw(self, page: Page, entities: Sequence[MapEntity], look: Look) -> None:
        axes = page.panel(LATITUDES, 6.0, MAP[0] - LATITUDES - 6.0, MAP[1] - LONGITUDES - 6.0)
        draw_map(
            entities,
            axes,
            highlight=look.glowing,
            marked=look.marked,
            colours=look.palette.kinds,
            channel_colours=look.palette.channels,
            within=self.within,
        )


def logical_page(bigraph: Bigraph, look: Look) -> Page:
    """Return the picture of a bigraph of L on a page of its own."""
    plan = logical_layout(bigraph, look)
    width = (plan.width + 2 * BIGRAPH_MARGIN) * MAGNIFIED
    height = (plan.height + 2 * BIGRAPH_MARGIN) * MAGNIFIED
    page = Page(width, height)
    draw_logical(page.panel(0.0, 0.0, width, height), plan, MAGNIFIED, look)
    return page


def logical_svg(bigraph: Bigraph, look: Look, title: str) -> str:
    """Return the picture of a bigraph of L as the text of an SVG file."""
    with plain_style():
        return svg_file(logical_page(bigraph, look).figure, title)


def _places(entity: MapEntity) -> Iterator[Geometry]:
    if entity.geometry is not None and entity.carried_by is None:
        yield entity.geometry
    if entity.destination is not None:
        yield entity.destination
