# Sphinx makes the pages of docs/ with this (build.py). Its search is a script and no request, so it works from a folder, too.
from pygments.lexers.asm import NasmLexer
from pygments.lexers.c_cpp import CLexer

project = "ipos"
language = "en"
extensions = ["myst_parser"]
source_suffix = {".md": "markdown"}
root_doc = "index"
myst_heading_anchors = 6  # names of headings as Git servers make them

suppress_warnings = ["misc.highlighting_failure"]  # of programs that are wrong on purpose

highlight_language = "text"  # of a fence that names none
html_theme = "furo"
html_title = "ipos"
html_copy_source = False
html_show_sourcelink = False
html_show_search_summary = False  # it would fetch the pages found
html_show_sphinx = False
html_use_index = False
html_permalinks_icon = "#"


def setup(app):
    app.add_lexer("ipc", CLexer)
    app.add_lexer("ipa", NasmLexer)
