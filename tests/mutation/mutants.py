"""The small changes that could be made to a source: an operator turned, a constant moved, a sign lost."""

import dataclasses
import re


@dataclasses.dataclass(frozen=True)
class Mutant:
    path: str
    line: int  # counted from 1
    start: int  # in the line
    end: int
    old: str
    new: str

    def __str__(self):
        return f"{self.path}:{self.line}:{self.start + 1}: {self.old.strip()} becomes {self.new.strip() or 'nothing'}"

    def apply(self, text):
        lines = text.split("\n")
        line = lines[self.line - 1]
        lines[self.line - 1] = line[: self.start] + self.new + line[self.end :]
        return "\n".join(lines)


# clang-format puts spaces around binary operators, which keeps them apart from templates, signs and references.
OPERATORS = {
    " < ": " <= ", " <= ": " < ", " > ": " >= ", " >= ": " > ", " == ": " != ", " != ": " == ",
    " + ": " - ", " - ": " + ", " * ": " / ", " / ": " * ", " && ": " || ", " || ": " && ",
    " += ": " -= ", " -= ": " += ",
}
WORDS = {"true": "false", "false": "true", "min": "max", "max": "min"}

_OPERATOR = re.compile("|".join(re.escape(o) for o in sorted(OPERATORS, key=len, reverse=True)))
_WORD = re.compile(r"(?<=std::)(?:min|max)(?=[<(])|\b(?:true|false)\b")
_NOT = re.compile(r"(?<=[ (])!(?=[a-zA-Z(])")
_MINUS = re.compile(r"(?:(?<=[=,?:] )|(?<=return )|(?<=\())-(?=[a-zA-Z(])")
_NUMBER = re.compile(r"(?<![\w.])\d+(?:\.\d+)?(?:e-?\d+)?(?![\w.])")
# Declarations, directives, and what is there for the compiler's sake alone.
_SKIPPED = re.compile(r"^\s*(#|template|using|static_assert|namespace|case |enum|struct|class |friend)|operator|0x1p|= default")


def without_comments(text):
    """Comments and strings blanked, every character in its place."""
    blank = lambda match: re.sub(r"[^\n]", " ", match.group())
    return re.sub(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', blank, text, flags=re.S)


def _number(text):
    return "1" if float(text) == 0 else "2" if float(text) == 1 else str(float(text) / 2) if "." in text or "e" in text else str(int(text) + 1)


def mutants_of(path, text):
    """All mutants of a file, in the order of their places."""
    found = []
    for number, line in enumerate(without_comments(text).split("\n"), 1):
        if _SKIPPED.search(line):
            continue
        for pattern, change in (
            (_OPERATOR, lambda old: OPERATORS[old]),
            (_WORD, lambda old: WORDS[old]),
            (_NOT, lambda old: ""),
            (_MINUS, lambda old: ""),
            (_NUMBER, _number),
        ):
            for match in pattern.finditer(line):
                found.append(Mutant(path, number, match.start(), match.end(), match.group(), change(match.group())))
    return sorted(found, key=lambda m: (m.line, m.start))
