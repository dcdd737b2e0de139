// Every command that can stand in a loop, made from the rows of the opcode table: a program that goes round
// with it is the same in every mode of execution. A new row is here by itself.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <deque>
#include <random>

#include "tests/runtime/plant/machine_code.hpp"
#include "tests/runtime/plant/picture.hpp"
#include "tests/runtime/plant/plant_rig.hpp"
#include "vm/isa/isa.hpp"
#include "vm/jit/jit.hpp"

namespace ipos::tests {
namespace {

using runtime::Plant;
using vm::Flow;
using vm::Instruction;
using vm::Opcode;
using vm::OperandKind;

constexpr int32_t kTurns = 361, kSkipped = 362, kSent = 364, kObject = 370;
constexpr int32_t kPool = 380, kPoolSize = 6;  // what the command works with
constexpr int32_t kTrouble = 150;              // after so many turns it gets what it may fault with

std::vector<vm::OpcodeInfo> rows_of_loops() {
  std::vector<vm::OpcodeInfo> rows;
  for (const vm::OpcodeInfo& row : vm::opcode_table())
    if (row.flow == Flow::Next || row.flow == Flow::Jump || row.flow == Flow::Branch) rows.push_back(row);
  return rows;
}

// Code whose labels are numbers of commands.
std::vector<uint32_t> assembled(std::vector<Instruction> commands) {
  std::vector<int32_t> addresses;
  int32_t at = 0;
  for (const Instruction& command : commands) {
    addresses.push_back(at);
    at += vm::coding(command.opcode).words;
  }
  std::vector<uint32_t> code;
  for (Instruction& command : commands) {
    const vm::Coding& row = vm::coding(command.opcode);
    for (size_t n = 0; n < row.operand_count; ++n)
      if (row.kinds[n] == OperandKind::Label)
        command.operands[n] = addresses[static_cast<size_t>(command.operands[n])];
    std::array<uint32_t, vm::kMaxWords> words{};
    const uint32_t count = vm::encode(command, words);
    code.insert(code.end(), words.begin(), words.begin() + count);
  }
  return code;
}

class Loop {
 public:
  Loop(uint64_t seed, const vm::OpcodeInfo& row, int number) : random_(seed) {
    const bool sends = pick(0, 1) == 0;
    if (sends) send(number);
    const int32_t begin = next();
    add(Opcode::AddHK, kTurns, 1);
    // Numbers of variables, so that they are indexes, too, and no divisor is 0.
    for (int32_t n = kPool; n < kPool + kPoolSize; ++n) {
      add(Opcode::SetHH, n, kTurns);
      add(Opcode::MulHK, n, pick(1, 9));
      add(Opcode::AndHK, n, 3);
      add(Opcode::AddHK, n, kPool + 8);
    }
    trouble(row);
    const int rounds = pick(1, 3);
    for (int n = 0; n < rounds; ++n) {
      Instruction& command = add(row.opcode);
      for (size_t operand = 0; operand < static_cast<size_t>(row.operand_count); ++operand)
        command.operands[operand] = operand_of(row.operands[operand].kind);
      add(Opcode::AddHK, kSkipped, 1);
      add(Opcode::XorHH, kSkipped + 1, pick(kPool, kPool + kPoolSize - 1));
    }
    add(Opcode::AddHH, kSent, kSkipped + 1);
    add(Opcode::Jmp, begin);
  }
  std::vector<uint32_t> code() { return assembled(commands_); }

