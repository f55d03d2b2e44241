"""The calculus: configurations ⟨α | S | η⟩, the seven inference rules, and the bigActor extension.

It knows nothing of search, time, files, devices or the mission language. Generated structures and configurations for
property-based tests are in `semantics.strategies`, which needs the extra `strategies`.
"""

from semantics.configuration import Configuration, Label, Transition
from semantics.control import Obstacle, obstacle
from semantics.environment import Appears, Clause, Drifts, Drops, Leaves, Says, Vanishes
from semantics.expressions import Fault
from semantics.extension import EXTENSION
from semantics.initial import Beliefs, initial
from semantics.monitor import monitored
from semantics.physical_model import Carried, InTransit, Placed
from semantics.program import Behaviour, Program
from semantics.propositions import Property, Proposition, holds
from semantics.queries import Observation, Query, evaluate, overlay
from semantics.reactions import COMMANDS, Match, Pattern, Reaction, matches
from semantics.requests import CTR, FLY, MGR, OBS, READY, SND, Request
from semantics.rules import RULES, TIMED_RULES
from semantics.setting import Control, Scheduler, Setting
from semantics.signature import REGION, Kind, Name, Signature
from semantics.structure import Linked, Parent, Structure
from semantics.successors import Expansion, expand, successors

__all__ = [
    "COMMANDS",
    "CTR",
    "EXTENSION",
    "FLY",
    "MGR",
    "OBS",
    "READY",
    "REGION",
    "RULES",
    "SND",
    "TIMED_RULES",
    "Appears",
    "Behaviour",
    "Beliefs",
    "Carried",
    "Clause",
    "Configuration",
    "Control",
    "Drifts",
    "Drops",
    "Expansion",
    "Fault",
    "InTransit",
    "Kind",
    "Label",
    "Leaves",
    "Linked",
    "Match",
    "Name",
    "Observation",
    "Obstacle",
    "Parent",
    "Pattern",
    "Placed",
    "Program",
    "Property",
    "Proposition",
    "Query",
    "Reaction",
    "Request",
    "Says",
    "Scheduler",
    "Setting",
    "Signature",
    "Structure",
    "Transition",
    "Vanishes",
    "evaluate",
    "expand",
    "holds",
    "initial",
    "matches",
    "monitored",
    "obstacle",
    "overlay",
    "successors",
]
