"""Stations as processes of their own over loopback, links between them that can be cut, and what each has come to."""

import json
import os
import selectors
import signal
import socket
import subprocess
import sys
import threading
from contextlib import ExitStack, contextmanager, suppress

from flown_processes import until

from adapters.recording.mcap_files import RecordingError
from adapters.recording.recording_reader import read_recording
from bigactors.recordings import mission_of, trace_of
from semantics.state.abstraction import as_it_is

WORLD = """
signature {
  kind Location contains Location, Vessel, UAV, Station
  kind UAV driven
  kind Vessel
  kind Station
}
world {
  west0: Location = box (37.02, -8.64) (37.00, -8.66)
  east0: Location = box (37.02, -8.60) (37.00, -8.62)
  gcs0: Station = point (37.05, -8.63) linked control:gcs0, internet
  gcs1: Station = point (37.06, -8.63) linked control:gcs1, internet
  gcs2: Station = point (37.07, -8.63) linked internet
  boat0: Vessel = point (37.03, -8.63)
  boat1: Vessel = point (37.03, -8.64)
}
live { on broken assumption: continue }
"""
WEST, EAST, NOWHERE = (37.01, -8.65), (37.01, -8.61), (37.03, -8.63)


def peers_toml(reached, *, listen=None, hosts=None, scheme="tcp", tls=None):
    """Write a peers file: where each station is reached, and where one of them really listens."""
    lines = []
    for name, port in reached.items():
        lines += [f"[{name}]", f'connect = ["{scheme}/127.0.0.1:{port}"]']
        if listen and listen[0] == name:
            lines.append(f'listen = ["{scheme}/127.0.0.1:{listen[1]}"]')
        if hosts and name in hosts:
            lines.append(f"hosts = {json.dumps(hosts[name])}")
    return "\n".join([*lines, *(tls or [])]) + "\n"


class Cable:
    """A TCP relay: a link that can be cut and joined again."""

    def __init__(self, to):
        self.to = to
        self.joined = True
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.port = self._listener.getsockname()[1]
        self._selector = selectors.DefaultSelector()
        self._selector.register(self._listener, selectors.EVENT_READ)
        self._other = {}
        self._open = True
        self._thread = threading.Thread(target=self._serve, daemon=True)
        self._thread.start()

    def _serve(self):
        while self._open:
            for key, _ in self._selector.select(0.05):
                if key.fileobj is self._listener:
                    self._accept()
                elif key.fileobj in self._other:
                    self._pass(key.fileobj)
            if not self.joined:
                for end in list(self._other):
                    self._drop(end)

    def _accept(self):
        near, _ = self._listener.accept()
        try:
            if not self.joined:
                raise OSError("cut")
            far = socket.create_connection(("127.0.0.1", self.to), 1.0)
        except OSError:
            near.close()
            return
        self._other |= {near: far, far: near}
        for end in (near, far):
            self._selector.register(end, selectors.EVENT_READ)

    def _pass(self, end):
        try:
            if not self.joined:  # cut while it was waited for: what comes now is sent after that
                raise OSError("cut")
            data = end.recv(65_536)
            self._other[end].sendall(data)
        except OSError:
            data = b""
        if not data:
            self._drop(end)

    def _drop(self, end):
        for each in (end, self._other.pop(end, None)):
            if each is not None:
                self._other.pop(each, None)
                with suppress(KeyError, ValueError):
                    self._selector.unregister(each)
                each.close()

    def close(self):
        self._open = False
        self._thread.join()
        for end in list(self._other):
            self._drop(end)
        self._listener.close()
        self._selector.close()


class Station:
    """One process of `bigactors run`."""

    def __init__(self, folder, name, peers, mission, *more):
        self.folder, self.name = folder, name
        self.camera = folder / f"{name}.camera"
        self.camera.mkdir(exist_ok=True)
        self.recording = folder / f"{name}.mcap"
        self.socket = folder / f"{name}.sock"
        self._errors = folder / f"{name}.err"
        self._line = ["-m", "bigactors", "run", str(mission), "--station", name, "--peers", str(peers)]
        self._line += ["--feed", f"detections=folder:{self.camera}", "--socket", str(self.socket)]
        self._line += ["--station-log", str(folder / f"{name}.log"), *(more or ["--unverified"])]
        self._process = None
        self._mission = None
        self._replayed = (None, None)

    def start(self):
        environment = {**os.environ, "PYTHONPATH": os.getcwd()}
        with self._errors.open("ab") as errors:
            self._process = subprocess.Popen(
                [sys.executable, *self._line, "--record", str(self.recording)],
                env=environment,
                stdout=errors,
                stderr=errors,
            )
        return self

    def resume(self):
        """Start again where the last recording ended."""
        before, self.recording = self.recording, self.recording.with_suffix(".again.mcap")
        self._line += ["--resume", str(before)]
        return self.start()

    def kill(self):
        self._process.kill()
        self._process.wait()

    def interrupt(self):
        """Let it end as its operator does."""
        self._process.send_signal(signal.SIGINT)
        self._process.wait(20)

    def see(self, **places):
        """Let the station's camera see entities at places."""
        for name, at in places.items():
            feature = {
                "type": "Feature",
                "geometry": {"type": "Point", "coordinates": [at[1], at[0]]},
                "properties": {"name": name, "kind": "Vessel"},
            }
            part = self.camera / f"{name}.part"
            part.write_text(json.dumps({"type": "FeatureCollection", "features": [feature]}))
            os.replace(part, self.camera / f"{name}.geojson")

    @property
    def said(self):
        return self._errors.read_text() if self._errors.exists() else ""

    def trace(self):
        """Return the run so far, replayed from the recording; None while there is none."""
        size = self.recording.stat().st_size if self.recording.exists() else 0
        if self._replayed[0] != (self.recording, size):
            recording = self._read()
            trace = None if recording is None else self._trace_of(recording)
            self._replayed = ((self.recording, size), trace)
        return self._replayed[1]

    def _trace_of(self, recording):
        self._mission = self._mission or mission_of(recording)  # which is the same in all that it records
        return trace_of(recording, self._mission)

    def _read(self):
        try:
            return read_recording(self.recording)
        except (RecordingError, FileNotFoundError):
            return None  # it has only just begun

    def steps(self):
        """Return the labels of the steps that are recorded."""
        recording = self._read()
        return [] if recording is None else [message.data["label"] for message in recording.of("steps")]

    def places(self, *names):
        """Return where A(P) has these entities."""
        trace = self.trace()
        if trace is None:
            return None
        logical = as_it_is(trace.configurations[-1]).structure.logical
        return {name: logical.parent(name) for name in names}

    def links(self, name):
        trace = self.trace()
        return None if trace is None else as_it_is(trace.configurations[-1]).structure.logical.links(name)


@contextmanager
def running(stations):
    with ExitStack() as stack:
        for station in stations:
            stack.callback(lambda station=station: station.kill())
            station.start()
        yield


def agree(stations, **wanted):
    """Wait until all stations have entities where they are to be."""
    until(lambda: all(station.places(*wanted) == wanted for station in stations))
