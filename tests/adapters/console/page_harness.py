"""A server that speaks the console's protocol about a state that a test writes, for tests of the page alone."""

import asyncio
import json
import math
import threading
import time
from pathlib import Path

from aiohttp import WSMsgType, web
from console_clients import OF_SERVER
from threaded import loop_beside

from adapters.console.console_server import HEADERS

PAGE = Path(__file__).parents[3] / "adapters" / "console" / "page"
TOKEN = "a-token"


class Harness:
    """Serves the page, and its state to whoever says hello with the token."""

    def __init__(self, state, *, role="act", mode="live", has_begun=True):
        self.state, self.role, self.mode = with_alarms(state), role, mode
        self.sockets, self.hellos = {}, []
        self.refusal, self.answers = "", {}
        self.token, self.recording = TOKEN, "run.mcap"
        self.is_slow = False  # then what shows another moment is heard, and not done
        self.port = 0
        self.begun = threading.Event()
        if has_begun:
            self.begun.set()
        self._beside = loop_beside()

    def __enter__(self):
        self._call = self._beside.__enter__()
        self._call(self._start())
        return self

    def __exit__(self, *error):
        self._call(self._stop())
        self._beside.__exit__(*error)

    @property
    def link(self):
        return f"http://127.0.0.1:{self.port}/#token={TOKEN}"

    def change(self, **sections):
        """Set values of sections, None to drop a key, in one frame; return its number for the newest page."""
        if "alerts" in sections and "alarms" not in sections:
            alerts = self.state["alerts"] | sections["alerts"]
            sections["alarms"] = dict.fromkeys(self.state["alarms"]) | alarms_of(alerts)
        gone = {}
        for section, values in sections.items():
            known = self.state.setdefault(section, {})
            known.update(values)
            gone[section] = [key for key, value in values.items() if value is None and section in KEYED]
            for key in gone[section]:
                del known[key]
        given = {section: values | {} for section, values in sections.items()}
        for section, keys in gone.items():
            for key in keys:
                del given[section][key]
        frame = {"type": "changes", "set": given, "gone": gone}
        OF_SERVER.validate(frame | {"n": 2})  # no page is tried by what no server says
        self._call(self._send(frame))
        return next(reversed(self.sockets.values()), 0)

    def hang_up(self):
        self._call(self._hang_up())

    def stop_serving(self):
        self._call(self._stop())

    def serve_again(self):
        self._call(self._start())

    # --- in the thread of the loop ------------------------------------------------------------------------------

    async def _start(self):
        application = web.Application()
        application.router.add_get("/", self._index)
        application.router.add_get("/ws", self._socket)
        application.router.add_get("/land", self._land)
        application.router.add_get("/parts/{path:.*}", self._part)
        self._runner = web.AppRunner(application, access_log=None, shutdown_timeout=0.1)
        await self._runner.setup()
        site = web.TCPSite(self._runner, "127.0.0.1", self.port, reuse_address=True)
        await site.start()
        self.port = self._runner.addresses[0][1]

    async def _stop(self):
        for site in list(self._runner.sites):  # first, so that no page comes back meanwhile
            await site.stop()
        await self._hang_up()
        await self._runner.cleanup()

    async def _hang_up(self):
        for socket in list(self.sockets):
            await socket.close(code=1001)

    async def _index(self, _):
        return web.FileResponse(PAGE / "index.html", headers=HEADERS)

    async def _land(self, request):
        assert request.headers["Authorization"] == f"Bearer {TOKEN}"
        return web.json_response({"type": "FeatureCollection", "features": []})

    async def _part(self, request):
        path = PAGE / request.match_info["path"]
        if path.is_file():
            return web.FileResponse(path)
        raise web.HTTPNotFound

    async def _socket(self, request):
        socket = web.WebSocketResponse()
        await socket.prepare(request)
        hello = json.loads((await socket.receive()).data)
        self.hellos.append(hello)
        if hello["token"] != self.token:
            await socket.close(code=4401)
            return socket
        head = {"protocol": "bigactors.console/1", "version": "0", "role": self.role, "mode": self.mode}
        head |= {"tiles": False, "recording": self.recording}
        await socket.send_json({"type": "welcome", **head})
        if not self.begun.is_set():
            await socket.send_json({"type": "waiting", "message": "the run has not begun"})
            await asyncio.to_thread(self.begun.wait, 10)
        self.sockets[socket] = 1
        await socket.send_json({"type": "snapshot", "n": 1, "state": self.state})
        try:
            async for message in socket:
                if message.type == WSMsgType.TEXT:
                    await self._hear(socket, json.loads(message.data), hello["name"])
        finally:
            self.sockets.pop(socket, None)
        return socket

    async def _hear(self, socket, message, by):
        if message["type"] == "act":
            answer = {"refusal": self.refusal, "left_out": {}, "notes": []} | self.answers
            await socket.send_json({"type": "answer", "id": message["id"]} | answer)
            if not self.refusal and (done := recorded(message["action"], by)) is not None:
                number = str(len(self.state["actions"]) + 1)
                self.state["actions"][number] = done
                await self._send({"type": "changes", "set": {"actions": {number: done}}, "gone": {}})
        elif message["type"] in ("seek", "play", "pause", "live"):
            await self._turn(message)

    async def _turn(self, message):
        """Do to the clock what a server does."""
        if self.is_slow:
            return
        clock = dict(self.state["clock"])
        match message["type"]:
            case "seek":
                clock |= {"now": min(message["time"], clock["head"]), "live": False}
            case "play":
                clock |= {"playing": True, "live": False, "speed": message["speed"]}
            case "pause":
                clock |= {"playing": False, "live": False}
            case "live":
                clock |= {"playing": False, "live": True, "now": clock["head"], "speed": 1}
        self.state["clock"] = clock
        await self._send({"type": "changes", "set": {"clock": clock}, "gone": {}})

    async def _send(self, frame):
        for socket in list(self.sockets):
            self.sockets[socket] += 1
            await socket.send_str(json.dumps(frame | {"n": self.sockets[socket]}))


