// What machines of the C API do: ticks and commands, callbacks, telegrams, non-volatile memory, clock, trace.
#include <fstream>
#include <iterator>
#include <set>

#include "tests/embed/rig.hpp"
#include "vm/isa/isa.hpp"

namespace ipos::tests {
namespace {

std::string scom1() {
  std::ifstream in(IPOS_SOURCE_DIR "/examples/scom/SCOM1.IPC", std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

// The default rates are 1, 2 and 20 commands a millisecond (IPOSplus p. 44; task 3 ours).
TEST(ApiMachine, TicksExecuteTheRatesOfATask) {
  const LoadedProgram loaded("main() { while (1) H0++; }");
  RunningMachine machine(loaded);
  ipos_progress progress;
  ASSERT_EQ(ipos_run_ticks(machine.vm, 100, &progress), IPOS_OK);
  EXPECT_EQ(progress.ticks, 100U);
  EXPECT_EQ(progress.commands, 100U);
  EXPECT_EQ(ipos_ticks(machine.vm), 100U);
  const uint32_t fast[3] = {50, 0, 0};
  ASSERT_EQ(ipos_set_rates(machine.vm, fast), IPOS_OK);
  ASSERT_EQ(ipos_run_ticks(machine.vm, 2, &progress), IPOS_OK);
  EXPECT_EQ(progress.commands, 100U);
  EXPECT_EQ(machine[0U], 100);  // ADD and JMP take turns
  uint32_t done = 0;
  ASSERT_EQ(ipos_run_commands(machine.vm, 1, 11, &done), IPOS_OK);
  EXPECT_EQ(done, 11U);
  EXPECT_EQ(ipos_ticks(machine.vm), 102U);  // no time has passed
}

TEST(ApiMachine, WaitsTakeTheirMilliseconds) {
  const LoadedProgram loaded("main() { _Wait(10); H0 = 1; while (1) ; }");
  RunningMachine machine(loaded);
  ASSERT_EQ(ipos_run_ticks(machine.vm, 10, nullptr), IPOS_OK);
  ipos_task task;
  ASSERT_EQ(ipos_task_of(machine.vm, 1, &task), IPOS_OK);
  EXPECT_EQ(task.state, IPOS_TASK_WAITING);
  EXPECT_EQ(task.wait_ms, 1U);
  EXPECT_EQ(machine[0U], 0);
  ASSERT_EQ(ipos_run_ticks(machine.vm, 1, nullptr), IPOS_OK);
  EXPECT_EQ(machine[0U], 1);
}

// 1053 1610 p. 57 to 59, figure 36: the values of SCOM1 after its partner has sent.
TEST(ApiMachine, Scom1SendsAndReceives) {
  const LoadedProgram loaded(scom1());
  RecordingHost host;
  const ipos_host callbacks = host.callbacks();
  RunningMachine machine(loaded, &callbacks);
  ASSERT_EQ(ipos_run_ticks(machine.vm, 500, nullptr), IPOS_OK);
  ASSERT_EQ(host.frames.size(), 5U);
  const uint64_t first = host.frames[0].first;
  for (size_t n = 0; n < host.frames.size(); ++n) {
    const auto& [tick, frame] = host.frames[n];
    EXPECT_EQ(tick, first + 100 * n);
    EXPECT_EQ(frame.id, 1024);
    ASSERT_EQ(frame.length, 8);
    const uint8_t motorola[] = {0x55, 0x66, 0x77, 0x88, 0x11, 0x22, 0x33, 0x44};
    EXPECT_TRUE(std::equal(frame.data, frame.data + 8, motorola));
  }
  EXPECT_EQ(machine["TrCycl.Result"], 99);
  const ipos_frame partner{1025, 8, {0x88, 0x77, 0x66, 0x55, 0x44, 0x33, 0x22, 0x11}};
  EXPECT_EQ(ipos_receive(machine.vm, &partner), IPOS_OK);
  EXPECT_EQ(machine["lReDataHigh"], static_cast<int32_t>(0x88776655));
  EXPECT_EQ(machine["lReDataLow"], 0x44332211);
  const ipos_frame shorter{1025, 4, {}};
  EXPECT_EQ(ipos_receive(machine.vm, &shorter), IPOS_NOT_TAKEN);
  ASSERT_EQ(ipos_stop(machine.vm), IPOS_OK);
  EXPECT_EQ(ipos_receive(machine.vm, &partner), IPOS_NOT_TAKEN);
}

// Status of SCTRACYCL: 1 sending, 2 sent, 3 failed (1053 1610 p. 56).
TEST(ApiMachine, AcyclicTelegramsKeepTheirStatus) {
  const LoadedProgram loaded(
      "#include <const.h>\n#include <io.h>\nSCTRACYCL t; long data;\n"
      "main() { t.ObjectNo = 1100; t.Format = 4; t.DPointer = numof(data); data = 0x01020304;"
      " _SBusCommDef(SCD_TRACYCL, t); while (1) ; }");
  RecordingHost host;
  const ipos_host callbacks = host.callbacks();
  const auto run = [&](ipos_sending sending) {
    host.sending = sending;
    RunningMachine machine(loaded, &callbacks);
    EXPECT_EQ(ipos_run_ticks(machine.vm, 20, nullptr), IPOS_OK);
    const int32_t before = machine["t.Result"];
    EXPECT_EQ(ipos_sent(machine.vm, host.tags.back(), true), IPOS_OK);
    EXPECT_EQ(machine["t.Result"], 2);
    EXPECT_EQ(ipos_sent(machine.vm, host.tags.back(), false), IPOS_OK);
    EXPECT_EQ(machine["t.Result"], 3);
    return before;
  };
  EXPECT_EQ(run(IPOS_SENDING_QUEUED), 1);
  EXPECT_EQ(run(IPOS_SENDING_DONE), 2);
  EXPECT_EQ(run(IPOS_SENDING_FAILED), 3);
  EXPECT_EQ(host.frames.back().second.length, 4);
  EXPECT_EQ(host.frames.back().second.data[0], 1);  // high byte first
}

TEST(ApiMachine, ClosedIdentifiersFollowTheAddress) {
  const LoadedProgram loaded(scom1());
  RecordingHost host;
  const ipos_host callbacks = host.callbacks();
  RunningMachine machine(loaded, &callbacks);
  ASSERT_EQ(ipos_set_sbus(machine.vm, 10'000, 0, 0, 0), IPOS_OK);
  ASSERT_EQ(ipos_run_ticks(machine.vm, 50, nullptr), IPOS_OK);
  // 135 bits in 100 ms are 1350 bit/s of 7000 (70 % of 10000 baud): 80 of 100 remain.
  EXPECT_EQ(machine["TrCycl.Result"], 80);
}

TEST(ApiMachine, CommandsReachTheHostAndWaitForIt) {
  const LoadedProgram loaded(
      "#include <const.h>\nmain() { _GetSys(H7, GS_ACTSPEED); H0 = 1; _AxisStop(AS_PSTOP); H0 = 2; while (1) "
      "; }");
  RecordingHost host;
  ipos_host callbacks = host.callbacks();
  RunningMachine machine(loaded, &callbacks);
  host.reply.answer = IPOS_ANSWER_WAIT;
  ASSERT_EQ(ipos_run_ticks(machine.vm, 10, nullptr), IPOS_OK);
  ASSERT_EQ(host.commands.size(), 1U);
  EXPECT_EQ(host.commands[0].opcode, IPOS_COMMAND_GetSys);
  EXPECT_EQ(host.commands[0].context, 1);
  EXPECT_EQ(host.commands[0].operands[0], 7);
  EXPECT_EQ(host.commands[0].operands[1], 1);
  EXPECT_EQ(machine[0U], 0);
  ASSERT_EQ(ipos_resume(machine.vm, 1), IPOS_OK);
  host.reply = {IPOS_ANSWER_FAULT, 26, "external terminal"};
  ASSERT_EQ(ipos_run_ticks(machine.vm, 10, nullptr), IPOS_FAULTED);
  EXPECT_EQ(machine[0U], 1);
  ASSERT_EQ(host.faults.size(), 1U);
  EXPECT_EQ(host.faults[0].number, 26);
  EXPECT_STREQ(host.faults[0].reason, "external terminal");
  EXPECT_EQ(host.faults[0].address, host.commands[1].address);
}

TEST(ApiMachine, StoppingCancelsWhatTheHostWasDoing) {
  const LoadedProgram loaded("#include <const.h>\nmain() { _AxisStop(AS_PSTOP); }");
  RecordingHost host;
  const ipos_host callbacks = host.callbacks();
  RunningMachine machine(loaded, &callbacks);
  host.reply.answer = IPOS_ANSWER_WAIT;
  ASSERT_EQ(ipos_run_ticks(machine.vm, 1, nullptr), IPOS_OK);
  ASSERT_EQ(ipos_start(machine.vm), IPOS_OK);
  EXPECT_EQ(host.cancelled, std::vector<int>{1});
}

// `cancel` is a callback in whichever function it comes, also in those callbacks may use.
TEST(ApiMachine, StoppingATaskIsNoWayIntoItsMachine) {
  const LoadedProgram loaded("#include <const.h>\nmain() { _AxisStop(AS_PSTOP); while (1) ; }");
  RecordingHost host;
  const ipos_host callbacks = host.callbacks();
  host.reply.answer = IPOS_ANSWER_WAIT;
  for (const bool anew : {false, true}) {
    RunningMachine machine(loaded, &callbacks);
    ASSERT_EQ(ipos_run_ticks(machine.vm, 1, nullptr), IPOS_OK);
    host.nested = IPOS_OK;
    host.cancelled.clear();
    ASSERT_EQ(anew ? ipos_start_task(machine.vm, 1, 0) : ipos_stop_task(machine.vm, 1), IPOS_OK);
    EXPECT_EQ(host.cancelled, std::vector<int>{1});
    EXPECT_EQ(host.nested, IPOS_BUSY);
    EXPECT_EQ(ipos_run_ticks(machine.vm, 1, nullptr), anew ? IPOS_OK : IPOS_ENDED);
  }
}

TEST(ApiMachine, WrongAnswersAreFaults) {
  const LoadedProgram loaded("#include <const.h>\nmain() { _AxisStop(AS_PSTOP); while (1) ; }");
  for (const ipos_reply reply : {ipos_reply{IPOS_ANSWER_TAKEN, 0, nullptr},
                                 ipos_reply{IPOS_ANSWER_FAULT, 0, nullptr}, ipos_reply{9, 0, nullptr}}) {
    RecordingHost host;
    const ipos_host callbacks = host.callbacks();
    RunningMachine machine(loaded, &callbacks);
    host.reply = reply;
    EXPECT_EQ(ipos_run_ticks(machine.vm, 1, nullptr), IPOS_FAULTED);
    EXPECT_EQ(host.faults.at(0).number, 10);
  }
  RunningMachine bare(loaded);
  EXPECT_EQ(ipos_run_ticks(bare.vm, 1, nullptr), IPOS_FAULTED);
  ipos_fault fault;
  ASSERT_EQ(ipos_fault_of(bare.vm, &fault), IPOS_OK);
  EXPECT_EQ(fault.number, 10);
  EXPECT_STRNE(fault.reason, "");
}

TEST(ApiMachine, TheHostCanRaiseFaultsAndEvents) {
  const LoadedProgram loaded(
      "#include <const.h>\non_event() { H1++; }\nmain() { _SetInterrupt(SI_ERROR, on_event); while (1) H0++; "
      "}");
  RecordingHost host;
  const ipos_host callbacks = host.callbacks();
  RunningMachine machine(loaded, &callbacks);
  ASSERT_EQ(ipos_run_ticks(machine.vm, 10, nullptr), IPOS_OK);
  ASSERT_EQ(ipos_raise_event(machine.vm, IPOS_EVENT_ERROR), IPOS_OK);
  ASSERT_EQ(ipos_run_ticks(machine.vm, 10, nullptr), IPOS_OK);
  EXPECT_EQ(machine[1U], 1);
  ASSERT_EQ(ipos_raise_fault(machine.vm, 17, "watchdog"), IPOS_OK);
  ASSERT_EQ(ipos_raise_fault(machine.vm, 18, "again"), IPOS_OK);
  ASSERT_EQ(host.faults.size(), 1U);
  EXPECT_EQ(host.faults[0].number, 17);
}

TEST(ApiMachine, MemKeepsH0ToH127) {
  const LoadedProgram loaded(
      "#include <const.h>\nmain() { H0 = 7; H127 = 8; H128 = 9; _Memorize(MEM_STALL); while (1) ; }");
  RecordingHost host;
  const ipos_host callbacks = host.callbacks();
  {
    RunningMachine machine(loaded, &callbacks);
    ASSERT_EQ(ipos_run_ticks(machine.vm, 10, nullptr), IPOS_OK);
  }
  const LoadedProgram next("main() { while (1) ; }");
  RunningMachine machine(next, &callbacks);
  ASSERT_EQ(ipos_nv_load(machine.vm), IPOS_OK);
  EXPECT_EQ(machine[0U], 7);
  EXPECT_EQ(machine[127U], 8);
  EXPECT_EQ(machine[128U], 0);
  host.nv[100] ^= 1;
  EXPECT_EQ(ipos_nv_load(machine.vm), IPOS_NO_CONTENT);

  host.nv_works = false;
  RunningMachine failing(loaded, &callbacks);
  EXPECT_EQ(ipos_run_ticks(failing.vm, 10, nullptr), IPOS_FAULTED);
  EXPECT_EQ(host.faults.at(0).number, 25);  // F25 EEPROM
}

TEST(ApiMachine, RunDueFollowsTheClock) {
  const LoadedProgram loaded("main() { while (1) H0++; }");
  RecordingHost host;
  const ipos_host callbacks = host.callbacks();
  RunningMachine machine(loaded, &callbacks);
  ipos_progress progress;
  const auto at = [&](uint64_t us, uint32_t most) {
    host.now = us;
    EXPECT_EQ(ipos_run_due(machine.vm, most, &progress), IPOS_OK);
    return progress.ticks;
  };
  EXPECT_EQ(at(5'000'000, 100), 0U);
  EXPECT_EQ(at(5'000'999, 100), 0U);
  EXPECT_EQ(at(5'002'500, 100), 2U);
  EXPECT_EQ(at(5'003'000, 100), 1U);
  EXPECT_EQ(at(5'010'000, 4), 4U);  // 7 are due
  EXPECT_EQ(at(5'010'000, 100), 3U);
  EXPECT_EQ(at(4'000'000, 100), 0U);  // a clock that goes back
}

TEST(ApiMachine, TheTraceIsEveryCommandInOrder) {
  const LoadedProgram loaded("main() { H0 = 1; H1 = 2; while (1) ; }");
  RecordingHost host;
  ipos_host callbacks = host.callbacks();
  callbacks.trace = RecordingHost::note_step;
  RunningMachine machine(loaded, &callbacks), silent(loaded);
  ipos_progress traced, plain;
  ASSERT_EQ(ipos_run_ticks(machine.vm, 30, &traced), IPOS_OK);
  ASSERT_EQ(ipos_run_ticks(silent.vm, 30, &plain), IPOS_OK);
  EXPECT_EQ(traced.commands, plain.commands);
  ASSERT_EQ(host.steps.size(), traced.commands);
  for (size_t n = 0; n < host.steps.size(); ++n) EXPECT_EQ(host.steps[n].tick, n);
  EXPECT_EQ(host.steps[0].address, 0U);
  EXPECT_EQ(host.steps[0].word & 0xFF, static_cast<uint32_t>(vm::Opcode::SetHK));
}

TEST(ApiMachine, TheFastEngineChangesNothing) {
  if (!(ipos_features() & IPOS_FEATURE_FAST)) GTEST_SKIP() << "this build has no fast engine";
  const char source[] = "main() { for (H0 = 0; H0 < 100; H0++) { H1 = H1 * 3 + H0; H2 = H1 >> 3; } }";
  LoadedProgram plain(source), fast(source);
  std::vector<uint64_t> memory(ipos_accelerate_size(fast.program) / 8 + 1);
  ASSERT_EQ(ipos_program_accelerate(fast.program, memory.data(), 8 * memory.size()), IPOS_OK);
  RunningMachine one(plain), two(fast);
  for (int n = 0; n < 50; ++n) {
    uint32_t done_one = 0, done_two = 0;
    EXPECT_EQ(ipos_run_commands(one.vm, 1, 37, &done_one), ipos_run_commands(two.vm, 1, 37, &done_two));
    EXPECT_EQ(done_one, done_two);
    std::vector<uint8_t> a(ipos_state_size(one.vm)), b(a.size());
    ASSERT_EQ(ipos_save(one.vm, a.data(), a.size()), IPOS_OK);
    ASSERT_EQ(ipos_save(two.vm, b.data(), b.size()), IPOS_OK);
    EXPECT_EQ(a, b);
  }
}

TEST(ApiMachine, MachinesOfOneProgramDoNotKnowEachOther) {
  const LoadedProgram loaded("main() { while (1) H0 = H0 + H1; }");
  RunningMachine one(loaded), two(loaded);
  ASSERT_EQ(ipos_write(one.vm, 1, 1), IPOS_OK);
  ASSERT_EQ(ipos_write(two.vm, 1, 1000), IPOS_OK);
  for (int n = 0; n < 20; ++n) {
    ASSERT_EQ(ipos_run_ticks(one.vm, 1, nullptr), IPOS_OK);
    ASSERT_EQ(ipos_run_ticks(two.vm, 1, nullptr), IPOS_OK);
  }
  EXPECT_EQ(one[0U] * 1000, two[0U]);
  EXPECT_EQ(one[0U], 10);
}

TEST(ApiMachine, SymbolsAreThoseOfTheImage) {
  const LoadedProgram loaded(scom1());
  ipos_program_info info;
  ASSERT_EQ(ipos_program_info_of(loaded.program, &info), IPOS_OK);
  EXPECT_EQ(info.variables, 512);
  EXPECT_EQ(info.tasks, 2);
  std::set<std::string> names;
  ipos_symbol symbol;
  for (uint32_t n = 0; n < info.symbols; ++n) {
    ASSERT_EQ(ipos_symbol_at(loaded.program, n, &symbol), IPOS_OK);
    names.emplace(symbol.name, symbol.length);
  }
  EXPECT_EQ(names.count("TrCycl.ObjectNo"), 1U);
  ASSERT_EQ(ipos_find(loaded.program, "lReDataLow", &symbol), IPOS_OK);
  EXPECT_EQ(symbol.variable, 431);
  EXPECT_EQ(symbol.count, 1);
}

// The list of commands in ipos.h is that of the instruction set.
TEST(ApiMachine, EveryHostCommandHasItsNumber) {
  std::set<uint8_t> listed;
#define IPOS_OPCODE_ROW(name, code) listed.insert(code);
  IPOS_HOST_COMMANDS(IPOS_OPCODE_ROW)
#undef IPOS_OPCODE_ROW
  using vm::Opcode;
  const std::set<Opcode> own = {Opcode::WaitH, Opcode::WaitK,  Opcode::Task,
                                Opcode::Task2, Opcode::SetInt, Opcode::VarInt};
  for (const vm::OpcodeInfo& row : vm::opcode_table()) {
    const bool system = row.flow == vm::Flow::System || row.flow == vm::Flow::SystemCall;
    EXPECT_EQ(listed.count(static_cast<uint8_t>(row.opcode)) != 0, system && !own.count(row.opcode))
        << row.name;
  }
}

}  // namespace
}  // namespace ipos::tests
