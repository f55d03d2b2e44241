"""A crew: the workers of one exploration, as its leader sees them."""

from typing import Any, Protocol


class LostError(Exception):
    """A worker died; it can be started anew, but has forgotten all."""


class ClusterError(Exception):
    """A cluster that can't be worked with as it is asked for: not installed, not there, of another version."""


class Crew(Protocol):
    """Workers that are asked together; what they exchange meanwhile is their own affair (see `worker.Worker`).

    Each method raises `LostError` where a worker has died.
    """

    @property
    def size(self) -> int:
        """How many there are."""

    def one(self, worker: int, method: str, *arguments: Any) -> Any:
        """Return what one of them answers."""

    def every(self, method: str, *arguments: Any) -> list[Any]:
        """Return what each of them answers."""

    def revive(self) -> None:
        """Start anew those who died, and link all with each other.

        Raises:
            ClusterError: They run something else.
            MachineError: They can't be started.
            LostError: Some died at once.
        """
