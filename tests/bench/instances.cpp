// ipos_bench_instances: many machines of one program in one process, with the library that is the one file ipos.c. Prints the
// memory of each, the processor time to make, save and run them, and that of a tick of 64, the best of several rounds each. The
// figures are those of docs/guide/embedding.md.
#include <ipos.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <memory>
#include <vector>

#include "compiler/compile.hpp"
#include "vm/image/image.hpp"

namespace {

constexpr size_t kMachines = 1000;
constexpr uint32_t kTicks = 100;
constexpr int kRounds = 20;

// A controller with ramp and limits, as drive programs are.
constexpr char kSource[] =
    "long setpoint, actual, sum, error, output;\n"
    "main() { setpoint = 1000; while (1) { error = setpoint - actual; sum = sum + error;\n"
    "  if (sum > 5000) sum = 5000; output = (error * 3 + sum / 4) >> 2;\n"
    "  if (output > 200) output = 200; actual = actual + output / 3; } }\n";

// Of the processor: what else runs here does not count.
double seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct Fleet {
  std::vector<uint64_t> memory;
  std::vector<ipos_vm*> machines;

  Fleet(const ipos_program* program, size_t count) {
    const size_t each = (ipos_vm_size() + 7) / 8;
    memory.resize(count * each);
    for (size_t n = 0; n < count; ++n) {
      ipos_vm* vm = nullptr;
      if (ipos_init(memory.data() + n * each, 8 * each, program, nullptr, &vm) == IPOS_OK)
        machines.push_back(vm);
      ipos_start(vm);
    }
  }
  // Nanoseconds of one tick of all machines.
  double tick_ns(uint32_t rate) {
    const uint32_t rates[3] = {rate, 0, 0};
    for (ipos_vm* vm : machines) ipos_set_rates(vm, rates);
    double best = 1e9;
    for (int round = 0; round < kRounds; ++round) {
      const double begin = seconds();
      for (uint32_t tick = 0; tick < kTicks; ++tick)
        for (ipos_vm* vm : machines) ipos_run_ticks(vm, 1, nullptr);
      best = std::min(best, seconds() - begin);
    }
    return best / kTicks * 1e9;
  }
};

}  // namespace

int main() {
  ipos::compiler::CompileOptions options;
  options.unit = ipos::stdlib::find_unit(std::string_view("md60a"));
  const auto made = ipos::compiler::compile("bench.IPC", "", kSource, options);
  if (!made.image) return std::puts("the program does not compile"), 1;
  const std::vector<uint8_t> image = ipos::vm::write_image(*made.image);
  uint64_t program_memory[IPOS_PROGRAM_BYTES / 8];
  ipos_program* program = nullptr;
  if (ipos_program_load(program_memory, sizeof program_memory, image.data(), image.size(), &program,
                        nullptr) != IPOS_OK)
    return 1;
  std::vector<uint64_t> fast(ipos_accelerate_size(program) / 8 + 1);
  ipos_program_accelerate(program, fast.data(), 8 * fast.size());

  const double begin = seconds();
  Fleet all(program, kMachines);
  const double made_in = seconds() - begin;
  std::vector<uint8_t> state(ipos_state_size(all.machines[0]));
  const double saving = seconds();
  for (ipos_vm* vm : all.machines) ipos_save(vm, state.data(), state.size());
  const double saved_in = seconds() - saving;

  std::printf(
      "memory: %zu bytes a machine, of them %d variables; %zu for the program, %zu for its fast form\n",
      ipos_vm_size(), 4 * IPOS_VARIABLES, ipos_program_size(), 8 * fast.size());
  std::printf("making and starting: %.2f us a machine; saving %zu bytes: %.2f us\n",
              made_in * 1e6 / kMachines, state.size(), saved_in * 1e6 / kMachines);
  for (const uint32_t rate : {1U, 10U, 100U})
    std::printf("%zu machines, %u commands a tick: %.0f ns a machine and tick\n", kMachines, rate,
                all.tick_ns(rate) / kMachines);
  Fleet small(program, 64);
  for (const uint32_t rate : {1U, 10U, 100U})
    std::printf("a tick of 64 machines, %u commands each: %.1f us\n", rate, small.tick_ns(rate) / 1000);
  return 0;
}
