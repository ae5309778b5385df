"""The small changes that could be made to a source: an operator turned, a constant moved, a sign lost. And the source in
which all of them wait for their switch (switch.hpp)."""

import dataclasses
import re


@dataclasses.dataclass(frozen=True)
class Mutant:
    path: str
    line: int  # counted from 1
    start: int  # in the line
    end: int
    kind: str  # of switch
    old: str
    new: str
    text: str  # of the line

    def __str__(self):
        return f"{self.path}:{self.line}: {self.changed()}"

    def changed(self):
        """The line with the change marked in it: the mutant's name in the list of survivors, wherever the line moves."""
        marked = f"{{{self.old} -> {self.new}}}"
        return (self.text[: self.start] + marked + self.text[self.end :]).strip()


# clang-format puts spaces around binary operators, which keeps them apart from templates, signs and references.
OPERATORS = {
    "<": ("<=", "Less"), "<=": ("<", "LessEqual"), ">": (">=", "Greater"), ">=": (">", "GreaterEqual"),
    "==": ("!=", "Equal"), "!=": ("==", "NotEqual"),
    "+": ("-", "Plus"), "-": ("+", "Minus"), "*": ("/", "Times"), "/": ("*", "Over"),
    "&&": ("||", "And"), "||": ("&&", "Or"), "+=": ("-=", "PlusAssign"), "-=": ("+=", "MinusAssign"),
}
WORDS = {"true": ("false", "Value"), "false": ("true", "Value"), "std::min": ("std::max", "Extreme"),
         "std::max": ("std::min", "Extreme")}

_PATTERNS = (
    (re.compile("(?<= )(?:" + "|".join(re.escape(o) for o in sorted(OPERATORS, key=len, reverse=True)) + ")(?= |$)"),
     OPERATORS.get),
    (re.compile(r"std::(?:min|max)(?=[<(])|\b(?:true|false)\b"), WORDS.get),
    (re.compile(r"(?<=[ (])!(?=[a-zA-Z(])"), lambda old: ("", "Not")),
    (re.compile(r"(?:(?<=[=,?:] )|(?<=return )|(?<=[(\[]))-(?=[a-zA-Z(])"), lambda old: ("", "Negative")),
    # No template's argument: those are types and sizes.
    (re.compile(r"(?<![\w.])\d+(?:\.\d+)?(?:e-?\d+)?(?![\w.>])"), lambda old: (_other_number(old), "Value")),
)
# Declarations, directives, and what is there for the compiler's sake alone; a constexpr in a function is an array's size.
_SKIPPED = re.compile(r"^\s*(#|template|using|static_assert|namespace|case |enum|struct|class |friend)|^\s+constexpr |operator|0x1p|= default")
# What the compiler computes no run could change. So it is computed at the program's start, or when called.
_CONSTEXPR_VALUE = re.compile(r"(?m)(^|static |inline )constexpr (?=[\w:<>, ]+ k[A-Z]\w*[ {])")
_CONSTEXPR_FUNCTION = re.compile(r"(?<!if )\bconstexpr (?=[\w:<>, ]+\()")


def without_comments(text):
    """Comments and strings blanked, every character in its place."""
    blank = lambda match: re.sub(r"[^\n]", " ", match.group())
    return re.sub(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', blank, text, flags=re.S)


def _other_number(text):
    if float(text) < 2 and float(text) in (0, 1):
        return text.replace("0", "1", 1) if float(text) == 0 else text.replace("1", "2", 1)
    return str(float(text) / 2) if "." in text or "e" in text else str(int(text) + 1)


def mutants_of(path, text):
    """All mutants of a file, in the order of their places."""
    lines = text.split("\n")
    found = []
    for number, line in enumerate(without_comments(text).split("\n"), 1):
        if _SKIPPED.search(line):
            continue
        for pattern, change in _PATTERNS:
            for match in pattern.finditer(line):
                new, kind = change(match.group())
                found.append(Mutant(path, number, *match.span(), kind, match.group(), new, lines[number - 1]))
    return sorted(found, key=lambda m: (m.line, m.start))


def _operand_end(code, start):
    """Where the right operand of && or || ends that begins at `start`."""
    depth = 0
    for place in range(start, len(code)):
        if code[place] in "([{":
            depth += 1
        elif code[place] in ")]}":
            depth -= 1
        outside = depth == 0 and (code[place] in ",;?" or code[place : place + 2] in ("&&", "||") or code[place : place + 3] == " : ")
        if depth < 0 or outside:
            return place
    raise ValueError("an operand without end")


def weave(text, mutants, first):
    """The source with a switch at each of its mutants, which are numbered from `first` on."""
    code = without_comments(text)
    starts = [0]
    for line in text.split("\n"):
        starts.append(starts[-1] + len(line) + 1)
    edits = []  # (place, characters dropped, text put there)
    for n, m in enumerate(mutants, first):
        place, end = starts[m.line - 1] + m.start, starts[m.line - 1] + m.end
        switch = f"::carom_mutation::{m.kind}{{{n}"
        if m.kind == "Value":
            edits.append((place, end - place, f"(::carom_mutation::on({n}) ? {m.new} : {m.old})"))
        elif m.kind == "Extreme":
            edits.append((place, end - place, f"{switch}, {'true' if m.old == 'std::max' else 'false'}}}.of"))
        elif m.kind in ("Not", "Negative"):
            edits.append((place, end - place, f"{switch}}}->*"))
        elif m.kind in ("And", "Or"):
            edits.append((end, 0, f" {switch}}} {m.old} [&]() -> bool {{ return bool("))
            edits.append((_operand_end(code, end), 0, "); }"))
        else:
            edits.append((end, 0, f" {switch}}} {m.old}"))
    # From the end on, and of two at one place the later closes what the earlier has opened.
    for place, dropped, put in sorted(edits, key=lambda e: e[0], reverse=True):
        text = text[:place] + put + text[place + dropped :]
    text = _CONSTEXPR_VALUE.sub(r"\1const ", text).replace("static const ", "static inline const ")
    return _CONSTEXPR_FUNCTION.sub("inline ", text)
