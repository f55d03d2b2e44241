"""`bigactors big`: systems of bigraphs, without missions."""

from argparse import Namespace
from typing import Final

from bigactors.arguments.options import CHECKPOINTS, MEMORY, SPILL
from bigactors.exits import Exit

DESCRIPTION: Final = """\
Explore, simulate, check and draw bigraphical reactive systems, without missions, and write Markov models for PRISM and
Storm. A search that a limit stops is incomplete: exit code 3."""

EXAMPLES: Final = (
    "bigactors big full sensor_network --html network.html",
    "bigactors big full --storm network --max-states 100000 network.big",
    "bigactors big sim --runs 10000 --plot network.svg network.big",
    "bigactors big check --ltl 'request leads to answer' --ctl 'AG EF idle' network.big",
    "bigactors big check --storm 'Pmax=? [F delivered]' network.big",
)

SYSTEM: Final = """\
  file FILE  a system of bigraphs: .big (BigraphER's language), .bgm (BigMC's), or the name of a system that ships, such
      as mobile_ambients
  --const NAME=VALUE  give a constant of the file another value; may be repeated"""

LIMITS: Final = f"""\
  --max-states N = 1,000,000  visit at most N states
  --max-time SECONDS  explore for at most SECONDS (default: no limit)
  --threads N  let at most N processes share the search after half a second; the results are the same for every N
      (default: one a core)
{MEMORY}

long runs
{CHECKPOINTS}
{SPILL.format("states")}"""

ARGUMENTS: Final = {
    "full": (
        "explore every reachable state, and write the state space for people and other programs",
        f"""\
{SYSTEM}
{LIMITS}

files
  --html FILE  write the state space as a page; a click on a state shows its bigraph
  --svg FILE  write the state space as a picture
  --dot FILE  write the state space for Graphviz
  --json FILE  write states and transitions as JSON; - for standard output, alone
  --prism PREFIX  write PREFIX.tra, .lab, .csl, .srew and .trew for PRISM
  --storm PREFIX  write PREFIX.tra, .lab, .srew and .trew for Storm""",
    ),
    "sim": (
        "simulate one run, or many with statistics",
        f"""\
{SYSTEM}
  --seed N as at_least_zero = 0  the number that chooses the run; the same seed gives the same run
  --runs N  simulate runs 0 to N-1 of the seed, and print in how many each predicate was true, and when first
  --run N as at_least_zero  print run N of those of --runs, step by step
  --plot FILE  with --runs: draw the share of runs in which each predicate has been true, over time (.svg or .png)
  --steps N as at_least_zero = 100  take at most N steps
  --until TIME as seconds  in an sbrs, simulate up to TIME, in its own unit (default: no limit)
  --json FILE  write the run or the statistics as JSON; - for standard output, alone""",
    ),
    "check": (
        "decide predicates, and formulas of LTL and CTL, each with a run as evidence",
        f"""\
{SYSTEM}
{LIMITS}

claims (default: the properties in the file)
  --always PREDICATE  the predicate holds in every state; may be repeated
  --never PREDICATE  the predicate holds in no state; may be repeated
  --reachable PREDICATE  the predicate holds in some state; may be repeated
  --ltl FORMULA  a formula of predicates that holds on every run, such as 'p leads to q'; may be repeated
  --ctl FORMULA  a formula of predicates that holds on the tree of runs, such as 'AG EF p'; may be repeated
  --storm FORMULA  a probability, reward or time for Storm to compute, such as 'Pmax=? [F goal]', with the likeliest
      run; or a bound on one, such as 'P>=0.9 [F goal]'; needs the extra [storm]; may be repeated
  --no-deadlock  every state has a next state

  --json FILE  write the verdicts as JSON; - for standard output, alone""",
    ),
    "validate": (
        "read the file, and print its contents",
        SYSTEM,
    ),
    "show": (
        "print a state, and draw it",
        f"""\
{SYSTEM}
  --state N as at_least_zero = 0  the number of the state, as the task full counts
  --output FILE  draw the state (.svg or .png)""",
    ),
    "convert": (
        "write the model in BigraphER's language",
        f"""\
{SYSTEM}
  output OUT as named  the .big file that is written; - for standard output
  --from {{big,bgm}} in source  the language of FILE, BigraphER's or BigMC's (default: by its suffix)""",
    ),
}
"""For each task its purpose, and its arguments."""


def run(options: Namespace) -> Exit:
    """Run one of the tasks."""
    from bigactors.commands.big.tasks import run_task

    return run_task(options)
