"""Named tuples that compiled functions take by reference: as one pointer.

numba hands a tuple on number by number, hundreds for a State of arrays, and compiles each of them again at every call
and in every loop of threads. Here the way in from Python writes the members down once, and a function reads those that
it names. What a reference points to lasts as long as that call, so that none is returned; of arrays on a device the
tuple stays what numba makes of it.
"""

from __future__ import annotations

from llvmlite import ir
from numba.core import cgutils, types
from numba.core.datamodel import models
from numba.core.imputils import impl_ret_borrowed
from numba.core.typing.templates import AttributeTemplate
from numba.core.typing.typeof import typeof_impl
from numba.extending import (
    NativeValue,
    infer_getattr,
    lower_builtin,
    lower_getattr_generic,
    register_model,
    type_callable,
    unbox,
)


class Reference(types.Type):
    """Type of a named tuple `held` whose members are of the types `parts`."""

    def __init__(self, held: type, parts: tuple[types.Type, ...]):
        self.held, self.parts = held, parts
        super().__init__(f"reference to {held.__module__}.{held.__qualname__}({', '.join(map(str, parts))})")

    @property
    def key(self):
        return self.held, self.parts


def by_reference(held: type) -> type:
    """Decorator: compiled functions take named tuples of the class `held` by reference."""

    @typeof_impl.register(held)
    def _type_of(value, context):
        parts = tuple(typeof_impl(part, context) for part in value)
        if None in parts:
            return None
        away = any(hasattr(part, "__cuda_array_interface__") for part in value)
        return types.BaseTuple.from_types(parts, held) if away else Reference(held, parts)

    return held


@register_model(Reference)
class _Pointer(models.PrimitiveModel):
    """To the members, one behind the other."""

    def __init__(self, manager, kind):
        members = ir.LiteralStructType([manager[part].get_data_type() for part in kind.parts])
        super().__init__(manager, kind, members.as_pointer())


@infer_getattr
class _Names(AttributeTemplate):
    key = Reference

    def generic_resolve(self, kind, name):
        """Type of a member; None: there is none, and the function does not compile."""
        return kind.parts[kind.held._fields.index(name)] if name in kind.held._fields else None


@lower_getattr_generic(Reference)
def _member(context, builder, kind, pointer, name):
    at = kind.held._fields.index(name)
    found = _read(builder, cgutils.gep_inbounds(builder, pointer, 0, at))
    found = context.data_model_manager[kind.parts[at]].from_data(builder, found)
    return impl_ret_borrowed(context, builder, kind.parts[at], found)


def _read(builder, place):
    """Read what stands there, number by number. LLVM may take each to stay the same, and so read it before a loop; that
    holds as numba never takes a function into its way in from Python, which writes."""
    kind = place.type.pointee
    if isinstance(kind, ir.LiteralStructType | ir.ArrayType):
        found = ir.Constant(kind, ir.Undefined)
        for at in range(len(kind.elements) if isinstance(kind, ir.LiteralStructType) else kind.count):
            found = builder.insert_value(found, _read(builder, cgutils.gep_inbounds(builder, place, 0, at)), at)
        return found
    found = builder.load(place)
    found.set_metadata("invariant.load", builder.module.add_metadata([]))
    return found


@type_callable(len)
def _type_of_length(context):
    return lambda given: types.intp if isinstance(given, Reference) else None


@lower_builtin(len, Reference)
def _length(context, builder, signature, arguments):
    return context.get_constant(types.intp, len(signature.args[0].parts))


@unbox(Reference)
def _written(kind, given, c):
    """The members written down where the way in from Python keeps its variables, and let go after the call."""
    members = [c.context.data_model_manager[part] for part in kind.parts]
    room = cgutils.alloca_once(c.builder, ir.LiteralStructType([part.get_data_type() for part in members]), zfill=True)
    failed = cgutils.alloca_once_value(c.builder, cgutils.false_bit)
    places = [cgutils.gep_inbounds(c.builder, room, 0, at) for at in range(len(members))]
    beside = []
    for at, (part, member, place) in enumerate(zip(kind.parts, members, places, strict=True)):
        native = c.unbox(part, c.pyapi.tuple_getitem(given, at))
        c.builder.store(member.as_data(c.builder, native.value), place)
        with c.builder.if_then(native.is_error, likely=False):
            c.builder.store(cgutils.true_bit, failed)
        beside.append(native.cleanup)

    def let_go():
        for part, member, place, own in zip(kind.parts, members, places, beside, strict=True):
            if own is not None:
                own()
            c.context.nrt.decref(c.builder, part, member.from_data(c.builder, c.builder.load(place)))

    return NativeValue(room, is_error=c.builder.load(failed), cleanup=let_go)