 private:
  int32_t pick(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  int32_t next() const { return static_cast<int32_t>(commands_.size()); }
  Instruction& add(Opcode opcode, int32_t a = 0, int32_t b = 0, int32_t c = 0) {
    return commands_.emplace_back(Instruction{opcode, {a, b, c, 0}});
  }
  void send(int number) {
    const int32_t values[] = {1100 + number, pick(3, 40), 0, 8, kSent};
    for (int32_t n = 0; n < 5; ++n) add(Opcode::SetHK, kObject + n, values[n]);
    add(Opcode::Scom, 1, kObject);
    add(Opcode::ScomOn);
  }
  void trouble(const vm::OpcodeInfo& row) {
    const int32_t value = vm::coding(row.opcode).faults == vm::Faults::Zero ? 0 : -1;
    add(Opcode::JmpLtHK, kTurns, kTrouble, next() + 1 + kPoolSize);
    for (int32_t n = kPool; n < kPool + kPoolSize; ++n) add(Opcode::SetHK, n, value);
  }
  int32_t operand_of(OperandKind kind) {
    static constexpr int32_t kConstants[] = {1, -1, 3, kPool + 9, 1000, INT32_MIN};
    switch (kind) {
      case OperandKind::Variable: return pick(kPool, kPool + kPoolSize - 1);
      case OperandKind::Bit: return pick(0, 31);
      case OperandKind::Count: return pick(1, 6);
      case OperandKind::Constant: return kConstants[pick(0, 5)];
      case OperandKind::Label: return next() + 1 - pick(0, 1);  // over the next command, or on
      default: ADD_FAILURE() << "an operand that no command of a loop has had so far"; return 0;
    }
  }

  std::mt19937_64 random_;
  std::vector<Instruction> commands_;
};

// A station for each row.
class RowPlant {
 public:
  explicit RowPlant(uint64_t seed) {
    std::mt19937_64 random(seed);
    text_ = "[[bus]]\nname = \"can\"\nkind = \"can\"\nbaud = 1000000\n";
    int number = 0;
    for (const vm::OpcodeInfo& row : rows_of_loops()) {
      const std::string file = fmt::format("P{}.ipx", number);
      text_ += fmt::format(
          "[[station]]\nname = \"u{0} {1}\"\nunit = \"mdxb\"\nprogram = \"{2}\"\nsbus = \"can\"\n"
          "[station.parameters]\nP881 = {3}\nP884 = 3\nP938 = {4}\n",
          number, row.name, file, number + 1, 5 + random() % 5);
      vm::Image image;
      image.unit = stdlib::find_unit(std::string_view("mdxb"))->code;
      image.code = Loop(random(), row, number).code();
      programs_[file] = image;
      ++number;
    }
  }
  std::unique_ptr<Plant> make(const runtime::Execution& execution) const {
    return make_plant<vm::Image>(text_, programs_, std::nullopt, execution);
  }

 private:
  std::string text_;
  std::map<std::string, vm::Image> programs_;
};

TEST(EveryRow, IsTheSameInAllModes) {
  std::vector<runtime::Execution> modes;
  for (const runtime::Pace pace : {runtime::Pace::InTurn, runtime::Pace::Lazy}) {
    modes.push_back({.fast = false, .compiler = nullptr, .pace = pace});
    modes.push_back({.fast = true, .compiler = nullptr, .pace = pace});
    if (vm::jit::available()) modes.push_back({.fast = true, .compiler = machine_code, .pace = pace});
  }
  size_t ahead = 0, faults = 0;
  for (uint64_t seed = 1; seed <= 3; ++seed) {
    const RowPlant rows(seed);
    std::deque<Watched> plants;
    for (const runtime::Execution& mode : modes) plants.emplace_back(rows.make(mode));
    std::mt19937_64 random(seed);
    for (runtime::Time now = 0; now < ms(1500);) {
      now += ms(static_cast<int64_t>(300 + random() % 300));
      for (size_t n = 0; n < plants.size(); ++n) {
        plants[n].plant->run_until(now);
        for (const auto& station : plants[n].plant->stations()) ahead += runs_ahead(*station) ? 1 : 0;
        ASSERT_NO_FATAL_FAILURE(
            expect_same(plants[n], plants[0], fmt::format("seed {}, mode {} at {}", seed, n, now)));
      }
    }
    for (const auto& station : plants[0].plant->stations()) faults += station->fault() != 0 ? 1 : 0;
  }
  EXPECT_GT(ahead, 3 * rows_of_loops().size()) << "looks that found a program ahead of its drive";
  EXPECT_GT(faults, 8U);
}

// As it was found: a block copy was done twice.
constexpr const char* kCopy =
    "#include <constb.h>\nMLDATA x; MLDATA y; long n; SCTRCYCL Tr;\n"
    "main() {{ {} while (1) {{ n = n + 1; x.WritePar = x.WritePar + n; x.ReadPar = n; y = x; }} }}";

TEST(EveryRow, AStructureIsCopiedOnceInATurn) {
  const std::string text =
      "[[bus]]\nname = \"can\"\nkind = \"can\"\nbaud = 500000\n"
      "[[station]]\nname = \"u\"\nunit = \"mdxb\"\nprogram = \"P.IPC\"\nsbus = \"can\"\n"
      "[station.parameters]\nP938 = 9\n";
  for (const char* telegram :
       {"",
        "Tr.ObjectNo = 1100; Tr.CycleTime = 3; Tr.Format = 4; Tr.DPointer = numof(n);\n"
        "_SBusCommDef(SCD_TRCYCL, Tr); _SBusCommOn();"}) {
    const std::map<std::string, std::string> sources = {{"P.IPC", fmt::format(kCopy, telegram)}};
    Watched expected(make_plant(text, sources, std::nullopt, in_turn())), plant(make_plant(text, sources));
    expected.plant->run_until(ms(2000));
    plant.plant->run_until(ms(2000));
    ASSERT_NO_FATAL_FAILURE(expect_same(plant, expected, telegram));
  }
}

}  // namespace
}  // namespace ipos::tests
