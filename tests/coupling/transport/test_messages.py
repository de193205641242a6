"""The wire format: what goes in comes out bit for bit, and nothing that is not a message gets through."""

import contextlib
import os
import struct
import zlib

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from coupling.gas import FIELDS, ON_REQUEST, SOURCES
from coupling.transport.messages import (
    ABSOLUTE_LIMIT,
    HEADER,
    MAGIC,
    VERSION,
    Kind,
    Message,
    MessageError,
    decode,
    encode,
    message_limit,
)  # fmt: skip

NAMES = st.text(st.characters(codec="utf-8"), min_size=1, max_size=40).filter(lambda s: len(s.encode()) < 256)
SHAPES = hnp.array_shapes(min_dims=0, max_dims=3, min_side=0, max_side=6)
ARRAYS = st.one_of(
    hnp.arrays(np.float64, SHAPES, elements=st.floats(allow_nan=True, width=64)),
    hnp.arrays(np.int64, SHAPES, elements=st.integers(-(2**63), 2**63 - 1)),
)
VALUES = st.dictionaries(NAMES, st.one_of(ARRAYS, st.text(st.characters(codec="utf-8"), max_size=300)), max_size=8)
MESSAGES = st.builds(Message, st.sampled_from(Kind), VALUES)
PLAIN = encode(
    Message(Kind.STATE, {"time": 0.5, "T": np.arange(6.0).reshape(2, 3), "note": "warm"}, {"time": "s", "T": "K"})
)


@given(MESSAGES, st.text("msKg/23 ", max_size=12))
def test_what_goes_in_comes_out(message, unit):
    sent = Message(message.kind, message.values, dict.fromkeys(message.values, unit))
    received = decode(encode(sent))
    assert received.kind is sent.kind
    assert list(received.values) == list(sent.values)
    assert received.units == sent.units
    for name, value in sent.values.items():
        if isinstance(value, str):
            assert received[name] == value
        else:
            assert received[name].shape == value.shape
            assert received[name].dtype == value.dtype
            assert received[name].tobytes() == value.tobytes()


@given(st.data())
def test_every_truncation_is_refused(data):
    cut = data.draw(st.integers(0, len(PLAIN) - 1))
    with pytest.raises(MessageError):
        decode(PLAIN[:cut])


@given(st.integers(0, len(PLAIN) - 1), st.integers(1, 255))
def test_every_damaged_byte_is_noticed(place, change):
    damaged = bytearray(PLAIN)
    damaged[place] ^= change
    if bytes(damaged[6:8]) != PLAIN[6:8] and damaged[6] in list(Kind) and damaged[7] == 0:
        assert decode(bytes(damaged)).kind is Kind(damaged[6])  # the kind is outside the checksum: another valid one
        return
    with pytest.raises(MessageError):
        decode(bytes(damaged))


@given(st.binary(max_size=300))
def test_garbage_is_refused(garbage):
    with pytest.raises(MessageError) as error:
        decode(garbage)
    assert "\n" not in str(error.value)


@given(st.binary(max_size=200))
def test_a_garbage_body_with_a_right_checksum_is_read_to_its_end_or_refused(body):
    data = HEADER.pack(MAGIC, VERSION, Kind.STATE, len(body), zlib.crc32(body), 0) + body
    with contextlib.suppress(MessageError):
        assert encode(decode(data))


def header(magic=MAGIC, version=VERSION, kind=Kind.DONE, length=4, crc=None, zero=0):
    body = struct.pack("<I", 0)
    return HEADER.pack(magic, version, kind, length, zlib.crc32(body) if crc is None else crc, zero) + body


@pytest.mark.parametrize("wrong, says", [
    ({"magic": b"HTTP"}, "begins with b'HTTP'; one of sdph with b'SDPH'"),
    ({"version": VERSION + 1}, f"protocol version {VERSION + 1}"),
    ({"kind": 77}, "unknown kind"),
    ({"length": 2**40}, "at most"),
    ({"crc": 1}, "checksum"),
    ({"zero": 7}, "the last word of its header is 7; one of sdph has 0: run"),
])  # fmt: skip
def test_a_wrong_header_is_named(wrong, says):
    assert decode(header()).kind is Kind.DONE
    with pytest.raises(MessageError, match=says):
        decode(header(**wrong))


def body_of(*fields: bytes) -> bytes:
    body = struct.pack("<I", len(fields)) + b"".join(fields)
    return HEADER.pack(MAGIC, VERSION, Kind.STATE, len(body), zlib.crc32(body), 0) + body


def test_a_huge_shape_is_refused_before_memory_is_taken():
    field = b"\x01T\x00" + struct.pack("<BB4I", 0, 4, *[2**32 - 1] * 4)
    with pytest.raises(MessageError, match="ends in the middle"):
        decode(body_of(field))


