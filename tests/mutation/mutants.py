# The small mistakes that can be planted in a C++ source: one change of one place each. The text is read as
# clang-format leaves it, so an operator between two values has a space on both sides and a statement that stands
# alone has its line; comments, strings and preprocessor lines are left alone.
import re
from dataclasses import dataclass


@dataclass(frozen=True)
class Mutant:
    start: int  # in the text of the file
    end: int
    new: str
    line: int

    def apply(self, text):
        return text[: self.start] + self.new + text[self.end :]

    def lines(self, text):
        """The line as it is, and as it becomes."""
        first = text.rfind("\n", 0, self.start) + 1
        last = text.find("\n", self.end)
        before = text[first:last]
        return before.strip(), (text[first : self.start] + self.new + text[self.end : last]).strip()


# What is looked for, and what takes the place of the group `it`.
OPERATORS = [
    (r" (?P<it><) ", ["<=", ">="]),
    (r" (?P<it>>) ", [">=", "<="]),
    (r" (?P<it><=) ", ["<", ">"]),
    (r" (?P<it>>=) (?=[^;]*[;)&|?])(?<!  >>= )", [">", "<"]),
    (r" (?P<it>==) ", ["!="]),
    (r" (?P<it>!=) ", ["=="]),
    (r" (?P<it>&&) ", ["||"]),
    (r" (?P<it>\|\|) ", ["&&"]),
    (r"[\w)\]] (?P<it>\+) ", ["-"]),
    (r"[\w)\]] (?P<it>-) ", ["+"]),
    (r"[\w)\]] (?P<it>\*) (?=[\w(])", ["/"]),
    (r"[\w)\]] (?P<it>/) ", ["*"]),
    (r"[\w)\]] (?P<it>%) ", ["/"]),
    (r"[\w)\]] (?P<it>&) (?=[\w(~])", ["|"]),
    (r" (?P<it>\|) ", ["&"]),
    (r" (?P<it>\^) ", ["&"]),
    (r" (?P<it><<) (?=[\w(])", [">>"]),
    (r" (?P<it>>>) (?=[\w(])", ["<<"]),
    (r" (?P<it>\+=) ", ["-=", "="]),
    (r" (?P<it>-=) ", ["+="]),
    (r" (?P<it>\|=) ", ["=", "&="]),
    (r" (?P<it>&=) ", ["=", "|="]),
    (r"(?P<it>\+\+)(?=\w)", ["--"]),
    (r"(?P<it>--)(?=\w)", ["++"]),
    (r"(?<=[(,=?:&|] )(?P<it>-)(?=[\w(])|(?<=[(\[])(?P<it2>-)(?=[\w(])|(?<=return )(?P<it3>-)(?=[a-zA-Z_(])", [""]),
    (r"(?P<it>!)(?=[\w(:])", [""]),
    (r"\bstd::(?P<it>min)\b", ["max"]),
    (r"\bstd::(?P<it>max)\b", ["min"]),
    (r"\bstd::(?P<it>upper_bound)\b", ["lower_bound"]),
    (r"\bstd::(?P<it>lower_bound)\b", ["upper_bound"]),
    (r"\b(?P<it>true)\b", ["false"]),
    (r"\b(?P<it>false)\b", ["true"]),
    (r"(?P<it> \? )", [" && false ? ", " || true ? "]),
    (r"(?m)^\s*(?:\} else )?if \((?P<it>)(?=[^;]*?\) ?(?:\{|[a-z][^\n]*;)$)", ["false && "]),
    (r"\breturn (?P<it>)(?=[^;\n]*(?:==|!=| < | > | <= | >= |&&|\|\|)[^;\n]*;)", ["!"]),
]
NUMBER = re.compile(r"(?<![\w.'])(?P<it>0[xX][0-9A-Fa-f']+|\d[\d']*)(?P<suffix>[uUlL]*)(?![\w.'])")
# A call, an assignment or a step that has its line for itself (not a declaration), or what ends a run of statements.
STATEMENT = re.compile(
    r"(?m)^[ ]+(?:if \([^;\n]*\) |else |for \([^\n]*\) )?"
    r"(?P<it>(?:\+\+|--)?[a-zA-Z_][\w.\[\]:]*(?:->[\w.\[\]]+)*(?:\([^;\n]*\)[^;\n]*| [-+*/|&^]?= [^;\n]*)?;)$"
)
KEEP = re.compile(r"(return|break|continue|using|case|default|goto|static_assert|assert|delete)\b")


def mask(text):
    """The text with comments, strings, characters and preprocessor lines blanked, its places unchanged."""
    pattern = r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|(?<!\w)\'(?:\\.|[^\'\\\n])+\'|(?m:^[ ]*#(?:[^\n]*\\\n)*[^\n]*)'
    return re.sub(pattern, lambda m: re.sub(r"[^\n]", "~", m.group()), text, flags=re.S)


def numbers(text):
    for match in NUMBER.finditer(text):
        digits = match["it"].replace("'", "")
        value = int(digits, 0) if digits[:2].lower() == "0x" or digits == "0" else int(digits.lstrip("0") or "0")
        for other in {value + 1, abs(value - 1)}:
            yield match.start("it"), match.end("it"), str(other)


def statements(text):
    for match in STATEMENT.finditer(text):
        if not KEEP.match(match["it"]) and not re.match(r"[\w:<>]+;$", match["it"]):
            yield match.start("it"), match.end("it"), "{}"
        elif re.match(r"(return|continue);$", match["it"]):
            yield match.start("it"), match.end("it"), "{}"


def operators(text):
    for pattern, replacements in OPERATORS:
        for match in re.finditer(pattern, text):
            group = next(name for name, found in match.groupdict().items() if found is not None)
            for new in replacements:
                yield match.start(group), match.end(group), new


def mutants(text):
    """All mutants of a source, in the order of their places."""
    masked = mask(text)
    found = {place for kind in (operators, numbers, statements) for place in kind(masked)}
    line_of = lambda at: text.count("\n", 0, at) + 1
    return [
        Mutant(start, end, new, line_of(start))
        for start, end, new in sorted(found)
        if not is_fixed(masked, start)
    ]


def is_fixed(masked, at):
    """Declarations that the compiler checks itself, and bounds of arrays and templates."""
    first = masked.rfind("\n", 0, at) + 1
    line = masked[first : masked.find("\n", at)]
    return bool(re.match(r"\s*(static_assert|template|using|enum|assert)\b", line))
