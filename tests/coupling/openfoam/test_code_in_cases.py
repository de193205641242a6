"""Which OpenFOAM cases are refused for code of their own, and which are not."""

import gzip
import os
import shutil
import struct

import pytest
from gas_boxes import TEMPLATE, box_case
from written_cases import DICTIONARY, HEADER, put

from coupling.openfoam import case as case_files
from coupling.openfoam.code import refuse_code
from coupling.openfoam.programs import run as programs
from sdph.scenes import paths
from sdph.schema import CaseError

SHIPPED = sorted(path.parent.parent for path in paths.data("openfoam_case_templates").glob("*/*/system/controlDict"))


@pytest.fixture
def case(tmp_path):
    """An OpenFOAM case to write into."""
    folder = tmp_path / "gas"
    shutil.copytree(TEMPLATE, folder)
    return folder


def refused(case, told=None):
    with pytest.raises(CaseError, match=told) as error:
        refuse_code(case)
    assert "--allow-code" in str(error.value) and "\n" not in str(error.value)


@pytest.mark.parametrize("entry", [
    'note "http://x"; libs ("x.so");', 'a "/*"; libs ("x.so"); b "*/";', '"libs" ("x.so");', "libs(x.so);",
    'sub { libs ("x.so"); }',
    'functionObjectLibs ("x.so");', 'geometricGAMGAgglomerationLibs ("x.so");', 'a "//"; type coded;',
    "type scalarCodedSource;",
    'type "codedFixedValue";', "type systemCall;", "type timeActivatedFileUpdate;", '#calc "1"', '# /* */ calc "1"',
    "a #codeStream { };",
    '"#calc" "1"', '#{#calc#} "1"', '"#include" "/x";', "#codeBlock x", '"li.*" ("x.so");', '"(a|libs)" ("x.so");',
    '"l[i]bs" ("x.so");',
    '"l\\ibs" ("x.so");', '".*" (x.so);', '".*" $a;', '".*" #include "a";', '"a/libs" ("x.so");',
    '"a/ l ibs" ("x.so");', "\"a/'li.*'\" (\"x.so\");",
    '$x/* libs ("x.so"); */', "x List<char> 2(/*); libs (x); // */", "InfoSwitches { }",
    "OptimisationSwitches { fileHandler collated; }",
    '"InfoSwitches" { }', "allowSystemOperations 1;", "$a \"li.*\" (\"x.so\");",
    "FoamFile { #x /* \n } libs (x); /* */ }", 'a "b', "a /* b",
    'FoamFile { #inputMode merge /* \n } libs ("x.so"); /* */', "#eval { 1 // }; libs (x);\n}",
    "#if 1 /* \n libs (x); */", "${{ 1 }} /* libs */",
    "decomposedBlockData", "#nonsense 1", "a ${libs};", "a ${x}/* b */;",
    'FoamFile { "#x" /* \n } libs ("x.so"); /* */', "#remove (a\n\"li.*\" (\"x.so\");",
])  # fmt: skip
def test_code_is_found(case, entry):
    put(case, "constant/extra", f"{DICTIONARY}{entry}\n")
    refused(case)


@pytest.mark.parametrize("entry", [
    '// libs ("x.so");\na 1;', "/* #calc libs */ a 1;", 'note "libs are not code, nor is #calc";',
    'a "http://x/y"; b 1;', '".*" 0.7;',
    '".*" { type zeroGradient; }', '"(U|k).*" { value uniform (0 0 0); }', '"(U|T)" ("a" "b");',
    'patches (".*" "in.*");', '".*" Gauss linear;',
    "a $gas_density;", "a ${gas_density};", "$defaults;", '#include "sdphCase"',
    '#include "../constant/sdphCase" // of sdph', "#include sdphCase",
    '#include "$FOAM_CASE/constant/sdphCase"', '#include "${FOAM_CASE}/constant/sdphCase"',
    '#include "<constant>/sdphCase"',
    '#includeIfPresent "other"', '#sinclude "<system>/other"', '#includeEtc "caseDicts/setConstraintTypes"',
    "#includeFunc mag(U)", "#includeFunc probes",
    "#inputMode merge", "#remove a", '#remove (a "b.*")', '#remove "b.*"', "#if 1\na 1;\n#else\nb 1;\n#endif",
    "#ifeq $a 1\n#endif", 'a #eval "1 + 2";',
    "a #eval { 2 * $b };", 'colour "#ff0000";', "a #{ any \" text // #};", "a List<scalar> 2(1 2);",
    "div(phi,U) Gauss linear;", "codes 5;", "DebugSwitches { }",
])  # fmt: skip
def test_what_is_no_code_passes(case, entry):
    put(case, "constant/extra", f"{DICTIONARY}{entry}\n")
    refuse_code(case)


