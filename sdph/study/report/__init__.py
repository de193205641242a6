"""`sdph report`: what was run and what came of it, one HTML file that needs nothing else and no network."""

from sdph.study.report.page import write

__all__ = ["write"]
