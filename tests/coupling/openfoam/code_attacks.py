"""Hostile cases: each makes OpenFOAM v1912 run code that came with it, in a way that a look over the text may miss.

An attack changes a folder made by `sdph init disc_cluster`; its OpenFOAM case would then load the library of a `Place`.
Not among them, for they are known from a field report: an `#include` of a file outside in plain words, a linked
`system`, comment signs in strings, `#calc` under polyMesh/ and in a FoamFile header.
"""

import gzip
import hashlib
import shutil
from collections.abc import Callable
from dataclasses import dataclass

from attack_places import HEAD, MESH, Place

WM_OPTIONS = "linux64"  # what a sourced OpenFOAM sets, and its folder of libraries made of code; Debian's does not
UPWARDS = "../" * 20  # from any folder to the root


@dataclass(frozen=True)
class Attack:
    """`edit` makes the case hostile; `programs` of OpenFOAM show that it is (none: only sdph's own run can).

    As root OpenFOAM refuses code that it would have to compile (`as_user`); libraries it loads for anyone.
    """

    edit: Callable[[Place], None]
    programs: tuple[str, ...] = ("blockMesh",)
    as_user: bool = False


ATTACKS: dict[str, Attack] = {}


def attack(programs: tuple[str, ...] = ("blockMesh",), as_user: bool = False):
    def register(edit):
        ATTACKS[edit.__name__] = Attack(edit, programs, as_user)
        return edit

    return register


# Attacks that are a text in system/controlDict, whose `libs` every program opens
IN_CONTROL_DICT = {
    # a keyword that is no word
    "keyword_in_quotes": '"libs" ("@LIB");',
    "keyword_as_pattern": '"[[:lower:]]i[b]." ("@LIB");',
    "keyword_as_pattern_of_parts": '"(nothing|li|bs)*" ("@LIB");',
    "keyword_verbatim": '#{li.s#} ("@LIB");',
    "keyword_of_the_parent": 'notes { "../libs" ("@LIB"); }',
    "keyword_of_the_parent_as_pattern": "notes { \"../'li.s'\" (\"@LIB\"); }",
    "keyword_merged_from_a_dictionary": 'notes { "l.*" ("@LIB"); } $notes;',
    # a value that is no list in round brackets
    "uniform_list": 'libs 1{"@LIB"};',
    "list_from_a_macro": 'notes ("@LIB"); "lib."  $notes;',
    # what looks like a comment or a text, and is none
    "comment_sign_in_a_variable": '$notes//; libs ("@LIB");\n',
    "comment_sign_in_the_variable_of_a_value": 'a 1; b $a//; libs ("@LIB");\n',
    "block_comment_sign_in_a_variable": '$notes/*; libs ("@LIB"); // */\n',
    "comment_sign_in_verbatim": 'a #{ /* #}; libs ("@LIB"); b #{ */ #};',
    "quote_in_verbatim": 'a #{ " #}; libs ("@LIB"); b #{ " #};',
    "backslashes_at_the_end_of_a_text": 'a "\\\\"; libs ("@LIB"); b "\\\\";',
    "backslash_at_the_end_of_a_comment": '// notes \\\nlibs ("@LIB");\n',
    "comment_sign_in_a_condition": '#if 1; /*\nlibs ("@LIB");\n#endif // */\n',
    "comment_sign_in_an_expression": 'a #eval { 1 /* }; libs ("@LIB"); b #eval { 1 }; // */\n',
    "quote_in_an_expression": 'a #eval { 1 " }; libs ("@LIB"); // "\n',
    "long_comment": "// " + "=" * 300_000 + '\nlibs ("@LIB");\n',
    # directives that do not look like one
    "directive_with_blanks": '# /* as\nusual */\n include "@LIST"\n',
    "directive_in_quotes": '"#include" "@LIST"\n',
    "directive_verbatim": '#{#include#} "@LIST"\n',
    "optional_include": '#sinclude "@LIST"\n',
    # names of files that do not look like one
    "file_name_verbatim": "#include #{@LIST#}\n",
    "file_name_from_a_variable": 'where "@LIST"; #include $where\n',
    "file_name_in_two_parts": 'where "@DIR"; what list; #include "$where/${what}"\n',
    "file_name_by_default": '#include "${NOWHERE:-@LIST}"\n',
    "file_name_by_alternative": 'note a; #include "${note:+@LIST}"\n',
    "file_of_etc_that_is_absolute": '#includeEtc "@LIST"\n',
    "file_of_etc_upwards": f'#sincludeEtc "caseDicts/{UPWARDS}@LIST"\n',
    "file_of_etc_by_tag_upwards": f'#include "<etc>/{UPWARDS}@LIST"\n',
    "file_by_tag_of_the_case": '#include "<case>/../../outside/list"\n',
    "file_by_tag_of_home": f'#include "~/{UPWARDS}@LIST"\n',
    "file_beside_the_case_from_the_run": '#include "../../../my_case/list"\n',
    "file_beside_the_case_by_environment": '#include "$PWD/my_case/list"\n',
}  # fmt: skip


