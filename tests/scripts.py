"""Scripts of validation/ and benchmarks/, as modules."""

import importlib.util

from sdph.scenes import paths

ROOT = paths.PACKAGE.parent
FOLDER = ROOT / "validation"


def script(name: str, folder: str = "validation"):
    """<folder>/<name>.py."""
    spec = importlib.util.spec_from_file_location(name, ROOT / folder / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
