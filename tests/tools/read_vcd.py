"""Reads a value change dump by the grammar of IEEE 1364-2005, 18.2, and nothing more: what a viewer might forgive is
an error here. Prints one line a value: time in the file's unit, scopes and reference, value as a decimal number,
"x", "event" or a real. Written for the tests from the standard, without knowledge of the writer."""
import re
import sys

SIMPLE = re.compile(r"[A-Za-z_][A-Za-z0-9_$]*$")
ESCAPED = re.compile(r"\\[!-~]+$")
TYPES = {"event", "integer", "parameter", "real", "realtime", "reg", "supply0", "supply1", "time", "tri", "triand",
         "trior", "trireg", "tri0", "tri1", "wand", "wire", "wor"}


def fail(text):
    sys.exit("not a value change dump: " + text)


def read(text):
    if not text.isascii():
        # A comment may say "degrees"; identifiers are ASCII and checked below.
        text = text.encode("ascii", "replace").decode()
    tokens = iter(text.split())
    scopes, variables, now, last, seen = [], {}, None, -1, set()

    def section():
        words = []
        for token in tokens:
            if token == "$end":
                return words
            if token.startswith("$") and token in KEYWORDS:
                fail(f"{token} inside a section")
            words.append(token)
        fail("a section without $end")

    for token in tokens:
        if token in ("$comment", "$date", "$version"):
            section()
        elif token == "$timescale":
            if not re.match(r"(1|10|100)(s|ms|us|ns|ps|fs)$", "".join(section())):
                fail("timescale")
            seen.add(token)
        elif token == "$scope":
            words = section()
            if len(words) != 2 or words[0] not in {"begin", "fork", "function", "module", "task"}:
                fail(f"scope {words}")
            if not SIMPLE.match(words[1]) and not ESCAPED.match(words[1]):
                fail(f"scope identifier {words[1]}")
            scopes.append(words[1])
        elif token == "$upscope":
            if section() or not scopes:
                fail("upscope")
            scopes.pop()
        elif token == "$var":
            words = section()
            if len(words) not in (4, 5) or words[0] not in TYPES or not words[1].isdigit():
                fail(f"variable {words}")
            if not SIMPLE.match(words[3]) and not ESCAPED.match(words[3]):
                fail(f"reference {words[3]}")
            if len(words) == 5:
                index = re.match(r"\[(\d+):(\d+)\]$", words[4])
                if not index or int(index[1]) - int(index[2]) + 1 != int(words[1]):
                    fail(f"range {words[4]}")
            if words[2] in variables:
                fail(f"identifier code {words[2]} used twice")
            variables[words[2]] = (words[0], int(words[1]), ".".join(scopes + [words[3]]))
        elif token == "$enddefinitions":
            if section() or scopes or "$timescale" not in seen:
                fail("end of definitions")
            seen.add(token)
        elif token == "$dumpvars":
            if now is None:
                fail("$dumpvars before a time")
            seen.add(token)
        elif token == "$end":
            if "$dumpvars" not in seen:
                fail("$end of nothing")
        elif "$enddefinitions" not in seen:
            fail(f"{token} among the declarations")
        elif token[0] == "#":
            now = int(token[1:])
            if now <= last:
                fail(f"time {now} behind {last}")
            last = now
        elif token[0] in "bBrR":
            code = next(tokens, None)
            if code not in variables or now is None:
                fail(f"value of {code}")
            kind, size, name = variables[code]
            if (kind == "real") != (token[0] in "rR") or kind == "event":
                fail(f"value {token} of a {kind}")
            if kind == "real":
                value = repr(float(token[1:]))
            elif re.match(r"[01]+$", token[1:]):
                if len(token) - 1 > size:
                    fail(f"{token} is longer than {size} bits")
                number = int(token[1:], 2)
                if kind == "integer" and number >> (size - 1):
                    number -= 1 << size
                value = str(number)
            elif re.match(r"[xz]$", token[1:]):
                value = token[1:]
            else:
                fail(f"value {token}")
            print(now, name, value)
        elif token[0] in "01xXzZ":
            if token[1:] not in variables or variables[token[1:]][1] != 1 or now is None:
                fail(f"value {token}")
            kind, _, name = variables[token[1:]]
            print(now, name, "event" if kind == "event" else token[0])
        else:
            fail(f"token {token}")
    if "$enddefinitions" not in seen:
        fail("no definitions")


KEYWORDS = {"$comment", "$date", "$version", "$timescale", "$scope", "$upscope", "$var", "$enddefinitions", "$dumpvars",
            "$dumpall", "$dumpoff", "$dumpon"}
with open(sys.argv[1], encoding="utf-8") as file:
    read(file.read())
