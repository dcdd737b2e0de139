// The same in C++: a host that is a class, a program that asks it for a value, and a state that is saved and
// restored.
#include <ipos_compile.h>
#include <cstdio>
#include <ipos.hpp>
#include <vector>

namespace {

constexpr char kSource[] = R"(#include <const.h>
long current, peak;
main() {
  while (1) {
    _GetSys(current, GS_ACTCUR);
    if (current > peak) peak = current;
  }
}
)";

struct Host {
  int32_t amperes = 0;

  ipos_reply command(ipos_vm* vm, const ipos_command& command) {
    if (command.opcode != IPOS_COMMAND_GetSys) return {IPOS_ANSWER_FAULT, 10, "not on this host"};
    ipos_write(vm, static_cast<uint32_t>(command.operands[0]), ++amperes);
    return {IPOS_ANSWER_DONE, 0, nullptr};
  }
  void fault(ipos_vm*, const ipos_fault& fault) { std::printf("F%d: %s\n", fault.number, fault.reason); }
};

}  // namespace

int main() {
  alignas(8) static std::byte image[4096];
  char messages[500];
  ipos_compile_job job{};
  job.name = "peak.IPC";
  job.source = kSource;
  job.image = image;
  job.image_capacity = sizeof image;
  job.messages = messages;
  job.messages_capacity = sizeof messages;
  if (ipos_compile(&job) != IPOS_OK) return std::puts(messages), 1;

  Host host;
  static ipos::Program program;
  static ipos::Machine machine;
  if (program.load(std::span(image).first(job.image_size)) != IPOS_OK ||
      machine.init(program, host) != IPOS_OK || machine.start() != IPOS_OK)
    return 1;

  machine.run_ticks(100);
  std::vector<std::byte> saved(machine.state_size());
  machine.save(saved);
  int32_t before = 0, later = 0, again = 0;
  machine.read("peak", before);
  machine.run_ticks(100);
  machine.read("peak", later);
  machine.restore(saved);
  machine.read("peak", again);
  std::printf("peak after 100 ms grows on: %s, and is back after restoring: %s\n",
              later > before ? "yes" : "no", again == before ? "yes" : "no");
  return later > before && again == before ? 0 : 1;
}
