// A machine's state as bytes: it goes on as the original, and what no machine of the program can be in is refused
// (vm/exec/saved_state.hpp, docs/inside/security.md).
#include "vm/exec/saved_state.hpp"

#include <gtest/gtest.h>

#include "tests/vm/assembled.hpp"

namespace ipos::vm {
namespace {

using tests::Assembled;

// Little endian numbers without gaps, in the order of the structures.
constexpr size_t kStateAt = 0, kDepthAt = 1, kTaskAt = 2, kRankAt = 3, kPcAt = 4, kWaitAt = 8,
                 kCommandsAt = 12, kCallsAt = 20, kContextBytes = kCallsAt + 2 * kMaxCallDepth;
constexpr size_t kEventsAt = kContexts * kContextBytes;  // installed, pending, address (4)
constexpr size_t kEventBytes = 6;
constexpr size_t kWatchesAt = kEventsAt + kEvents * kEventBytes;
constexpr size_t kHeldAt = 1, kModeAt = 2, kWatchTaskAt = 3, kPriorityAt = 4, kSourceAt = 5, kStructureAt = 7,
                 kAddressAt = 17, kWatchBytes = 21;
constexpr size_t kFaultAt = kWatchesAt + kVariableInterrupts * kWatchBytes + 1;  // behind the turn
constexpr size_t kHeadBytes = kFaultAt + 7;  // number, task, context, address (4)

constexpr size_t context_at(int number) { return static_cast<size_t>(number - 1) * kContextBytes; }
constexpr size_t watch_at(int number) { return kWatchesAt + static_cast<size_t>(number) * kWatchBytes; }

// Task 1 is in a function, task 2 in a WAIT, task 3 in a command that the host has not finished, and the routine of
// TIMER 0 in a WAIT.
const char* const kAllStates = R"(
      TASK2 START , M04
      TASK START , M05
      SETINT TIMER0 , M03
      VARINT H10 , M06
      CALL M02
M01 : JMP M01
M02 : ADD H0 + 1
      JMP M02
M03 : WAIT 30
      RET
M04 : WAIT 50
      JMP M04
M05 : MOVLNK H100
      END
M06 : RET
)";

HostReply never_done(void*, Machine&, int, const Instruction&) noexcept { return {Answer::Wait, 0, nullptr}; }

class SavedBytes {
 public:
  SavedBytes() : run_(kAllStates, Host{nullptr, never_done}) {
    run_.set(10, {1, 2, 20, 0, 1, 5});
    run_.tick();
    run_->raise_event(Event::Timer0);
    run_.tick();
    good_.resize(SavedState::size(run_->program()));
    EXPECT_EQ(SavedState::write(run_.machine(), good_.data()), good_.data() + good_.size());
  }

  Machine& machine() { return run_.machine(); }
  const std::vector<uint8_t>& good() const { return good_; }
  uint64_t number(size_t at, size_t bytes) const {
    uint64_t out = 0;
    for (size_t n = bytes; n-- > 0;) out = out << 8 | good_[at + n];
    return out;
  }
  // Whether the state is taken with that number in place of its own.
  bool takes(size_t at, size_t bytes, uint64_t value) const { return takes_all({{at, bytes, value}}); }
  struct Change {
    size_t at, bytes;
    uint64_t value;
  };
  bool takes_all(std::initializer_list<Change> changes) const {
    std::vector<uint8_t> state = good_;
    for (const Change& change : changes)
      for (size_t n = 0; n < change.bytes; ++n)
        state[change.at + n] = static_cast<uint8_t>(change.value >> (8 * n));
    return SavedState::check(program_.machine().program(), state.data());
  }

