"""A crew of Ray actors: the only file that imports Ray.

Ray places actors, carries questions and answers, and starts an actor anew that dies. It knows nothing then: calls say
which crew they are meant for, so that none is answered by one that has forgotten. What workers exchange with each other
goes over `links.Sockets`.
"""

import os
import secrets
import shutil
import signal
import socket
import tempfile
import threading
import time
import weakref
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from dataclasses import replace
from functools import lru_cache
from hashlib import sha256
from pathlib import Path
from typing import Any
from uuid import uuid4

from checker.engines.cluster.crew import ClusterError, LostError
from checker.engines.cluster.explorer import Expedition
from checker.engines.cluster.links import Address, Sockets
from checker.engines.cluster.transfer import WORKERS_AT_MOST
from checker.engines.cluster.worker import Worker
from checker.engines.contract import (
    CheckpointError,
    Cluster,
    Exploration,
    Inspect,
    MachineError,
    Options,
)
from physical.messages import install_extra
from semantics.state.configuration import Configuration

PATIENCE = 120.0
"""Seconds in which Ray must have started an actor, or started it anew."""

STORE = 512 << 20
"""Bytes of the object store of a cluster of one's own: what is on its way at once."""

ROOMS = ("bigraphs", "physical", "semantics", "checker")


class ForgottenError(Exception):
    """An actor was started anew since it joined a crew."""


class Process:
    """A Ray actor: it works in any number of crews.

    Attributes:
        joined: By the name of each crew, its worker there, and how often the crew was revived.
    """

    def __init__(self) -> None:
        self.joined: dict[str, tuple[Worker, Sockets, int]] = {}

    def join(
        self, crew: str, revived: int, initial: Configuration, pending: int, me: int, workers: int
    ) -> tuple[str, Address]:
        """Join a crew as some worker, unless it is one; return which checker runs here, and where it is met."""
        links = Sockets(load_ray().util.get_node_ip_address())
        known, before, _ = self.joined.get(crew, (None, None, 0))
        if known is None or before is None:
            known = Worker(initial, pending, me, workers, links)
        else:
            before.close()
            known.links = links
        self.joined[crew] = known, links, revived
        return edition(), links.address

    def meet(self, crew: str, revived: int, addresses: list[Address], secret: bytes) -> None:
        """Link the worker of a crew with the others, which do the same."""
        worker, links = self._of(crew, revived)
        links.meet(worker.shard.me, addresses, secret)

    def call(self, crew: str, revived: int, method: str, *arguments: Any) -> Any:
        """Return what the worker of a crew answers; where it can't, no other waits for it."""
        worker, links = self._of(crew, revived)
        try:
            return getattr(worker, method)(*arguments)
        except BaseException:
            links.close()
            raise

    def _of(self, crew: str, revived: int) -> tuple[Worker, Sockets]:
        if crew not in self.joined or self.joined[crew][2] != revived:
            raise ForgottenError
        return self.joined[crew][:2]

    def leave(self, crew: str) -> None:
        """Leave a crew."""
        if crew in self.joined:
            self.joined.pop(crew)[1].close()


@lru_cache(maxsize=4)
def processes(node: str, workers: int) -> tuple[Any, ...]:  # noqa: ARG001  # of each Ray cluster there are others
    """Return so many actors, spread over the machines of the cluster; the same where they were had before."""
    # Ray doesn't repeat calls: what an actor knew is gone, and only all together can go back.
    options = {"num_cpus": 0, "max_restarts": -1, "max_task_retries": 0, "scheduling_strategy": "SPREAD"}
    actor = load_ray().remote(Process).options(**options)
    return tuple(actor.remote() for _ in range(workers))