KEYED = ("vehicles", "alerts", "alarms", "actions", "entities", "sayings")
"""The sections in which a key may go."""


def with_alarms(state):
    """Add what is wrong to a state of which only alerts are given."""
    return state if "alarms" in state else state | {"alarms": alarms_of(state.get("alerts", {}))}


def alarms_of(alerts):
    """Return the section `alarms` of a run that has not fallen back."""
    follows = {
        "hold": "all vehicles were commanded to hold",
        "return": "all vehicles were commanded to return home",
    }
    return {
        key: alert | {"consequence": follows.get(alert["fallback"], alert["fallback"])}
        for key, alert in alerts.items()
        if alert and alert["wrong"] and not alert["acknowledged"]
    }


# --- a state to look at ---------------------------------------------------------------------------------------


PICTURE = (
    '<svg xmlns="http://www.w3.org/2000/svg" width="400pt" height="220pt" viewBox="0 0 400 220">'
    '<rect width="400" height="220" fill="#fff"/>'
    '<path d="M 20 20 L 380 20 L 380 200 L 20 200 z" style="fill:none;stroke:#d8dee4;stroke-width:1.6"/>'
    '<text style="font-size:14px;fill:#1f2933" x="30" y="44">searchArea0</text>'
    '<circle cx="120" cy="110" r="34" style="fill:#dceefb;stroke:#1b6ca8;stroke-width:1.6"/>'
    '<text style="font-size:12px;text-anchor:middle;fill:#1f2933" x="120" y="114">uav0</text>'
    '<circle cx="270" cy="110" r="34" style="fill:#fdebd0;stroke:#b9770e;stroke-width:3"/>'
    '<text style="font-size:12px;text-anchor:middle;fill:#1f2933" x="270" y="114">oilSpill0</text></svg>'
)


