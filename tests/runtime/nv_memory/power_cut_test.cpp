// Power cuts during a save of all parameters: before, inside (at every byte) and after every write, with torn
// sectors and with sectors that reach the medium out of order. What is found afterwards is the old state or
// the new one, whole, in every case.
#include <gtest/gtest.h>

#include <cstdio>
#include <random>

#include "runtime/nv_memory/kept/unit_memory.hpp"
#include "tests/runtime/nv_memory/fake_medium.hpp"

namespace ipos::runtime {
namespace {

using tests::FakeMedium;
using tests::MediumBytes;
using tests::MediumState;
using tests::MediumWrite;

constexpr size_t kSector = 512;

struct Unit {
  explicit Unit(const char* name, std::shared_ptr<MediumState> state)
      : type(*stdlib::find_unit(name)), parameters(type), memory(parameters) {
    EXPECT_EQ(memory.open(std::make_unique<FakeMedium>(std::move(state)), "unit.nv"), std::nullopt);
  }
  const stdlib::UnitType& type;
  ParameterStore parameters;
  UnitMemory memory;
};

NvContent stored(const MediumBytes& bytes, uint8_t unit) {
  tests::FoundMedium medium(bytes);
  return SlotStore(medium, unit).load().content;
}

// One commit: what the medium held before, its writes, and the two contents that may be found.
struct Commit {
  MediumBytes before;
  std::vector<MediumWrite> writes;
  NvContent old_content;
  NvContent new_content;
};

class Sweep {
 public:
  explicit Sweep(uint8_t unit) : unit_(unit) {}

  void every_byte(const Commit& commit) {
    MediumBytes image = commit.before;
    check(commit, image, false);  // before the first
    for (size_t w = 0; w < commit.writes.size(); ++w) {
      const MediumWrite& write = commit.writes[w];
      for (size_t n = 1; n <= write.bytes.size(); ++n) {
        tests::put_bytes(image, write.offset + n - 1, std::span(write.bytes).subspan(n - 1, 1));
        const bool done = w + 1 == commit.writes.size() && n == write.bytes.size();
        check(commit, image, done);
      }
    }
  }

  // The sector in which the power failed holds `fill` or noise behind the cut.
  void torn_sectors(const Commit& commit, std::mt19937& noise) {
    MediumBytes done = commit.before;
    for (const MediumWrite& write : commit.writes) {
      for (size_t n = 0; n < write.bytes.size(); ++n)
        for (const int fill : {0x00, 0xFF, -1}) {
          MediumBytes image = done;
          tests::put_bytes(image, write.offset, std::span(write.bytes).first(n));
          const uint64_t end = write.offset + write.bytes.size();
          const uint64_t sector_end = ((write.offset + n) / kSector + 1) * kSector;
          std::vector<uint8_t> rest(std::min(end, sector_end) - (write.offset + n));
          for (uint8_t& byte : rest)
            byte = static_cast<uint8_t>(fill < 0 ? noise() : static_cast<unsigned>(fill));
          tests::put_bytes(image, write.offset + n, rest);
          check(commit, image, false);
        }
      tests::put_bytes(done, write.offset, write.bytes);
    }
  }

  // The file has its new length, and zeros behind the cut.
  void extended_first(const Commit& commit) {
    MediumBytes done = commit.before;
    for (const MediumWrite& write : commit.writes) {
      MediumBytes image = done;
      if (image.size() < write.offset + write.bytes.size()) image.resize(write.offset + write.bytes.size());
      check(commit, image, false);
      for (size_t n = 1; n < write.bytes.size(); ++n) {
        tests::put_bytes(image, write.offset + n - 1, std::span(write.bytes).subspan(n - 1, 1));
        check(commit, image, false);
      }
      tests::put_bytes(done, write.offset, write.bytes);
    }
  }

