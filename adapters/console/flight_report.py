"""The report of a flight as a page: its mission, its verdict, its vehicles, its findings, and who did what."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from datetime import UTC, datetime
from html import escape
from typing import Final

from adapters.console.console_view import Json
from adapters.console.facts import Facts
from physical.frame import E7, geod
from physical.geojson_tracks import Track
from physical.untrusted_text import legible
from physical.written_times import LATEST
from semantics.behaviours.durations import duration_text

STYLE: Final = """
:root { color-scheme: light dark; }
body { font: 14px/1.45 system-ui, "Segoe UI", Roboto, sans-serif; max-width: 72em; margin: 2em auto; padding: 0 1em; }
h1 { font-size: 22px; } h2 { font-size: 16px; margin-top: 1.6em; }
table { border-collapse: collapse; width: 100%; }
th, td { text-align: left; vertical-align: top; padding: 3px 10px 3px 0;
  border-bottom: 1px solid #8886; overflow-wrap: anywhere; }
td:first-child, th { white-space: nowrap; } .scroll { overflow-x: auto; }
"""


def flight_report(facts: Facts, tracks: Sequence[Track] = ()) -> str:
    """Return the report of a run as an HTML page that needs nothing else; `tracks` give the ways that were flown."""
    assert facts.run is not None
    mission = facts.run.mission
    title = f"Flight of {mission['name']}"
    parts = [
        f"<h1>{_text(title)}</h1>",
        _table((), _summary(facts)),
        _section("Verdict", ("property", "verdict", "rests on"), map(_verdict, mission["verdicts"])),
        _section(
            "Vehicles",
            ("vehicle", "kind", "first heard", "last heard", "flown", "highest"),
            _flown(facts, tracks),
        ),
        _section(
            "Findings",
            ("time", "finding", "about", "message", "acknowledged"),
            map(_finding, facts.alerts.values()),
        ),
        _section(
            "Who did what", ("time", "who", "what", "about", "result"), map(_action, facts.actions.values())
        ),
    ]
    if facts.invariants:
        parts.append(_section("Invariants about ways", ("invariant", "holds", "figure"), _invariants(facts)))
    head = f'<meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>{_text(title)}</title>'
    head += f"<style>{STYLE}</style>"
    return (
        f'<!doctype html>\n<html lang="en"><head>{head}</head><body>\n'
        + "\n".join(parts)
        + "\n</body></html>\n"
    )


def _summary(facts: Facts) -> Iterable[Sequence[str]]:
    assert facts.run is not None
    mission, begin = facts.run.mission, facts.time if facts.begin is None else facts.begin
    yield "mission", f"{mission['name']}, {mission['digest']}"
    yield "verified", "yes" if mission["verified"] else "no: nothing was verified of this run"
    rehearsed = sorted(name for name, plugin in facts.run.vehicles.items() if "simulated:" in plugin)
    if rehearsed or facts.run.rate != 1.0:
        yield "simulated", ", ".join(rehearsed) or "its time"
    if mission["scheduler"]:
        yield "scheduler", mission["scheduler"]
    if facts.run.station:
        yield "station", facts.run.station
    yield (
        "from",
        f"{_time(begin, day=True)} to {_time(facts.time, day=True)}, {duration_text(round(facts.time - begin))}",
    )
    yield "end", facts.ended or "the run goes on"
    yield "steps", f"{facts.step:,}"
    shown = len(facts.actions), len(facts.alerts)
    for what, count, all_ in (("actions", shown[0], facts.acted), ("findings", shown[1], facts.found)):
        if count < all_:
            yield what, f"the last {count:,} of {all_:,} are listed"


def _verdict(each: Mapping[str, Json]) -> Sequence[str]:
    return each["property"], each["verdict"], "; ".join(each["rests_on"]) or "nothing assumed"


def _flown(facts: Facts, tracks: Sequence[Track]) -> Iterable[Sequence[str]]:
    assert facts.run is not None
    known = {track.name: track for track in tracks}
    for name in sorted(facts.run.vehicles):
        if (track := known.get(name)) is None:
            yield name, "", "never", "never", "", ""
            continue
        times = [fix.time for fix in track.fixes if fix.time is not None]
        surface = facts.status.get(name, {}).get("surface", False)
        heights = [fix.height for fix in track.fixes if fix.height is not None and not surface]
        highest = f"{max(heights):.0f} m above the sea" if heights else ""
        heard = (_time(min(times)), _time(max(times))) if times else ("", "")
        yield name, track.kind, *heard, f"{_length(track) / 1000:.2f} km", highest


def _length(track: Track) -> float:
    at = [fix.position for fix in track.fixes]
    longitudes, latitudes = [each[1] / E7 for each in at], [each[0] / E7 for each in at]
    return float(geod().line_length(longitudes, latitudes))


def _finding(each: Mapping[str, Json]) -> Sequence[str]:
    seen = each["acknowledged"]
    by = "" if seen is None else f"by {seen['by'] or 'someone'} at {_time(seen['time'])}"
    then = f"{each['message']}; then: {each['fallback']}" if each["fallback"] else each["message"]
    return (
        _time(each["time"]),
        each["kind"],
        each["about"],
        then,
        by or ("not acknowledged" if each["wrong"] else ""),
    )


def _action(each: Mapping[str, Json]) -> Sequence[str]:
    fates = [
        f"{name}: {fate['state']}" for name, fate in sorted(each["fates"].items()) if len(each["fates"]) > 1
    ]
    left_out = [f"not {name}: {why}" for name, why in each["left_out"].items()]
    result = "; ".join(
        filter(None, [each["state"], each["why"], *fates, *left_out, *each["notes"], each["vain"]])
    )
    return _time(each["time"]), each["by"] or "someone", each["what"], each["about"], result


def _invariants(facts: Facts) -> Iterable[Sequence[str]]:
    return (
        (name, "yes" if each["holds"] else "no", each["figure"]) for name, each in facts.invariants.items()
    )


# --- markup -------------------------------------------------------------------------------------------


def _section(title: str, heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    rows = list(rows)
    return f"<h2>{title}</h2>\n" + (_table(heads, rows) if rows else "<p>None.</p>")


def _table(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    head = (
        f"<thead><tr>{''.join(f'<th scope=col>{each}</th>' for each in heads)}</tr></thead>" if heads else ""
    )
    body = "\n".join(f"<tr>{''.join(f'<td>{_text(each)}</td>' for each in row)}</tr>" for row in rows)
    return f'<div class="scroll"><table>{head}<tbody>\n{body}\n</tbody></table></div>'


def _text(words: str) -> str:
    return escape(legible(str(words)))


def _time(time: float, *, day: bool = False) -> str:
    """Return a time in UTC."""
    return datetime.fromtimestamp(min(max(time, 0.0), LATEST), UTC).strftime(
        "%Y-%m-%d %H:%M:%S UTC" if day else "%H:%M:%S"
    )
