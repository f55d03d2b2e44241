"""Draw a configuration ⟨α | S | η⟩: L as a bigraph beside P as a map, above the agents and their requests.

For a page that steps through a run, the two models are separate pictures.
"""

import re
from collections.abc import Hashable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Final

from bigactors.pictures.page import Page
from bigactors.pictures.region_marks import RegionMarks
from bigactors.pictures.scene import (
    Palette,
    changed_names,
    channels_of,
    differing,
    is_place,
    map_entities,
    palette_of,
    shown_names,
)
from bigraphs.bigraph import Bigraph
from bigraphs.drawing import draw_layout
from bigraphs.layout import layout
from physical.drawing import MapEntity, draw_map
from physical.map_marks import draw_halo, draw_icon, draw_mark
from physical.map_regions import NO_WAYS, MapWays
from physical.map_style import BROKEN, INK, QUIET, SQUARE, kind_shapes
from physical.shape import Geometry
from physical.svg import Canvas, Paint, Picture, shortened, text_width
from semantics.state.configuration import Configuration
from semantics.state.printing import print_agent
from semantics.state.signature import Name

WIDTH: Final = 960.0
MARGIN: Final = 26.0
GUTTER: Final = 22.0
PANEL: Final = (WIDTH - 2 * MARGIN - GUTTER) / 2
"""The width of the bigraph, and of the map with its latitudes."""

PANEL_HEIGHT: Final = 372.0
LARGEST: Final = 1.2
"""The largest magnification of a small bigraph."""

ROW: Final = 15.0
MOST_ROWS: Final = 12
LEGEND_ROW: Final = 17.0
LEGEND_WIDTH: Final = 280.0
"""The width of a legend alone."""

WAYS: Final = {
    "region": Paint("#dfe3e7", QUIET, 0.9),
    "breach": Paint("#ecbab6", BROKEN, 1.1),
    "limit": Paint("#fff", INK, 0.9, dash=(2, 2)),
}
"""The looks of regions in the legend."""


@dataclass(frozen=True, slots=True)
class LegendEntry:
    """One entry of the legend: its look, and the name for it."""

    look: str
    name: str
    colour: str = INK


@dataclass(frozen=True, slots=True)
class Look:
    """The look of a configuration: its colours and marks.

    Attributes:
        palette: The colours of kinds and of channels.
        glowing: The names that changed.
        marked: The names on which L and P differ.
        ways: The regions that a property is about.
    """

    palette: Palette
    glowing: frozenset[Name]
    marked: frozenset[Name]
    ways: MapWays = NO_WAYS


def look_of(c: Configuration, before: Configuration | None, marks: RegionMarks | None = None) -> Look:
    """Return the look of a configuration after another, with the marks of regions."""
    glowing = frozenset() if before is None else changed_names(before, c)
    return Look(palette_of(c), glowing, differing(c), NO_WAYS if marks is None else marks.ways(c))


def draw_configuration(
    configuration: Configuration,
    *,
    title: str | None = None,
    changed: Configuration | None = None,
    marks: RegionMarks | None = None,
) -> Picture:
    """Return the picture of a configuration.

    Entities on which L and A(P) differ have a dashed outline in both. With `changed`, the configuration before, the
    changes since then glow. With `marks`, the map shows where entities may be.
    """
    c, look = configuration, look_of(configuration, changed, marks)
    legend = _legend_rows(_entries(c, look))
    rows = max(1, _shown(len(c.alpha.names())), _shown(len(c.eta.all())))
    top = MARGIN + (26.0 if title else 0.0)
    strip = top + 18.0 + PANEL_HEIGHT + 30.0
    foot = strip + 16.0 + rows * ROW + 12.0
    page = Page(WIDTH, foot + len(legend) * LEGEND_ROW + 18.0)
    if title:
        page.write(MARGIN, MARGIN + 10, title, 14.0, bold=True, width=WIDTH - 2 * MARGIN)
    _draw_logical(page, c, top, look)
    _draw_physical(page, c, top, look)
    page.rule(MARGIN, WIDTH - MARGIN, strip - 16.0)
    _write_list(page, MARGIN, strip, ("α", "agents"), [print_agent(c, a) for a in c.alpha.names()])
    requests = [str(each.request) for each in c.eta.all()]
    _write_list(page, MARGIN + PANEL + GUTTER, strip, ("η", "pending requests"), requests or ["∅"])
    page.rule(MARGIN, WIDTH - MARGIN, foot)
    for rank, row in enumerate(legend):
        _draw_legend_row(page, c, row, foot + 16.0 + rank * LEGEND_ROW)
    return page.picture(title or "configuration")


def _shown(count: int) -> int:
    return min(count, MOST_ROWS)


def _write_list(page: Page, x: float, y: float, heading: tuple[str, str], lines: list[str]) -> None:
    page.heading(x, y, *heading)
    shown = (
        lines
        if len(lines) <= MOST_ROWS
        else [*lines[: MOST_ROWS - 1], f"and {len(lines) - MOST_ROWS + 1} more"]
    )
    for rank, line in enumerate(shown):
        _write_line(page, x, y + 16.0 + rank * ROW, line)