class RayCrew:
    """Actors that explore one mission together.

    Attributes:
        name: What tells crews apart.
        revived: How often it was revived.
    """

    def __init__(self, initial: Configuration, pending: int, workers: int) -> None:
        self.ray = load_ray()
        self.name = uuid4().hex
        self.revived = 0
        self.about = (initial, pending)
        self.actors = processes(self.ray.get_runtime_context().get_node_id(), workers)
        weakref.finalize(self, _leave, self.ray, self.actors, self.name)

    @property
    def size(self) -> int:
        """How many there are."""
        return len(self.actors)

    def one(self, worker: int, method: str, *arguments: Any) -> Any:
        """Return what one of them answers."""
        return self._got([self.actors[worker].call.remote(self.name, self.revived, method, *arguments)])[0]

    def every(self, method: str, *arguments: Any) -> list[Any]:
        """Return what each of them answers."""
        return self._asked("call", method, *arguments)

    def _asked(self, question: str, *arguments: Any) -> list[Any]:
        return self._got(
            [getattr(actor, question).remote(self.name, self.revived, *arguments) for actor in self.actors]
        )

    def _got(self, references: list[Any]) -> list[Any]:
        """Return all answers; of failures that counts which is none of a worker that only lost another."""
        found, failures = [], []
        for reference in references:
            try:
                found.append(self._answer(reference))
            except Exception as error:
                failures.append(error)
        if failures:
            raise min(failures, key=lambda error: isinstance(error, LostError))
        return found

    def _answer(self, reference: Any) -> Any:
        errors = self.ray.exceptions
        try:
            return self.ray.get(reference)
        except (errors.RayActorError, errors.ObjectLostError, errors.OutOfMemoryError) as lost:
            raise LostError(str(lost).strip().splitlines()[0]) from lost
        except errors.RayTaskError as error:
            if isinstance(error.cause, ForgottenError):
                raise LostError("a worker was started anew") from None
            if isinstance(error.cause, (CheckpointError, LostError)):
                raise error.cause from None  # it says all; where in a worker it was raised is of no interest
            raise

    def revive(self) -> None:
        """Wait until all actors are there, let them join anew, and link them.

        Raises:
            ClusterError: Some run something else.
            MachineError: Some are not there in time.
            LostError: Some died since.
        """
        self.revived += 1
        deadline = time.monotonic() + PATIENCE
        joined = [self._join(worker, deadline) for worker in range(self.size)]
        if {runs for runs, _ in joined} != {edition()}:
            raise ClusterError(
                "the machines of the cluster run another version of the checker: install the same on all"
            )
        self._asked("meet", [address for _, address in joined], secrets.token_bytes())

    def _join(self, worker: int, deadline: float) -> tuple[str, Address]:
        errors = self.ray.exceptions
        while True:
            reference = self.actors[worker].join.remote(
                self.name, self.revived, *self.about, worker, self.size
            )
            try:
                joined: tuple[str, Address] = self.ray.get(
                    reference, timeout=max(0.0, deadline - time.monotonic())
                )
                return joined
            except errors.ActorUnschedulableError as error:
                raise MachineError(f"worker {worker} can't be placed: {error}") from error
            except (errors.RayActorError, errors.GetTimeoutError) as error:
                if isinstance(error, errors.GetTimeoutError) or time.monotonic() > deadline:
                    raise MachineError(
                        f"worker {worker} could not be started within {PATIENCE:g} s: {error}"
                    ) from error
                time.sleep(0.1)


def _leave(ray: Any, actors: tuple[Any, ...], crew: str) -> None:
    if ray.is_initialized():
        for actor in actors:
            actor.leave.remote(crew)


def load_ray() -> Any:
    """Return the Ray library, that tells nobody that it is used.

    Raises:
        ClusterError: It is not installed.
    """
    os.environ["RAY_USAGE_STATS_ENABLED"] = "0"
    try:
        import ray  # noqa: PLC0415  # an extra, and slow to load
    except ImportError as error:
        raise ClusterError(
            f"--engine ray needs Ray, which is not installed: {install_extra('cluster')}"
        ) from error
    return ray


def connect(cluster: Cluster) -> None:
    """Join the Ray cluster that is meant, unless this process is in one; without an address, start one here alone.

    Raises:
        ClusterError: There is none at the address, or Ray is not installed.
        MachineError: None could be started here.
    """
    with _listening_here() if _is_here(cluster.address) else nullcontext():
        _connect(cluster)


