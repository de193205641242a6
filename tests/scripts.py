"""Scripts of validation/, as modules."""

import importlib.util

from sdph.scenes import paths

FOLDER = paths.PACKAGE.parent / "validation"


def script(name: str):
    """validation/<name>.py."""
    spec = importlib.util.spec_from_file_location(name, FOLDER / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
