"""A crew of Ray actors: the only module that imports Ray.

Ray places actors, carries calls and results, and restarts an actor that died. A restarted actor has lost its memory. So
each call names its crew, and a restarted actor rejects it. Data between workers goes over `links.Sockets`.
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

from checker.engines.cluster.cluster_worker import Worker
from checker.engines.cluster.crew import ClusterError, LostError
from checker.engines.cluster.explorer import Expedition
from checker.engines.cluster.transfer import WORKERS_AT_MOST
from checker.engines.cluster.worker_links import Address, Sockets
from checker.engines.contract import (
    CheckpointError,
    Cluster,
    Exploration,
    Inspect,
    MachineError,
    Options,
)
from checker.reduction.reducer import Reduced
from physical.wordings import install_extra
from semantics.state.configuration import Configuration

PATIENCE = 120.0
"""Seconds within which Ray must start or restart an actor."""

STORE = 512 << 20
"""The bytes of the object store of a local cluster: all data in transit at a time."""

Task = tuple[Configuration, int, Reduced | None]
"""The initial configuration, the limit on pending requests, and the reductions."""

ROOMS = ("bigraphs", "physical", "semantics", "checker")


class ForgottenError(Exception):
    """An actor was restarted since it joined a crew."""


class RayProcess:
    """A Ray actor; it can work in any number of crews.

    Attributes:
        joined: For each crew, by name, its worker, its links, and the number of the revival.
    """

    def __init__(self) -> None:
        self.joined: dict[str, tuple[Worker, Sockets, int]] = {}

    def join(self, crew: str, revived: int, task: Task, me: int, workers: int) -> tuple[str, Address]:
        """Join a crew as a worker, unless it is one already; return the digest of the checker and the own address."""
        links = Sockets(load_ray().util.get_node_ip_address())
        known, before, _ = self.joined.get(crew, (None, None, 0))
        if known is None or before is None:
            initial, pending, reduce = task
            known = Worker(initial, pending, me, workers, links, reduce)
        else:
            before.close()
            known.links = links
        self.joined[crew] = known, links, revived
        return edition(), links.address

    def meet(self, crew: str, revived: int, addresses: list[Address], secret: bytes) -> None:
        """Link a crew's worker with the others, which do the same."""
        worker, links = self._of(crew, revived)
        links.meet(worker.shard.me, addresses, secret)

    def call(self, crew: str, revived: int, method: str, *arguments: Any) -> Any:
        """Return the result of a worker's method; on failure close its links, so that no other worker waits for it."""
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
def processes(node: str, workers: int) -> tuple[Any, ...]:  # noqa: ARG001  # each Ray cluster has its own actors
    """Return `workers` actors, spread over the machines of the cluster; a second call returns the same ones."""
    # Ray must not repeat a call: a restarted actor has lost its memory, and only all together can resume.
    options = {"num_cpus": 0, "max_restarts": -1, "max_task_retries": 0, "scheduling_strategy": "SPREAD"}
    actor = load_ray().remote(RayProcess).options(**options)
    return tuple(actor.remote() for _ in range(workers))


class RayCrew:
    """Actors that explore one mission together.

    Attributes:
        name: A unique name.
        revived: The number of revivals so far.
    """

    def __init__(
        self, initial: Configuration, pending: int, workers: int, reduce: Reduced | None = None
    ) -> None:
        self.ray = load_ray()
        self.name = uuid4().hex
        self.revived = 0
        self.task: Task = (initial, pending, reduce)
        self.actors = processes(self.ray.get_runtime_context().get_node_id(), workers)
        weakref.finalize(self, _leave, self.ray, self.actors, self.name)

    @property
    def size(self) -> int:
        """The number of workers."""
        return len(self.actors)

    def one(self, worker: int, method: str, *arguments: Any) -> Any:
        """Return the result of a method of one worker."""
        return self._got([self.actors[worker].call.remote(self.name, self.revived, method, *arguments)])[0]

    def every(self, method: str, *arguments: Any) -> list[Any]:
        """Return the results of a method of all workers."""
        return self._asked("call", method, *arguments)

    def _asked(self, question: str, *arguments: Any) -> list[Any]:
        return self._got(
            [getattr(actor, question).remote(self.name, self.revived, *arguments) for actor in self.actors]
        )

    def _got(self, references: list[Any]) -> list[Any]:
        """Return all results; of several failures, raise one that is not the loss of another worker, if any."""
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
                raise error.cause from None  # its message is complete without the worker's traceback
            raise

    def revive(self) -> None:
        """Wait for all actors, let them join again, and link them.

        Raises:
            ClusterError: Some run another version.
            MachineError: Some did not start in time.
            LostError: Some died meanwhile.
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
            reference = self.actors[worker].join.remote(self.name, self.revived, self.task, worker, self.size)
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
    """Return the Ray library, with its usage reports disabled.

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
    """Join a Ray cluster, unless this process is in one; without an address, start a local one.

    Raises:
        ClusterError: There is none at the address, or Ray is not installed.
        MachineError: A local one can't be started.
    """
    with _listening_here() if _is_here(cluster.address) else nullcontext():
        _connect(cluster)


