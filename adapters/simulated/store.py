"""The vehicle's side of mission upload and download, as in ArduPilot, with PX4's differences.

ArduPilot requests item after item, repeats a request after a second, and gives up after eight. It answers an
unrequested item with INVALID_SEQUENCE, and overwrites item 0 by home. It serves one ground station at a time: other
uploads meanwhile, and all downloads, get DENIED. A mission is overwritten item by item on arrival, a fence at the end.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Final

from adapters.mavlink.constants import Cmd, MavFrame, MissionResult, MissionType
from adapters.mavlink.item_polling import ALL_KINDS
from adapters.mavlink.items import Items, OnboardItem, item_message, item_of
from adapters.mavlink.message import MavlinkMessage, say

MAX_ITEMS: Final = 700
FENCE_ITEMS: Final = 84
"""The capacity of ArduPilot's storage, in items of a fence."""

VERTICES: Final = 255
"""The most corners of one polygon."""

POLYGONS: Final = (Cmd.FENCE_VERTEX_INCLUSION, Cmd.FENCE_VERTEX_EXCLUSION)

WARNING: Final = 4
HIGHEST: Final = 1e5


@dataclass(frozen=True, slots=True)
class Manner:
    """The differences between makes of autopilot in an upload.

    Attributes:
        ask_again: Seconds before it requests an item again.
        give_up: Seconds of silence after which it cancels.
        busy: Its answer to other uploads meanwhile.
        out_of_turn: Its answer to an unrequested item, None if it ignores it.
        home_is_item: Whether it overwrites item 0 of a mission by home.
        in_place: Whether the items of a mission are overwritten on arrival.
    """

    ask_again: float
    give_up: float
    busy: MissionResult
    out_of_turn: MissionResult | None
    home_is_item: bool
    in_place: bool


ARDUPILOT_MANNER: Final = Manner(
    1.0, 8.0, MissionResult.DENIED, MissionResult.INVALID_SEQUENCE, home_is_item=True, in_place=True
)
PX4_MANNER: Final = Manner(0.25, 5.0, MissionResult.ERROR, None, home_is_item=False, in_place=False)
"""After mavlink/mavlink_mission.cpp and mavlink_mission.h."""


@dataclass(frozen=True, slots=True)
class Receiving:
    """An upload in progress: its sender, its kind, its items so far."""

    station: int
    component: int
    kind: MissionType
    count: int
    items: Items = ()
    asked: float = 0.0
    heard: float = 0.0


