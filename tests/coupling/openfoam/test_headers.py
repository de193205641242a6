"""Headers from the source package of the distribution, by apt as it is here, from an archive made up."""

import hashlib
import io
import shutil
import subprocess
import tarfile

import pytest

from coupling.openfoam import headers

pytestmark = pytest.mark.openfoam


def mirror(folder) -> str:
    """A source package of the version that is here, of which the mirror has nothing but the archive; its line for
    apt."""
    command = ["dpkg-query", "-W", "-f", "${source:Version}", "openfoam"]
    version = subprocess.run(command, capture_output=True, text=True).stdout
    folder.mkdir()
    archive = folder / f"openfoam_{version.rpartition('-')[0]}.orig.tar.gz"
    with tarfile.open(archive, "w:gz") as made:
        for name in ("src/OpenFOAM/Make/files", "src/OpenFOAM/label.H", "src/other/none.H", "src/OpenFOAM/../../out.H"):
            made.addfile(tarfile.TarInfo(f"openfoam-{version}/{name}"), io.BytesIO())
    missing = [archive.name.replace(".orig.tar.gz", end) for end in (".debian.tar.xz", ".dsc")]
    content = archive.read_bytes()
    own = (hashlib.sha256(content).hexdigest(), len(content), archive.name)
    rows = [own, *(("0" * 64, 1, name) for name in missing)]
    sums = "".join(f" {digest} {size} {name}\n" for digest, size, name in rows)
    files = sums.replace(rows[0][0], hashlib.md5(content).hexdigest()).replace("0" * 64, "0" * 32)
    head = f"Package: openfoam\nBinary: openfoam\nVersion: {version}\nArchitecture: any\nFormat: 3.0 (quilt)\n"
    (folder / "Sources").write_text(f"{head}Directory: .\nFiles:\n{files}Checksums-Sha256:\n{sums}\n")
    return f"deb-src [trusted=yes] copy:{folder} ./"


@pytest.mark.skipif(shutil.which("apt-get") is None, reason="apt-get is not here")
def test_a_mirror_without_the_description(tmp_path, monkeypatch):
    line = mirror(tmp_path / "mirror")
    monkeypatch.setattr(headers, "_source_lines", lambda: [line])
    headers.fetch(tmp_path / "tree", lambda _: None)
    files = (path for path in (tmp_path / "tree").rglob("*") if not path.is_dir())
    found = sorted(str(path.relative_to(tmp_path / "tree")) for path in files)
    assert found == ["src/OpenFOAM/Make/files", "src/OpenFOAM/label.H", "src/OpenFOAM/lnInclude/label.H"]
    assert not (tmp_path / "out.H").exists()
