"""Named tuples that Python makes and kernels hand on by reference.

Numba would hand on all numbers of a tuple, seven for each array, and take them apart and put them together in
every kernel on the way; that is most of the code it would make, and time goes by what it makes.
"""

from typing import Any

from numba import extending, types
from numba.core import cgutils
from numba.core.typing.templates import AttributeTemplate, infer_getattr


class Reference(types.Type):  # type: ignore[misc]
    """Numba's type of a reference to a named tuple."""

    def __init__(self, tuple_type: Any) -> None:
        self.tuple_type = tuple_type
        super().__init__(f"Reference({tuple_type})")


def by_reference(named_tuple: Any) -> Any:
    """Mark a class of named tuples whose values kernels get by reference, and return the class.

    A kernel that is handed one sees the type :class:`Reference`, and loads a field where it asks for it.
    """

    @extending.typeof_impl.register(named_tuple)  # type: ignore[untyped-decorator]
    def of_value(values: Any, context: Any) -> Reference:
        """Numba's type of a tuple of values."""
        return Reference(
            types.BaseTuple.from_types(
                [extending.typeof_impl(value, context) for value in values], named_tuple
            )
        )

    return named_tuple


@extending.register_model(Reference)
class _Pointer(extending.models.PrimitiveModel):  # type: ignore[misc]
    def __init__(self, manager: Any, reference: Reference) -> None:
        pointed = manager.lookup(reference.tuple_type).get_value_type()
        super().__init__(manager, reference, pointed.as_pointer())


@infer_getattr
class _Fields(AttributeTemplate):  # type: ignore[misc]
    key = Reference

    def generic_resolve(self, reference: Reference, name: str) -> Any:
        names = reference.tuple_type.fields
        return reference.tuple_type.types[names.index(name)] if name in names else None


@extending.lower_getattr_generic(Reference)  # type: ignore[untyped-decorator]
def _field(
    context: Any, builder: Any, reference: Reference, pointer: Any, name: str
) -> Any:
    """Load a field of a named tuple that is handed on by reference."""
    at = reference.tuple_type.fields.index(name)
    return builder.load(cgutils.gep_inbounds(builder, pointer, 0, at))


@extending.intrinsic
def referred(typing_context, values):  # type: ignore[no-untyped-def]
    """Return a reference to a named tuple that a kernel has made itself, for as long as that kernel runs.

    Parameters
    ----------
    typing_context : numba's
    values : a named tuple of a class that is marked by :func:`by_reference`
    """

    def generate(context, builder, signature, arguments):  # type: ignore[no-untyped-def]
        return cgutils.alloca_once_value(builder, arguments[0])

    return Reference(values)(values), generate


@extending.unbox(Reference)  # type: ignore[untyped-decorator]
def _from_python(reference: Reference, value: Any, call: Any) -> Any:
    """Put a tuple of Python into memory of the call, and give the kernel where it is."""
    given = call.unbox(reference.tuple_type, value)
    place = cgutils.alloca_once_value(call.builder, given.value)
    return extending.NativeValue(place, cleanup=given.cleanup, is_error=given.is_error)
