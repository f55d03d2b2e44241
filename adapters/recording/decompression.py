"""Decompression of recordings: up to the declared size, and no further."""

from __future__ import annotations

from collections.abc import Callable
from io import BytesIO
from typing import Final

from physical.wordings import install_extra

MOST_WINDOW: Final = 1 << 24
"""The most bytes of a decompressor's window, which it keeps in memory."""


def opened(compression: str, data: bytes, size: int) -> bytes:
    """Return decompressed data, at most one byte more than its declared size.

    Raises:
        ValueError: The data are not compressed in this way, or no installed library can open them.
    """
    find = OPENERS.get(compression)
    if find is None:
        known = " or ".join(sorted(filter(None, OPENERS)))
        raise ValueError(f"it is compressed by '{compression:.20}', not by {known}")
    try:
        return find(data, size + 1)
    except ImportError as error:
        raise ValueError(
            f"the library of this compression is not installed: {install_extra('live')}"
        ) from error
    except (RuntimeError, EOFError, MemoryError) as error:
        raise ValueError(f"its {compression} is damaged: {error!s:.100}") from error


def _plain(data: bytes, most: int) -> bytes:
    return data[:most]


def _zstd(data: bytes, most: int) -> bytes:
    import zstandard  # noqa: PLC0415 - an extra

    try:
        with zstandard.ZstdDecompressor(max_window_size=MOST_WINDOW).stream_reader(BytesIO(data)) as reader:
            return reader.read(most)
    except zstandard.ZstdError as error:
        raise RuntimeError(str(error)) from error


def _lz4(data: bytes, most: int) -> bytes:
    import lz4.frame  # noqa: PLC0415 - an extra

    found: bytes = lz4.frame.LZ4FrameDecompressor().decompress(data, max_length=most)
    return found


OPENERS: Final[dict[str, Callable[[bytes, int], bytes]]] = {"": _plain, "zstd": _zstd, "lz4": _lz4}
