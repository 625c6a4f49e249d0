"""Prefetch of what is read next: where the next texels lie, the processor cannot guess."""

from __future__ import annotations

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic


@intrinsic
def prefetch_row(typingctx, table, line):
    """Begin to read row ``line`` of a table (n, k) into the cache, and do not wait for it."""

    def generate(context, builder, signature, arguments):
        kind = signature.args[0]
        array = context.make_array(kind)(context, builder, arguments[0])
        first = context.get_constant(types.intp, 0)
        where = cgutils.get_item_pointer(
            context, builder, kind, array, [arguments[1], first], wraparound=False
        )
        where = builder.bitcast(where, cgutils.voidptr_t)
        number = ir.IntType(32)
        instruction = cgutils.get_or_insert_function(
            builder.module,
            ir.FunctionType(ir.VoidType(), [cgutils.voidptr_t, number, number, number]),
            "llvm.prefetch.p0",
        )
        # For reading, into the nearest cache, of data.
        builder.call(instruction, [where, number(0), number(3), number(1)])
        return context.get_dummy_value()

    return types.void(table, types.intp), generate
