// Saved states: a machine goes on from one as if nothing had happened, and no byte of one can do harm.
#include "tests/generated/pcg.hpp"
#include "tests/embed/rig.hpp"

namespace ipos::tests {
namespace {

const char kProgram[] =
    "#include <const.h>\n#include <io.h>\n"
    "SCTRCYCL t; long data;\n"
    "inner() { data = data + 1; _Wait(3); }\n"
    "outer() { inner(); data = data * 3; inner(); }\n"
    "second() { while (1) H5 = H5 + 3; }\n"
    "main() { t.ObjectNo = 1024; t.CycleTime = 10; t.Format = 8; t.DPointer = numof(data);"
    " _SBusCommDef(SCD_TRCYCL, t); _SBusCommOn(); _SetTask2(T2_START, second);"
    " while (1) { outer(); H6++; } }";

std::vector<uint8_t> save(ipos_vm* vm) {
  std::vector<uint8_t> state(ipos_state_size(vm));
  EXPECT_EQ(ipos_save(vm, state.data(), state.size()), IPOS_OK);
  return state;
}

TEST(ApiState, ARestoredMachineGoesOnAsTheOriginal) {
  const LoadedProgram loaded(kProgram);
  ASSERT_EQ(loaded.status, IPOS_OK);
  for (const uint32_t ticks : {0U, 1U, 17U, 60U, 133U, 500U}) {
    RecordingHost host, other_host;
    const ipos_host callbacks = host.callbacks(), other_callbacks = other_host.callbacks();
    RunningMachine machine(loaded, &callbacks);
    ipos_run_ticks(machine.vm, ticks, nullptr);
    const std::vector<uint8_t> state = save(machine.vm);
    RunningMachine other(loaded, &other_callbacks);
    ipos_run_ticks(other.vm, 77, nullptr);
    ASSERT_EQ(ipos_restore(other.vm, state.data(), state.size()), IPOS_OK);
    EXPECT_EQ(save(other.vm), state);
    other_host.frames.clear();
    const size_t before = host.frames.size();
    ipos_run_ticks(machine.vm, 200, nullptr);
    ipos_run_ticks(other.vm, 200, nullptr);
    EXPECT_EQ(save(other.vm), save(machine.vm));
    EXPECT_EQ(other_host.frames.size(), host.frames.size() - before);
    EXPECT_GE(other_host.frames.size(), ticks == 0 ? 10U : 20U);
  }
}

TEST(ApiState, AFaultIsPartOfIt) {
  const LoadedProgram loaded("main() { H1 = 1 / H0; }");
  RunningMachine machine(loaded), other(loaded);
  EXPECT_EQ(ipos_run_ticks(machine.vm, 9, nullptr), IPOS_FAULTED);
  const std::vector<uint8_t> state = save(machine.vm);
  ASSERT_EQ(ipos_restore(other.vm, state.data(), state.size()), IPOS_OK);
  EXPECT_EQ(ipos_run_ticks(other.vm, 9, nullptr), IPOS_FAULTED);
  ipos_fault fault;
  ASSERT_EQ(ipos_fault_of(other.vm, &fault), IPOS_OK);
  EXPECT_EQ(fault.number, 10);
  EXPECT_STREQ(fault.reason, "");
}

// Every byte changed in several ways, with a checksum that is right: refused without a trace, or run.
TEST(ApiState, ChangedBytesDoNoHarm) {
  const LoadedProgram loaded(kProgram);
  RecordingHost host;
  const ipos_host callbacks = host.callbacks();
  RunningMachine machine(loaded, &callbacks);
  ipos_run_ticks(machine.vm, 133, nullptr);
  const std::vector<uint8_t> good = save(machine.vm);
  Pcg random(1);
  int refused = 0, accepted = 0;
  for (size_t at = 0; at + 4 < good.size(); ++at)
    for (const uint8_t change : {uint8_t{1}, uint8_t{0x80}, static_cast<uint8_t>(1 + random.below(255))}) {
      std::vector<uint8_t> bad = good;
      bad[at] ^= change;
      seal(bad);
      ASSERT_EQ(ipos_restore(machine.vm, good.data(), good.size()), IPOS_OK);
      if (ipos_restore(machine.vm, bad.data(), bad.size()) == IPOS_OK) {
        ++accepted;
        EXPECT_EQ(save(machine.vm), bad);
        ipos_run_ticks(machine.vm, 12, nullptr);
      } else {
        ++refused;
        EXPECT_EQ(save(machine.vm), good) << at;
      }
    }
  EXPECT_GT(refused, 200);
  EXPECT_GT(accepted, 2000);  // variables may have any value
}

TEST(ApiState, TelegramsNeedTheirCallback) {
  const LoadedProgram loaded(kProgram);
  RecordingHost host;
  const ipos_host callbacks = host.callbacks();
  RunningMachine machine(loaded, &callbacks), bare(loaded);
  ipos_run_ticks(machine.vm, 60, nullptr);
  const std::vector<uint8_t> state = save(machine.vm);
  EXPECT_EQ(ipos_restore(bare.vm, state.data(), state.size()), IPOS_BAD_STATE);
}

}  // namespace
}  // namespace ipos::tests
