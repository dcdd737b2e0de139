#!/usr/bin/env python3
# What mutate.py plants and whom it asks; without a build.
import re
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
from layer import programs_of  # noqa: E402
from mutants import mutants  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]


def planted(line):
    text = f"void f() {{\n  {line}\n}}\n"
    return {mutant.lines(text)[1] for mutant in mutants(text)}


class Mutants(unittest.TestCase):
    def test_comparisons(self):
        self.assertLessEqual({"if (a <= b) g();", "if (a >= b) g();", "if (false && a < b) g();", "if (a < b) {}"},
                             planted("if (a < b) g();"))

    def test_numbers(self):
        self.assertLessEqual({"x = 255;", "x = 257;"}, planted("x = 0x100;"))
        self.assertLessEqual({"x = 10001;", "x = 9999;"}, planted("x = 10'000;"))

    def test_arithmetic_and_signs(self):
        self.assertLessEqual({"return a - b * c;", "return a + b / c;"}, planted("return a + b * c;"))
        self.assertIn("return cw ? speed : speed;", planted("return cw ? -speed : speed;"))

    def test_statements_that_stand_alone(self):
        self.assertIn("{}", planted("rest_ = 0;"))
        self.assertIn("{}", planted("winners_.clear();"))
        self.assertNotIn("{}", planted("int32_t rest = 0;"))

    def test_texts_and_comments_are_left_alone(self):
        self.assertEqual(planted('// a < b'), set())
        self.assertEqual(planted('say("a < 5 && b");') - {"{}"}, set())

    def test_every_mutant_changes_its_line(self):
        for source in ("runtime/motion/ramp.cpp", "vm/verify/verify.cpp", "runtime/drive/setpoint.cpp"):
            text = (ROOT / source).read_text()
            found = mutants(text)
            self.assertGreater(len(found), 100)
            for mutant in found:
                before, after = mutant.lines(text)
                self.assertNotEqual(before, after)
                self.assertEqual(mutant.apply(text).count("\n"), text.count("\n"))


class Layers(unittest.TestCase):
    README = (ROOT / "tests/README.md").read_text()

    def test_the_table_says_whom_to_ask(self):
        for source, program in {
            "vm/exec/machine.cpp": "ipos_vm_tests",
            "vm/verify/verify.cpp": "ipos_vm_tests",
            "vm/fast/engine.cpp": "ipos_engine_tests",
            "vm/exec/idle.cpp": "ipos_engine_tests",
            "runtime/drive/setpoint.cpp": "ipos_drive_tests",
            "runtime/bus/can/line.cpp": "ipos_bus_tests",
            "runtime/bus/words/can_words.cpp": "ipos_bus_tests",
            "runtime/bus/movilink/serial_master.cpp": "ipos_rs485_tests",
            "runtime/bus/movilink/profile.cpp": "ipos_bus_tests",
            "runtime/scom/object_table.cpp": "ipos_scom_tests",
            "compiler/codegen/values.cpp": "ipos_compiler_tests",
            "runtime/station/station.cpp": "ipos_plant_tests",
            "embed/core/machine.c": "ipos_api_tests",
        }.items():
            self.assertEqual(programs_of(source, self.README)[0], program, source)

    def test_the_table_has_every_test_program(self):
        for file in (ROOT / "tests").rglob("CMakeLists.txt"):
            for name in re.findall(r"^\s*ipos_test\((ipos_\w+)", file.read_text(), re.M):
                group = re.sub(r"^(ipos_[a-z]+_)\w+", r"`\1*`", name)  # `ipos_bench_*`
                self.assertTrue(f"`{name}`" in self.README or group in self.README, f"{file}: {name}")

    def test_the_table_has_every_source(self):
        for folder in ("compiler", "embed", "runtime", "stdlib", "tools", "vm"):
            for file in (ROOT / folder).rglob("*.cpp"):
                source = str(file.relative_to(ROOT))
                self.assertTrue(programs_of(source, self.README), source)

    def test_equivalents_are_still_there(self):
        for row in (ROOT / "tests/mutation/equivalents.tsv").read_text().splitlines():
            if row.startswith("#"):
                continue
            source, before, after, reason = row.split("\t")
            self.assertTrue(reason)
            text = (ROOT / source).read_text()
            self.assertIn((before, after), {m.lines(text) for m in mutants(text)}, source)


if __name__ == "__main__":
    unittest.main()
