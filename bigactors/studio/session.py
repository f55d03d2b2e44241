"""One page of the studio: what it asks, and the processes that answer it."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Coroutine, Iterable
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, Final

from bigactors.commands.check.file_changes import Looks, look
from bigactors.lsp.edited_mission import Reading, reading_of
from bigactors.lsp.textmate import TYPES, textmate_grammar
from bigactors.mistakes import Mistake
from bigactors.studio.child_process import ChildProcess, FlightProcess
from bigactors.studio.mission_file import (
    Overwritten,
    Saved,
    begin_mission,
    is_empty,
    keep_places,
    read_mission,
    save_mission,
)
from bigactors.studio.page_requests import (
    Add,
    BeginFrame,
    DropFrame,
    ExploreFrame,
    FlyFrame,
    LspFrame,
    Request,
    Reshape,
    SaveFrame,
    TextFrame,
    WorldFrame,
    read_request,
)
from bigactors.studio.world_edits import TextChange, Uneditable, changes, from_file, shapes
from physical import PhysicalError
from specs.missions import shipped_missions

MOST_CONFIGURATIONS: Final = 2_000_000
MOST_SECONDS: Final = 600.0
ANSWERED: Final = 30.0
"""Seconds that an exploration has for one answer."""

MOST_WAITING: Final = 16
"""The most requests to an exploration that wait for the one before."""

POLL: Final = 0.5
"""Seconds between two looks at the file."""


@dataclass
class Desk:
    """What all pages of a studio share.

    Attributes:
        file: The mission's file; it may not be there yet.
        flight: The simulated flight.
        run: The file of a run that the explorer shows first, if there is one.
    """

    file: Path
    flight: FlightProcess
    run: Path | None = None


class Session:
    """Answers one page until either side ends it."""

    def __init__(self, socket: Any, desk: Desk) -> None:
        self._socket = socket
        self._desk = desk
        self._seen: Looks = {}
        self._known = ""
        self._tasks: set[asyncio.Task[None]] = set()
        self._children: list[ChildProcess] = []
        self._lsp: ChildProcess | None = None
        self._check: asyncio.Task[None] | None = None
        self._explorer: ChildProcess | None = None
        self._text: TextFrame | None = None
        self._turn = asyncio.Lock()
        self._waiting = 0

    async def run(self) -> None:
        """Greet the page and answer it; end its processes with it."""
        try:
            await self._in_words(self._greet())
            self._begin(self._watch_file())
            async for message in self._socket:
                if isinstance(message.data, str):
                    await self._hear(message.data)
        finally:
            for task in tuple(self._tasks):
                task.cancel()
            await asyncio.gather(*self._tasks, return_exceptions=True)
            await asyncio.gather(*(child.end() for child in self._children))

    async def _hear(self, frame: str) -> None:
        try:
            request = read_request(frame)
        except PhysicalError as error:
            await self._tell(f"this page sent what the studio cannot read: {error.message}")
        else:
            await self._in_words(self._answer(request))

    async def _in_words(self, work: Awaitable[None]) -> None:
        try:
            await work
        except Mistake as mistake:
            await self._tell(str(mistake))

    async def _answer(self, request: Request) -> None:
        match request:
            case LspFrame(message):
                if self._lsp is not None:
                    await self._lsp.send_frame(message)
            case TextFrame():
                await self._take(request)
            case SaveFrame(text, over):
                await self._save(text, over)
            case BeginFrame(name, source):
                self._desk.file = begin_mission(self._file.parent, name, source)
                await self._open()
            case ExploreFrame():
                self._begin(self._explore(request))
            case FlyFrame(number):
                self._begin(self._fly(number))
            case WorldFrame(number, text, edit):
                await self._change_world(number, partial(_edited, self._reading(text), edit))
            case DropFrame(number, text, name, content):
                file = partial(keep_places, self._file.resolve().parent, name, content)
                await self._change_world(number, partial(_taken, self._reading(text), file))

    async def _send(self, kind: str, **data: Any) -> None:
        await self._socket.send_json({"type": kind, **data})

    async def _tell(self, words: str) -> None:
        await self._send("error", message=words)

    @property
    def _file(self) -> Path:
        return self._desk.file

    async def _start(self, *module: str) -> ChildProcess:
        """Start a process that ends with the page."""
        child = await ChildProcess.start(*module)
        self._children = [*(each for each in self._children if not each.has_ended), child]
        return child

    def _begin(self, work: Coroutine[Any, Any, None]) -> asyncio.Task[None]:
        task = asyncio.create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._finished)
        return task

    def _finished(self, task: asyncio.Task[None]) -> None:
        self._tasks.discard(task)
        error = None if task.cancelled() else task.exception()
        if error is not None and not isinstance(error, ConnectionError):  # else the page is gone
            task.get_loop().call_exception_handler({"message": str(error), "exception": error, "task": task})

    async def _fly(self, number: int) -> None:
        try:
            await self._send("flying", id=number, answer=await self._desk.flight.begin(self._file))
        except Mistake as mistake:
            await self._send("flying", id=number, refused=str(mistake))
            return
        if (recording := await self._desk.flight.recording()) is not None:
            await self._send("flown", recording=str(recording))

    # --- the file

    async def _greet(self) -> None:
        if not is_empty(self._file):
            await self._open()
            return
        stem, shipped = self._file.stem, shipped_missions()
        name, source = ("", stem) if stem in shipped else (stem, "")
        folder = str(self._file.resolve().parent)
        await self._send("start", name=name, source=source, folder=folder, shipped=[*shipped])

    async def _open(self) -> None:
        """Send the mission's text, with what an editor needs."""
        saved = read_mission(self._file)
        self._keep(saved)
        if self._lsp is None:
            self._lsp = await self._start("bigactors", "lsp")
            self._begin(self._relay(self._lsp))
        file = self._file.resolve()
        uri, name, types = file.as_uri(), file.name, [*TYPES]
        grammar = textmate_grammar()
        words = {
            "name": name,
            "uri": uri,
            "types": types,
            "grammar": grammar,
            "given": self._given is not None,
        }
        await self._send("open", text=saved.text, digest=saved.digest, **words)

    async def _relay(self, server: ChildProcess) -> None:
        async for message in server.frames():
            await self._send("lsp", message=message)
        await self._tell("the language server has ended: reload the page to have its help again")

    async def _save(self, text: str, over: str) -> None:
        try:
            saved = save_mission(self._file, text, over)
        except Overwritten:
            await self._changed_outside()
            return
        self._keep(saved)
        await self._send("saved", digest=saved.digest)

    def _keep(self, saved: Saved) -> None:
        self._known = saved.digest
        self._seen = look([self._file])

    async def _watch_file(self) -> None:
        """Tell the page when another program has saved the file."""
        while True:
            await asyncio.sleep(POLL)
            now = look([self._file], self._seen)
            if now != self._seen:
                self._seen = now
                with suppress(Mistake):  # it may be gone for the moment of its replacement
                    await self._changed_outside()

    async def _changed_outside(self) -> None:
        saved = read_mission(self._file)
        if saved.digest != self._known:
            self._keep(saved)
            await self._send("changed", text=saved.text, digest=saved.digest)

    # --- the world, drawn on the map

    def _reading(self, text: str) -> Reading:
        return reading_of(self._file.name, text, self._file.resolve().parent)

    async def _change_world(self, number: int, work: Callable[[], dict[str, Any]]) -> None:
        try:
            await self._send("world", id=number, answer=await asyncio.to_thread(work))
        except (Uneditable, Mistake, PhysicalError) as error:
            await self._send("world", id=number, refused=str(error))

    # --- the text as it is now

    async def _take(self, text: TextFrame) -> None:
        """Check and explore a text; end the check and the exploration of the text before."""
        self._text = text
        if self._check is not None:
            self._check.cancel()
        if self._explorer is not None:
            self._explorer.kill()
            self._explorer = None
        self._check = self._begin(self._checked(text))

    def _mission(self, text: TextFrame) -> dict[str, str]:
        return {"name": self._file.name, "text": text.text, "directory": str(self._file.resolve().parent)}

    @property
    def _given(self) -> str | None:
        return None if self._desk.run is None else str(self._desk.run.resolve())

    async def _checked(self, text: TextFrame) -> None:
        child = await self._start("bigactors.lsp.worker")
        limits = {"configurations": MOST_CONFIGURATIONS, "seconds": MOST_SECONDS}
        found = await child.ask_once(self._mission(text) | limits)
        failed = {"refused": "the check has ended without a report: more memory may be needed"}
        await self._send("verdicts", number=text.number, **(failed if found is None else found))

    async def _explore(self, request: ExploreFrame) -> None:
        if self._waiting >= MOST_WAITING:
            await self._send("explored", id=request.id, refused="too many requests wait for an answer")
            return
        self._waiting += 1
        try:
            async with self._turn:
                found = await self._explored(request.request)
        finally:
            self._waiting -= 1
        await self._send("explored", id=request.id, **found)

    async def _explored(self, request: dict[str, Any]) -> dict[str, Any]:
        """Return the answer of the exploration of the newest text; start it where there is none."""
        text = self._text
        if text is None:
            return {"refused": "there is no text yet"}
        if self._explorer is None:
            child = self._explorer = await self._start("bigactors.studio.exploring")
            begun = await child.ask(self._mission(text) | {"given": self._given})
            if begun is None or "refused" in begun or self._text is not text:
                self._forget(child)
                return begun if begun and "refused" in begun else {"refused": "the text has changed"}
        child = self._explorer
        try:
            async with asyncio.timeout(ANSWERED):
                found = await child.ask(request)
        except TimeoutError:
            self._forget(child)
            return {"refused": f"there was no answer within {ANSWERED:.0f} s: the exploration begins anew"}
        if found is None:
            self._forget(child)
        return found or {"refused": "the text has changed"}

    def _forget(self, child: ChildProcess) -> None:
        child.kill()
        if self._explorer is child:
            self._explorer = None


def _edited(reading: Reading, edit: Reshape | Add | None) -> dict[str, Any]:
    """Return what a text places, and the changes for an edit."""
    if edit is None:
        return shapes(reading)
    name, found = changes(reading, edit)
    return {"name": name, "changes": _changes_json(reading, found)}


def _taken(reading: Reading, keep: Callable[[], str]) -> dict[str, Any]:
    """Keep a dropped file; return the changes that take its places into the world."""
    return {"changes": _changes_json(reading, from_file(reading, keep()))}


def _changes_json(reading: Reading, found: Iterable[TextChange]) -> list[dict[str, Any]]:
    """Return changes with the offsets of a browser, which counts in UTF-16."""

    def offset(at: int) -> int:
        return len(reading.text[:at].encode("utf-16-le", "surrogatepass")) // 2

    return [{"from": offset(each.start), "to": offset(each.end), "insert": each.text} for each in found]
