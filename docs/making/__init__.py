"""Parts of the documentation that are made from the code, so that they cannot go stale.

pages      writes them all
gallery    a page for each scene and study
embedding  READMEs of the repository as pages, their links put right
keys       tables of the keys of a case, with the meanings of docs/keys.toml
docstrings docstrings as Markdown
dashboard  every recorded check of every scene
sources    pages of source files, and the role `src` that leads to a line of one
typeset    equations as pictures in the page (SVG), without scripts or a network
"""