@pytest.mark.parametrize("extents", [(0, 2**32 - 1, 2**32 - 1, 2**32 - 1), (2**32 - 1, 2**32 - 1, 0), (2**31, 0, 3)])
@pytest.mark.parametrize("dtype", [0, 1])
def test_an_extent_of_0_does_not_hide_the_others(extents, dtype):
    field = b"\x01T\x00" + struct.pack(f"<BB{len(extents)}I", dtype, len(extents), *extents)
    with pytest.raises(MessageError, match="impossible shape"):
        decode(body_of(field + bytes(-(4 + len(field)) % 8)))


def test_unknown_types_double_names_and_bad_text_are_refused():
    with pytest.raises(MessageError, match="unknown type"):
        decode(body_of(b"\x01T\x00" + struct.pack("<BB", 9, 0)))
    text = b"\x01n\x00" + struct.pack("<BBI", 2, 1, 1)
    padded = text + bytes(-(4 + len(text)) % 8)
    with pytest.raises(MessageError, match="not UTF-8"):
        decode(body_of(padded + b"\xff"))
    empty = b"\x01n\x00" + struct.pack("<BBI", 2, 1, 0)
    first = empty + bytes(-(4 + len(empty)) % 8)
    second = empty + bytes(-(4 + len(first) + len(empty)) % 8)
    with pytest.raises(MessageError, match="twice"):
        decode(body_of(first, second))


@pytest.mark.parametrize("kind", [Kind.ERROR, Kind.UNFINISHED])
def test_what_is_told_to_people_is_read_whatever_its_bytes_are(kind):
    """It may quote a file, or a path."""
    field = b"\x04text\x00" + struct.pack("<BBI", 2, 1, 6)
    body = struct.pack("<I", 1) + field + bytes(-(4 + len(field)) % 8) + b"no \xff\xc3\n"
    data = HEADER.pack(MAGIC, VERSION, kind, len(body), zlib.crc32(body), 0) + body
    assert decode(data).text("text") == "no \\xff\\xc3\n"


def test_a_text_that_is_not_utf_8_is_not_sent():
    path = os.fsdecode(b"/tmp/\xff\n" + b"x" * 200)
    for message in (Message(Kind.CHECKPOINT, {"folder": path}), Message(Kind.STATE, {path: 1.0})):
        with pytest.raises(MessageError, match="cannot be sent: it is no text in UTF-8; give another") as told:
            encode(message)
        assert str(told.value).isprintable() and len(str(told.value)) < 200


def test_what_cannot_be_sent_is_named():
    with pytest.raises(MessageError, match="'T' is of type complex128"):
        encode(Message(Kind.STATE, {"T": np.zeros(2, complex)}))
    with pytest.raises(MessageError, match="at most 255"):
        encode(Message(Kind.STATE, {"x" * 300: 1.0}))
    with pytest.raises(MessageError, match="at most 100 are allowed"):
        encode(Message(Kind.STATE, {"T": np.zeros(100)}), limit=100)


def test_limits_grow_with_the_mesh():
    assert message_limit(1000) < message_limit(2000) < ABSOLUTE_LIMIT
    assert message_limit(10**12) == ABSOLUTE_LIMIT
    cells = 1000
    everything = {name: np.zeros((cells, 3)) for name in "abcd"}
    assert len(encode(Message(Kind.ADVANCE, everything), message_limit(cells))) > 8 * 12 * cells


def test_the_limit_grows_by_what_the_largest_message_does():
    """All fields, or all sources, of a cell, and its centre and volume."""

    def size(table, cells):
        return len(encode(Message(Kind.STATE, {name: np.zeros((cells, row[1])) for name, row in table.items()})))

    largest = max(size(table, 2000) - size(table, 1000) for table in (SOURCES, FIELDS | ON_REQUEST))
    assert message_limit(2000) - message_limit(1000) == largest + 8 * 4 * 1000


def test_fields_are_asked_for_with_their_form():
    message = decode(PLAIN)
    assert message.text("note") == "warm" and message.number("time") == 0.5
    assert message.array("T", None, 3).shape == (2, 3)
    for wrong in (
        lambda: message.text("T"),
        lambda: message.number("T"),
        lambda: message.number("note"),
        lambda: message.array("T", 3, 2),
    ):
        with pytest.raises(MessageError, match="STATE: field '(T|note)' is"):
            wrong()


def test_a_missing_field_is_named():
    with pytest.raises(MessageError, match="STATE lacks the field 'pressure'; it has time, T, note"):
        decode(PLAIN)["pressure"]