@contextmanager
def _listening_here() -> Iterator[None]:
    """Let Ray, where it is loaded or started until left, listen on the loopback address alone."""
    name = "RAY_ENABLE_WINDOWS_OR_OSX_CLUSTER"
    before = os.environ.get(name)
    os.environ[name] = "0"
    try:
        yield
    finally:  # what this process starts later may be of a cluster of several machines
        if before is None:
            del os.environ[name]
        else:
            os.environ[name] = before


def _connect(cluster: Cluster) -> None:
    ray = load_ray()
    if ray.is_initialized():
        return
    if cluster.address not in (None, "auto"):
        _reach(str(cluster.address))
    before = signal.getsignal(signal.SIGTERM)
    quiet = {"include_dashboard": False, "log_to_driver": False, "logging_level": "error"}
    try:
        if cluster.address is None:
            ray.init(address="local", num_cpus=cluster.workers, object_store_memory=STORE, **quiet)
        else:
            ray.init(address=cluster.address, log_to_driver=False, logging_level="error")
    except Exception as error:  # Ray raises plain ones where it is not up in time
        if cluster.address is None:
            raise MachineError(f"no Ray cluster could be started here: {error}") from error
        raise ClusterError(f"there is no Ray cluster at {cluster.address}: {error}") from error
    if threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGTERM, before)  # Ray has put its own there, which leaves at once
    if cluster.address is None and not ray.util.get_node_ip_address().startswith("127."):
        ray.shutdown()
        raise ClusterError("Ray was loaded before and would listen to others: let the checker load it")


def _is_here(address: str | None) -> bool:
    return address is None or address.startswith(("127.", "localhost:"))


def _reach(address: str) -> None:
    """See whether anybody listens at an address: Ray itself would try for minutes."""
    host, colon, port = address.rpartition(":")
    if not colon or not host or not port.isdecimal() or int(port) > 65535:
        raise ClusterError(f"'{address:.60}' is no address of a Ray cluster: it should be HOST:PORT, or auto")
    try:
        socket.create_connection((host.strip("[]"), int(port)), timeout=5).close()
    except OSError as error:
        raise ClusterError(f"there is no Ray cluster at {address}: {error}") from error


def explore_with_ray(initial: Configuration, inspect: tuple[Inspect, ...], options: Options) -> Exploration:
    """Visit everything that is reachable, with workers in processes of their own.

    Where no folder is named for checkpoints, a cluster of one's own keeps them in a temporary one.

    Raises:
        ClusterError: There is no cluster, or it can't be worked with as it is asked for.
        MachineError: It does not start, or workers are lost again and again.
        CheckpointError: There is none to go on from, or it is of something else.
    """
    cluster, keeping = options.cluster, options.keeping
    if not 2 <= cluster.workers <= WORKERS_AT_MOST:
        raise ClusterError(f"--engine ray takes 2 to {WORKERS_AT_MOST} workers; one is --engine fast")
    connect(cluster)
    crew = RayCrew(initial, options.limits.pending, cluster.workers)
    if keeping.doubted:
        raise ClusterError("only the fast explorer can be doubted: --paranoid goes with --engine fast")
    is_temporary = keeping.folder is None and cluster.address is None
    if is_temporary:
        folder = tempfile.mkdtemp(prefix="bigactors-")
        weakref.finalize(crew, shutil.rmtree, folder, ignore_errors=True)
        options = replace(options, keeping=replace(keeping, folder=folder))
    return Expedition(crew, initial, options, is_temporary=is_temporary).run(inspect)


@lru_cache(maxsize=1)
def edition() -> str:
    """Return a digest of all that explores: workers that differ in it may learn different rules."""
    found = sha256()
    for name, path in sorted(modules().items()):
        found.update(name.encode())
        found.update(path.read_bytes())
    return found.hexdigest()


def modules() -> dict[str, Path]:
    """Return the modules that explore, by their paths from where the rooms stand: the repository, or the package."""
    root = Path(__file__).parents[3]
    return {path.relative_to(root).as_posix(): path for room in ROOMS for path in (root / room).rglob("*.py")}
