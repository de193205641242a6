"""Settings of the documentation: `make docs`, or `sphinx-build -W -E docs docs/site`; without -E changes of docs/making
are not seen.

Pages that are made from the code are written by `docs/making` before Sphinx reads anything.
"""

import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE.parent), str(HERE)]

from making import pages  # noqa: E402

import sdph  # noqa: E402

pages.write(HERE)

project, author, release = "sdph", "The sdph authors", sdph.__version__
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx_copybutton", "making.typeset", "making.sources"]
myst_enable_extensions = ["attrs_block", "attrs_inline", "colon_fence", "dollarmath"]
myst_heading_anchors = 3
exclude_patterns = ["generated/*", "site"]  # the first are parts of pages
toc_object_entries = False  # hundreds of laws, on every page
default_role = "code"  # of docstrings, where single backticks stand around code
autodoc_member_order = "bysource"
autodoc_typehints = "description"
html_theme, html_title = "furo", f"sdph {release}"
html_math_renderer = "typeset"
html_static_path, html_css_files = ["_static"], ["sdph.css"]
html_show_sourcelink = html_copy_source = html_show_copyright = False
suppress_warnings = ["myst.header"]  # docstrings and READMEs begin where they stand, at any level
numfig = math_numfig = True  # equations by chapter
numfig_secnum_depth = 1
math_eqref_format = "({number})"