 private:
  Assembled run_;
  mutable Assembled program_{kAllStates};  // that a check changes nothing
  std::vector<uint8_t> good_;
};

TEST(SavedState, HasEveryNumberOfTheMachine) {
  SavedBytes saved;
  const Machine& machine = saved.machine();
  EXPECT_EQ(saved.good().size(), kHeadBytes + 4 * 1024);
  EXPECT_EQ(machine.task(1).depth, 1);
  EXPECT_EQ(machine.task(2).state, TaskState::Waiting);
  EXPECT_EQ(machine.task(3).state, TaskState::Waiting);
  EXPECT_EQ(machine.active_context(1), context_of(Event::Timer0));
  for (int number = 1; number <= kContexts; ++number) {
    const TaskContext& t = machine.context(number);
    const size_t at = context_at(number);
    EXPECT_EQ(saved.number(at + kStateAt, 1), static_cast<uint64_t>(t.state)) << number;
    EXPECT_EQ(saved.number(at + kDepthAt, 1), t.depth) << number;
    EXPECT_EQ(saved.number(at + kTaskAt, 1), t.task) << number;
    EXPECT_EQ(saved.number(at + kRankAt, 1), t.rank) << number;
    EXPECT_EQ(saved.number(at + kPcAt, 4), t.pc) << number;
    EXPECT_EQ(saved.number(at + kWaitAt, 4), t.wait_ms) << number;
    EXPECT_EQ(saved.number(at + kCommandsAt, 8), t.commands) << number;
    for (size_t n = 0; n < kMaxCallDepth; ++n)
      EXPECT_EQ(saved.number(at + kCallsAt + 2 * n, 2), t.calls[n]) << number;
  }
  for (size_t n = 0; n < 1024; ++n)
    ASSERT_EQ(static_cast<int32_t>(saved.number(kHeadBytes + 4 * n, 4)), machine.variables()[n]) << "H" << n;
}

TEST(SavedState, AMachineGoesOnFromIt) {
  SavedBytes saved;
  Assembled other(kAllStates, Host{nullptr, never_done});
  ASSERT_TRUE(SavedState::check(other->program(), saved.good().data()));
  EXPECT_EQ(SavedState::read(saved.good().data(), other.machine()),
            saved.good().data() + saved.good().size());
  for (int ms = 0; ms < 100; ++ms) {
    if (ms == 40)
      for (Machine* machine : {&saved.machine(), &other.machine()}) {
        machine->raise_event(Event::Timer0);
        machine->variables()[20] ^= -1;
        machine->resume(3);
      }
    EXPECT_EQ(run_tick(saved.machine(), Rates{{3, 5, 7}}), run_tick(other.machine(), Rates{{3, 5, 7}})) << ms;
    std::vector<uint8_t> one(saved.good().size()), two(one);
    SavedState::write(saved.machine(), one.data());
    SavedState::write(other.machine(), two.data());
    ASSERT_EQ(one, two) << "after " << ms << " ms";
  }
}

// Each task goes on in the routine that it was in, and one that was in none in itself, whatever the machine that takes the
// state was in.
TEST(SavedState, EveryTaskIsInItsRoutineAgain) {
  const char* const program = R"(
      TASK2 START , M02
      TASK START , M03
      SETINT TIMER0 , M04
      VARINT H10 , M05
      VARINT H20 , M06
M01 : ADD H1 + 1
      JMP M01
M02 : ADD H2 + 1
      JMP M02
M03 : ADD H3 + 1
      JMP M03
M04 : ADD H4 + 1
      JMP M04
M05 : ADD H5 + 1
      JMP M05
M06 : ADD H6 + 1
      JMP M06
)";
  const auto in_routines = [&](int which) {
    auto run = std::make_unique<Assembled>(program);
    run->set(10, {1, 0, 30, 0, 0, 1});
    run->set(20, {2, 3, 30, 0, 0, 9});
    run->tick();
    if ((which & 1) != 0) (*run)->raise_event(Event::Timer0);
    run->h(kVarIntReq) = ((which & 2) != 0 ? 1 : 0) | ((which & 4) != 0 ? 8 : 0);
    run->tick();
    return run;
  };
  for (int which = 0; which < 8; ++which)
    for (int of_other = 0; of_other < 8; ++of_other) {
      SCOPED_TRACE(testing::Message() << which << " " << of_other);
      const auto original = in_routines(which), other = in_routines(of_other);
      std::vector<uint8_t> state(SavedState::size((*original)->program()));
      SavedState::write(original->machine(), state.data());
      ASSERT_TRUE(SavedState::check((*other)->program(), state.data()));
      SavedState::read(state.data(), other->machine());
      const int routines[] = {context_of(Event::Timer0), context_of_variable_interrupt(0),
                              context_of_variable_interrupt(3)};
      for (int task = 1; task <= kTasks; ++task)
        EXPECT_EQ((*other)->active_context(task), (which >> (task - 1) & 1) != 0 ? routines[task - 1] : task);
      original->tick();
      other->tick();
      for (size_t n = 1; n <= 6; ++n) EXPECT_EQ(other->h(n), original->h(n)) << "H" << n;
    }
}

