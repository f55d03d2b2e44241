"""The live loop: one configuration, moved by the checked rules as telemetry and feeds allow.

`advance` is the pure core: from a state, the input and a time it computes the next state, the steps, and the commands
to vehicles. `LiveRun` is the loop around it. Neither knows MAVLink, AIS or a file format.
"""

from adapters.live.batch import Batch, Heard, Saying
from adapters.live.core import advance, is_over, resumed, started, watch
from adapters.live.live_state import LiveState
from adapters.live.loop import Ending, LiveRun, NotAsAssumed, NotHeard, PluginFailed, settle
from adapters.live.operator_findings import Finding
from adapters.live.operator_socket import NobodyListens, listening, say
from adapters.live.plan import Plan
from adapters.live.turn_result import LiveStep, Turn

__all__ = [
    "Batch",
    "Ending",
    "Finding",
    "Heard",
    "LiveRun",
    "LiveState",
    "LiveStep",
    "NobodyListens",
    "NotAsAssumed",
    "NotHeard",
    "Plan",
    "PluginFailed",
    "Saying",
    "Turn",
    "Watcher",
    "advance",
    "is_over",
    "listening",
    "resumed",
    "say",
    "settle",
    "started",
    "watch",
]
