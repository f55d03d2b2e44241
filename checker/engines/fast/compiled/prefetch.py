"""Prefetching: start loading memory that will be read soon, without waiting for it."""

from collections.abc import Callable
from typing import Any, Final, cast

from llvmlite import ir
from numba import types
from numba.extending import intrinsic

READ, KEEP, DATA = 0, 3, 1
"""Arguments of LLVM's `prefetch`: read access, keep in all caches, data."""

_BYTES, _INT = ir.IntType(8).as_pointer(), ir.IntType(32)


@intrinsic
def _prefetch(_context: Any, array: Any, index: Any) -> Any:
    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        pages = context.make_array(signature.args[0])(context, builder, arguments[0])
        at = builder.bitcast(builder.gep(pages.data, [arguments[1]]), _BYTES)
        kind = ir.FunctionType(ir.VoidType(), [_BYTES, _INT, _INT, _INT])
        ask = builder.module.declare_intrinsic("llvm.prefetch", [_BYTES], kind)
        builder.call(ask, [at, *(ir.Constant(_INT, each) for each in (READ, KEEP, DATA))])
        return context.get_dummy_value()

    return types.void(array, index), generate


prefetch: Final[Callable[[Any, Any], None]] = cast("Callable[[Any, Any], None]", _prefetch)
"""Prefetch the cache line of an element of a contiguous array; the index is not checked."""