@dataclass(slots=True)
class Store:
    """The items on board, by kind, and the upload in progress.

    Attributes:
        manner: The differences of its make of autopilot.
        request: The name of its request for an item: planes use MISSION_REQUEST.
        home: Its home in 1e-7 degrees and metres above sea level.
        items: The items on board, of the last complete upload of each kind.
        torn: The mixed mission after an upload that was given up.
        receiving: The upload in progress.
        most: The most items of each kind.
        refuses: A result with which it refuses complete uploads, for tests.
        flown: Whether its mission is being flown, so that it can't be cleared.
    """

    manner: Manner = ARDUPILOT_MANNER
    request: str = "MISSION_REQUEST"
    home: tuple[int, int, float] = (0, 0, 0.0)
    items: dict[MissionType, Items] = field(default_factory=dict)
    receiving: Receiving | None = None
    torn: Items | None = None
    most: dict[MissionType, int] = field(
        default_factory=lambda: {
            MissionType.MISSION: MAX_ITEMS,
            MissionType.FENCE: FENCE_ITEMS,
            MissionType.RALLY: 50,
        }
    )
    refuses: dict[MissionType, MissionResult] = field(default_factory=dict)
    flown: bool = False

    def hear(self, message: MavlinkMessage, *, ready: bool, now: float) -> list[MavlinkMessage]:
        """Answer a message of the mission protocol."""
        kind = _kind(message)
        match message.name:
            case "MISSION_COUNT" if kind is not None:
                return self._count(message, kind, ready=ready, now=now)
            case "MISSION_CLEAR_ALL":
                return self._clear(message)
            case "MISSION_REQUEST_LIST" | "MISSION_REQUEST_INT" if self._receives(kind):
                return [_answer(message, kind, self.manner.busy)]
            case "MISSION_ITEM_INT" if self.receiving is not None and kind is self.receiving.kind:
                return self._item(self.receiving, message, now)
            case "MISSION_REQUEST_LIST" if kind is not None:
                count = {"count": len(self._all(kind)), "mission_type": int(kind)}
                return [say("MISSION_COUNT", **_back(message), **count)]
            case "MISSION_REQUEST_INT" if kind is not None:
                return self._asked(message, kind)
        return []

    def _receives(self, kind: MissionType | None) -> bool:
        return self.receiving is not None and self.receiving.kind is kind

    def tick(self, now: float) -> list[MavlinkMessage]:
        """Ask again for an item that does not come, or give up."""
        going = self.receiving
        if going is None:
            return []
        if now - going.heard >= self.manner.give_up:
            self.abandon()
            return [_ack(going, MissionResult.CANCELLED)]
        return self._ask(going, now) if now - going.asked >= self.manner.ask_again else []

    def _count(
        self, message: MavlinkMessage, kind: MissionType, *, ready: bool, now: float
    ) -> list[MavlinkMessage]:
        going = Receiving(message.system, message.component, kind, message["count"], heard=now)
        busy = self.receiving is not None and self.receiving.station != message.system
        if busy:
            return [_ack(going, self.manner.busy)]
        most = self.most[kind] if ready else 0
        if not ready or going.count > most:
            return [_ack(going, MissionResult.NO_SPACE), _said(f"Only {most} items are supported")]
        return self._ask(going, now) if going.count else self._complete(going)

    @property
    def mission(self) -> Items:
        """The present mission; in ArduPilot the received items of the next mission have overwritten its beginning."""
        going, whole = self.receiving, self.items.get(MissionType.MISSION, ())
        items = whole if self.torn is None else self.torn
        if going is None or going.kind is not MissionType.MISSION or not self.manner.in_place:
            return items
        return (*going.items, *items[len(going.items) : going.count])

    def abandon(self) -> None:
        """Give up an upload; overwritten items stay overwritten."""
        if self.receiving is not None and self.receiving.kind is MissionType.MISSION and self.manner.in_place:
            self.torn = self.mission
        self.receiving = None

    def _clear(self, message: MavlinkMessage) -> list[MavlinkMessage]:
        every = message.fields.get("mission_type") == ALL_KINDS
        kinds = [*MissionType] if every else [kind for kind in [_kind(message)] if kind is not None]
        busy = self.receiving is not None and self.receiving.station != message.system
        held = self.flown and self.manner.in_place and MissionType.MISSION in kinds
        result = MissionResult.ERROR if held else self.manner.busy if busy else MissionResult.ACCEPTED
        if result is MissionResult.ACCEPTED:
            self.receiving = None
            self.items |= dict.fromkeys(kinds, ())
            self.torn = None if MissionType.MISSION in kinds else self.torn
        return [_answer(message, kinds[0] if kinds else None, result)]

    def _item(self, going: Receiving, message: MavlinkMessage, now: float) -> list[MavlinkMessage]:
        if message["seq"] != len(going.items):
            wrong = self.manner.out_of_turn
            return [] if wrong is None else [_answer(message, going.kind, wrong)]
        if (message.system, message.component) != (going.station, going.component):
            return [_answer(message, going.kind, MissionResult.DENIED)]
        item = item_of(message.fields)
        wrong = _wrong(item, going.kind)
        if wrong is not None:
            self.abandon()
            return [_ack(going, wrong)]
        going = replace(going, items=(*going.items, item), heard=now)
        return self._complete(going) if len(going.items) == going.count else self._ask(going, now)

    def _ask(self, going: Receiving, now: float) -> list[MavlinkMessage]:
        self.receiving = replace(going, asked=now)
        seq = {"seq": len(going.items), "mission_type": int(going.kind)}
        return [say(self.request, target_system=going.station, target_component=going.component, **seq)]

    def _complete(self, going: Receiving) -> list[MavlinkMessage]:
        self.receiving = None
        if going.kind in self.refuses:
            return [_ack(going, self.refuses[going.kind])]
        self.items[going.kind] = going.items
        self.torn = None if going.kind is MissionType.MISSION else self.torn
        return [_ack(going, MissionResult.ACCEPTED)]

    def _all(self, kind: MissionType) -> Items:
        items = self.mission if kind is MissionType.MISSION else self.items.get(kind, ())
        if kind is not MissionType.MISSION or not items or not self.manner.home_is_item:
            return items
        x, y, z = self.home
        return (OnboardItem(Cmd.WAYPOINT, x, y, z, MavFrame.SEA_LEVEL), *items[1:])

    def _asked(self, message: MavlinkMessage, kind: MissionType) -> list[MavlinkMessage]:
        items, index = self._all(kind), message["seq"]
        if not 0 <= index < len(items):
            return []
        return [item_message(items[index], index, kind, message.system, message.component)]


def _wrong(item: OnboardItem, kind: MissionType) -> MissionResult | None:
    """Return the result that rejects an item, or None."""
    if kind is MissionType.FENCE and item.command in POLYGONS and item.parameters[0] > VERTICES:
        return MissionResult.INVALID_PARAM1
    return None if _sound(item) else MissionResult.INVALID


def _sound(item: OnboardItem) -> bool:
    """Return whether an item is on the earth, and its numbers are numbers."""
    on_earth = abs(item.x) <= 90 * 10**7 and abs(item.y) <= 180 * 10**7
    return on_earth and abs(item.z) <= HIGHEST and all(abs(value) <= HIGHEST for value in item.parameters)


def _said(text: str) -> MavlinkMessage:
    return say("STATUSTEXT", severity=WARNING, text=text.encode())


def _kind(message: MavlinkMessage) -> MissionType | None:
    try:
        return MissionType(message.fields.get("mission_type", 0))
    except ValueError:
        return None


def _back(message: MavlinkMessage) -> dict[str, int]:
    return {"target_system": message.system, "target_component": message.component}


def _answer(message: MavlinkMessage, kind: MissionType | None, result: MissionResult) -> MavlinkMessage:
    return say("MISSION_ACK", type=int(result), mission_type=int(kind or 0), **_back(message))


def _ack(going: Receiving, result: MissionResult) -> MavlinkMessage:
    whom = {"target_system": going.station, "target_component": going.component}
    return say("MISSION_ACK", type=int(result), mission_type=int(going.kind), **whom)
