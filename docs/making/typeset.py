"""Equations as SVG in the page itself: typeset when the site is built, so that it needs no script and no network."""

from __future__ import annotations

from functools import cache
from html import escape

import ziamath
from sphinx.util import logging
from sphinx.util.math import get_node_equation_number

LOG = logging.getLogger(__name__)
SIZE = 16.0  # px of an em
ziamath.config.svg2 = False  # no names in a page that another equation could have too
ziamath.config.precision = 2
ziamath.config.math.color = "currentColor"  # of the text around it, light or dark


@cache
def svg(latex: str, inline: bool) -> str:
    """An equation as an <svg> that scales with the text around it; its LaTeX is what screen readers read."""
    drawn = ziamath.Latex(latex, size=SIZE, inline=inline)
    if "\\" in drawn.mathmlstr():
        raise ValueError("a command that is not known")
    element = drawn.svgxml()
    for side in ("width", "height"):
        element.set(side, f"{float(element.get(side)) / SIZE:.3f}em")
    element.set("style", f"vertical-align: {drawn.getyofst() / SIZE:.3f}em")
    element.set("role", "img")
    element.set("aria-label", latex)
    return ziamath.zmath.ET.tostring(element, encoding="unicode")


def drawn(latex: str, inline: bool, node) -> str:
    """The same; what cannot be drawn is a warning, and stands as text."""
    try:
        return svg(latex, inline)
    except Exception as error:  # of a parser that tells of a slip in many ways
        LOG.warning("equation cannot be typeset (%r): %s", error, latex, location=node)
        return f"<code>{escape(latex)}</code>"


def visit_math(self, node) -> None:
    self.body.append(f'<span class="math">{drawn(node.astext(), True, node)}</span>')
    raise _skip()


def visit_displaymath(self, node) -> None:
    self.body.append(self.starttag(node, "div", CLASS="math"))
    self.body.append(f'<span class="drawn">{drawn(node.astext(), False, node)}</span>')
    if node["number"]:
        self.body.append(f'<span class="eqno">({get_node_equation_number(self, node)})')
        self.add_permalink_ref(node, "Link to this equation")
        self.body.append("</span>")
    self.body.append("</div>\n")
    raise _skip()


def _skip() -> Exception:
    from docutils import nodes

    return nodes.SkipNode()


def setup(app):
    """Register the renderer."""
    app.add_html_math_renderer("typeset", (visit_math, None), (visit_displaymath, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
