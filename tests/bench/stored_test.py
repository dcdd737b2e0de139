#!/usr/bin/env python3
"""What --against of the benches says of a kept run: figures worked out by hand."""
import os
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import stored


def kept(processor="one", kind="compare", **rows):
    return {"kind": kind, "processor": processor, "figures": rows}


class Against(unittest.TestCase):
    def lines(self, figures, then, kind="compare"):
        return stored.compared(kind, figures, then, "one", 0.1)

    def test_tells_the_mean_and_what_is_outside_of_the_noise(self):
        # 2/1 and 0.5/1: the geometric mean is 1; 1.05 is within a tenth.
        lines = self.lines({"fast": {"fib": 2, "crc": 0.5, "pid": 1.05}}, kept(fast={"fib": 1, "crc": 1, "pid": 1}))
        self.assertEqual(lines, ["fast: 1.016 of the kept run, outside of the noise: fib 2.00, crc 0.50"])

    def test_the_same_run_says_1(self):
        self.assertEqual(self.lines({"fast": {"fib": 3}}, kept(fast={"fib": 3})), ["fast: 1.000 of the kept run"])

    def test_a_row_that_was_not_kept_is_named(self):
        self.assertEqual(self.lines({"native": {"fib": 3}}, kept(fast={"fib": 3})), ["native: not in the kept run"])

    def test_another_processor_is_said(self):
        lines = self.lines({"fast": {"fib": 3}}, kept("other", fast={"fib": 3}))
        self.assertIn("another processor (other), this is one", lines[0])

    def test_another_bench_is_not_compared(self):
        lines = self.lines({"fast": {"fib": 3}}, kept(kind="counts", fast={"fib": 1}))
        self.assertEqual(lines, ["the kept run is of counts, this one of compare: nothing to compare"])


unittest.main()
