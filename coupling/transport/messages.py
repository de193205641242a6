"""The wire format between particles and gas: named, shaped, united arrays in small checked messages.

    header  magic "SDPH" | u16 version | u16 kind | u64 body length | u32 crc32 of the body | u32 zero
    body    u32 count, then per field: u8 length + name | u8 length + unit | u8 dtype | u8 ndim
            | u32 per dimension | zeros up to a multiple of 8 of the body | data

Everything is little-endian. dtype 0 is float64, 1 int64, 2 UTF-8 text (one dimension: its bytes). Whatever
does not fit raises `MessageError` with one line that says what; nothing received is ever executed. The text of `TOLD`
is read whatever its bytes are: it may quote a file.
`sdphGasFoam/wire.H` is the same format in C++.
"""

from __future__ import annotations

import hmac
import math
import struct
import zlib
from dataclasses import dataclass, field
from enum import IntEnum

import numpy as np

from coupling.gas import FIELDS, ON_REQUEST, SOURCES
from sdph.engine.reading import one_line

MAGIC = b"SDPH"
VERSION = 2
HEADER = struct.Struct("<4sHHQII")

ABSOLUTE_LIMIT = 2**31  # bytes of one message, whatever the mesh
FIXED_PART = 2**18  # bytes of names, units, budget and texts that do not grow with the mesh
GREETING_LIMIT = 2**12  # bytes of the first message, which is read before anybody knows who sends it
MAX_FIELDS = 256
MAX_DIMENSIONS = 4
SHORT = 80  # letters of a text in a line that says what is wrong with it; our choice

F64, I64, UTF8 = 0, 1, 2
NUMBERS = {F64: np.dtype("<f8"), I64: np.dtype("<i8")}


class MessageError(RuntimeError):
    """A message that is not what the format allows: what it holds, and what was expected."""


class Kind(IntEnum):
    """Kinds of messages."""

    HELLO = 1  # gas -> sdph, first of all: secret
    START = 2  # sdph -> gas: sources to come, initial alpha_g
    STATE = 3  # gas -> sdph: time, fields, budget
    ADVANCE = 4  # sdph -> gas: dt, sources
    CHECKPOINT = 5  # sdph -> gas: folder
    RESTORE = 6  # sdph -> gas: folder
    DONE = 7  # gas -> sdph: a checkpoint is written
    ERROR = 8  # either way: text
    CLOSE = 9  # sdph -> gas: end
    MESH = 10  # gas -> sdph, after HELLO: mesh, properties
    UNFINISHED = 11  # gas -> sdph: why it could not finish a step; it can retreat
    RETREAT = 12  # sdph -> gas: go back to where the last step began


TOLD = (Kind.ERROR, Kind.UNFINISHED)  # kinds whose text is for people


@dataclass(frozen=True)
class Message:
    """`values` name -> array, number or text; `units` name -> unit (none: a pure number or a text)."""

    kind: Kind
    values: dict = field(default_factory=dict)
    units: dict = field(default_factory=dict)

    def __getitem__(self, name: str):
        if name not in self.values:
            raise MessageError(f"{self.kind.name} lacks the field {name!r}; it has {', '.join(self.values) or 'none'}")
        return self.values[name]

    def text(self, name: str) -> str:
        """A field that has to be a text."""
        if not isinstance(self[name], str):
            raise MessageError(f"{self.kind.name}: field {name!r} is no text")
        return self[name]

    def number(self, name: str) -> float:
        """A field that has to be one number."""
        return self.array(name).item()

    def array(self, name: str, *shape: int | None) -> np.ndarray:
        """A field that has to be numbers of this shape; None where any extent will do."""
        value = np.asarray(self[name])
        if (
            value.dtype.kind not in "fi"
            or len(value.shape) != len(shape)
            or any(b not in (a, None) for a, b in zip(value.shape, shape))
        ):
            raise MessageError(
                f"{self.kind.name}: field {name!r} is of type {value.dtype} and shape {value.shape}; numbers of shape "
                f"{shape} were expected"
            )
        return value


def secret_fits(first: Message, secret: str) -> bool:
    """True where the first message carries the secret of the run, compared in constant time."""
    given = first.values.get("secret")
    return isinstance(given, str) and hmac.compare_digest(given.encode(), secret.encode())


def message_limit(cells: int) -> int:
    """Bytes that the largest message on a mesh of `cells` cells can have: centres, volumes, all fields, or all
    sources."""
    components = 4 + max(sum(row[1] for row in table.values()) for table in (SOURCES, FIELDS | ON_REQUEST))
    return min(ABSOLUTE_LIMIT, FIXED_PART + 8 * components * cells)


def encode(message: Message, limit: int = ABSOLUTE_LIMIT) -> bytes:
    """Header and body as bytes."""
    pieces = [struct.pack("<I", len(message.values))]
    length = 4
    for name, value in message.values.items():
        head, data = _encode_field(name, message.units.get(name, ""), value)
        head += bytes(-(length + len(head)) % 8)
        pieces += head, data
        length += len(head) + len(data)
    if length > limit:
        raise MessageError(f"{message.kind.name} is {length} bytes long; at most {limit} are allowed")
    body = b"".join(pieces)
    return HEADER.pack(MAGIC, VERSION, message.kind, length, zlib.crc32(body), 0) + body


