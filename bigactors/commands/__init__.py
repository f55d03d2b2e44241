"""The commands: a module for each, or a folder where its work is long.

The module of a command holds its help, its arguments and its work:

- `DESCRIPTION` and `EXAMPLES`, the help;
- `ARGUMENTS`, the sheet of its arguments and options (`bigactors.arguments.sheets`);
- `run(options)`, its work, which returns the exit code.

Importing it loads nothing slow, so that help and completion appear at once: the work imports its libraries itself.
"""

from typing import Final

GROUPS: Final = {
    "write and check missions": {
        "new": "write a small first mission",
        "studio": "write, check and watch a mission in the browser",
        "check": "explore missions, and decide their properties",
        "simulate": "simulate one run of a mission",
        "show": "print and draw a configuration or a trace",
        "replay": "replay a trace or a recording through the rules",
        "export": "write a mission with times as a timed automaton",
        "fmt": "format mission files",
        "lsp": "serve an editor: diagnostics, completion, renaming, verdicts",
        "explain": "explain a diagnostic code or a word of a report",
    },
    "fly them": {
        "run": "fly a verified mission",
        "console": "show a recording or a run in the browser, on a map",
        "status": "print the state of a running mission: vehicles, requests, permitted messages",
        "say": "send a message to a bigActor of a running mission",
        "hold": "order a vehicle of a running mission, or all, to hold its position",
        "return": "order a vehicle of a running mission, or all, to return home",
        "give-back": "give a running mission command of a vehicle again, or its new address",
        "plugins": "list the installed plugins for vehicles, feeds and detectors",
        "keygen": "make a pair of keys that sign and test verdicts",
    },
    "places and bigraphs": {
        "world": "print and draw the bigraph of places and recordings",
        "detect": "find slicks in a camera's frames",
        "big": "explore, simulate, check and draw systems of bigraphs",
    },
    "begin": {
        "demo": "check and draw two missions that ship",
        "warm-up": "compile all loops now, for an image of a container",
        "completion": "print the script that completes command lines in bash, zsh or fish",
    },
}
"""The summary of each command, in groups, in the order of the help."""

NAMES: Final = tuple(name for commands in GROUPS.values() for name in commands)
