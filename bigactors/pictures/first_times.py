"""Draw the first times of predicates over many runs: the share of runs in which each was true by then."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from bigactors.pictures.page import Page, plain_style
from physical.map_style import FAINT, PALETTE, QUIET

WIDTH: Final = 640.0
HEIGHT: Final = 360.0
MARGIN: Final = 26.0
NAMES: Final = 150.0
"""Points beside the curves for their names."""


@dataclass(frozen=True, slots=True)
class Curve:
    """The share of runs in which something was true by each of some times, with its interval."""

    name: str
    times: Sequence[float]
    shares: Sequence[float]
    low: Sequence[float]
    high: Sequence[float]


def draw_curves(
    curves: Sequence[Curve], path: str | Path, *, title: str, gloss: str, axis: str, end: float
) -> None:
    """Write one picture of curves, which start at 0 and reach to the end.

    Args:
        curves: The curves; only as many as there are colours are drawn (`physical.map_style.PALETTE`).
        path: The file, `.svg` or `.png`.
        title: The title.
        gloss: The line below the title.
        axis: The label of the time axis.
        end: The time to which runs were followed.

    Raises:
        PictureError: The file has another suffix.
        OSError: The file cannot be written.
    """
    from matplotlib.ticker import MaxNLocator  # noqa: PLC0415 - only drawing needs matplotlib

    with plain_style():
        page = Page(WIDTH, HEIGHT)
        page.write(MARGIN, MARGIN + 9, title, 14.0, bold=True, width=WIDTH - 2 * MARGIN)
        page.write(MARGIN, MARGIN + 26, gloss, 8.0, ink=QUIET, width=WIDTH - 2 * MARGIN)
        axes = page.panel(MARGIN + 34, MARGIN + 44, WIDTH - 2 * MARGIN - 34 - NAMES, HEIGHT - 2 * MARGIN - 80)
        axes.set(xlim=(0, end or 1.0), ylim=(-0.02, 1.02))
        axes.set_yticks([0, 0.25, 0.5, 0.75, 1], ["0", "25 %", "50 %", "75 %", "100 %"])
        axes.xaxis.set_major_locator(MaxNLocator(nbins=8, min_n_ticks=1))
        axes.tick_params(labelsize=8, colors=QUIET, length=3)
        axes.grid(color=FAINT, linewidth=0.7)
        axes.set_xlabel(axis, fontsize=8, color=QUIET)
        axes.set_axisbelow(True)
        for side in ("top", "right"):
            axes.spines[side].set_visible(False)
        for curve, colour in zip(curves, PALETTE, strict=False):
            times = (0.0, *curve.times, end)
            low, high, shares = (
                (first, *each, each[-1] if each else first)
                for first, each in ((0.0, curve.low), (0.0, curve.high), (0.0, curve.shares))
            )
            axes.fill_between(times, low, high, step="post", color=colour, alpha=0.2, linewidth=0)
            axes.step(times, shares, where="post", color=colour, linewidth=1.6, label=curve.name)
        if curves:
            axes.legend(
                loc="upper left", bbox_to_anchor=(1.02, 1.02), fontsize=8, frameon=False, handlelength=1.2
            )
        page.save(Path(path), title)
