"""The floors of the house (.importlinter): rooms import what lies below them alone, and no module by way of others
itself."""

import grimp
from importlinter.cli import lint_imports

from sdph.scenes import paths

ROOT = paths.PACKAGE.parent


def test_rooms_import_only_what_lies_below_them(capsys):
    broken = lint_imports(config_filename=str(ROOT / ".importlinter"), no_cache=True)
    assert not broken, capsys.readouterr().out


def test_no_circle_is_hidden_in_a_function():
    """Modules whose imports have all been taken away are taken away, those in functions counted; a circle would
    stay."""
    graph = grimp.build_graph("sdph", "coupling", cache_dir=None)
    left = {name: graph.find_modules_directly_imported_by(name) for name in graph.modules}
    assert len(left) > 200
    while free := [name for name, needs in left.items() if not needs & left.keys()]:
        for name in free:
            del left[name]
    assert not left, f"on circles, or above one: {sorted(left)}"
