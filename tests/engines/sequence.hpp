// A short program for the fast engine and for machine code, with what both are made of. Three machines run it from its
// first command on, and the reference interpreter has the expected values.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "tests/vm/code.hpp"
#include "vm/exec/machine.hpp"
#include "vm/fast/predecode.hpp"
#include "vm/jit/jit.hpp"

namespace ipos::tests {

inline constexpr vm::Limits kRowLimits{64, 2048, 3, 4};

class Sequence {
 public:
  // Labels are word addresses.
  explicit Sequence(const std::vector<vm::Instruction>& commands) : Sequence(code_of(commands)) {}
  explicit Sequence(std::vector<uint32_t> code) : code_(std::move(code)) {
    slots_.resize(vm::fast::Predecoded::slots_needed(code_.size()), dirt());
    image_ = vm::verify(code_, kRowLimits, {}).image;
    if (!image_) return;
    predecoded_.emplace(*image_, slots_);
  }
  Sequence(const Sequence&) = delete;
  Sequence& operator=(const Sequence&) = delete;
  bool good() const { return image_.has_value(); }
  const vm::VerifiedImage& image() const { return *image_; }
  const vm::fast::Predecoded& predecoded() const { return *predecoded_; }
  const vm::jit::Code* native() const {
    if (!native_) native_ = vm::jit::compile(*image_);
    return native_.get();
  }

  // The fast engine and machine code from the first command on, with every budget up to `most`: the same as the
  // reference in the end, and so again with further ones. Machine code wants more than 16 commands.
  void expect_equal(const std::vector<int32_t>& variables, uint32_t most) const {
    for (uint32_t budget = 0; budget <= most; ++budget)
      ASSERT_NO_FATAL_FAILURE(expect_equal_parts(variables, {budget, 37U, 500U}));
  }

  // The same with these budgets, one behind the other. `prepare` has a started machine.
  void expect_equal_parts(const std::vector<int32_t>& variables, const std::vector<uint32_t>& parts,
                          const std::function<void(vm::Machine&)>& prepare = {}) const {
    const vm::jit::Code* const code = native();
    ASSERT_EQ(code != nullptr, vm::jit::available());
    vm::Machine reference(*image_, {}), fast(*image_, {}), jit(*image_, {});
    fast.use(&*predecoded_);
    jit.use(&*predecoded_, code != nullptr ? &code->native() : nullptr);
    for (vm::Machine* machine : {&reference, &fast, &jit}) {
      std::copy(variables.begin(), variables.end(), machine->variables().begin());
      machine->start();
      if (prepare) prepare(*machine);
    }
    for (const uint32_t part : parts) {
      const vm::RunResult should = reference.run(1, part);
      for (vm::Machine* machine : {&fast, &jit}) {
        SCOPED_TRACE(testing::Message()
                     << (machine == &jit ? "machine code" : "fast") << ", budget " << parts.front());
        const vm::RunResult is = machine->run(1, part);
        ASSERT_EQ(is.commands, should.commands);
        ASSERT_EQ(is.stop, should.stop);
        const vm::TaskContext &t = machine->task(1), &wanted = reference.task(1);
        ASSERT_EQ(t.pc, wanted.pc);
        ASSERT_EQ(t.depth, wanted.depth);
        ASSERT_TRUE(std::equal(t.calls.begin(), t.calls.begin() + t.depth, wanted.calls.begin()));
        ASSERT_EQ(t.commands, wanted.commands);
        ASSERT_EQ(machine->fault().address, reference.fault().address);
        ASSERT_EQ(machine->fault().number, reference.fault().number);
        const std::span<const int32_t> values = machine->variables(), right = reference.variables();
        for (size_t n = 0; n < right.size(); ++n)
          if (values[n] != right[n]) FAIL() << "H" << n << " is " << values[n] << ", not " << right[n];
      }
    }
  }

 private:
  // The memory is the caller's and may have anything in it.
  static vm::fast::Slot dirt() {
    vm::fast::Slot out;
    out.lines.fill(0xAAAA);
    return out;
  }
  std::vector<uint32_t> code_;
  std::vector<vm::fast::Slot> slots_;
  std::optional<vm::VerifiedImage> image_;
  std::optional<vm::fast::Predecoded> predecoded_;
  mutable std::unique_ptr<vm::jit::Code> native_;  // made when it is wanted
};

}  // namespace ipos::tests