def _in_control_dict(text: str) -> Callable[[Place], None]:
    def edit(place: Place) -> None:
        place.add("system/controlDict", f"\n{text}\n")
        place.add("list", 'libs ("@LIB");\n', place.case)

    return edit


ATTACKS |= {name: Attack(_in_control_dict(text)) for name, text in IN_CONTROL_DICT.items()}


# ---- how a file is written -----------------------------------------------------------------------------------------
@attack()
def binary_list_with_a_comment_sign(place):
    """Of a list in a binary file, eight bytes are a number, whatever they look like."""
    place.change("system/controlDict", "ascii", "binary")
    place.add("system/controlDict", 'a List<scalar> 1(/*======); libs ("@LIB"); b List<scalar> 1(======*/);\n')


@attack()
def bytes_of_no_text(place):
    place.add("system/controlDict", b"// \0\xff\xfe\x00\n" + place.filled('libs ("@LIB");\n').encode())


def _packed(place: Place, content: bytes) -> None:
    place.add("system/controlDict", '#include "../constant/notes"\n')
    place.add("constant/notes.gz", content)


def _list(place: Place) -> bytes:
    return place.loader.read_bytes()


@attack()
def gz_that_is_plain_text(place):
    """zlib hands on as it is what it did not pack."""
    _packed(place, _list(place))


@attack()
def gz_without_end(place):
    _packed(place, gzip.compress(_list(place))[:-8])


@attack()
def gz_with_rubbish_at_its_end(place):
    _packed(place, gzip.compress(_list(place)) + b"rubbish")


@attack()
def gz_of_two_members(place):
    _packed(place, gzip.compress(b"note fine;\n") + gzip.compress(_list(place)))


@attack()
def gz_read_as_it_is(place):
    """Harmless when it is unpacked; by its whole name OpenFOAM reads it packed, and the comment in its head is code."""
    packed = gzip.compress(b"note fine;\n", mtime=0)
    comment = b" 1; " + _list(place) + b" /*"
    place.add("constant/notes.gz", packed[:3] + b"\x10" + b"abcdef" + comment + b"\0" + packed[10:])
    assert gzip.decompress((place.gas / "constant/notes.gz").read_bytes()) == b"note fine;\n"
    place.add("system/controlDict", '#include "../constant/notes.gz"\n')


# ---- where a file lies ---------------------------------------------------------------------------------------------
@attack()
def include_of_a_hidden_folder(place):
    place.add("system/controlDict", '#include "../.notes/.list"\n')
    place.add(".notes/.list", 'libs ("@LIB");\n')


@attack()
def include_of_the_readme(place):
    (place.gas / "README").unlink()
    place.add("README", '("@LIB")\n')
    place.add("system/controlDict", '"lib."  #include "../README"\n;\n')


@attack()
def include_from_the_folder_of_the_process(place):
    """`./` is the folder that the program was started in, and not the one of the file that includes."""
    place.add("system/controlDict", '#include "./docs/list"\n')
    place.add("system/docs/list", "note fine;\n")
    place.add("docs/list", 'libs ("@LIB");\n')


@attack()
def include_of_case_toml(place):
    """A comment to one language is code to the other."""
    place.add("system/controlDict", '#include "$PWD/my_case/case.toml"\n')
    place.change("case.toml", "dimensions = 2\n", "", place.case)
    path = place.case / "case.toml"
    path.write_text(place.filled('dimensions = 2 #; "lib." ("@LIB"); /*\n') + path.read_text())


@attack()
def library_in_the_case(place):
    shutil.copy(place.library, place.gas / "constant" / "notes.txt")
    place.add("system/controlDict", '"lib." ("<case>/constant/notes.txt");\n')


# ---- other entries that load a library -----------------------------------------------------------------------------
@attack(())
def library_of_a_linear_solver(place):
    place.change("system/fvSolution", "GAMG;", 'GAMG;\n        algebraicGAMGAgglomerationLibs ("@LIB");')


@attack(())
def library_of_a_linear_solver_as_pattern(place):
    place.change("system/fvSolution", "GAMG;", 'GAMG;\n        ".*Agg.*(x|s)" ("@LIB");')


