"""Files of OpenFOAM cases, as tests of their code write them."""

HEADER = 'FoamFile {{ version 2.0; format {}; class {}; object x; arch "LSB;label=32;scalar=64"; }}\n'
DICTIONARY = HEADER.format("ascii", "dictionary")


def put(case, name, content):
    """A file of the case."""
    path = case / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content.encode() if isinstance(content, str) else content)