def _write_line(page: Page, x: float, y: float, line: str) -> None:
    """Write an agent or a request with its first word in bold."""
    word = re.match(r"[^ (]*", line)
    head = shortened(word[0] if word else "", PANEL, 8.0, bold=True)
    wide = text_width(head, 8.0, bold=True)
    page.write(x, y, head, 8.0, bold=True)
    rest = line[len(head) :]
    gap = 3.0 if rest.startswith(" ") else 0.5
    page.write(x + wide + gap, y, rest.lstrip(), 8.0, width=max(PANEL - wide - gap, 0.0))


# --- the two models -------------------------------------------------------------------------------


def _draw_logical(page: Page, c: Configuration, top: float, look: Look) -> None:
    page.heading(MARGIN, top + 8, "L", "the logical model: beliefs")
    canvas = draw_logical(c.structure.logical.bigraph(), look)
    scale = min(PANEL / canvas.width, PANEL_HEIGHT / canvas.height, LARGEST)
    left = MARGIN + (PANEL - canvas.width * scale) / 2
    page.put(canvas, (left, top + 18.0 + (PANEL_HEIGHT - canvas.height * scale) / 2), scale)


def draw_logical(bigraph: Bigraph, look: Look) -> Canvas:
    """Draw L; every glowing node has its own box."""
    plan = layout(bigraph, look.glowing, look.marked)
    return draw_layout(plan, highlight=look.glowing, marked=look.marked)


def _draw_physical(page: Page, c: Configuration, top: float, look: Look) -> None:
    left = MARGIN + PANEL + GUTTER
    page.heading(left, top + 8, "P", "the physical model: reality")
    canvas = draw_map(
        map_entities(c),
        (PANEL, PANEL_HEIGHT),
        highlight=look.glowing,
        marked=look.marked,
        colours=look.palette.kinds,
        channel_colours=look.palette.channels,
        ways=look.ways,
    )
    page.put(canvas, (left, top + 18.0))


# --- the legend -----------------------------------------------------------------------------------


def _entries(c: Configuration, look: Look) -> list[LegendEntry]:
    kinds = sorted({c.setting.kind(name) for name in shown_names(c)})
    entries = [LegendEntry("kind", kind, look.palette.kinds[kind]) for kind in kinds]
    down = c.structure.physical.is_down
    entries += [
        LegendEntry(
            "channel", f"{channel} (down)" if down(channel) else channel, look.palette.channels[channel]
        )
        for channel in channels_of(c)
    ]
    entries += [LegendEntry("changed", "changed in this step")] if look.glowing else []
    entries += [LegendEntry("marked", "L and P differ")] if look.marked else []
    return entries + [LegendEntry(name, words) for name, words in way_entries(look.ways)]


def way_entries(ways: MapWays) -> list[tuple[str, str]]:
    """Return the entries of a legend for regions: each look with its words."""
    return [
        *([("region", "where it may be")] if ways.regions else []),
        *([("breach", "where it breaks the property")] if ways.breaches else []),
        *([("limit", "the range")] if ways.limits else []),
    ]


def legend_picture(c: Configuration, before: Configuration | None, marks: RegionMarks | None = None) -> str:
    """Return the legend of a configuration alone, as an SVG."""
    look = look_of(c, before, marks)
    rows = _legend_rows(_entries(c, look), LEGEND_WIDTH)
    page = Page(LEGEND_WIDTH, len(rows) * LEGEND_ROW + 8.0)
    for rank, row in enumerate(rows):
        _draw_legend_row(page, c, row, 16.0 + rank * LEGEND_ROW)
    return page.picture("legend").svg


def _legend_rows(entries: list[LegendEntry], wide: float = WIDTH) -> list[list[tuple[float, LegendEntry]]]:
    """Return the entries in rows, each with its left edge."""
    rows: list[list[tuple[float, LegendEntry]]] = [[]]
    x = MARGIN
    for entry in entries:
        width = 20.0 + text_width(entry.name, 8.0)
        if rows[-1] and x + width > wide - MARGIN:
            rows.append([])
            x = MARGIN
        rows[-1].append((x, entry))
        x += width + 18.0
    return rows


def _draw_legend_row(page: Page, c: Configuration, row: list[tuple[float, LegendEntry]], y: float) -> None:
    places = {c.setting.kind(name) for name in shown_names(c) if is_place(c, name)}
    shapes = kind_shapes(c.setting.kind(name) for name in shown_names(c))
    for x, entry in row:
        at = (x + 7.0, y - 3.0)
        if entry.look == "kind":
            shape = SQUARE if entry.name in places else tuple((a, -b) for a, b in shapes[entry.name])
            draw_icon(page, at, shape, entry.colour, radius=4.6)
        elif entry.look == "channel":
            page.line([(x, at[1]), (x + 14, at[1])], Paint(stroke=entry.colour, width=1.6))
        elif entry.look == "changed":
            draw_halo(page, at, 6.0)
        elif entry.look in WAYS:
            page.rectangle((x, y - 7.5), (14.0, 9.0), WAYS[entry.look], radius=2.5)
        else:
            draw_mark(page, at, 5.5)
        page.write(x + 19.0, y, entry.name, 8.0, ink=QUIET)


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
