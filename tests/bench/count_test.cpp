// How many operations the fast engine needs for a million commands of each benchmark: the part of its speed
// that does not depend on the machine. Counted with the reference interpreter in single steps, by the
// predecoded form alone. operations.tsv has the figures; they were counted by this test.
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "compiler/compile.hpp"
#include "vm/exec/machine.hpp"
#include "vm/fast/predecode.hpp"

namespace ipos::tests {
namespace {

constexpr uint64_t kCommands = 1'000'000;
constexpr uint64_t kTolerance = 2;  // percent

std::map<std::string, uint64_t> recorded() {
  std::map<std::string, uint64_t> rows;
  std::ifstream in(IPOS_BENCH_DIR "/operations.tsv");
  for (std::string name; in >> name;) {
    uint64_t count = 0;
    if (name[0] != '#' && in >> count) rows[name] = count;
    std::getline(in, name);
  }
  return rows;
}

uint64_t count_operations(const std::string& name) {
  const auto path = std::filesystem::path(IPOS_BENCH_DIR) / "programs" / (name + ".IPC");
  std::ifstream in(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  compiler::CompileOptions options;
  options.unit = stdlib::find_unit(std::string_view("mdxb"));
  const compiler::Compilation made = compiler::compile(path.string(), "", text, options);
  if (!made.image) return 0;
  const auto code = std::span<const uint32_t>(made.image->code);
  const vm::Verification verified = vm::verify(code, {1024, 16384, 3, 32}, {});
  std::vector<vm::fast::Slot> slots(vm::fast::Predecoded::slots_needed(code.size()));
  const vm::fast::Predecoded program(*verified.image, slots);
  std::vector<uint32_t> lengths(code.size());
  for (uint32_t at = 0; at < code.size(); at += vm::decode(code, at).words)
    lengths[at] = program.commands(at);

  vm::Machine machine(*verified.image, {});
  machine.start();
  uint64_t operations = 0;
  uint32_t rest = 0, next = 0;
  for (uint64_t n = 0; n < kCommands; ++n) {
    const uint32_t pc = machine.task(1).pc;
    if (rest == 0 || pc != next) {
      rest = lengths[pc];
      ++operations;
    }
    --rest;
    next = pc + vm::decode(code, pc).words;
    if (machine.run(1, 1).stop != vm::Stop::Budget) break;
  }
  return operations;
}

TEST(Operations, AMillionCommandsTakeNoMoreThanRecorded) {
  const auto rows = recorded();
  EXPECT_GE(rows.size(), 15U);
  for (const auto& [name, limit] : rows) {
    const uint64_t count = count_operations(name);
    std::printf("%s\t%llu\n", name.c_str(), static_cast<unsigned long long>(count));
    EXPECT_NE(count, 0U) << name;
    EXPECT_LE(count * 100, limit * (100 + kTolerance)) << name;
  }
}

}  // namespace
}  // namespace ipos::tests
