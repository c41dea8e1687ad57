"""Operations that the processor has and the compiler does not offer."""

from numba import types
from numba.extending import intrinsic


@intrinsic
def take_next(typing_context, counter):  # type: ignore[no-untyped-def]
    """Return the first entry of an integer array and add 1 to it, in one step that no thread can interrupt."""

    def generate(context, builder, signature, arguments):  # type: ignore[no-untyped-def]
        array = context.make_array(signature.args[0])(context, builder, arguments[0])
        one = context.get_constant(types.int64, 1)
        return builder.atomic_rmw("add", array.data, one, "monotonic")

    return types.int64(counter), generate


@intrinsic
def fma(typing_context, a, b, c):  # type: ignore[no-untyped-def]
    """Return a b + c, rounded once: everywhere the same, unlike multiply-adds that a compiler chooses."""

    def generate(context, builder, signature, arguments):  # type: ignore[no-untyped-def]
        return builder.fma(*arguments)

    return types.float64(types.float64, types.float64, types.float64), generate


@intrinsic
def lowest_bit(typing_context, bits):  # type: ignore[no-untyped-def]
    """Return the place of the lowest bit that is set in an integer that is not zero."""

    def generate(context, builder, signature, arguments):  # type: ignore[no-untyped-def]
        return builder.cttz(arguments[0], context.get_constant(types.boolean, True))

    return types.int64(types.int64), generate
