#!/usr/bin/env python3
"""Tests of the finder of mutants and of the weaver: what is changed, what is left alone, and that each switch in a woven source gives
the value that the changed source would give."""

import os
import pathlib
import subprocess
import tempfile
import unittest

from mutants import mutants_of, weave

HERE = pathlib.Path(__file__).resolve().parent


def changes(line):
    return [m.changed() for m in mutants_of("a.hpp", line)]


class Finder(unittest.TestCase):
    def test_turns_operators_signs_and_constants(self):
        self.assertEqual(changes("    return -a + 2 * b;"),
                         ["return {- -> }a + 2 * b;", "return -a {+ -> -} 2 * b;", "return -a + {2 -> 3} * b;",
                          "return -a + 2 {* -> /} b;"])
        self.assertEqual(changes("if (!(a < b) && c) x += std::max<T>(c, 0.5);"),
                         ["if ({! -> }(a < b) && c) x += std::max<T>(c, 0.5);",
                          "if (!(a {< -> <=} b) && c) x += std::max<T>(c, 0.5);",
                          "if (!(a < b) {&& -> ||} c) x += std::max<T>(c, 0.5);",
                          "if (!(a < b) && c) x {+= -> -=} std::max<T>(c, 0.5);",
                          "if (!(a < b) && c) x += {std::max -> std::min}<T>(c, 0.5);",
                          "if (!(a < b) && c) x += std::max<T>(c, {0.5 -> 0.25});"])
        self.assertEqual(changes("x = 1e-6;"), ["x = {1e-6 -> 5e-07};"])

    def test_sees_an_operator_at_a_lines_end(self):
        self.assertEqual(changes("x = a +\n    b;"), ["x = a {+ -> -}"])

    def test_leaves_comments_strings_types_and_declarations_alone(self):
        for line in ("// a + b", "/* a < 0 */", 'text("a + 1");', "std::array<double, 4> x;", "auto f(T&& a, const T* b);",
                     "#include <a>", "template <class T, int N = 0>", "friend bool operator<(A a, B b) { return a.x < b.x; }",
                     "x = 0x1p52;", "    constexpr int kSize = 4;", "a->b();", "i++;"):
            self.assertEqual(changes(line), [], line)

    def test_names_a_mutant_by_its_line_whatever_the_number(self):
        first, = mutants_of("a.hpp", "a < b;")
        moved, = mutants_of("a.hpp", "\n\n    a < b;")
        self.assertEqual(first.changed(), moved.changed())


# Operators that bind closer, looser and alike on both sides; a right side that must not be looked at; several lines.
SOURCE = """
static constexpr double kHalf = 0.5;
int answers(int a, int b, int* none, int* x) {
    int n = 0;
    x[n++] = a + b * a - b / 2;
    x[n++] = a - b - a;
    x[n++] = -a * b;
    x[n++] = a < b ? 10 : a == b ? 20 : 30;
    x[n++] = !(a > b) || (none && *none > 0) ? 1 : 2;
    x[n++] = a > 0 &&
             b > a;
    x[n++] = std::max(a, b) + std::min<int>(a, b) * 100;
    x[n] = a;
    x[n] += b * b;
    x[n++] -= a == b;
    for (int i = 0; i < 3; ++i) x[n] += i;
    return int(8 * kHalf);
}
"""
PROGRAM = """
int main() {
    for (int a = 1; a < 4; ++a)
        for (int b = 1; b < 4; ++b) {
            int x[12] = {};
            std::printf("%d", answers(a, b, nullptr, x));
            for (int i : x) std::printf(" %d", i);
            std::puts("");
        }
}
"""


class Weaver(unittest.TestCase):
    def test_a_switch_gives_what_the_changed_source_gives(self):
        with tempfile.TemporaryDirectory() as folder:
            self.folder = pathlib.Path(folder)
            mutants = mutants_of("a.hpp", SOURCE)
            self.assertGreater(len(mutants), 40)
            woven = self.build("woven", weave(SOURCE, mutants, 100))
            self.assertEqual(self.output(woven), self.output(self.build("plain", SOURCE)))
            # Every mutant by its text, all in one program of many namespaces: a compiler's run for each would take minutes.
            changed = self.build("changed", "", mutants)
            for n, m in enumerate(mutants):
                self.assertEqual(self.output(woven, 100 + n), self.output(changed, n), m.changed())

    def build(self, name, source, mutants=()):
        code = "#include <algorithm>\n#include <cstdio>\n" + source + PROGRAM if not mutants else self.all_changed(mutants)
        (self.folder / f"{name}.cpp").write_text(code)
        subprocess.run([os.environ.get("CXX", "g++"), "-std=c++20", "-w", "-include", HERE / "switch.hpp", self.folder / f"{name}.cpp", "-o", self.folder / name],
                       check=True)
        return self.folder / name

    @staticmethod
    def all_changed(mutants):
        lines = SOURCE.split("\n")
        code = "#include <algorithm>\n#include <cstdio>\n"
        for n, m in enumerate(mutants):
            changed = lines[: m.line - 1] + [m.text[: m.start] + m.new + m.text[m.end :]] + lines[m.line :]
            code += f"namespace n{n} {{" + "\n".join(changed) + PROGRAM.replace("main", "all") + "}\n"
        calls = "".join(f"case {n}: return n{n}::all(), 0;" for n in range(len(mutants)))
        return code.replace("int all() {", "void all() {") + "int main() { switch (carom_mutation::active) {" + calls + "} }"

    def output(self, program, mutant=None):
        done = subprocess.run([program], env={"CAROM_MUTANT": str(mutant)} if mutant is not None else {}, capture_output=True)
        # What is undefined in the changed source (a null that is followed) need not die alike.
        return done.stdout if done.returncode == 0 else None


if __name__ == "__main__":
    unittest.main()
