#!/usr/bin/env python3
"""Syntax of IPOS sources for vim and tree-sitter, made of the compiler's tables.

    syntax.py            writes vim/syntax/ipos.vim, tree-sitter/words.json and tree-sitter/queries/highlights.scm
    syntax.py --check    fails where they differ from what is there, or where a word is missing in the grammar of
                         tools/vscode
"""
import json
import re
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent

# What a word is for: the tables do not say so. A new keyword that stands in none of these is an error.
CONTROL = "if else for while do switch case default break continue return".split()
TYPES = "long struct typedef".split()
MODIFIERS = ["initial"]
OPERATORS = ["numof"]


def table(path, *rows):
    """First texts of the rows of a .def file."""
    text = (ROOT / path).read_text()
    return [word for row in rows for word in re.findall(rf'^{row}\((?:\w+, )?"([^"]+)"', text, re.M)]


def words():
    keywords = table("compiler/preprocess/tokens.def", "KEYWORD")
    foreign = table("compiler/preprocess/tokens.def", "FOREIGN_TYPE", "FOREIGN_QUALIFIER")
    known = CONTROL + TYPES + MODIFIERS + OPERATORS
    unsorted = [word for word in keywords if word not in known]
    directives = re.findall(r'\{"(\w+)", &Preprocessor::', (ROOT / "compiler/preprocess/directives.cpp").read_text())
    conditions = ["if", "ifdef", "ifndef", "elif", "else", "endif"]
    return {
        "control": [word for word in CONTROL if word in keywords],
        "type": [word for word in TYPES if word in keywords],
        "modifier": [word for word in MODIFIERS if word in keywords],
        "operator": [word for word in OPERATORS if word in keywords],
        "foreign": unsorted + foreign,
        "structure": table("stdlib/structures.def", "STRUCTURE"),
        "function": table("stdlib/system_functions.def", "FUNCTION", "SPELLING"),
        "directive": sorted(set(directives) | set(conditions)),
        "punctuator": table("compiler/preprocess/tokens.def", "PUNCTUATOR"),
    }


def vim(w):
    def keywords(group, names):
        return f"syn keyword {group} {' '.join(names)}\n"

    return (
        '" IPOS: sources of drive programs. Made by tools/editors/syntax.py; do not edit.\n'
        'if exists("b:current_syntax")\n  finish\nendif\nsyn case match\n\n'
        + keywords("iposControl", w["control"])
        + keywords("iposType", w["type"])
        + keywords("iposModifier", w["modifier"])
        + keywords("iposWordOperator", w["operator"])
        + keywords("iposForeign", w["foreign"])
        + keywords("iposStructure", w["structure"])
        + keywords("iposSystemFunction", w["function"])
        + r"""syn match iposVariable "\<H\d\+\>"
syn match iposNumber "\<\d\+\>"
syn match iposNumber "\<0[xX]\x\+\>"
syn match iposNumber "\<0[bB][01]\+\>"
syn match iposMember "\.\s*\h\w*"hs=s+1
"""
        + 'syn match iposDirective "^\\s*#\\s*\\(' + "\\|".join(w["directive"]) + ')\\>"\n'.replace(")", "\\)", 1)
        + r"""syn match iposIncluded "<[^>]*>" contained
syn match iposInclude "^\s*#\s*include\>.*" contains=iposDirective,iposIncluded,iposString
syn region iposString start=+"+ end=+"+ oneline
syn match iposComment "//.*$" contains=iposTodo
syn region iposComment start="/\*" end="\*/" contains=iposTodo
syn keyword iposTodo TODO FIXME contained

hi def link iposControl Statement
hi def link iposType Type
hi def link iposModifier StorageClass
hi def link iposWordOperator Operator
hi def link iposForeign Error
hi def link iposStructure Structure
hi def link iposSystemFunction Function
hi def link iposVariable Identifier
hi def link iposNumber Number
hi def link iposMember Normal
hi def link iposDirective PreProc
hi def link iposIncluded String
hi def link iposString String
hi def link iposComment Comment
hi def link iposTodo Todo

let b:current_syntax = "ipos"
"""
    )


def highlights(w):
    quoted = lambda names: "[" + " ".join(f'"{name}"' for name in names) + "]"
    return (
        "; Made by tools/editors/syntax.py; do not edit.\n"
        f"{quoted(w['control'])} @keyword\n{quoted(w['type'])} @type.builtin\n"
        f"{quoted(w['modifier'])} @keyword.modifier\n{quoted(w['operator'])} @keyword.operator\n"
        "(comment) @comment\n(string) @string\n(header) @string\n(number) @number\n"
        "(directive_word) @keyword.directive\n(raw_variable) @variable.builtin\n"
        "(call function: (identifier) @function.call)\n(function name: (identifier) @function)\n"
        "(member name: (identifier) @variable.member)\n"
        f'((identifier) @function.builtin (#any-of? @function.builtin {" ".join(json.dumps(n) for n in w["function"])}))\n'
        f'((identifier) @type.builtin (#any-of? @type.builtin {" ".join(json.dumps(n) for n in w["structure"])}))\n'
    )


def main():
    w = words()
    files = {
        "vim/syntax/ipos.vim": vim(w),
        "tree-sitter/words.json": json.dumps(w, indent=1) + "\n",
        "tree-sitter/queries/highlights.scm": highlights(w),
    }
    bad = 0
    for name, text in files.items():
        if "--check" not in sys.argv:
            (HERE / name).parent.mkdir(parents=True, exist_ok=True)
            (HERE / name).write_text(text)
        elif not (HERE / name).exists() or (HERE / name).read_text() != text:
            print(f"{HERE / name} is not what the tables say; run {sys.argv[0]}")
            bad += 1
    grammar = (ROOT / "tools/vscode/syntaxes/ipos.tmLanguage.json").read_text()
    for kind in ("control", "type", "modifier", "operator", "foreign", "structure"):
        for word in w[kind]:
            if not re.search(rf"\b{word}\b", grammar.replace("\\b", " ")):
                print(f"the grammar of tools/vscode does not know the {kind} '{word}'")
                bad += 1
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
