"""`bigactors export`: a mission with times as a timed automaton, for a second opinion."""

from argparse import Namespace

from bigactors.exits import Exit
from bigactors.files import write_text
from bigactors.missions import open_mission, variation_of
from bigactors.mistakes import Mistake, suggestion
from bigactors.terminal import say_text, tell
from checker import Engine, explore
from checker.engines.contract import TickError
from semantics.properties.property import Property, watching
from specs.elaboration import ElaboratedMission


def run(options: Namespace) -> Exit:
    """Explore a mission by zones, and write its automaton."""
    mission = open_mission(options.file, variation_of(options))
    if mission.initial.setting.timing is None:
        raise Mistake(
            f"{options.file} says nothing of times",
            "only missions with a section `timing` have timed automata",
        )
    from checker.engines.timed.zone_answers import ZoneTimes  # noqa: PLC0415 - the same
    from checker.engines.zones.interchange import model_of  # noqa: PLC0415 - numba is slow to load
    from checker.engines.zones.tchecker import tchecker_text  # noqa: PLC0415 - the same
    from checker.engines.zones.uppaal import uppaal_text  # noqa: PLC0415 - the same

    asked = None if options.property is None else _asked(mission, options.property)
    try:
        found = explore(watching(mission.initial, [asked] if asked else []), engine=Engine.FAST)
    except TickError as error:
        raise Mistake(str(error), "give timing a larger tick, or shorter times", options.file) from error
    assert isinstance(found.times, ZoneTimes)
    try:
        model = model_of(found.times, asked, mission.name)
    except ValueError as error:
        raise Mistake(f"{options.property} is not exported", str(error)) from error
    text = uppaal_text(model) if options.format == "uppaal" else tchecker_text(model)
    if options.out == "-":
        say_text(text)
    else:
        write_text(options.out, text)
        tell(f"{options.out} written")
    return Exit.HOLDS if found.complete else Exit.INCOMPLETE


def _asked(mission: ElaboratedMission, name: str) -> Property:
    """Return a property by its name or its kind."""
    for each in mission.properties:
        if name in (each.name, each.kind.value):
            return each
    names = [each.name for each in mission.properties]
    raise Mistake(f"{mission.name} asks for no property '{name}'", suggestion(name, names))