@contextmanager
def _listening_here() -> Iterator[None]:
    """Restrict Ray to the loopback address if it is loaded or started within the context."""
    name = "RAY_ENABLE_WINDOWS_OR_OSX_CLUSTER"
    before = os.environ.get(name)
    os.environ[name] = "0"
    try:
        yield
    finally:  # later clusters of this process may span machines
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
    except Exception as error:  # Ray raises plain exceptions if it does not start in time
        if cluster.address is None:
            raise MachineError(f"no Ray cluster could be started here: {error}") from error
        raise ClusterError(f"there is no Ray cluster at {cluster.address}: {error}") from error
    if threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGTERM, before)  # Ray's handler would exit at once
    if cluster.address is None and not ray.util.get_node_ip_address().startswith("127."):
        ray.shutdown()
        raise ClusterError(
            "Ray is loaded already and accepts connections from outside: let the checker load it"
        )


def _is_here(address: str | None) -> bool:
    return address is None or address.startswith(("127.", "localhost:"))


def _reach(address: str) -> None:
    """Raise ClusterError unless a server listens at an address: Ray itself would try for minutes."""
    host, colon, port = address.rpartition(":")
    if not colon or not host or not port.isdecimal() or int(port) > 65535:
        raise ClusterError(f"'{address:.60}' is no address of a Ray cluster: it should be HOST:PORT, or auto")
    try:
        socket.create_connection((host.strip("[]"), int(port)), timeout=5).close()
    except OSError as error:
        raise ClusterError(f"there is no Ray cluster at {address}: {error}") from error


def explore_with_ray(initial: Configuration, inspect: tuple[Inspect, ...], options: Options) -> Exploration:
    """Explore all reachable configurations with workers in separate processes.

    Without a folder for checkpoints, a local cluster stores them in a temporary one.

    Raises:
        ClusterError: There is no cluster, or it does not fit the options.
        MachineError: It does not start, or workers are lost again and again.
        CheckpointError: The checkpoint is damaged, or of another exploration.
    """
    cluster, keeping = options.cluster, options.keeping
    if not 2 <= cluster.workers <= WORKERS_AT_MOST:
        raise ClusterError(f"--engine ray takes 2 to {WORKERS_AT_MOST} workers; one is --engine fast")
    connect(cluster)
    crew = RayCrew(initial, options.limits.pending, cluster.workers, options.reduce)
    is_temporary = keeping.folder is None and cluster.address is None
    if is_temporary:
        folder = tempfile.mkdtemp(prefix="bigactors-")
        weakref.finalize(crew, shutil.rmtree, folder, ignore_errors=True)
        options = replace(options, keeping=replace(keeping, folder=folder))
    return Expedition(crew, initial, options, is_temporary=is_temporary).run(inspect)


@lru_cache(maxsize=1)
def edition() -> str:
    """Return a digest of the checker's source: workers with different sources may learn different rules."""
    found = sha256()
    for name, path in sorted(modules().items()):
        found.update(name.encode())
        found.update(path.read_bytes())
    return found.hexdigest()


def modules() -> dict[str, Path]:
    """Return the checker's source files by their path relative to the repository or the package."""
    root = Path(__file__).parents[3]
    return {path.relative_to(root).as_posix(): path for room in ROOMS for path in (root / room).rglob("*.py")}
