// Variable interrupts of tasks 2 and 3 (IPOSplus p. 38, 45, 347): the copied structure, comparisons, requests
// in H530, priority. Comparison modes and priorities are ours, docs/reference/stdlib.md has them.
#include <gtest/gtest.h>

#include "stdlib/headers.hpp"
#include "stdlib/system_variables.hpp"
#include "tests/generated/pcg.hpp"
#include "tests/vm/assembled.hpp"
#include "vm/exec/interrupts.hpp"

namespace ipos::vm {
namespace {

using tests::Assembled;

// Structure at H10, watched variable H20. Task 2 counts in H0, the routine in H1; H5 != 0 runs VARINT again.
const char* const kOne = R"(
      TASK2 START , M02
M01 : VARINT H10 , M03
      SET H5 = 0
M04 : JMP H5 == 0 , M04
      JMP M01
M02 : ADD H0 + 1
      JMP M02
M03 : ADD H1 + 1
      RET
)";

TEST(VariableInterrupts, TheNumberOfTheRequestVariableIsTheTables) {
  EXPECT_EQ(kVarIntReq, stdlib::system_variable("VarIntReq"));
}

// constb.h has a constant for each mode.
TEST(VariableInterrupts, ConstantsOfTheModes) {
  std::string_view header;
  for (const stdlib::EmbeddedFile& file : stdlib::headers::embedded_files())
    if (file.name == "constb.h") header = file.text;
  const struct {
    int value;
    std::string name;
  } rows[] = {
#define COMPARE_MODE(value, name, constant, meaning) {value, constant},
#include "vm/exec/compare_modes.def"
  };
  EXPECT_EQ(std::size(rows), static_cast<size_t>(kCompareModes));
  for (const auto& row : rows) {
    const size_t at = header.find("#define " + row.name + " ");
    ASSERT_NE(at, std::string_view::npos) << row.name;
    EXPECT_EQ(std::stoi(std::string(header.substr(at + 9 + row.name.size(), 20))), row.value) << row.name;
  }
}

// What each mode makes of a sequence of values, a value a millisecond: how often the routine has run.
TEST(VariableInterrupts, Modes) {
  struct Row {
    int32_t mode;
    int32_t compare;
    std::vector<int32_t> values;  // the first one at VARINT
    std::vector<int32_t> runs;    // after each of the others
  };
  const Row rows[] = {
      {0, 0, {0, 1, 2, 3}, {0, 0, 0}},
      {1, 0b0110, {0, 0b0010, 0b1011, 0b1101, 0b1101}, {1, 1, 2, 2}},
      {2, 0b0110, {0b0010, 0b0010, 0b0110, 0, 0b0100}, {0, 1, 1, 2}},
      {3, 0b0110, {0b0010, 0b0010, 0b0110, 0b0001, 0b0100, 0}, {0, 0, 1, 1, 2}},
      {4, 7, {0, 7, 7, 8, 7}, {1, 1, 1, 2}},
      {5, 7, {7, 7, 8, 9, 7, 6}, {0, 1, 1, 1, 2}},
      {6, -5, {-6, -6, -5, 100, -6, -5}, {0, 1, 1, 1, 2}},
      {7, -5, {0, -4, -5, -6, -4, INT32_MIN}, {0, 1, 1, 1, 2}},
      {8, 0b0110, {0, 0b1001, 0b0010, 0b0100, 0, 0b0010}, {0, 1, 1, 1, 2}},
      {9, 0b0110, {0b0010, 0b0010, 0b1001, 0, 0b0100, 0}, {0, 1, 1, 1, 2}},
      {4, 7, {7, 7, 7}, {1, 1}},  // what holds already at VARINT is an event
  };
  for (const Row& row : rows) {
    Assembled run(kOne);
    run.set(10, {1, 2, 20, row.compare, row.mode, 5});
    run.h(20) = row.values[0];
    run->run(1, 10);
    run->run(2, 10);
    for (size_t n = 0; n < row.runs.size(); ++n) {
      run.h(20) = row.values[n + 1];
      run.tick(8);
      EXPECT_EQ(run.h(1), row.runs[n]) << "mode " << row.mode << ", value " << n + 1;
    }
    EXPECT_EQ(run->fault().number, 0);
  }
}

TEST(VariableInterrupts, TheStructureIsCopied) {
  Assembled run(kOne);
  run.set(10, {1, 0, 20, 7, 4, 5});
  run.tick(8);
  run.h(13) = 9;  // has no effect until VARINT runs again
  run.h(20) = 9;
  run.tick(8);
  EXPECT_EQ(run.h(1), 0);
  run.h(20) = 7;
  run.tick(8);
  EXPECT_EQ(run.h(1), 1);
  EXPECT_EQ(run.h(16), 7) << "IntEvent is the value at the event";
  run.h(5) = 1;  // arms number 0 anew, with the new value
  run.tick(8);
  run.h(20) = 9;
  run.tick(8);
  EXPECT_EQ(run.h(1), 2);
}

TEST(VariableInterrupts, RequestsInH530) {
  Assembled run(kOne);
  run.set(10, {1, 3, 20, 0, 0, 5});
  run.tick(8);
  run.h(530) = 0b1111;  // the others are not installed
  run.tick(8);
  EXPECT_EQ(run.h(1), 1);
  EXPECT_EQ(run.h(530), 0);
}

TEST(VariableInterrupts, RequestsOfNone) {
  Assembled run("M01 : JMP M01\n");
  run.h(530) = 0b111111;
  run.tick(8);
  EXPECT_EQ(run.h(530), 0b110000) << "the others are nobody's";
}

TEST(VariableInterrupts, ControlZeroEndsAll) {
  Assembled run(kOne);
  run.set(10, {1, 0, 20, 7, 4, 5});
  run.tick(8);
  run.h(10) = 0;
  run.h(5) = 1;
  run.tick(8);
  run.h(20) = 7;
  run.h(530) = 1;
  run.tick(8);
  EXPECT_EQ(run.h(1), 0);
  EXPECT_EQ(run.h(530), 0);
}

TEST(VariableInterrupts, PriorityZeroIsOff) {
  Assembled run(kOne);
  run.set(10, {1, 0, 20, 7, 4, 0});
  run.h(20) = 7;
  for (int n = 0; n < 3; ++n) run.tick(8);
  EXPECT_EQ(run.h(1), 0);
  EXPECT_EQ(run->fault().number, 0);
}

TEST(VariableInterrupts, OnlyWhileTheTaskRuns) {
  Assembled run(R"(
      VARINT H10 , M03
M04 : JMP H5 == 0 , M04
      TASK START , M02
M05 : JMP M05
M02 : ADD H0 + 1
      JMP M02
M03 : ADD H1 + 1
      RET
)");
  run.set(10, {2, 0, 20, 7, 4, 5});
  run.h(20) = 7;
  run.h(530) = 1;
  for (int n = 0; n < 3; ++n) run.tick(8);
  EXPECT_EQ(run.h(1), 0);
  EXPECT_EQ(run.h(530), 0) << "not made up for";
  run.h(5) = 1;
  run.tick(8);
  run.tick(8);
  EXPECT_EQ(run.h(1), 0) << "nor is the condition that has lasted since then";
  EXPECT_EQ(run.h(16), 0) << "what is lost is no event";
  run.h(20) = 8;
  run.tick(8);
  run.h(20) = 7;
  run.tick(8);
  EXPECT_EQ(run.h(1), 1);
  EXPECT_EQ(run->context(context_of_variable_interrupt(0)).task, 3);
}

// What a mode makes of two values, as compare_modes.def has it; `held`: it was so at the last look.
bool is_event(CompareMode mode, int32_t compare, int32_t before, int32_t now, bool& held) {
  bool holds = false;
  switch (mode) {
    case CompareMode::Never: return false;
    case CompareMode::Changed: return (before & compare) != (now & compare);
    case CompareMode::Rising: return (~before & now & compare) != 0;
    case CompareMode::Falling: return (before & ~now & compare) != 0;
    case CompareMode::Equal: holds = now == compare; break;
    case CompareMode::NotEqual: holds = now != compare; break;
    case CompareMode::AtLeast: holds = now >= compare; break;
    case CompareMode::AtMost: holds = now <= compare; break;
    case CompareMode::AnySet: holds = (now & compare) != 0; break;
    case CompareMode::NoneSet: holds = (now & compare) == 0; break;
  }
  const bool event = holds && !held;
  held = holds;
  return event;
}

// The unit looks in every millisecond, whether the task runs or not; what happens while it does not is over, in each mode.
TEST(VariableInterrupts, EventsOfAStoppedTaskAreLost) {
  tests::Pcg random(44);
  for (int32_t mode = 0; mode < kCompareModes; ++mode) {
    int32_t events = 0;
    for (int course = 0; course < 60; ++course) {
      SCOPED_TRACE(testing::Message() << "mode " << mode << ", course " << course);
      const int32_t compare = 1 + random.below(6), number = random.below(4), task = 2 + random.below(2);
      Assembled run(kOne);
      run.set(10, {task - 1, number, 20, compare, mode, 5});
      int32_t before = run.h(20) = random.below(8);
      run->run(1, 10);
      const uint32_t begin = run->task(2).pc;  // of both tasks
      run->stop_task(2);
      bool held = false, runs = false;
      int32_t expected = 0, seen = 0;
      for (int ms = 0; ms < 60; ++ms) {
        if (random.one_in(5)) {
          runs = !runs;
          runs ? run->start_task(task, begin) : run->stop_task(task);
        }
        if (random.one_in(2)) run.h(20) = random.below(8);
        const int32_t now = run.h(20);
        if (is_event(static_cast<CompareMode>(mode), compare, before, now, held) && runs)
          ++expected, seen = now;
        before = now;
        run.tick(8);
        ASSERT_EQ(run.h(1), expected) << ms;
        ASSERT_EQ(run.h(16), seen) << ms;
        ASSERT_EQ(run.h(530), 0) << ms;
      }
      events += expected;
    }
    EXPECT_EQ(events > 60, mode != 0) << "mode " << mode << ", " << events << " events";
  }
}

// Also a program that a fault has stopped: the unit goes on looking, takes its requests away, and none of the routines begins.
TEST(VariableInterrupts, AfterAFaultNoneBegins) {
  Assembled run(R"(
      TASK2 START , M02
      VARINT H10 , M03
      DIV H0 / H0
M02 : JMP M02
M03 : ADD H1 + 1
      RET
)");
  run.set(10, {1, 2, 20, 7, 4, 5});
  run.tick(8);
  ASSERT_EQ(run->fault().number, kFaultIllop);
  run.h(20) = 7;
  run.h(530) = -1;
  run.tick(8);
  EXPECT_EQ(run.h(530), ~kAllRequests);
  EXPECT_EQ(run.h(1), 0);
  EXPECT_EQ(run.h(16), 0);
}

// IntEvent is written when the event comes, also where its routine has to wait.
TEST(VariableInterrupts, IntEventIsWrittenAtTheEvent) {
  Assembled run(R"(
      TASK2 START , M02
      VARINT H10 , M03
      VARINT H20 , M04
M01 : JMP M01
M02 : JMP M02
M03 : WAIT 10
      RET
M04 : SET H1 = H26
      RET
)");
  run.set(10, {1, 0, 30, 0, 0, 9});
  run.set(20, {1, 1, 31, 5, 6, 1});
  run.tick(8);
  run.h(530) = 1;
  run.tick(8);
  run.h(31) = 6;
  run.tick(8);
  EXPECT_EQ(run.h(26), 6);
  EXPECT_EQ(run.h(1), 0) << "its routine waits for the end of the other one";
  run.h(31) = 4;
  run.tick(8);
  run.h(31) = 8;
  run.tick(8);
  EXPECT_EQ(run.h(26), 8) << "an event that comes again before that, remembered once";
  for (int n = 0; n < 12; ++n) run.tick(8);
  EXPECT_EQ(run.h(1), 8);
}

// Structures at H10, H20, H30, H40 for numbers 0..3, all on task 2, in mode 0; routines wait 9 ms and note
// begin and end as digits in H0.
TEST(VariableInterrupts, PriorityDecides) {
  const char* const program = R"(
      TASK2 START , M09
      VARINT H10 , M01
      VARINT H20 , M02
      VARINT H30 , M03
      END
M09 : JMP M09
M01 : MUL H0 * 10
      ADD H0 + 1
      WAIT 9
      MUL H0 * 10
      ADD H0 + 2
      RET
M02 : MUL H0 * 10
      ADD H0 + 3
      WAIT 9
      MUL H0 * 10
      ADD H0 + 4
      RET
M03 : MUL H0 * 10
      ADD H0 + 5
      WAIT 9
      MUL H0 * 10
      ADD H0 + 6
      RET
)";
  const auto setup = [](Assembled& run) {
    run.set(10, {1, 0, 100, 0, 0, 1});
    run.set(20, {1, 1, 100, 0, 0, 10});
    run.set(30, {1, 2, 100, 0, 0, 1});
    run.tick();
  };
  Assembled together(program);
  setup(together);
  together.h(530) = 0b111;
  together.tick();
  EXPECT_EQ(together.h(0), 3) << "the highest begins";
  EXPECT_EQ(together.h(530), 0b101) << "the others are pending, and seen";
  for (int n = 0; n < 40; ++n) together.tick();
  EXPECT_EQ(together.h(0), 341'256) << "of equals the lower number first, and neither breaks into the other";

  Assembled nested(program);
  setup(nested);
  nested.h(530) = 0b001;
  nested.tick();
  nested.h(530) = 0b010;
  nested.tick();
  for (int n = 0; n < 40; ++n) nested.tick();
  EXPECT_EQ(nested.h(0), 1342);

  Assembled cancelled(program);
  setup(cancelled);
  cancelled.h(530) = 0b011;
  cancelled.tick();
  cancelled.h(530) = 0;  // p. 50: clearing the bit cancels one that is pending
  for (int n = 0; n < 40; ++n) cancelled.tick();
  EXPECT_EQ(cancelled.h(0), 34);
}

TEST(VariableInterrupts, WrongStructuresAreF10) {
  const struct {
    size_t element;
    int32_t value;
    const char* word;
  } rows[] = {{0, 3, "Control"},   {0, -1, "Control"},  {1, 4, "IntNum"},        {1, -1, "IntNum"},
              {2, 1024, "SrcVar"}, {2, -1, "SrcVar"},   {4, 10, "Mode"},         {4, -1, "Mode"},
              {5, 11, "Priority"}, {5, -1, "Priority"}, {2, INT32_MIN, "SrcVar"}};
  for (const auto& row : rows) {
    Assembled run(kOne);
    run.set(10, {1, 0, 20, 7, 4, 5});
    run.h(10 + row.element) = row.value;
    run.tick(8);
    EXPECT_EQ(run->fault().number, 10) << row.word << row.value;
    EXPECT_NE(std::string(run->fault().reason).find(row.word), std::string::npos) << run->fault().reason;
  }
}

// Interrupts of tasks 2 and 3 leave task 1 and the other one alone, and those of task 1 them.
TEST(VariableInterrupts, OtherTasksRunOn) {
  Assembled run(R"(
      SETINT TIMER0 , M06
      TASK2 START , M02
      TASK START , M03
      VARINT H10 , M05
M01 : ADD H100 + 1
      JMP M01
M02 : ADD H101 + 1
      JMP M02
M03 : ADD H102 + 1
      JMP M03
M05 : WAIT 100
      RET
M06 : WAIT 100
      RET
)");
  run.set(10, {2, 0, 20, 0, 0, 5});
  run.tick(10);
  const auto counts = [&] { return std::array{run.h(100), run.h(101), run.h(102)}; };
  auto before = counts();
  run.h(530) = 1;
  run.tick(10);
  EXPECT_EQ(counts(), (std::array{before[0] + 5, before[1] + 5, before[2]}));
  before = counts();
  run->raise_event(Event::Timer0);
  run.tick(10);
  EXPECT_EQ(counts(), (std::array{before[0], before[1] + 5, before[2]}));
}

// The ends of all ranges are values of the structure (docs/reference/stdlib.md).
TEST(VariableInterrupts, TheEndsOfTheRangesAreTaken) {
  for (const int32_t control : {1, 2})
    for (const int32_t number : {0, 3})
      for (const int32_t source : {0, 1023})
        for (const int32_t mode : {0, 9})
          for (const int32_t priority : {1, 10}) {
            Assembled run(
                "TASK2 START , M01\nTASK START , M01\nVARINT H10 , M02\nM01 : JMP M01\nM02 : ADD H1 + "
                "1\nRET\n");
            run.h(0) = run.h(1023) = 1;
            run.set(10, {control, number, source, 1, mode, priority});
            run.tick();
            EXPECT_EQ(run->fault().number, 0);
            const VariableInterrupt& row = run->interrupts().variables[static_cast<size_t>(number)];
            EXPECT_TRUE(row.installed);
            EXPECT_EQ(row.task, control + 1);
            EXPECT_EQ(row.source, source);
            EXPECT_EQ(static_cast<int32_t>(row.mode), mode);
            EXPECT_EQ(row.priority, priority);
            run.h(kVarIntReq) = 1 << number;
            run.tick();
            EXPECT_EQ(run.h(1), 1);
            EXPECT_EQ(run.h(kVarIntReq), 0);
          }
}

// Bits of H530 that are no requests are nobody's, with interrupts that begin, wait and are not installed.
TEST(VariableInterrupts, OtherBitsOfTheRequestsStay) {
  for (int32_t number = 0; number < kVariableInterrupts; ++number) {
    Assembled run(kOne);
    run.set(10, {1, number, 20, 0, 0, 5});
    run.tick(8);
    run.h(530) = -1;
    run.tick(8);
    EXPECT_EQ(run.h(1), 1);
    EXPECT_EQ(run.h(530), -16);
  }
}

// A routine that runs is not begun again, also when it has meanwhile been installed anew with a higher priority or for the
// other task: the request waits for its end.
TEST(VariableInterrupts, ARoutineThatRunsIsNotBegunAgain) {
  for (const int32_t control : {1, 2}) {
    Assembled run(R"(
      TASK2 START , M01
      TASK START , M01
      VARINT H10 , M02
M03 : JMP H5 == 0 , M03
      VARINT H10 , M02
M01 : JMP M01
M02 : MUL H1 * 10
      ADD H1 + 1
      WAIT 5
      ADD H1 + 1
      RET
)");
    run.set(10, {1, 0, 20, 0, 0, 1});
    run.tick();
    run.h(530) = 1;
    run.tick();
    EXPECT_EQ(run.h(1), 1);
    run.set(10, {control, 0, 20, 0, 0, 9});
    run.h(5) = 1;
    run.tick();
    run.h(530) = 1;
    for (int n = 0; n < 3; ++n) run.tick();
    EXPECT_EQ(run.h(1), 1);
    EXPECT_EQ(run.h(530), 1) << "pending";
    for (int n = 0; n < 20; ++n) run.tick();
    EXPECT_EQ(run.h(1), 22) << "the first to its end, then the second";
    EXPECT_EQ(run->context(context_of_variable_interrupt(0)).task, control + 1);
  }
}

// Among all numbers and priorities: the higher one begins, of equals the lower number, and all of them run once.
TEST(VariableInterrupts, EveryPairOfPrioritiesIsInOrder) {
  for (int32_t first = 1; first <= kMaxPriority; ++first)
    for (int32_t second = 1; second <= kMaxPriority; ++second)
      for (const auto& [one, two] : {std::pair(0, 1), std::pair(1, 3), std::pair(2, 3)}) {
        Assembled run(R"(
      TASK2 START , M01
      VARINT H10 , M02
      VARINT H20 , M03
M01 : JMP M01
M02 : MUL H1 * 10
      ADD H1 + 1
      RET
M03 : MUL H1 * 10
      ADD H1 + 2
      RET
)");
        run.set(10, {1, one, 100, 0, 0, first});
        run.set(20, {1, two, 100, 0, 0, second});
        run.tick();
        run.h(530) = 1 << one | 1 << two;
        for (int n = 0; n < 3; ++n) run.tick();
        // The lower one begins in a later millisecond, when the higher one has ended.
        EXPECT_EQ(run.h(1), first >= second ? 12 : 21) << first << " " << second;
      }
}

// Without H530 there are no variable interrupts: a unit ends in front of it or behind.
TEST(VariableInterrupts, NeedTheVariableOfTheRequests) {
  for (const uint16_t variables : std::initializer_list<uint16_t>{512, 529, 530, 531, 532, 1024}) {
    Assembled unit(kOne);
    const std::vector<uint32_t> code(unit->program().code().begin(), unit->program().code().end());
    Machine machine(verify(code, Limits{variables, 16384, 3, 32}, {}).image.value(), {});
    machine.start();
    const auto h = [&](size_t n) -> int32_t& { return machine.variables()[n]; };
    const int32_t structure[] = {1, 0, 20, 7, 4, 5};
    std::copy(std::begin(structure), std::end(structure), machine.variables().begin() + 10);
    run_tick(machine, Rates{{8, 8, 8}});
    EXPECT_EQ(machine.idle_ticks({0, 0, 0}), kIdleForever) << variables;
    h(20) = 7;
    const bool has_requests = variables > 530;
    EXPECT_EQ(machine.idle_ticks({0, 0, 0}), has_requests ? 0 : kIdleForever) << variables;
    run_tick(machine, Rates{{8, 8, 8}});
    EXPECT_EQ(h(1), has_requests ? 1 : 0) << variables;
    EXPECT_EQ(machine.fault().number, 0);
  }
}

}  // namespace
}  // namespace ipos::vm
