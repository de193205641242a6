"""Arguments of a kernel lie in one buffer as its text declares them: each at a multiple of its size, nothing behind the
last."""

import ctypes
import struct

import numpy as np
import pytest

from sdph.engine.gpu import toolkit


class There:
    """As much of an array of a device as a launch asks for."""

    copy_to_host = None
    dtype, ndim, size, shape, strides = np.dtype(np.float64), 2, 6, (3, 2), (16, 8)
    device_ctypes_pointer = ctypes.c_void_p(0x7000)

    @staticmethod
    def is_c_contiguous() -> bool:
        return True


ARRAY = struct.pack("<9q", 0, 0, 6, 8, 0x7000, 3, 2, 16, 8)


@pytest.mark.parametrize(
    "given, form, values",
    [
        ((1.5, True), "<d?", (1.5, True)),  # behind a truth value there is nothing: a longer buffer is refused
        ((True, 1.5), "<?7xd", (True, 1.5)),
        ((True, np.False_, np.int64(3)), "<??6xq", (True, False, 3)),
        (((), (True, (2,)), 3), "<?7xqq", (True, 2, 3)),
    ],
)
def test_numbers_lie_at_multiples_of_their_size(given, form, values):
    words = bytearray()
    toolkit._pack(given, [], words)
    assert bytes(words) == struct.pack(form, *values)


def test_arrays_lie_as_nine_words_and_are_looked_at_once():
    kinds, words, array = [], bytearray(), There()
    toolkit._pack((True, array, (array,)), kinds, words)
    assert bytes(words) == b"\x01" + bytes(7) + 2 * ARRAY
    assert array.words[1] == ARRAY and kinds.count(("<f8", 2, True)) == 2


def test_kinds_tell_kernels_apart():
    """A truth value is no number, and what is grouped otherwise is of another kernel."""
    found = set()
    for given in ((1, 2.0), (True, 2.0), ((1,), 2.0), ((1, 2.0),), (1.0, 2.0)):
        toolkit._pack(given, kinds := [], bytearray())
        found.add(tuple(kinds))
    assert len(found) == 5


def test_what_no_kernel_of_ours_takes_is_refused():
    with pytest.raises(TypeError, match="float32"):
        toolkit._pack((np.float32(1.0),), [], bytearray())
