"""`bigactors check`: the verdicts on missions."""

from argparse import Namespace
from typing import Final

from bigactors.arguments.options import CHECKPOINTS, MEMORY, MISSION, SPILL, VARIATION
from bigactors.arguments.values import FORMATS
from bigactors.exits import Exit

DESCRIPTION: Final = """\
Explore every interleaving of a mission and decide its properties, with a shortest trace for each that fails and a
witness for each that holds. Ctrl-C, SIGTERM and SIGHUP end it within seconds with the results so far; a second one
ends it at once. `bigactors --help` lists the exit codes."""

EXAMPLES: Final = (
    "bigactors check oil_spill.mission",
    "bigactors check --watch oil_spill.mission",
    "bigactors check --no-traces specs/missions/*.mission",
    "bigactors check --json - oil_spill.mission | jq '.properties[] | [.name, .verdict]'",
    "bigactors check --output junit:report.xml --output sarif:report.sarif specs/missions/*.mission",
)

ARGUMENTS: Final = f"""\
  files FILE...  {MISSION}
  --watch  check now, and at every save of a mission or a file of its world; print the changes first; Ctrl-C ends
      it with the exit code of the last check

report
  --json FILE  write the report as JSON (docs/reference/json.md); - for standard output, alone
  --output FORMAT:FILE  write the report for other programs (docs/reference/output.md): {", ".join(FORMATS)};
      - as FILE for standard output, alone; may be repeated
  --trace DIR  write the trace of each violation and witness into DIR: as text, JSON, pictures and a page that steps
      through it
  --verdict FILE  write the verdict that `bigactors run` needs (docs/explanation/live.md); for one mission, with
      --control timed
  --sign KEY  sign the verdict with the private key in KEY, for `bigactors run --trust KEY.pub` (`bigactors keygen
      KEY` makes both)
  --violations N = 5  print at most N different violations of each property, and count the others
  --times  print the earliest and the latest moment at which each flight of a mission with timing begins and ends,
      and each time property is first true
  --ways  print the way of each flight leg by leg: its length, its distance from places that properties name, and the
      least distance of two vehicles under way together
  --no-traces  print a short report, without traces
  --all  print whole traces and all warnings (default: about a screen of each mission)

limits
  --max-configurations N  visit at most N configurations (default: 100,000,000, of about 30 bytes each, for each
      worker of --engine ray; 2,000,000 with --engine reference)
  --max-pending N  go no further from a configuration in which a bigActor has more than N pending requests or
      messages (default: 64)
  --max-time SECONDS  explore and decide for at most SECONDS; the fast engine explores in at most half (default: no
      limit)
{MEMORY}

exploring
  --engine {{reference,fast,ray}}  the engine that explores; all reach the same verdicts (default: reference or fast,
      by the mission's size)
  --threads N  let the fast engine use at most N threads, with the same results for every N (default: one a core;
      with --reduce por one)
  --clock {{local,global}} = local  explore a mission with timing by one clock for each process, where that is sound
      (not under fcfs, with spawn or with --reduce symmetry), or by one clock for all
  --reduce NAMES  visit fewer configurations, where that is sound: por (partial-order reduction), symmetry, or
      por,symmetry (default: none; docs/explanation/reduction.md)

long runs, by --engine fast or ray
{CHECKPOINTS}
{SPILL.format("configurations")}
  --paranoid N  let the interpreter re-check the successors of N configurations, with --reduce also the reduction's
      assumptions, and stop at a difference (not with --engine ray; default: none)

several processes or machines, by --engine ray (docs/how-to/cluster.md)
  --workers N  the number of processes that share the search (default: 2)
  --address ADDRESS  the Ray cluster to join, such as 10.0.0.1:6379, or auto for the one on this machine (default: a
      new one on this machine)

{VARIATION}"""


def run(options: Namespace) -> Exit:
    """Check missions, with `--watch` at each save; print the reports and write the requested files."""
    from bigactors.commands.check.check_report import check_and_report

    return check_and_report(options)