  // Within a write any set of its sectors may have reached the medium.
  void sectors_out_of_order(const Commit& commit) {
    const MediumWrite& write = commit.writes.front();
    std::vector<std::span<const uint8_t>> sectors;
    std::vector<uint64_t> offsets;
    for (size_t at = 0; at < write.bytes.size();) {
      const size_t end =
          std::min<size_t>(write.bytes.size(), ((write.offset + at) / kSector + 1) * kSector - write.offset);
      sectors.push_back(std::span(write.bytes).subspan(at, end - at));
      offsets.push_back(write.offset + at);
      at = end;
    }
    for (uint32_t set = 0; set < 1U << sectors.size(); ++set) {
      MediumBytes image = commit.before;
      for (size_t s = 0; s < sectors.size(); ++s)
        if ((set >> s & 1) != 0) tests::put_bytes(image, offsets[s], sectors[s]);
      check(commit, image, false);
    }
  }

  long cases() const { return old_ + new_ + mixed_; }
  long old_states() const { return old_; }
  long new_states() const { return new_; }
  long mixed() const { return mixed_; }

 private:
  void check(const Commit& commit, const MediumBytes& image, bool acknowledged) {
    const NvContent found = stored(image, unit_);
    if (found == commit.new_content)
      ++new_;
    else if (found == commit.old_content && !acknowledged)
      ++old_;
    else
      ++mixed_;
  }

