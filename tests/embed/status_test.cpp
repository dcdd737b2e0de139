// Every status of ipos.h is reached by a call that is described as giving it; the last test counts them.
// Those of the compiler are in compile_test.cpp.
#include <set>

#include "tests/embed/rig.hpp"

namespace ipos::tests {
namespace {

std::set<ipos_status> reached;

void expect(ipos_status status, ipos_status expected) {
  EXPECT_EQ(status, expected) << ipos_status_text(status);
  reached.insert(status);
}

const char kForever[] = "main() { while (1) H0++; }";
constexpr uint32_t kEnd = 0x02;

TEST(ApiStatus, LoadingRefusesWhatIsNoImage) {
  std::vector<uint8_t> bytes = image_of(kForever);
  const auto status_of = [](const std::vector<uint8_t>& image) { return LoadedProgram(image).status; };
  expect(status_of(bytes), IPOS_OK);
  expect(status_of({0}), IPOS_NOT_AN_IMAGE);
  expect(status_of({'I', 'P', 'X', '1', 1, 0, 0, 0}), IPOS_NOT_AN_IMAGE);
  std::vector<uint8_t> bad = bytes;
  bad[4] = 2;
  expect(status_of(bad), IPOS_IMAGE_VERSION);
  bad = bytes;
  bad[30] ^= 1;
  expect(status_of(bad), IPOS_IMAGE_DAMAGED);
  bad = bytes;
  bad[20] = static_cast<uint8_t>(bad[20] + 1);  // offset of the code section
  seal(bad);
  expect(status_of(bad), IPOS_IMAGE_DAMAGED);
  expect(status_of(image_of_words({kEnd}, 0)), IPOS_UNKNOWN_UNIT);
  expect(status_of(image_of_words({kEnd}, 99)), IPOS_UNKNOWN_UNIT);
  expect(status_of(image_of_words({kEnd}, 5)), IPOS_UNKNOWN_UNIT);  // a MOVITRAC 31 has no IPOS
  expect(status_of(image_of_words({kEnd}, 4)), ipos_most_variables() < 1024 ? IPOS_UNIT_TOO_LARGE : IPOS_OK);
}

TEST(ApiStatus, ARefusedProgramSaysWhereAndWhy) {
  const LoadedProgram loaded(image_of_words({0x01, 0xFF, kEnd, 0xFE}));
  expect(loaded.status, IPOS_REFUSED);
  EXPECT_EQ(loaded.program, nullptr);
  EXPECT_EQ(loaded.trouble.word, 1U);
  EXPECT_EQ(loaded.trouble.rule, 3);  // V03 unknown command
  EXPECT_EQ(loaded.trouble.violations, 2U);
  EXPECT_EQ(loaded.trouble.offset, 16U + 12 + 4);
  EXPECT_STREQ(ipos_rule_text(3), "the code word is no command");
  EXPECT_STREQ(ipos_rule_text(0), "");
}

TEST(ApiStatus, MemoryIsChecked) {
  const std::vector<uint8_t> image = image_of(kForever);
  alignas(8) std::array<uint8_t, IPOS_PROGRAM_BYTES + 8> memory;
  ipos_program* program = nullptr;
  const auto load = [&](size_t shift, size_t size) {
    return ipos_program_load(memory.data() + shift, size, image.data(), image.size(), &program, nullptr);
  };
  expect(load(0, ipos_program_size()), IPOS_OK);
  expect(load(0, ipos_program_size() - 1), IPOS_MEMORY_TOO_SMALL);
  expect(load(4, ipos_program_size()), IPOS_MISALIGNED);
  std::vector<uint8_t> shifted(image.size() + 2);
  std::copy(image.begin(), image.end(), shifted.begin() + 2);
  expect(ipos_program_load(memory.data(), sizeof memory, shifted.data() + 2, image.size(), &program, nullptr),
         IPOS_MISALIGNED);
  ASSERT_EQ(load(0, sizeof memory), IPOS_OK);

  std::vector<uint64_t> machine(IPOS_VM_BYTES / 8 + 1);
  ipos_vm* vm = nullptr;
  expect(ipos_init(machine.data(), ipos_vm_size(), program, nullptr, &vm), IPOS_OK);
  expect(ipos_init(machine.data(), ipos_vm_size() - 1, program, nullptr, &vm), IPOS_MEMORY_TOO_SMALL);
  expect(ipos_init(reinterpret_cast<uint8_t*>(machine.data()) + 1, ipos_vm_size(), program, nullptr, &vm),
         IPOS_MISALIGNED);
}

// A host reads as many variables as a symbol says.
TEST(ApiStatus, SymbolsBeyondTheUnitAreRefused) {
  const auto load = [&](uint16_t variable, uint16_t count) {
    vm::Image image;
    image.unit = 1;  // md60a: H0 to H511
    image.code = {kEnd};
    image.symbols = {{"x", variable, count}};
    return LoadedProgram(vm::write_image(image)).status;
  };
  for (const auto& [variable, count] : {std::pair<uint16_t, uint16_t>{511, 1}, {0, 512}})
    expect(load(variable, count), IPOS_OK);
  for (const auto& [variable, count] : {std::pair<uint16_t, uint16_t>{512, 1}, {511, 2}, {0, 513}, {500, 3000}, {65535, 65535}})
    expect(load(variable, count), IPOS_IMAGE_DAMAGED);
}

TEST(ApiStatus, AcceleratingIsBuiltInOrSaysSo) {
  LoadedProgram loaded(kForever);
  const size_t size = ipos_accelerate_size(loaded.program);
  std::vector<uint64_t> memory(size / 8 + 1);
  const ipos_status status = ipos_program_accelerate(loaded.program, memory.data(), size);
  if (ipos_features() & IPOS_FEATURE_FAST) {
    expect(status, IPOS_OK);
    expect(ipos_program_accelerate(loaded.program, memory.data(), size - 1), IPOS_MEMORY_TOO_SMALL);
    expect(ipos_program_accelerate(loaded.program, reinterpret_cast<uint8_t*>(memory.data()) + 1, size),
           IPOS_MISALIGNED);
  } else {
    EXPECT_EQ(size, 0U);
    expect(status, IPOS_NOT_BUILT_IN);
  }
}

TEST(ApiStatus, Running) {
  const LoadedProgram forever(kForever), over("main() { H0 = 1; }"), faulty("main() { H1 = 1 / H0; }");
  RunningMachine runs(forever), ends(over), faults(faulty);
  expect(ipos_run_ticks(runs.vm, 3, nullptr), IPOS_OK);
  expect(ipos_run_ticks(ends.vm, 9, nullptr), IPOS_ENDED);
  expect(ipos_run_commands(ends.vm, 1, 1, nullptr), IPOS_ENDED);
  expect(ipos_run_commands(runs.vm, 2, 1, nullptr), IPOS_ENDED);  // task 2 was never started
  expect(ipos_run_ticks(faults.vm, 9, nullptr), IPOS_FAULTED);
  expect(ipos_run_ticks(faults.vm, 9, nullptr), IPOS_FAULTED);
  expect(ipos_run_commands(faults.vm, 1, 1, nullptr), IPOS_FAULTED);
  expect(ipos_run_due(runs.vm, 1, nullptr), IPOS_NO_CALLBACK);
}

TEST(ApiStatus, VariablesAndSymbols) {
  const LoadedProgram loaded("long speed; main() { speed = 5; while (1) ; }");
  RunningMachine machine(loaded);
  int32_t value = 0;
  expect(ipos_read(machine.vm, 511, &value), IPOS_OK);
  expect(ipos_read(machine.vm, 512, &value), IPOS_NO_VARIABLE);
  expect(ipos_write(machine.vm, UINT32_MAX, 1), IPOS_NO_VARIABLE);
  expect(ipos_read_symbol(machine.vm, "speed", &value), IPOS_OK);
  expect(ipos_read_symbol(machine.vm, "H511", &value), IPOS_OK);
  for (const char* name : {"", "H", "H512", "H4294967296", "Hx", "spee", "speedy"}) {
    expect(ipos_read_symbol(machine.vm, name, &value), IPOS_NO_SYMBOL);
    expect(ipos_write_symbol(machine.vm, name, 1), IPOS_NO_SYMBOL);
  }
  ipos_symbol symbol;
  expect(ipos_symbol_at(loaded.program, 1000, &symbol), IPOS_NO_SYMBOL);
}

TEST(ApiStatus, CallbacksCannotRunTheirMachine) {
  const LoadedProgram loaded("#include <const.h>\nmain() { _GetSys(H0, GS_ERROR); while (1) ; }");
  RecordingHost host;
  const ipos_host callbacks = host.callbacks();
  RunningMachine machine(loaded, &callbacks);
  ASSERT_EQ(ipos_run_ticks(machine.vm, 1, nullptr), IPOS_OK);
  ASSERT_EQ(host.commands.size(), 1U);
  expect(host.nested, IPOS_BUSY);
}

TEST(ApiStatus, FramesAndResume) {
  const LoadedProgram loaded(kForever);
  RunningMachine machine(loaded);
  const ipos_frame frame{1025, 8, {}};
  expect(ipos_receive(machine.vm, &frame), IPOS_NOT_TAKEN);
  expect(ipos_resume(machine.vm, 1), IPOS_NOT_TAKEN);
}

TEST(ApiStatus, NonVolatileMemory) {
  const LoadedProgram loaded(kForever);
  RunningMachine bare(loaded);
  expect(ipos_nv_store(bare.vm), IPOS_NO_CALLBACK);
  expect(ipos_nv_load(bare.vm), IPOS_NO_CALLBACK);
  RecordingHost host;
  const ipos_host callbacks = host.callbacks();
  RunningMachine machine(loaded, &callbacks);
  expect(ipos_nv_load(machine.vm), IPOS_NO_CONTENT);
  host.nv_works = false;
  expect(ipos_nv_store(machine.vm), IPOS_HOST_FAILED);
  expect(ipos_nv_load(machine.vm), IPOS_HOST_FAILED);
}

TEST(ApiStatus, States) {
  const LoadedProgram one(kForever), other("main() { while (1) H1++; }");
  RunningMachine machine(one), stranger(other);
  std::vector<uint8_t> state(ipos_state_size(machine.vm));
  expect(ipos_save(machine.vm, state.data(), state.size() - 1), IPOS_MEMORY_TOO_SMALL);
  ASSERT_EQ(ipos_save(machine.vm, state.data(), state.size()), IPOS_OK);
  expect(ipos_restore(machine.vm, state.data(), state.size()), IPOS_OK);
  expect(ipos_restore(machine.vm, state.data(), state.size() - 1), IPOS_BAD_STATE);
  expect(ipos_restore(stranger.vm, state.data(), state.size()), IPOS_OTHER_PROGRAM);
  state[40] ^= 1;
  expect(ipos_restore(machine.vm, state.data(), state.size()), IPOS_BAD_STATE);
}

// Null pointers and numbers out of their ranges, for every function that can say so.
TEST(ApiStatus, InvalidArguments) {
  LoadedProgram loaded(kForever);
  RunningMachine machine(loaded);
  ipos_vm* const vm = machine.vm;
  const std::vector<uint8_t> image = image_of(kForever);
  uint64_t memory[IPOS_PROGRAM_BYTES / 8];
  ipos_program* program;
  ipos_vm* out;
  int32_t value;
  ipos_symbol symbol;
  ipos_task task;
  ipos_fault fault;
  ipos_program_info info;
  const uint32_t rates[3] = {1, 1, 1};
  const ipos_frame good{1, 1, {}}, long_frame{1, 9, {}}, high_frame{2048, 1, {}};
  const ipos_status statuses[] = {
      ipos_program_load(nullptr, 999, image.data(), image.size(), &program, nullptr),
      ipos_program_load(memory, sizeof memory, nullptr, 0, &program, nullptr),
      ipos_program_load(memory, sizeof memory, image.data(), image.size(), nullptr, nullptr),
      ipos_program_info_of(nullptr, &info),
      ipos_program_info_of(loaded.program, nullptr),
      ipos_program_accelerate(nullptr, memory, sizeof memory),
      ipos_symbol_at(nullptr, 0, &symbol),
      ipos_symbol_at(loaded.program, 0, nullptr),
      ipos_find(nullptr, "a", &symbol),
      ipos_find(loaded.program, nullptr, &symbol),
      ipos_find(loaded.program, "a", nullptr),
      ipos_init(nullptr, 99999, loaded.program, nullptr, &out),
      ipos_init(memory, 99999, nullptr, nullptr, &out),
      ipos_init(memory, 99999, loaded.program, nullptr, nullptr),
      ipos_start(nullptr),
      ipos_stop(nullptr),
      ipos_set_rates(nullptr, rates),
      ipos_set_rates(vm, nullptr),
      ipos_set_sbus(nullptr, 500'000, 0, 0, 0),
      ipos_set_sbus(vm, 0, 0, 0, 0),
      ipos_set_sbus(vm, 1'000'001, 0, 0, 0),
      ipos_set_sbus(vm, 1, 64, 0, 0),
      ipos_set_sbus(vm, 1, 0, 64, 0),
      ipos_set_sbus(vm, 1, 0, 0, 2048),
      ipos_run_ticks(nullptr, 1, nullptr),
      ipos_run_due(nullptr, 1, nullptr),
      ipos_run_commands(nullptr, 1, 1, nullptr),
      ipos_run_commands(vm, 0, 1, nullptr),
      ipos_run_commands(vm, 4, 1, nullptr),
      ipos_read(nullptr, 0, &value),
      ipos_read(vm, 0, nullptr),
      ipos_write(nullptr, 0, 0),
      ipos_read_symbol(nullptr, "H0", &value),
      ipos_read_symbol(vm, nullptr, &value),
      ipos_read_symbol(vm, "H0", nullptr),
      ipos_write_symbol(nullptr, "H0", 0),
      ipos_write_symbol(vm, nullptr, 0),
      ipos_task_of(nullptr, 1, &task),
      ipos_task_of(vm, 0, &task),
      ipos_task_of(vm, 11, &task),
      ipos_task_of(vm, 1, nullptr),
      ipos_start_task(nullptr, 1, 0),
      ipos_start_task(vm, 0, 0),
      ipos_start_task(vm, 3, 0),  // md60a has two
      ipos_start_task(vm, 1, 1),  // inside the first command
      ipos_start_task(vm, 1, 9999),
      ipos_stop_task(nullptr, 1),
      ipos_stop_task(vm, 4),
      ipos_resume(nullptr, 1),
      ipos_resume(vm, 0),
      ipos_resume(vm, 11),
      ipos_raise_event(nullptr, IPOS_EVENT_ERROR),
      ipos_raise_event(vm, 3),
      ipos_fault_of(nullptr, &fault),
      ipos_fault_of(vm, nullptr),
      ipos_raise_fault(nullptr, 1, ""),
      ipos_raise_fault(vm, 0, ""),
      ipos_raise_fault(vm, 1, nullptr),
      ipos_receive(nullptr, &good),
      ipos_receive(vm, nullptr),
      ipos_receive(vm, &long_frame),
      ipos_receive(vm, &high_frame),
      ipos_sent(nullptr, 0, true),
      ipos_nv_store(nullptr),
      ipos_nv_load(nullptr),
      ipos_save(nullptr, memory, 9),
      ipos_save(vm, nullptr, 9),
      ipos_restore(nullptr, memory, 9),
      ipos_restore(vm, nullptr, 9)};
  size_t n = 0;
  for (const ipos_status status : statuses) EXPECT_EQ(status, IPOS_INVALID_ARGUMENT) << "number " << n++;
  expect(statuses[0], IPOS_INVALID_ARGUMENT);
  EXPECT_EQ(ipos_program_of(nullptr), nullptr);
  EXPECT_EQ(ipos_variables(nullptr), nullptr);
  EXPECT_EQ(ipos_ticks(nullptr), 0U);
  EXPECT_EQ(ipos_state_size(nullptr), 0U);
  EXPECT_EQ(ipos_accelerate_size(nullptr), 0U);
}

TEST(ApiStatus, TextsAndVersion) {
#define IPOS_STATUS_ROW(name, number, text)    \
  EXPECT_EQ(static_cast<int>(name), (number)); \
  EXPECT_STREQ(ipos_status_text(name), text);
  IPOS_STATUSES(IPOS_STATUS_ROW)
#undef IPOS_STATUS_ROW
  EXPECT_STREQ(ipos_status_text(999), "");
  EXPECT_EQ(ipos_version(), static_cast<uint32_t>(IPOS_VERSION));
  EXPECT_EQ(ipos_most_variables(), static_cast<uint32_t>(IPOS_VARIABLES));
}

// Runs last in this file. A small build reaches UNIT_TOO_LARGE and NOT_BUILT_IN, a full one cannot.
TEST(ApiStatusCount, AllAreReached) {
  const bool small = ipos_most_variables() < 1024;
  const auto missing = [&](ipos_status status) {
    const bool of_compiler = status == IPOS_SOURCE_ERROR || status == IPOS_OUT_OF_MEMORY;
    const bool of_small = status == IPOS_UNIT_TOO_LARGE || status == IPOS_NOT_BUILT_IN;
    return !of_compiler && (small || !of_small) && reached.count(status) == 0;
  };
#define IPOS_STATUS_ROW(name, number, text) EXPECT_FALSE(missing(name)) << #name;
  IPOS_STATUSES(IPOS_STATUS_ROW)
#undef IPOS_STATUS_ROW
}

}  // namespace
}  // namespace ipos::tests