@pytest.mark.parametrize("target", [
    "/etc/x", "../../x", "../constant/../../x", "~/x", "~user/x", "$HOME/x", "${HOME}/x", "$FOAM_CASE/../x",
    "${FOAM_CASE:-/etc}/x", "<case>/../x", "<etc>/x",
    "<etc:u>/x", "$FOAM_CASEx/x", "$a", "./../x", "..", "../log.blockMesh", "a\\/b", "",
])  # fmt: skip
@pytest.mark.parametrize("directive", ["#include", "#includeIfPresent", "#sinclude"])
def test_includes_that_lead_out_or_nowhere_certain_are_refused(case, directive, target):
    put(case, "constant/extra", f'{DICTIONARY}{directive} "{target}"\n')
    refused(case, "extra: line 2")


@pytest.mark.parametrize("line", [
    '#includeEtc "../x"', '#includeEtc "/x"', '#includeEtc "$x"', '#includeEtc "caseDicts/../../x"',
    '#includeFunc "../x"', '#includeFunc "p(libs=(a))"',
    '#include $x', "#include #{x#}", '#include\n"x"', '#if #include "../x"',
    'FOAM_CASE "/x"; #include "$FOAM_CASE/x"', '"a/FOAM_CASE" "/x";',
])  # fmt: skip
def test_other_ways_out_are_refused(case, line):
    put(case, "constant/extra", f"{DICTIONARY}{line}\n")
    refused(case)


@pytest.mark.parametrize("name", [
    "constant/polyMesh/cellZones", "constant/polyMesh/owner", "constant/polyMesh/sets/a", "0/U", "0.5/U",
    "1e-3/uniform/time", "processor0/constant/polyMesh/boundary",
    "processor1/0/U", "system/blockMeshDict", "constant/region/polyMesh/points", "0.orig/U", "nan/U", "topLevel",
    "constant/triSurface/a.stl", ".hidden/a",
])  # fmt: skip
def test_files_of_all_places_are_read(case, name):
    put(case, name, DICTIONARY.replace("version 2.0", '#calc "1"'))
    refused(case, "#calc")


@pytest.mark.parametrize("header", [
    'FoamFile #calc "1"', 'FoamFile version 2.0; format ascii; libs (x);', "/* */ FoamFile // \n { format $x; }",
    'FoamFile { "form.*" binary; }', "FoamFile { format ascii; format binary; }", "FoamFile { 1 (format binary;) }",
    "FoamFile { format ascii; x } ; format binary; }", "FoamFile { format binary ascii; }", "FoamFile { a { } }",
    'FoamFile { #include "extra" }',
])  # fmt: skip
def test_headers_are_plain(case, header):
    put(case, "constant/polyMesh/points", header)
    refused(case)


@pytest.mark.parametrize("name", ["system/a", "constant/a", "0/a", "nan/a", "other/a", "processor0/a"])
def test_files_without_a_header_are_read_in_all_folders(case, name):
    put(case, name, "libs (x);")
    refused(case, "'libs'")


def test_files_that_no_program_opens_are_read_where_they_are_included(case):
    put(case, "README", 'libs, #calc and " are words here')
    put(case, "constant/triSurface/box.obj", "# it's a box\nlibs 1\n")
    refuse_code(case)
    put(case, "system/extra", '#include "../README"')
    refused(case, "README")


def test_a_table_with_comments_passes_unless_it_is_included(case):
    put(case, "constant/table.dat", "# time value\n0 1\n")
    refuse_code(case)
    put(case, "constant/extra", '#include "table.dat"')
    refused(case, "#time")


