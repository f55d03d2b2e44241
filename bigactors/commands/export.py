"""`bigactors export`: a mission with times as a timed automaton, for a second opinion."""

from __future__ import annotations

from argparse import Namespace
from typing import TYPE_CHECKING, Final

from bigactors.arguments.options import MISSION, VARIATION
from bigactors.exits import Exit
from bigactors.mistakes import Mistake, near_or_known
from bigactors.terminal import say_text, tell

if TYPE_CHECKING:
    from semantics.properties.property import Property
    from specs.elaboration import ElaboratedMission

DESCRIPTION: Final = """\
Write the reachable part of a mission with times as timed automata, for a second opinion: --format tchecker for
TChecker (github.com/ticktac-project/tchecker), --format uppaal for UPPAAL (uppaal.org), as XML. With --property, a
location `wrong` is reachable exactly if the property is violated. TChecker gets a process for each bigActor, vehicle
with an endurance, clause of the environment and group of shared cells, where `check` explores in local time. So its
algorithm of local time (concur19) needs few zones. UPPAAL gets a single process.

  tck-reach -a concur19 -l wrong patrol.tck     REACHABLE true: it is violated
  verifyta patrol.xml                           Formula is satisfied: it holds"""

EXAMPLES: Final = (
    "bigactors export endurance --format tchecker --out endurance.tck",
    "bigactors export broken_endurance --format uppaal --property endurance --out broken_endurance.xml",
)

ARGUMENTS: Final = f"""\
  file FILE  {MISSION}
  required --format {{tchecker,uppaal}}  the language of the automaton
  --clock {{local,global}} = local  write the processes of local time for TChecker, or a single process
  --property NAME as named  observe this property: the name of a deadline, or `endurance` (default: none)
  --out FILE = -  the file that is written (default: -, standard output)

{VARIATION}"""


def run(options: Namespace) -> Exit:
    """Explore a mission by zones, and write its automaton."""
    from bigactors.files import write_text
    from bigactors.mission_lookup import open_mission, variation_of
    from checker import Engine, ZoneClock, explore
    from checker.engines.contract import TickError
    from semantics.properties.property import watching

    mission = open_mission(options.file, variation_of(options))
    if mission.initial.setting.timing is None:
        raise Mistake(
            f"{options.file} has no times",
            "only missions with a section `timing` have timed automata",
        )
    # numba is slow to load: a mission without times is refused before
    from checker.engines.timed.zone_answers import ZoneTimes
    from checker.engines.zones.automaton_export import model_of
    from checker.engines.zones.explorer import why_global
    from checker.engines.zones.tchecker import tchecker_text
    from checker.engines.zones.uppaal import uppaal_text

    asked = None if options.property is None else _asked(mission, options.property)
    clock = ZoneClock(options.clock)
    try:
        found = explore(watching(mission.initial, [asked] if asked else []), engine=Engine.FAST, clock=clock)
    except TickError as error:
        raise Mistake(str(error), "give timing a larger tick, or shorter times", options.file) from error
    assert isinstance(found.times, ZoneTimes)
    divided = options.format == "tchecker" and clock is ZoneClock.LOCAL
    try:
        model = model_of(found.times, asked, mission.name, divided=divided)
    except ValueError as error:
        raise Mistake(f"{options.property} is not exported", str(error)) from error
    text = uppaal_text(model) if options.format == "uppaal" else tchecker_text(model)
    if options.out == "-":
        say_text(text)
    else:
        write_text(options.out, text)
        tell(f"{options.out} written")
    if divided and len(model.processes) == 1:
        reason = why_global(mission.initial) or "it was not possible to search it in local time"
        tell(f"it has a single process: {reason}")
    return Exit.HOLDS if found.complete else Exit.INCOMPLETE


def _asked(mission: ElaboratedMission, name: str) -> Property:
    """Return a property by its name or its kind."""
    for each in mission.properties:
        if name in (each.name, each.kind.value):
            return each
    names = [each.name for each in mission.properties]
    hint = near_or_known(name, names, "properties")
    raise Mistake(f"{mission.name} asks for no property '{name:.60}'", hint)