  uint8_t unit_;
  long old_ = 0;
  long new_ = 0;
  long mixed_ = 0;
};

// A legal value other than the present one.
int32_t other_value(const ParameterStore& store, const stdlib::Parameter& p) {
  const auto bits = [](int64_t number) { return static_cast<int32_t>(static_cast<uint32_t>(number)); };
  const int32_t now = store.value(p.index);
  return bits(p.maximum()) != now ? bits(p.maximum()) : bits(p.minimum());
}

// Lock, factory setting and orders would stop the others from being written.
bool is_setting(const stdlib::Parameter& p) { return p.writable && p.nonvolatile && p.index != 8595; }

class PowerCut : public ::testing::TestWithParam<const char*> {};

// As a change of many values in one millisecond is stored: one commit.
TEST_P(PowerCut, SaveOfAllParametersAtOnce) {
  auto state = std::make_shared<MediumState>();
  Unit unit(GetParam(), state);
  unit.memory.changed();
  ASSERT_TRUE(unit.memory.commit());  // factory values
  int changed = 0;
  for (const stdlib::Parameter* p : unit.parameters.table().by_index()) {
    if (!is_setting(*p)) continue;
    ASSERT_TRUE(unit.parameters.preset(p->index, other_value(unit.parameters, *p))) << p->index;
    ++changed;
  }
  Commit commit{state->bytes, {}, stored(state->bytes, unit.type.code), {}};
  state->writes.clear();
  ASSERT_TRUE(unit.memory.commit());
  commit.writes = state->writes;
  commit.new_content = stored(state->bytes, unit.type.code);
  ASSERT_NE(commit.new_content, commit.old_content);
  EXPECT_EQ(commit.new_content.values, unit.parameters.kept());

  Sweep sweep(unit.type.code);
  std::mt19937 noise(20011);
  sweep.every_byte(commit);
  sweep.torn_sectors(commit, noise);
  sweep.sectors_out_of_order(commit);
  std::printf("%s: %d parameters in one commit: %ld cut cases, %ld old, %ld new, %ld mixed\n", GetParam(),
              changed, sweep.cases(), sweep.old_states(), sweep.new_states(), sweep.mixed());
  RecordProperty("cases", static_cast<int>(sweep.cases()));
  EXPECT_EQ(sweep.mixed(), 0);
  EXPECT_GT(sweep.old_states(), 0);
  EXPECT_GT(sweep.new_states(), 0);
}

// As a parameter set is loaded over a bus: one service Write after the other, each answered when it is
// stored.
using PowerCutOneByOne = PowerCut;

TEST_P(PowerCutOneByOne, EveryByteOfEveryWrite) {
  auto state = std::make_shared<MediumState>();
  Unit unit(GetParam(), state);
  unit.memory.changed();
  ASSERT_TRUE(unit.memory.commit());
  Sweep sweep(unit.type.code);
  int written = 0;
  for (const stdlib::Parameter* p : unit.parameters.table().by_index()) {
    if (!is_setting(*p)) continue;
    Commit commit{state->bytes, {}, stored(state->bytes, unit.type.code), {}};
    state->writes.clear();
    const int32_t value = other_value(unit.parameters, *p);
    ASSERT_TRUE(unit.parameters.execute(ParameterService::Write, p->index, value)) << p->index;
    commit.writes = state->writes;
    commit.new_content = stored(state->bytes, unit.type.code);
    const auto& values = commit.new_content.values;
    ASSERT_NE(std::find(values.begin(), values.end(), std::pair(p->index, value)), values.end());
    sweep.every_byte(commit);
    ++written;
  }
  std::printf("%s: %d parameters one by one: %ld cut cases, %ld old, %ld new, %ld mixed\n", GetParam(),
              written, sweep.cases(), sweep.old_states(), sweep.new_states(), sweep.mixed());
  RecordProperty("cases", static_cast<int>(sweep.cases()));
  EXPECT_EQ(sweep.mixed(), 0);
  EXPECT_GE(sweep.new_states(), written) << "what was answered is there";
}

// The content grows and shrinks: variables, curve points, a program of its own. The file grows with it; what
// a file system leaves of a file that was made longer, but not filled, is among the cases.
TEST(PowerCutGrowth, ContentGrowsAndShrinks) {
  auto state = std::make_shared<MediumState>();
  Unit unit("md60a", state);
  unit.memory.changed();
  ASSERT_TRUE(unit.memory.commit());
  Sweep sweep(unit.type.code);
  size_t longest = 0;
  size_t file = 0;
  const auto sweep_commit = [&](const auto& change) {
    Commit commit{state->bytes, {}, stored(state->bytes, unit.type.code), {}};
    state->writes.clear();
    change();
    ASSERT_TRUE(unit.memory.commit());
    commit.writes = state->writes;
    commit.new_content = stored(state->bytes, unit.type.code);
    ASSERT_NE(commit.new_content, commit.old_content);
    sweep.every_byte(commit);
    sweep.extended_first(commit);
    longest = std::max(longest, commit.writes.front().bytes.size());
    file = state->bytes.size();
  };
  const auto memorize = [&](int value, Memorize what) {
    for (size_t n = 0; n < 128; ++n) unit.memory.variables().words()[n] = value;
    unit.memory.memorize(what);
  };
  sweep_commit([&] { memorize(1, Memorize::StoreData); });
  for (uint16_t n = 0; n < 12; ++n)
    sweep_commit([&] {
      unit.parameters.execute(ParameterService::Write, static_cast<uint16_t>(20'000 + 40 * n), -1 - n);
    });
  for (uint16_t n = 0; n < 200; ++n) unit.memory.program().write(n, 0x0101'0101, false);
  sweep_commit([&] { memorize(1, Memorize::StoreProgram); });
  const size_t grown = longest;
  sweep_commit([&] { memorize(0, Memorize::StoreData); });
  sweep_commit([&] {
    unit.parameters.execute(ParameterService::Write, 8594, 1);
    unit.parameters.finish_factory_setting();
    unit.parameters.execute(ParameterService::Write, 8470, 2500);
  });
  std::printf(
      "growth: payloads up to %zu bytes, file of %zu bytes: %ld cut cases, %ld old, %ld new, %ld mixed\n",
      grown, file, sweep.cases(), sweep.old_states(), sweep.new_states(), sweep.mixed());
  RecordProperty("cases", static_cast<int>(sweep.cases()));
  EXPECT_EQ(sweep.mixed(), 0);
}

INSTANTIATE_TEST_SUITE_P(Units, PowerCut, ::testing::Values("md60a", "mc07", "mdxb"));
INSTANTIATE_TEST_SUITE_P(Units, PowerCutOneByOne, ::testing::Values("md60a", "mc07"));

}  // namespace
}  // namespace ipos::runtime