def test_compressed_files(case):
    put(case, "constant/fine.gz", gzip.compress(b"// libs\na 1;") + gzip.compress(b"b 1;"))
    refuse_code(case)
    put(case, "constant/not.gz", "libs 1;")  # OpenFOAM reads it as it is
    refused(case, "not.gz")
    put(case, "constant/not.gz", gzip.compress(b"a 1;") + gzip.compress(b"libs 1;"))
    refused(case, "'libs'")
    put(case, "constant/not.gz", gzip.compress(b"a 1;")[:-4])
    refused(case, "unpacked")


@pytest.mark.parametrize("make", [
    lambda case: (case / "constant" / "a").symlink_to("gasProperties"),
    lambda case: (case / "0").symlink_to(case.parent),
    lambda case: (case / "a").symlink_to("nowhere"),
    lambda case: os.mkfifo(case / "constant" / "a"),
    lambda case: put(case, "dynamicCode/platforms/lib/liba.so", b""),
    lambda case: put(case, "processors2/0/U", DICTIONARY),
])  # fmt: skip
def test_links_and_odd_files_are_refused(case, make):
    make(case)
    refused(case)


def test_a_link_to_a_case_is_refused(case, tmp_path):
    (tmp_path / "link").symlink_to(case)
    refused(tmp_path / "link", "is a link")


def binary_field(count, *, after=b";"):
    """A field whose numbers hold what begins a string and a comment."""
    numbers = struct.pack("<d", 1.0)[:-3] + b'"/*'
    head = HEADER.format("binary", "volScalarField").encode()
    return head + b"internalField nonuniform List<scalar> %d(%b)%b" % (count, 3 * numbers, after)


def test_binary_fields_are_stepped_over(case):
    put(case, "0/T", binary_field(3))
    refuse_code(case)
    put(case, "0/T", binary_field(3, after=b'; libs ("x.so"); // */"'))
    refused(case, "'libs'")
    for count in (2, 4, 10**9):
        put(case, "0/T", binary_field(count))
        refused(case, "does not end")


def test_binary_files_of_another_build_or_in_another_s_place_are_refused(case):
    put(case, "0/T", binary_field(3).replace(b"label=32", b"label=64"))
    refused(case, "arch")
    put(case, "0/T", binary_field(3))
    put(case, "0/U", f'{DICTIONARY}#include "T"')
    refused(case, "binary")


def test_binary_meshes_are_stepped_over(case):
    head = HEADER.format("binary", "labelList").encode()
    put(case, "constant/polyMesh/owner", head + b'2(/*"//*"/)\n// end')
    refuse_code(case)
    put(case, "constant/polyMesh/owner", head + b'2(/*"//*"/)\nmore;')
    refused(case, "more than its class")
    put(case, "constant/polyMesh/owner", head + b'5(/*calc  #calc   "1"   );')
    refused(case, "may run code")


def test_a_file_is_read_once_until_it_changes(case):
    known = {}
    refuse_code(case, known)
    before = dict(known)
    put(case, "constant/extra", "a 1;")
    refuse_code(case, known)
    assert before and all(known[name] is findings for name, findings in before.items())
    put(case, "constant/extra", "libs 1;")
    with pytest.raises(CaseError, match="extra"):
        refuse_code(case, known)


@pytest.mark.parametrize("folder", SHIPPED, ids=lambda folder: f"{folder.parent.name}-{folder.name}")
def test_shipped_templates_name_no_code_but_our_libraries(folder):
    if folder.name == "tfm":
        refused(folder, "'libs'")
    else:
        refuse_code(folder)


@pytest.mark.openfoam
@pytest.mark.parametrize("form", ["ascii", "binary"])
@pytest.mark.parametrize("compression", ["off", "on"])
def test_meshes_and_fields_that_openfoam_writes_pass(tmp_path, form, compression):
    case_files.write_case(box_case((0.1, 0.1), 0.01), TEMPLATE, tmp_path / "gas", 2)
    control = tmp_path / "gas" / "system" / "controlDict"
    asked = f"writeCompression {compression}; writeFormat {form}"
    control.write_text(control.read_text().replace("writeFormat     ascii", asked))
    for command in (["blockMesh"], ["decomposePar"]):
        programs.run(command, tmp_path / "gas", tmp_path / "log")
    refuse_code(tmp_path / "gas")
    owner = next((tmp_path / "gas" / "processor1" / "constant" / "polyMesh").glob("owner*"))
    assert owner.suffix == (".gz" if (form, compression) == ("ascii", "on") else "")
