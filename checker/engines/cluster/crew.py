"""A crew: the workers of one exploration, as their leader sees them."""

from typing import Any, Protocol


class LostError(Exception):
    """A worker died; it can be restarted, without its memory."""


class ClusterError(Exception):
    """A cluster is unusable as requested: not installed, not reachable, or of another version."""


class Crew(Protocol):
    """Workers that are called together; they exchange data among themselves (see `worker.Worker`).

    Each method raises `LostError` if a worker has died.
    """

    @property
    def size(self) -> int:
        """The number of workers."""

    def one(self, worker: int, method: str, *arguments: Any) -> Any:
        """Return the result of a method of one worker."""

    def every(self, method: str, *arguments: Any) -> list[Any]:
        """Return the results of a method of all workers."""

    def revive(self) -> None:
        """Restart dead workers, and link all with each other.

        Raises:
            ClusterError: Some run another version.
            MachineError: Some can't be started.
            LostError: Some died at once.
        """
