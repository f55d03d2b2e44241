"""The commands: a module for each, or a folder where its work is long.

The module of a command holds its help, its arguments and its work:

- `DESCRIPTION` and `EXAMPLES`, the help;
- `add_arguments(parser)`, its arguments and options;
- `run(options)`, its work, which returns the exit code.

Importing it loads nothing slow, so that help and completion appear at once: the work imports its libraries itself.
"""

from typing import Final

GROUPS: Final = {
    "write and check missions": {
        "new": "write a first mission to begin with",
        "check": "decide the properties of missions",
        "simulate": "run a mission once",
        "show": "print and draw a configuration or a trace",
        "replay": "run a trace again",
        "export": "write a mission with times as a timed automaton",
        "fmt": "lay out mission files in the canonical way",
        "lsp": "serve an editor: mistakes, completion, renaming, verdicts",
        "explain": "explain a diagnostic code, or a word of a report",
    },
    "fly them": {
        "run": "fly a mission that was checked",
        "console": "show a recording, or a run, beside its map in the browser",
        "status": "say how a running mission stands: vehicles, requests, what may be said",
        "say": "say something to a bigActor of a running mission",
        "hold": "order a vehicle of a running mission, or all, to stay where it is",
        "return": "order a vehicle of a running mission, or all, to go home",
        "give-back": "give a vehicle back to a running mission: taken over, or heard elsewhere",
        "plugins": "list the plugins of vehicles and feeds that are installed",
        "keygen": "make a key pair to sign verdicts with",
    },
    "places and bigraphs": {
        "world": "print and draw the bigraph of places and recordings",
        "detect": "find slicks in a camera's frames",
        "big": "explore, run, check and draw systems of bigraphs",
    },
    "begin": {
        "demo": "check two missions that ship, and draw them",
        "completion": "print what completes command lines in bash, zsh or fish",
    },
}
"""The summary of each command, in groups, in the order of the help."""

NAMES: Final = tuple(name for commands in GROUPS.values() for name in commands)
