"""Harm to the checkpoints of a run that is done with care: sums and lengths in the manifest fit to what the files then
hold."""

import hashlib
import io
import json
import os
import pickle
import zipfile

import numpy as np

from coupling.transport.messages import Message, decode, encode

NASTY = (
    None, True, False, 0, 1, -1, 7, 2**31, 2**63, 10**400, 0.0, -0.5, 1e-300, 1e300, -1e300, float("nan"), float("inf"),
    -float("inf"), "", "text", "\ud800", "\x1b[2J\n", "../../x", [], {}, [1, "a"], {"a": 1}, {"array": "0"},
    {"array": "999"}, {"array": 5}, {"array": ["0"]},
)  # fmt: skip


def checkpoints(run):
    return sorted((run / "checkpoints").glob("[0-9]*"))


def certify(folder):
    """A manifest that fits to the files, whatever they hold."""
    path = folder / "manifest.json"
    manifest = json.loads(path.read_text())
    files = [file for file in folder.rglob("*") if file.is_file() and file != path]
    manifest["files"] = {str(file.relative_to(folder)): hashlib.sha256(file.read_bytes()).hexdigest() for file in files}
    manifest["bytes"] = {str(file.relative_to(folder)): file.stat().st_size for file in files}
    path.write_text(json.dumps(manifest))


def places(value, found):
    """(table or list, key) of everything in a value of JSON."""
    for key, part in value.items() if isinstance(value, dict) else enumerate(value):
        found.append((value, key))
        if isinstance(part, (dict, list)):
            places(part, found)
    return found


def harm_json(rng, table):
    """One or two values of a table replaced, removed, added, repeated or exchanged."""
    for _ in range(int(rng.integers(1, 3))):
        found = places(table, [])
        where, key = found[rng.integers(len(found))]
        how = rng.integers(8)
        if how < 4:
            where[key] = NASTY[rng.integers(len(NASTY))]
        elif how == 4:
            del where[key]
        elif how == 5 and isinstance(where, dict):
            where[("new", "array", "", "\x00")[rng.integers(4)]] = NASTY[rng.integers(len(NASTY))]
        elif how == 6 and isinstance(where[key], list) and where[key]:
            where[key] *= int(rng.integers(2, 5))
        else:
            other, name = found[rng.integers(len(found))]
            if name in other if isinstance(other, dict) else name < len(other):
                where[key] = json.loads(json.dumps(other[name]))
    return table


def other_number(rng, array):
    """One value, or all, become what no run leaves."""
    array = array.copy()
    if array.dtype.kind in "fiu" and array.size:
        worst = {
            "f": (np.nan, np.inf, -np.inf, 1e300, -1e300, 1e-300, 0.0, -1.0),
            "i": (-1, -128, 127, 100, 0),
            "u": (0, 1, 127),
        }[array.dtype.kind]
        value = np.array(worst[rng.integers(len(worst))]).astype(array.dtype)
        if array.dtype == np.int64 and rng.random() < 0.5:
            value = np.int64((2**62, -(2**62), 10**9)[rng.integers(3)])
        array[... if rng.random() < 0.3 else np.unravel_index(rng.integers(array.size), array.shape)] = value
    return array


ARRAY_HARMS = (
    other_number, other_number, other_number, other_number,
    lambda rng, a: a[:-1] if a.ndim else np.zeros(3),
    lambda rng, a: np.concatenate((a, a)) if a.ndim else a[None],
    lambda rng, a: a[:0] if a.ndim else np.array("text"),
    lambda rng, a: a[..., None],
    lambda rng, a: a.astype((np.float32, np.int64, np.int8, complex, bool, "S3")[rng.integers(6)],
    casting="unsafe") if a.dtype.kind in "fi" else a, lambda rng,
    a: np.frombuffer(rng.bytes(a.nbytes), a.dtype).reshape(a.shape) if a.dtype.kind in "fi" else a,
    lambda rng, a: rng.permutation(a) if a.ndim else a,
    lambda rng, a: np.asfortranarray(a) * 2 if a.dtype.kind in "fi" else a,
    lambda rng, a: np.array([{"a": 1}, None], object),
    lambda rng, a: a.astype(">f8") if a.dtype.kind == "f" else a,
    lambda rng, a: None,
)  # fmt: skip


def harm_arrays(rng, path):
    """One array of a file is another, is gone, or one more is there."""
    with np.load(path) as saved:
        arrays = dict(saved)
    names = list(arrays)
    if rng.random() < 0.1 or not names:
        arrays[("999", "", "../x")[rng.integers(3)]] = np.zeros(2)
    else:
        name = names[rng.integers(len(names))]
        with np.errstate(all="ignore"):
            arrays[name] = ARRAY_HARMS[rng.integers(len(ARRAY_HARMS))](rng, arrays[name])
        if arrays[name] is None:
            del arrays[name]
    (np.savez_compressed if rng.random() < 0.1 else np.savez)(path, **arrays)


