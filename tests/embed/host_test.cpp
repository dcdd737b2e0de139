// What passes between a machine of the C API and its host, to the last byte: telegrams, non-volatile memory, saved states,
// and the commands that are done without asking the host.
#include "tests/embed/rig.hpp"

namespace ipos::tests {
namespace {

uint64_t little_endian(const std::vector<uint8_t>& bytes, size_t at, size_t count) {
  uint64_t out = 0;
  for (size_t n = count; n-- > 0;) out = out << 8 | bytes[at + n];
  return out;
}

// Motorola, high byte first: with 8 bytes the second variable stands in front of the first, as figure 36 of 1053 1610 p. 59
// has it (High in front of Low).
TEST(ApiHost, TelegramsHaveEveryByteOfTheVariables) {
  for (const bool cyclic : {false, true})
    for (const uint8_t length : {uint8_t{4}, uint8_t{8}}) {
      const std::string kind = cyclic ? "SCTRCYCL t;" : "SCTRACYCL t;";
      const std::string define = cyclic ? " t.CycleTime = 10; _SBusCommDef(SCD_TRCYCL, t); _SBusCommOn();"
                                        : " _SBusCommDef(SCD_TRACYCL, t);";
      const LoadedProgram loaded(
          "#include <const.h>\n#include <io.h>\n" + kind + " long data[2];\n" +
          "main() { data[0] = 0x05060708; data[1] = 0x01020304; t.ObjectNo = 1100; t.Format = " +
          std::to_string(length) + "; t.DPointer = numof(data);" + define + " while (1) ; }");
      RecordingHost host;
      const ipos_host callbacks = host.callbacks();
      RunningMachine machine(loaded, &callbacks);
      ASSERT_EQ(ipos_run_ticks(machine.vm, 60, nullptr), IPOS_OK);
      ASSERT_FALSE(host.frames.empty());
      const ipos_frame& frame = host.frames.back().second;
      EXPECT_EQ(frame.id, 1100);
      ASSERT_EQ(frame.length, length);
      for (uint8_t n = 0; n < length; ++n) EXPECT_EQ(frame.data[n], 8 - length + n + 1) << cyclic;
    }
}

// The layout of embed/saved.cpp: "IPNV", CRC-32 of the values, H0 to H127.
TEST(ApiHost, NonVolatileMemoryHasItsLayout) {
  const LoadedProgram loaded("main() { while (1) ; }");
  RecordingHost host;
  const ipos_host callbacks = host.callbacks();
  RunningMachine machine(loaded, &callbacks);
  for (uint32_t n = 0; n < 200; ++n)
    ASSERT_EQ(ipos_write(machine.vm, n, static_cast<int32_t>(0x01020304 + n)), IPOS_OK);
  ASSERT_EQ(ipos_nv_store(machine.vm), IPOS_OK);
  EXPECT_EQ(std::string(host.nv.begin(), host.nv.begin() + 4), "IPNV");
  EXPECT_EQ(little_endian(host.nv, 4, 4), vm::crc32(std::span(host.nv).subspan(8)));
  for (uint32_t n = 0; n < IPOS_NV_VARIABLES; ++n)
    EXPECT_EQ(little_endian(host.nv, 8 + 4 * n, 4), 0x01020304 + n);
  // Any other byte is no content, and a load that fails leaves the variables as they are.
  const std::vector<uint8_t> good = host.nv;
  ASSERT_EQ(ipos_write(machine.vm, 5, 77), IPOS_OK);
  for (size_t at = 0; at < good.size(); ++at) {
    host.nv = good;
    host.nv[at] ^= 0x10;
    ASSERT_EQ(ipos_nv_load(machine.vm), IPOS_NO_CONTENT) << at;
  }
  EXPECT_EQ(machine[5U], 77);
  host.nv = good;
  ASSERT_EQ(ipos_nv_load(machine.vm), IPOS_OK);
  EXPECT_EQ(machine[5U], 0x01020304 + 5);
}

// "IPS1", checksum of the image, ticks; at the end the CRC-32 of all.
TEST(ApiHost, StatesHaveTheirLayout) {
  const std::vector<uint8_t> image = image_of("main() { while (1) H0++; }");
  const LoadedProgram loaded(image);
  RunningMachine machine(loaded);
  ASSERT_EQ(ipos_run_ticks(machine.vm, 0x123, nullptr), IPOS_OK);
  std::vector<uint8_t> state(ipos_state_size(machine.vm) + 3, 0xEE);
  ASSERT_EQ(ipos_save(machine.vm, state.data(), state.size()), IPOS_OK);
  const size_t end = state.size() - 3;
  EXPECT_EQ(std::string(state.begin(), state.begin() + 4), "IPS1");
  EXPECT_EQ(little_endian(state, 4, 4), little_endian(image, image.size() - 4, 4));
  EXPECT_EQ(little_endian(state, 8, 8), 0x123U);
  EXPECT_EQ(little_endian(state, end - 4, 4), vm::crc32(std::span(state).first(end - 4)));
  EXPECT_EQ(little_endian(state, end, 3), 0xEEEEEEU) << "nothing behind it is written";
  // Ticks are counted on below 2^62.
  state.resize(end);
  for (const uint8_t high : {uint8_t{0x3F}, uint8_t{0x40}, uint8_t{0xFF}}) {
    state[15] = high;
    seal(state);
    EXPECT_EQ(ipos_restore(machine.vm, state.data(), state.size()), high < 0x40 ? IPOS_OK : IPOS_BAD_STATE);
  }
  EXPECT_EQ(ipos_ticks(machine.vm), 0x3F00'0000'0000'0123U);
}

// MEM: 1 and 4 store, 2 loads, 0 and 3 do nothing; without nv_write the host is asked.
TEST(ApiHost, MemStoresAndLoadsByItsKeyword) {
  for (int what = 0; what <= 4; ++what)
    for (const bool has_memory : {true, false}) {
      const LoadedProgram loaded("main() { H0 = 7; _Memorize(" + std::to_string(what) + "); while (1) ; }");
      RecordingHost host;
      ipos_host callbacks = host.callbacks();
      {
        const LoadedProgram other("main() { while (1) ; }");
        RunningMachine machine(other, &callbacks);
        ASSERT_EQ(ipos_write(machine.vm, 0, 5), IPOS_OK);
        ASSERT_EQ(ipos_nv_store(machine.vm), IPOS_OK);
      }
      if (!has_memory) callbacks.nv_write = nullptr;
      RunningMachine machine(loaded, &callbacks);
      ASSERT_EQ(ipos_run_ticks(machine.vm, 10, nullptr), IPOS_OK);
      const bool stores = has_memory && (what == 1 || what == 4);
      EXPECT_EQ(little_endian(host.nv, 8, 4), stores ? 7U : 5U) << what;
      EXPECT_EQ(machine[0U], has_memory && what == 2 ? 5 : 7) << what;
      EXPECT_EQ(host.commands.size(), has_memory ? 0U : 1U) << what;
      if (!has_memory) {
        EXPECT_EQ(host.commands[0].opcode, IPOS_COMMAND_Memorize);
        EXPECT_EQ(host.commands[0].operands[0], what);
      }
    }
}

// SCOMST: 1 on, 0 off, and the variable takes the state. Without `send` the host is asked, as of all commands of SCOM.
TEST(ApiHost, TelegramsAreSwitchedOnAndOff) {
  const std::string text =
      "#include <const.h>\n#include <io.h>\nSCTRCYCL t; long data, state;\n"
      "main() { t.ObjectNo = 1100; t.CycleTime = 10; t.Format = 4; t.DPointer = numof(data); state = 9;"
      " _SBusCommDef(SCD_TRCYCL, t); _SBusCommOn(); while (H0 == 0) ; _SBusCommState(0, state); while (H0 == "
      "1) ;"
      " _SBusCommState(1, state); while (1) ; }";
  const LoadedProgram loaded(text);
  RecordingHost host;
  ipos_host callbacks = host.callbacks();
  RunningMachine machine(loaded, &callbacks);
  const auto frames = [&](int32_t phase) {
    EXPECT_EQ(ipos_write(machine.vm, 0, phase), IPOS_OK);
    EXPECT_EQ(ipos_run_ticks(machine.vm, 30, nullptr), IPOS_OK);
    host.frames.clear();
    EXPECT_EQ(ipos_run_ticks(machine.vm, 100, nullptr), IPOS_OK);
    return host.frames.size();
  };
  EXPECT_EQ(frames(0), 10U);
  EXPECT_EQ(machine["state"], 9);
  EXPECT_EQ(frames(1), 0U);
  EXPECT_EQ(machine["state"], 0);
  EXPECT_EQ(frames(2), 10U);
  EXPECT_EQ(machine["state"], 1);
  EXPECT_TRUE(host.commands.empty());

  callbacks.send = nullptr;
  RunningMachine asks(loaded, &callbacks);
  ASSERT_EQ(ipos_write(asks.vm, 0, 2), IPOS_OK);
  ASSERT_EQ(ipos_run_ticks(asks.vm, 50, nullptr), IPOS_OK);
  std::vector<int> opcodes;
  for (const ipos_command& command : host.commands) opcodes.push_back(command.opcode);
  EXPECT_EQ(opcodes, (std::vector<int>{IPOS_COMMAND_Scom, IPOS_COMMAND_ScomOn, IPOS_COMMAND_ScomState,
                                       IPOS_COMMAND_ScomState}));
}

// Of every context, from the first to the last; what a fresh machine says of it.
TEST(ApiHost, EveryContextIsThere) {
  const LoadedProgram loaded("f() { _Wait(50); } main() { f(); while (1) ; }");
  RunningMachine machine(loaded);
  ASSERT_EQ(ipos_run_ticks(machine.vm, 5, nullptr), IPOS_OK);
  for (uint8_t context = 1; context <= 10; ++context) {
    ipos_task task;
    ASSERT_EQ(ipos_task_of(machine.vm, context, &task), IPOS_OK);
    EXPECT_EQ(task.state, context == 1 ? IPOS_TASK_WAITING : IPOS_TASK_STOPPED) << int{context};
    EXPECT_EQ(task.depth, context == 1 ? 1U : 0U);
    EXPECT_EQ(task.wait_ms, context == 1 ? 47U : 0U) << "of 50, waited since the second tick";
    EXPECT_EQ(task.commands, context == 1 ? 2U : 0U);
    EXPECT_EQ(ipos_resume(machine.vm, context), IPOS_NOT_TAKEN) << "a wait for time";
  }
}

// Whichever the event is, it is the one that is installed.
TEST(ApiHost, EventsAreThoseOfTheirKeyword) {
  const std::pair<const char*, ipos_event> rows[] = {{"SI_ERROR", IPOS_EVENT_ERROR},
                                                     {"SI_TOUCHP1", IPOS_EVENT_TOUCH_PROBE},
                                                     {"SI_TIMER0", IPOS_EVENT_TIMER0}};
  for (const auto& [name, installed] : rows)
    for (const auto& [other, raised] : rows) {
      const LoadedProgram loaded("#include <const.h>\nr() { H1++; }\nmain() { _SetInterrupt(" +
                                 std::string(name) + ", r); while (1) ; }");
      RunningMachine machine(loaded);
      ASSERT_EQ(ipos_run_ticks(machine.vm, 5, nullptr), IPOS_OK);
      ASSERT_EQ(ipos_raise_event(machine.vm, raised), IPOS_OK);
      ASSERT_EQ(ipos_run_ticks(machine.vm, 10, nullptr), IPOS_OK);
      EXPECT_EQ(machine[1U], installed == raised ? 1 : 0) << name << " " << other;
    }
}

// A command that calls a function if something holds: the host says whether it does.
TEST(ApiHost, TakenCallsTheFunctionAndDoneDoesNot) {
  const LoadedProgram loaded(
      "f() { H1++; } g() { H2++; } main() { _SystemCall(1, f); _InputCall(1, 12, g); H3 = 1; while (1) ; }");
  for (const bool taken : {true, false}) {
    RecordingHost host;
    host.reply.answer = taken ? IPOS_ANSWER_TAKEN : IPOS_ANSWER_DONE;
    const ipos_host callbacks = host.callbacks();
    RunningMachine machine(loaded, &callbacks);
    ASSERT_EQ(ipos_run_ticks(machine.vm, 20, nullptr), IPOS_OK);
    for (const uint32_t function : {1U, 2U}) EXPECT_EQ(machine[function], taken ? 1 : 0) << function;
    EXPECT_EQ(machine[3U], 1);
  }
}

}  // namespace
}  // namespace ipos::tests
