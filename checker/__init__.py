"""The model checker: explores every interleaving of a mission and decides its properties, with shortest traces.

It knows the calculus by `semantics.successors` alone: nothing of files, vehicles or the mission language.
"""

from checker.check import Checkable, check
from checker.engines.choose import explore
from checker.engines.cluster.crew import ClusterError
from checker.engines.contract import (
    CheckpointError,
    Cluster,
    Engine,
    Exploration,
    Keeping,
    MachineError,
    Progress,
)
from checker.limits import Bound, Interruption, Limits, Stop
from checker.properties.ownership import owned
from checker.reduction import Reduction, RefusedError
from checker.reports.report import report_json, report_text
from checker.traces import ReplayError, Step, Trace, print_loop, print_trace, replay, to_json
from checker.verdicts import Outcome, Report, UnknownPropertyError, Verdict, Verdicts, Violation

__all__ = [
    "Bound",
    "Checkable",
    "CheckpointError",
    "Cluster",
    "ClusterError",
    "Engine",
    "Exploration",
    "Interruption",
    "Keeping",
    "Limits",
    "MachineError",
    "Outcome",
    "Progress",
    "Reduction",
    "RefusedError",
    "ReplayError",
    "Report",
    "Step",
    "Stop",
    "Trace",
    "UnknownPropertyError",
    "Verdict",
    "Verdicts",
    "Violation",
    "check",
    "explore",
    "owned",
    "print_loop",
    "print_trace",
    "replay",
    "report_json",
    "report_text",
    "to_json",
]