def card(level=0, **more):
    """Return a vehicle's card that is well, but for what is said."""
    where = {"believed": "searchArea0", "actual": "searchArea0", "differs": False, "going": None}
    motion = {"heading": 92.0, "altitude": None, "height": 118.7, "home": None, "returning": False}
    told = {"link": {"heard": time.time(), "lost": False}, "mode": "GUIDED", "armed": True, "said": None}
    needs = {"level": level, "word": ["well", "watch", "wrong", "lost"][level], "why": ""}
    none = ("request", "flight", "order", "handed", "taken", "ordered", "on_return")
    power = {"battery": {"percent": 78.4, "volts": 22.9}}
    known = {"kind": "UAV", "authority": ["porto"], **dict.fromkeys(none)}
    return known | where | motion | told | needs | power | more


def entity(latitude, longitude, **more):
    motion = {"at": [latitude, longitude], "course": 45.0, "speed": 5.2, "seen": time.time()}
    where = {"believed": "sea", "actual": "sea", "differs": False}
    return motion | where | {"kind": "Ship", "named": True, "vehicle": False, "source": "ais"} | more


def recorded(action, by):
    """Return what a run records of an action that it took, None of what it records elsewhere."""
    match action:
        case {"order": {"order": order, "vehicle": vehicle}}:
            named = vehicle if isinstance(vehicle, list) else [vehicle] if vehicle else []
            fates = {name: {"state": "sent", "why": ""} for name in named or ("uav0", "uav1")}
            return deed(time.time(), by, order, ", ".join(named) or "all", "sent") | {"fates": fates}
        case {"say": {"agent": agent, "message": message}}:
            return deed(time.time(), by, f'say "{message}"', agent)
        case {"note": {"text": text}}:
            return deed(time.time(), by, "note", text)
        case {"give_back": {"vehicle": vehicle}}:
            return deed(time.time(), by, "give back", vehicle)
    return None


def deed(at, by, what, about, state="confirmed", why=""):
    """Return an action as the section has it."""
    answered = None if state == "sent" else at
    done = {"time": at, "by": by, "what": what, "about": about, "state": state, "why": why}
    return done | {"fates": {}, "left_out": {}, "notes": [], "vain": None, "answered": answered}


MOVE = "FLY(pilot0, MOVE_HOST_TO spillArea)"
TICKS = ["world", "control", "world", "say", "world", "action", "finding"]
VERDICT = {"property": "local_consistency", "verdict": "holds", "rests_on": ["a vehicle arrives within 60 s"]}
RING = [[36.9, -8.9], [36.9, -8.5], [37.1, -8.5], [37.1, -8.9]]


def world():
    """Return a state with something of everything."""
    now = time.time()
    begin = now - 600
    handover = {"agent": "tower", "message": "handover", "left": 2, "awaited": True, "vain": None}
    taken = "uav1 is taken over: give it back first"
    place = {"kind": "Location", "ring": RING, "parent": None, "altitude": None, "differs": False}
    return {
        "mission": mission(begin),
        "clock": clock(begin, now),
        "places": {"searchArea0": place},
        "fences": {},
        "entities": {
            "cargo1": entity(36.95, -8.75),
            "uav0": entity(37.0, -8.7, vehicle=True, kind="UAV"),
            "uav1": entity(37.02, -8.65, vehicle=True, kind="UAV"),
            "boat0": entity(36.97, -8.6, vehicle=True, kind="USV"),
        },
        "vehicles": vehicles(now),
        "tracks": {"uav0#0": [[37.0, -8.72], [37.0, -8.7]]},
        "agents": {
            "pilot0": agent("waits for the move to spillArea", host="uav0", request=MOVE),
            "tower": agent("waits for handover", awaits=["handover"], until=now + 90),
            "pilot1": agent("has failed", host="uav1"),
        },
        "steps": {str(n): step(n, begin) for n in range(1, 43)},
        "ticks": {str(n): [begin + 12 * n, TICKS[n % 7]] for n in range(1, 50)},
        "bigraph": {"svg": PICTURE, "text": "searchArea0\n  uav0\n  oilSpill0", "step": 42, "drawn": 42},
        "alerts": alerts(now),
        "sayings": {'tower "handover"': handover},
        "actions": {
            "1": deed(now - 200, "Ana", "hold", "uav0"),
            "2": deed(now - 100, "Rui", "return", "uav1", "refused", taken),
        },
        "stations": {
            "porto": {
                "here": True,
                "reached": None,
                "heard": None,
                "agrees": None,
                "begun": None,
                "vehicles": ["uav0", "uav1"],
            },
            "faro": {
                "here": False,
                "reached": True,
                "heard": now - 2,
                "agrees": True,
                "begun": True,
                "vehicles": ["boat0"],
            },
            "lagos": {
                "here": False,
                "reached": False,
                "heard": now - 120,
                "agrees": None,
                "begun": None,
                "vehicles": [],
            },
        },
    }


