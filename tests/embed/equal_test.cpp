// The VM of the library (embed/core, in C) against that of the simulation: whole states after every tick, on every
// language program, the examples and thousands of programs by chance; and its variable telegrams against runtime/scom.
#include <map>

#include "runtime/scom/object_table.hpp"
#include "tests/embed/reference.hpp"
#include "tests/embed/rig.hpp"

namespace ipos::tests {
namespace {

constexpr size_t kStateHead = 16;               // magic, checksum, ticks
constexpr uint32_t kRandomPrograms = 3000;

struct Library {
  ipos_vm* vm;
  const ipos_program_info& info;
  chance random;

  static ipos_reply command(void* self, ipos_vm* vm, const ipos_command* command) {
    auto& mine = *static_cast<Library*>(self);
    const bool can_call =
        command->opcode == IPOS_COMMAND_InputCall || command->opcode == IPOS_COMMAND_SystemCall;
    const host_answer answer = answer_of(&mine.random, can_call, mine.info.variables);
    if (answer.writes) ipos_variables(vm)[answer.variable] = answer.value;
    return {answer.answer, answer.fault, ""};
  }

  ipos_status obey() {
    const order next = order_of(&random, info.variables, info.tasks);
    switch (next.kind) {
      case ORDER_NONE: return IPOS_OK;
      case ORDER_WRITE: return ipos_write(vm, next.number, next.value);
      case ORDER_EVENT: return ipos_raise_event(vm, static_cast<ipos_event>(next.number));
      case ORDER_RESUME: ipos_resume(vm, static_cast<uint8_t>(next.number)); return IPOS_OK;
      case ORDER_START: return ipos_start_task(vm, static_cast<uint8_t>(next.number), 0);
      case ORDER_STOP: return ipos_stop_task(vm, static_cast<uint8_t>(next.number));
      case ORDER_FAULT: return ipos_raise_fault(vm, static_cast<uint8_t>(next.number), "by chance");
    }
    return IPOS_INVALID_ARGUMENT;
  }
};

struct Totals {
  uint32_t programs = 0, faults = 0;
  uint64_t commands = 0, routines = 0;
  std::map<uint8_t, uint32_t> fault_numbers;
};

// Empty: equal through the whole run.
std::string difference(const OrderedRun& run, bool accelerated, Totals& totals) {
  const vm::Image image = vm::read_image(run.image).image;
  if (stdlib::find_unit(image.unit)->variables > ipos_most_variables() || image.code.size() > ipos_most_words()) return "";
  const LoadedProgram loaded(run.image);
  if (loaded.status != IPOS_OK) return std::string("the library refuses it: ") + ipos_status_text(loaded.status);
  std::vector<uint64_t> fast(ipos_accelerate_size(loaded.program) / 8 + 1);
  if (accelerated) ipos_program_accelerate(loaded.program, fast.data(), 8 * fast.size());
  ipos_program_info info;
  ipos_program_info_of(loaded.program, &info);

  Reference reference(run);
  Library library{nullptr, info, {run.seed}};
  ipos_host host{};
  host.user = &library;
  host.command = Library::command;
  RunningMachine machine(loaded, &host);
  library.vm = machine.vm;
  uint32_t rates[3];
  for (uint32_t& rate : rates) rate = chance_below(&library.random, 48);
  ipos_set_rates(machine.vm, rates);

  ++totals.programs;
  std::vector<uint8_t> saved(ipos_state_size(machine.vm));
  for (uint32_t tick = 0; tick < run.ticks; ++tick) {
    const bool goes_on = reference.tick();
    ipos_progress progress;
    ipos_status status = ipos_run_ticks(machine.vm, 1, &progress);
    totals.commands += progress.commands;
    if (status != IPOS_FAULTED) status = library.obey();
    ipos_fault fault;
    ipos_fault_of(machine.vm, &fault);
    if (ipos_save(machine.vm, saved.data(), saved.size()) != IPOS_OK) return "not saved";
    const std::vector<uint8_t> expected = reference.state();
    if (!std::equal(expected.begin(), expected.end(), saved.begin() + kStateHead))
      return "the states differ after tick " + std::to_string(tick);
    if (fault.reason != reference.fault_reason())
      return "the reasons differ: " + std::string(fault.reason) + ", " + reference.fault_reason();
    for (uint8_t context = 4; context <= 10; ++context) {
      ipos_task task;
      ipos_task_of(machine.vm, context, &task);
      totals.routines += task.state != IPOS_TASK_STOPPED;
    }
    if (!goes_on) {
      ++totals.faults;
      ++totals.fault_numbers[fault.number];
      break;
    }
  }
  return "";
}

TEST(EqualToTheSimulation, EveryLanguageProgramAndExample) {
  Totals totals;
  for (const OrderedRun& run : language_runs())
    for (const bool accelerated : {false, true}) EXPECT_EQ(difference(run, accelerated, totals), "") << run.name;
  EXPECT_GE(totals.programs, ipos_most_variables() < 1024 ? 200U : 400U);
  RecordProperty("programs", static_cast<int>(totals.programs));
}

TEST(EqualToTheSimulation, ThousandsOfProgramsByChance) {
  Totals totals;
  for (uint32_t number = 0; number < kRandomPrograms; ++number)
    ASSERT_EQ(difference(random_run(number), number % 2 == 0, totals), "") << number;
  // They have come about: routines of interrupts, faults of all kinds, many commands.
  EXPECT_GE(totals.programs, kRandomPrograms / 3);
  EXPECT_GE(totals.routines, 300U);
  EXPECT_GE(totals.fault_numbers[10], 20U);
  EXPECT_GE(totals.fault_numbers.size(), 20U);
  EXPECT_GE(totals.commands, 150'000U);
}

// ---- Variable telegrams ----

constexpr uint32_t kObjects = 20;

// A structure of SCOM with numbers that are often right.
void write_structure(Pcg& random, int kind, std::span<int32_t> h) {
  const int32_t id = random.one_in(8) ? static_cast<int32_t>(random.next()) : random.one_in(4) ? random.below(1100) : 1024 + random.below(12);
  const int32_t format = random.one_in(10) ? random.between(-2, 0x120) : random.below(9) + (random.one_in(2) ? 0x100 : 0);
  const int32_t data = random.one_in(8) ? static_cast<int32_t>(random.next()) : 160 + random.below(350);
  if (kind == 1) {
    const int32_t cycles[] = {1, 3, 5, 9, 10, 20, 70, 100, 255, 1000, 65530, 65540, 15, 0, -10};
    h[0] = id;
    h[1] = cycles[random.below(15)];
    h[2] = random.one_in(3) ? random.below(4) * 10 : random.below(9);
    if (random.one_in(10)) h[2] = static_cast<int32_t>(random.next());
    h[3] = format;
    h[4] = data;
  } else {
    h[0] = id;
    h[1] = format;
    h[2] = data;
  }
}

struct Sent {
  uint64_t tick;
  uint32_t tag;
  uint32_t id;
  uint8_t length;
  std::array<uint8_t, 8> data;
  bool operator==(const Sent&) const = default;
};

TEST(EqualToTheSimulation, VariableTelegrams) {
  using runtime::ObjectKind;
  using runtime::ObjectTable;
  uint64_t frames = 0, taken = 0, refused = 0, faults = 0;
  for (uint32_t seed = 1; seed <= 600; ++seed) {
    Pcg random(seed);
    const uint8_t units[] = {1, 3, 4, 6};
    const stdlib::UnitType& unit = *stdlib::find_unit(units[random.below(4)]);
    if (unit.variables > ipos_most_variables()) continue;
    // SCOM of all structures, SCOMON, SCOM of some more, END.
    std::vector<uint32_t> code;
    std::vector<std::pair<int, uint32_t>> objects;
    for (uint32_t n = 0; n < kObjects; ++n) {
      const int kind = random.one_in(3) ? 3 : random.one_in(4) ? 2 : 1;
      objects.emplace_back(kind, 6 * n);
      if (n == kObjects - 3) code.push_back(0x62);
      code.push_back(0x61U | static_cast<uint32_t>(kind) << 8 | 6 * n << 20);
    }
    code.push_back(0x02);
    RecordingHost host;
    const ipos_host callbacks = host.callbacks();
    const LoadedProgram loaded(image_of_words(code, unit.code));
    RunningMachine machine(loaded, &callbacks);
    const auto baud = static_cast<uint32_t>(random.one_in(2) ? 500'000 : 1 + random.below(1'000'000));
    const auto address = static_cast<uint8_t>(random.below(64)), group = static_cast<uint8_t>(random.below(64));
    ASSERT_EQ(ipos_set_sbus(machine.vm, baud, address, group, 0), IPOS_OK);
    ASSERT_EQ(ipos_start(machine.vm), IPOS_OK);

    std::vector<int32_t> h(unit.variables);
    for (int32_t& value : h) value = static_cast<int32_t>(random.next());
    for (const auto& [kind, at] : objects) write_structure(random, kind, std::span(h).subspan(at));
    std::copy(h.begin(), h.end(), ipos_variables(machine.vm));
    const uint32_t rates[3] = {100, 0, 0};
    ipos_set_rates(machine.vm, rates);

    ObjectTable table(unit, baud, 1);
    table.set_profile({address, group, 0, false, unit.has(stdlib::Trait::SynchronousSbus), true});
    // A millisecond of a machine begins so: nobody takes the requests of interrupts that are not installed.
    const auto begin_tick = [&] {
      if (h.size() > 530) h[530] &= ~15;
    };
    begin_tick();
    std::vector<Sent> expected;
    bool fault = false;
    for (uint32_t n = 0; n < kObjects && !fault; ++n) {
      if (n == kObjects - 3) table.start(0);
      const auto kind = static_cast<ObjectKind>(objects[n].first);
      const runtime::ObjectRequest request = table.request(kind, objects[n].second, h);
      const runtime::ObjectVerdict verdict = table.define(request, h);
      fault = verdict == runtime::ObjectVerdict::NoVariables;
      if (verdict != runtime::ObjectVerdict::Accepted) ++refused;
      if (verdict != runtime::ObjectVerdict::Accepted || kind != ObjectKind::TransmitAcyclic) continue;
      const uint32_t tag = ObjectTable::kAcyclicTags + objects[n].second;
      ObjectTable::note_acyclic(tag, runtime::AcyclicStatus::Sending, h);
      const runtime::Frame frame = ObjectTable::acyclic_frame(request, h);
      expected.push_back({0, tag, frame.id, frame.length, frame.data});
      ObjectTable::note_acyclic(tag, runtime::AcyclicStatus::Sent, h);
    }
    for (uint64_t tick = 0; tick < 130; ++tick) {
      begin_tick();
      const ipos_status status = ipos_run_ticks(machine.vm, 1, nullptr);
      ASSERT_EQ(status == IPOS_FAULTED, fault) << seed;
      if (fault) break;
      table.due(static_cast<int64_t>(tick), h, [&](uint32_t tag, const runtime::Frame& frame) {
        expected.push_back({tick, tag, frame.id, frame.length, frame.data});
      });
      ipos_frame in{static_cast<uint16_t>(1024 + random.below(12)), static_cast<uint8_t>(random.below(9)), {}};
      runtime::Frame same(in.id, in.length);
      for (size_t n = 0; n < in.length; ++n) same.data[n] = in.data[n] = static_cast<uint8_t>(random.next());
      const auto receiver = table.receiver(same);
      const bool takes = receiver && table.take(*receiver, same, h);
      taken += takes;
      ASSERT_EQ(ipos_receive(machine.vm, &in), takes ? IPOS_OK : IPOS_NOT_TAKEN) << seed;
    }
    faults += fault;
    ASSERT_TRUE(std::equal(h.begin(), h.end(), ipos_variables(machine.vm))) << seed;
    ASSERT_EQ(host.frames.size(), expected.size()) << seed;
    for (size_t n = 0; n < expected.size(); ++n) {
      const auto& [tick, frame] = host.frames[n];
      Sent sent{tick, host.tags[n], frame.id, frame.length, {}};
      std::copy_n(frame.data, 8, sent.data.begin());
      ASSERT_EQ(sent, expected[n]) << seed << ", frame " << n;
    }
    frames += expected.size();
  }
  EXPECT_GE(frames, 1000U);
  EXPECT_GE(taken, 100U);
  EXPECT_GE(refused, 1000U);
  EXPECT_GE(faults, 50U);
}

}  // namespace
}  // namespace ipos::tests