# ---- texts of case.toml, and files that are made of them -----------------------------------------------------------
# A key of case.toml becomes a keyword of constant/sdphCase
PROBE = '\n[probes."x 0; @ENTRY y"]\nat_m = [0.25, 0.25]\n'
LIBRARY = 'libs (\\"@LIB\\");'
FUNCTION = f"functions {{ notes {{ type none; {LIBRARY} }} }}"


@attack(())
def name_of_a_probe(place):
    place.add("case.toml", PROBE.replace("@ENTRY", LIBRARY), place.case)
    place.add("system/controlDict", '#include "../constant/sdphCase"\n')


@attack(("blockMesh", "checkMesh"))
def name_of_a_patch(place):
    """blockMesh writes it as it is into polyMesh/boundary, which the next program includes."""
    name = '"walls {} b {} ) ; \\"lib.\\" (\\"@LIB\\"); 2 ( c"'
    place.add("system/blockMeshDict", MESH.replace("@WALLS", name))
    place.add("system/controlDict", '#sinclude "../constant/polyMesh/boundary"\n')


# ---- code that OpenFOAM compiles, or finds compiled ----------------------------------------------------------------
def _compiled(place: Place, prefix: str, code: str) -> None:
    """The library of a code, where OpenFOAM looks for it before it compiles one; named by the sum of the code."""
    parts = f"<codeOptions><codeLibs><codeInclude><code>{code}<localCode>"
    name = f"lib{prefix}_{hashlib.sha1(parts.encode()).hexdigest()}.so"
    folder = place.gas / "dynamicCode" / "platforms" / WM_OPTIONS / "lib"
    folder.mkdir(parents=True)
    shutil.copy(place.library, folder / name)


CALCULATED = {
    "calc_with_blanks": 'a # /* of */\n calc "1";',
    "calc_in_quotes": '"#calc" "1";',
    "calc_verbatim": '#{#calc#} "1";',
    "calc_in_a_condition": '#if #calc "1"\n#endif',
    "code_stream_in_quotes": '"#codeStream" { "c[o]de" none; code #{ os << (1); #}; };',
}


def _calculated(text: str) -> Callable[[Place], None]:
    def edit(place: Place) -> None:
        place.add("system/controlDict", f"{text}\n")
        _compiled(place, "codeStream", "os << (1);")

    return edit


ATTACKS |= {name: Attack(_calculated(text), as_user=True) for name, text in CALCULATED.items()}


@attack(as_user=True)
def calc_in_a_function_file(place):
    place.add("system/controlDict", "#includeFunc notes\n")
    place.add("system/notes", 'a # calc "1";\n')
    _compiled(place, "codeStream", "os << (1);")


@attack(as_user=True)
def calc_in_the_time_folder(place):
    place.add("0/uniform/time", HEAD.format("dictionary", "time") + 'a # calc "1";\n')
    _compiled(place, "codeStream", "os << (1);")


def _coded(place: Place, kind: str, before: str = "") -> None:
    """A boundary condition of `kind`, which is to be the one made of code."""
    walls = f"walls {{ {kind} name notes; code #{{ operator==(1); #}}; value uniform 1; }}"
    sides = f"boundaryField {{ {walls} frontAndBack {{ type empty; }} }}\n"
    inside = "dimensions [0 0 0 1 0 0 0]; internalField uniform 350;\n"
    place.add("0/T", HEAD.format("volScalarField", "T") + before + inside + sides)
    _compiled(place, "notes", "operator==(1);")


COMPILED = ("blockMesh", "decomposePar")


@attack(COMPILED, as_user=True)
def coded_boundary_verbatim(place):
    _coded(place, "type #{codedFixedValue#};")


@attack(COMPILED, as_user=True)
def coded_boundary_by_pattern(place):
    _coded(place, '"t.*" "codedFixedValue";')


@attack((), as_user=True)
def coded_boundary_by_the_title(place):
    """The word stands in case.toml alone."""
    title = "Heated disc-shaped cluster of grains in a closed box of hot gas"
    place.change("case.toml", title, "codedFixedValue", place.case)
    _coded(place, "type $title;", '#include "../constant/sdphCase"\n')


@attack((), as_user=True)
def name_of_a_boundary(place):
    """It goes into blockMeshDict and 0/*: case.toml alone is enough, where OpenFOAM can compile."""
    place.change("case.toml", "[boundaries.walls]", '[boundaries."walls # calc \\"1\\""]', place.case)
    _compiled(place, "codeStream", "os << (1);")