def mission(begin):
    free = {"property": "race_freedom", "verdict": "holds", "rests_on": []}
    known = {"name": "spill_watch", "digest": "9f2b66d01c8a4f10aa55", "scheduler": "fair", "begun": begin}
    return known | {"verified": True, "verdicts": [VERDICT, free], "station": "porto"}


def clock(begin, now):
    moment = {"now": now, "begin": begin, "head": now, "step": 42, "rate": 1}
    mode = {"live": True, "playing": False, "speed": 1}
    return moment | mode | {"ended": None, "broken_off": False, "unread": None}


def vehicles(now):
    asked = {"text": MOVE, "agent": "pilot0", "since": now - 40, "limit": 60, "fallback": "return"}
    told = {"command": "GoTo", "to": "spillArea", "way": [[37.0, -8.8], [37.05, -8.7]], "since": now - 39}
    lost = {
        "link": {"heard": now - 31, "lost": True},
        "battery": {"percent": 19.0, "volts": 20.4},
        "taken": "the link was lost: the autopilot returned",
        "why": "link lost for 31 s; taken over by the fail-safe",
        "said": {"text": "Failsafe: GCS lost", "time": now - 12, "severity": 2},
        "mode": "RTL",
    }
    return {
        "uav0": card(
            1,
            request=asked | {"given_up": False},
            order=told | {"state": "accepted", "why": ""},
            why="a request over half of its limit",
        ),
        "uav1": card(3, **lost),
        "boat0": card(kind="USV", battery=None, mode=None, armed=None, authority=[]),
        "uav10": card(2, believed="spillArea", differs=True, why="late: the request has stood 75 s of 60 s"),
    }


def agent(state, **more):
    return {"host": None, "state": state, "request": None, "awaits": [], "until": None} | more


def step(number, begin):
    """Return one of a pilot's steps, or each third time one of the world's."""
    pilot = f"pilot{number % 2}" if number % 3 else None
    label = f"{pilot}: control(MOVE_HOST_TO spillArea)" if pilot else "uav0 enters spillArea"
    changes = ["uav0 is now in spillArea"] if number % 2 else []
    done = {"time": begin + 13 * number, "label": label, "rule": "control", "agent": pilot}
    return done | {"about": "spillArea", "changes": changes, "shown": [], "told": True}


def alerts(now):
    late = "the move to spillArea has stood 75 s and may stand 60 s"
    lost = "nothing was heard for 31 s, though the mission assumes 10 s"
    return {
        "1": alert(now - 95, "late", "uav10", late, "it goes on waiting"),
        "2": alert(now - 12, "assumption", "uav1", lost, "the autopilot returns", "local_consistency"),
    }


def alert(at, kind, about, message, fallback, *verdicts):
    said = {"time": at, "kind": kind, "about": about, "message": message, "fallback": fallback}
    return said | {"verdicts": list(verdicts), "wrong": True, "acknowledged": None}


def crowd(vehicles, entities):
    """Return sections with many: the vehicles' cards and everybody's positions."""
    cards, seen = {}, {}
    for n in range(vehicles):
        at = 37 + 0.3 * math.sin(n), -8.7 + 0.3 * math.cos(n)
        seen[f"v{n:03}"] = entity(*at, vehicle=True, kind="UAV", course=math.degrees(n) % 360)
        cards[f"v{n:03}"] = card(int(n % 17 == 0), heading=math.degrees(n) % 360)
    for n in range(entities - vehicles):
        seen[f"ship{n:04}"] = entity(36.6 + (n % 40) / 50, -9.2 + (n // 40) / 25)
    return {"entities": seen, "vehicles": cards}