// A task has its own number and the rank 0; a routine that does something belongs to a task.
TEST(SavedState, ContextsBelongToTheirTask) {
  const SavedBytes saved;
  for (int task = 1; task <= kTasks; ++task)
    for (const bool stopped : {false, true})
      for (uint64_t value = 0; value <= 255; ++value) {
        const SavedBytes::Change state{context_at(task) + kStateAt, 1,
                                       stopped ? 0 : saved.number(context_at(task) + kStateAt, 1)};
        EXPECT_EQ(saved.takes_all({state, {context_at(task) + kTaskAt, 1, value}}),
                  value == static_cast<uint64_t>(task) || (stopped && value == 0))
            << task << " " << value;
        EXPECT_EQ(saved.takes_all({state, {context_at(task) + kRankAt, 1, value}}), value == 0)
            << task << " " << value;
      }
  const size_t timer = context_at(context_of(Event::Timer0));
  for (uint64_t value = 0; value <= 255; ++value) {
    EXPECT_EQ(saved.takes(timer + kTaskAt, 1, value), value >= 1 && value <= 3) << value;
    EXPECT_EQ(saved.takes(timer + kRankAt, 1, value), value <= kMaxPriority) << value;
  }
}

TEST(SavedState, ContextsStandAtCommandsAndReturnToThem) {
  const SavedBytes saved;
  Assembled program(kAllStates);
  const std::span<const uint32_t> code = program->program().code();
  std::vector<bool> starts(code.size());
  for (uint32_t at = 0; at < code.size(); at += decode(code, at).words) starts[at] = true;
  for (size_t at = 0; at < starts.size() + 3; ++at) {
    const bool command = at < starts.size() && starts[at];
    EXPECT_EQ(saved.takes(context_at(1) + kPcAt, 4, at), command) << at;
    EXPECT_EQ(saved.takes(context_at(1) + kCallsAt, 2, at), command) << at;
    EXPECT_TRUE(saved.takes(context_at(1) + kCallsAt + 2, 2, at)) << "beyond its depth";
    EXPECT_TRUE(saved.takes(context_at(4) + kPcAt, 4, at)) << "it does nothing";
    EXPECT_EQ(saved.takes(kEventsAt + 2 * kEventBytes + 2, 4, at), command) << at;
    EXPECT_TRUE(saved.takes(kEventsAt + 2, 4, at)) << "not installed";
    EXPECT_EQ(saved.takes(watch_at(2) + kAddressAt, 4, at), command) << at;
    EXPECT_TRUE(saved.takes(watch_at(1) + kAddressAt, 4, at)) << "not installed";
  }
  // Return addresses that are 0 are those of the first command.
  for (uint64_t depth = 0; depth <= 255; ++depth)
    EXPECT_EQ(saved.takes(context_at(1) + kDepthAt, 1, depth), depth <= 32) << depth;
  EXPECT_TRUE(saved.takes(context_at(1) + kCommandsAt, 8, UINT64_MAX / 2));
  EXPECT_FALSE(saved.takes(context_at(1) + kCommandsAt, 8, UINT64_MAX / 2 + 1));
}