def lying_member(shape, dtype="<f8", data=b""):
    head = f"{{'descr': '{dtype}', 'fortran_order': False, 'shape': {shape}, }}".encode().ljust(117) + b"\n"
    return b"\x93NUMPY\x01\x00" + len(head).to_bytes(2, "little") + head + data


def bomb(path):
    """A file of arrays that promise more than there is."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("0.npy", lying_member((2**24,), data=bytes(2**27)))


def with_member(data):
    def write(path):
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr("0.npy", data)

    return write


def pickled(path):
    path.write_bytes(pickle.dumps(os.system))


def of_objects(path):
    stream = io.BytesIO()
    np.save(stream, np.array([os.system], object), allow_pickle=True)
    with_member(stream.getvalue())(path)


FILE_HARMS = (
    bomb, pickled, of_objects,
    with_member(lying_member((10**12,))), with_member(lying_member((0, 2**62, 2**62))),
    with_member(lying_member("(" * 5000)), with_member(lying_member((10**12,), "<U0")),
    with_member(lying_member((1,), "<U999999999")), with_member(b""), with_member(b"\x93NUMPY\x02\x00"),
    lambda path: path.write_bytes(b""), lambda path: path.write_bytes(b"PK\x05\x06" + bytes(18)),
    lambda path: path.write_bytes(path.read_bytes()[:-40]),
    lambda path: path.write_bytes(path.read_bytes() + bytes(30)),
    lambda path: path.write_bytes(path.read_bytes()[:-12] + b"\xff" * 8 + path.read_bytes()[-4:]),
)  # fmt: skip
TEXTS = (
    "", "[]", "null", "5", '"x"', "{", "[" * 200_000, '{"a":' * 200_000, "[" * 100 + "]" * 100,
    "[" + "[]," * 10**6 + "[]]", "9" * 10**5, "\x00", "{}", '{"array": "0"}', "NaN",
)  # fmt: skip


def harm_whole(rng, run):
    """A file of the newest checkpoint is another altogether."""
    folder = checkpoints(run)[-1]
    if rng.random() < 0.5:
        file = folder / ("manifest.json", "numbers.json")[rng.integers(2)]
        file.write_text(TEXTS[rng.integers(len(TEXTS))])
        if file.name == "manifest.json":
            return
    else:
        FILE_HARMS[rng.integers(len(FILE_HARMS))](folder / "arrays.npz")
    certify(folder)


def harm_numbers(rng, run):
    for folder in checkpoints(run)[-int(rng.integers(1, 3)) :]:
        table = json.loads((folder / "numbers.json").read_text())
        (folder / "numbers.json").write_text(json.dumps(harm_json(rng, table)))
        certify(folder)


def harm_manifest(rng, run):
    path = checkpoints(run)[-1] / "manifest.json"
    path.write_text(json.dumps(harm_json(rng, json.loads(path.read_text()))))


def harm_stored(rng, run):
    for folder in checkpoints(run)[-int(rng.integers(1, 3)) :]:
        harm_arrays(rng, folder / "arrays.npz")
        certify(folder)


def harm_message(rng, path):
    """A field of a message in a file is another, is gone, or is of another form; its checksum fits."""
    message = decode(path.read_bytes())
    values, name = dict(message.values), list(message.values)[rng.integers(len(message.values))]
    if rng.random() < 0.2:
        del values[name]
    elif isinstance(values[name], str) or rng.random() < 0.2:
        values[name] = ("", "drag drag", "heat", 7, np.zeros(3), np.zeros((2, 2)), 2.5)[rng.integers(7)]
    else:
        with np.errstate(all="ignore"):
            harmed = ARRAY_HARMS[rng.integers(6)](rng, np.asarray(values[name]))
        values[name] = harmed if harmed.dtype.kind in "fi" else 1
    path.write_bytes(encode(Message(message.kind, values, message.units)))


def harm_gas(rng, run):
    """The gas's file: arrays of the embedded gas, bytes of OpenFOAM's."""
    folder = checkpoints(run)[-1]
    for path in (folder / "gas").glob("*"):
        if path.suffix == ".npz" and rng.random() < 0.9:
            harm_arrays(rng, path)
        elif path.suffix != ".npz" and rng.random() < 0.7:
            harm_message(rng, path)
        elif rng.random() < 0.3:
            path.unlink()
        else:
            data = bytearray(path.read_bytes())
            for _ in range(int(rng.integers(1, 4))):
                data[rng.integers(len(data))] = int(rng.integers(256))
            path.write_bytes(data[: int(rng.integers(1, len(data)))] if rng.random() < 0.5 else data)
    certify(folder)


HARMS = (
    harm_whole,
    harm_numbers,
    harm_numbers,
    harm_numbers,
    harm_manifest,
    harm_stored,
    harm_stored,
    harm_stored,
    harm_gas,
)