def _encode_field(name: str, unit: str, value) -> tuple[bytes, bytes]:
    if isinstance(value, str):
        data = _utf8(value)
        dtype, shape = UTF8, (len(data),)
    else:
        array = np.asarray(value)
        dtype = _dtype_code(name, array)
        data, shape = np.ascontiguousarray(array, NUMBERS[dtype]).tobytes(), array.shape
    head = _short_text(name) + _short_text(unit) + struct.pack("<BB", dtype, len(shape))
    return head + struct.pack(f"<{len(shape)}I", *shape), data


def _dtype_code(name: str, array: np.ndarray) -> int:
    if array.dtype.kind == "f":
        return F64
    if array.dtype.kind in "iub":
        return I64
    raise MessageError(f"field {name!r} is of type {array.dtype}; float64, int64 and text can be sent")


def _utf8(text: str) -> bytes:
    try:
        return text.encode()
    except UnicodeEncodeError:
        raise MessageError(f"{one_line(text, SHORT)!r} cannot be sent: it is no text in UTF-8; give another") from None


def _short_text(text: str) -> bytes:
    data = _utf8(text)
    if len(data) > 255:
        raise MessageError(f"{one_line(text, SHORT)!r} is {len(data)} bytes long; a name or unit has at most 255")
    return bytes([len(data)]) + data


def read_header(header: bytes, limit: int = ABSOLUTE_LIMIT) -> tuple[Kind, int, int]:
    """kind, length [bytes] and crc32 of the body that follows `header`."""
    if len(header) != HEADER.size:
        raise MessageError(f"a header has {HEADER.size} bytes; got {len(header)}")
    magic, version, kind, length, crc, zero = HEADER.unpack(header)
    if magic != MAGIC:
        raise MessageError(f"not a message of sdph: it begins with {magic!r}; one of sdph with {MAGIC!r}")
    if version != VERSION:
        raise MessageError(f"protocol version {version}; this is version {VERSION}: run `sdph openfoam setup` again")
    if kind not in list(Kind):
        raise MessageError(f"unknown kind of message {kind}; {min(Kind)} to {max(Kind)} are known")
    if zero != 0:
        raise MessageError(
            f"not a message of sdph: the last word of its header is {zero}; one of sdph has 0: run "
            "`sdph openfoam setup` again"
        )
    if length > (most := min(limit, ABSOLUTE_LIMIT)):
        raise MessageError(f"{Kind(kind).name} says it is {length} bytes long; at most {most} are allowed here")
    return Kind(kind), length, crc


def decode(data: bytes, limit: int = ABSOLUTE_LIMIT) -> Message:
    """The message in `data`, header included."""
    kind, length, crc = read_header(bytes(data[: HEADER.size]), limit)
    body = memoryview(data)[HEADER.size :]
    if len(body) != length:
        raise MessageError(f"{kind.name} has {len(body)} bytes where its header says {length}")
    return decode_body(kind, crc, body)


def decode_body(kind: Kind, crc: int, body) -> Message:
    """The message whose header was read already. Arrays are views of `body`."""
    if zlib.crc32(body) != crc:
        raise MessageError(f"{kind.name} was damaged on its way: the checksum does not fit")
    reader = _Reader(kind, memoryview(body))
    values, units = {}, {}
    count = reader.number("<I")
    if count > MAX_FIELDS:
        raise MessageError(f"{kind.name} says it has {count} fields; at most {MAX_FIELDS} are allowed")
    for _ in range(count):
        name, unit, value = reader.field()
        if name in values:
            raise MessageError(f"{kind.name} has the field {name!r} twice")
        values[name], units[name] = value, unit
    if reader.place != len(body):
        raise MessageError(f"{kind.name} has {len(body) - reader.place} bytes after its last field")
    return Message(kind, values, units)


class _Reader:
    """Takes a body apart from front to back; never reads past its end."""

    def __init__(self, kind: Kind, body: memoryview):
        self.kind, self.body, self.place = kind, body, 0

    def take(self, length: int) -> memoryview:
        end = self.place + length
        if end > len(self.body):
            raise MessageError(f"{self.kind.name} ends in the middle of a field")
        piece, self.place = self.body[self.place : end], end
        return piece

    def number(self, code: str) -> int:
        return struct.unpack(code, self.take(struct.calcsize(code)))[0]

    def text(self, length: int) -> str:
        try:
            return str(self.take(length), "utf-8", "backslashreplace" if self.kind in TOLD else "strict")
        except UnicodeDecodeError:
            raise MessageError(f"{self.kind.name} has a text that is not UTF-8") from None

    def field(self):
        name, unit = self.text(self.number("<B")), self.text(self.number("<B"))
        dtype, ndim = self.number("<B"), self.number("<B")
        if dtype not in (F64, I64, UTF8) or ndim > MAX_DIMENSIONS:
            raise MessageError(f"{self.kind.name}: field {name!r} has the unknown type {dtype} in {ndim} dimensions")
        shape = [self.number("<I") for _ in range(ndim)]
        self.take(-self.place % 8)
        if dtype == UTF8:
            return name, unit, self.text(math.prod(shape))
        data = self.take(8 * math.prod(shape))
        if math.prod(max(1, extent) for extent in shape) > ABSOLUTE_LIMIT // 8:  # an extent of 0 hides the others
            raise MessageError(f"{self.kind.name}: field {name!r} has the impossible shape {tuple(shape)}")
        return name, unit, np.frombuffer(data, NUMBERS[dtype]).reshape(shape)