// A unit whose program may call less deep takes no more return addresses.
TEST(SavedState, CallsAreNoDeeperThanTheUnitAllows) {
  SavedBytes saved;
  const std::span<const uint32_t> code = saved.machine().program().code();
  for (const uint8_t limit : std::initializer_list<uint8_t>{1, 4, 32}) {
    const VerifiedImage program = verify(code, Limits{1024, 16384, 3, limit}, {}).image.value();
    for (uint8_t depth = 0; depth <= 33; ++depth) {
      std::vector<uint8_t> state = saved.good();
      state[context_at(1) + kDepthAt] = depth;
      EXPECT_EQ(SavedState::check(program, state.data()), depth <= limit) << int{limit} << " " << int{depth};
    }
  }
}

TEST(SavedState, WaitsAreInCommandsThatWait) {
  const SavedBytes saved;
  const uint64_t function = saved.number(context_at(1) + kPcAt, 4),
                 wait = saved.number(context_at(2) + kPcAt, 4), host = saved.number(context_at(3) + kPcAt, 4);
  const auto takes = [&](uint64_t state, uint64_t pc, uint64_t wait_ms) {
    return saved.takes_all({{context_at(2) + kStateAt, 1, state},
                            {context_at(2) + kPcAt, 4, pc},
                            {context_at(2) + kWaitAt, 4, wait_ms}});
  };
  for (const uint64_t pc : {function, wait, host})
    for (const uint64_t wait_ms : {0U, 1U, 50U}) {
      EXPECT_TRUE(takes(0, pc, wait_ms));
      EXPECT_TRUE(takes(1, pc, wait_ms));
      EXPECT_EQ(takes(2, pc, wait_ms), wait_ms == 0 ? pc == host : pc == wait) << pc << " " << wait_ms;
      EXPECT_FALSE(takes(3, pc, wait_ms)) << "no state";
    }
}

TEST(SavedState, NumbersOfInterruptsAndFaultAreInTheirRanges) {
  const SavedBytes saved;
  constexpr uint64_t kLastStructure = 1024 - 7;  // VARINT has seven elements
  for (uint64_t value = 0; value <= 255; ++value) {
    EXPECT_EQ(saved.takes(watch_at(2) + kModeAt, 1, value), value <= 9) << value;
    EXPECT_EQ(saved.takes(watch_at(2) + kWatchTaskAt, 1, value), value == 2 || value == 3) << value;
    EXPECT_EQ(saved.takes(watch_at(2) + kPriorityAt, 1, value), value <= 10) << value;
    EXPECT_EQ(saved.takes(watch_at(2) + kHeldAt, 1, value), value <= 1) << value;
    EXPECT_TRUE(saved.takes(watch_at(1) + kModeAt, 1, value)) << "not installed";
    EXPECT_EQ(saved.takes(kFaultAt + 1, 1, value), value <= 3) << value;
    EXPECT_EQ(saved.takes(kFaultAt + 2, 1, value), value <= 10) << value;
  }
  for (const uint64_t value :
       {uint64_t{0}, uint64_t{1017}, uint64_t{1018}, uint64_t{1023}, uint64_t{1024}, uint64_t{0xFFFF}}) {
    EXPECT_EQ(saved.takes(watch_at(2) + kSourceAt, 2, value), value < 1024) << value;
    EXPECT_EQ(saved.takes(watch_at(2) + kStructureAt, 2, value), value <= kLastStructure) << value;
  }
}

// An event is pending of an interrupt that is installed only; of the others also the address may be anything.
TEST(SavedState, OnlyInstalledInterruptsArePending) {
  const SavedBytes saved;
  for (size_t event = 0; event < kEvents; ++event) {
    const size_t at = kEventsAt + event * kEventBytes;
    for (uint64_t installed = 0; installed <= 2; ++installed)
      for (uint64_t pending = 0; pending <= 2; ++pending)
        for (const uint64_t address : {0U, 0xFFFFU})
          EXPECT_EQ(saved.takes_all({{at, 1, installed}, {at + 1, 1, pending}, {at + 2, 4, address}}),
                    installed <= 1 && pending <= 1 && (installed == 1 ? address == 0 : pending == 0))
              << event << " " << installed << " " << pending << " " << address;
  }
}

}  // namespace
}  // namespace ipos::vm
