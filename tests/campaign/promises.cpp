// The promises are read off the variables and tasks of the stations, as a debugger would see them.
#include "tests/campaign/promises.hpp"

#include <fmt/format.h>
#include <malloc.h>

#include "vm/isa/coding.hpp"

namespace ipos::tests {
namespace {

constexpr int kSent = 340, kReceived = 350;  // the variables of the pair

// P816 or P884: 125, 500 and 1000 kbaud
int baud_setting(std::string_view baud) { return baud == "125000" ? 0 : baud == "500000" ? 2 : 3; }

}  // namespace

Pair make_pair_at(std::string_view baud) {
  Pair pair;
  for (const auto& [name, address] : {std::pair{"sender", 61}, std::pair{"receiver", 62}})
    pair.stations += fmt::format(
        "[[station]]\nname = \"{0}\"\nunit = \"md60a\"\nprogram = \"{0}.IPC\"\nsbus = \"can\"\n"
        "[station.parameters]\nP813 = {1}\nP816 = {2}\n",
        name, address, baud_setting(baud));
  // _Copy is one command, so that no tick ends between the two variables.
  pair.programs["sender.IPC"] = fmt::format(
      "#include <constb.h>\n#define SENT H{0}\n#define THRICE H{1}\n#define NEXT H{2}\n#define NEXT_THRICE "
      "H{3}\n"
      "#pragma globals 360 399\nSCTRCYCL Tr;\n"
      "main() {{\n  Tr.ObjectNo = {4}; Tr.CycleTime = 10; Tr.Offset = 0; Tr.Format = 8; Tr.DPointer = {0};\n"
      "  _SBusCommDef(SCD_TRCYCL, Tr);\n  _SBusCommOn();\n"
      "  while (1) {{ NEXT = NEXT + 1; NEXT_THRICE = NEXT * 3; _Copy(SENT, NEXT, 2); }}\n}}\n",
      kSent, kSent + 1, kSent + 2, kSent + 3, kPairObject);
  pair.programs["receiver.IPC"] = fmt::format(
      "#include <constb.h>\n#pragma globals 360 399\nSCREC Re;\n"
      "main() {{\n  Re.ObjectNo = {0}; Re.Format = 8; Re.DPointer = {1};\n"
      "  _SBusCommDef(SCD_REC, Re);\n  _SBusCommOn();\n  while (1) ;\n}}\n",
      kPairObject, kReceived);
  return pair;
}

std::optional<std::string> torn_telegram(const runtime::Plant& plant) {
  for (const auto& owned : plant.stations()) {
    if (owned->config().name != "receiver" || owned->machine() == nullptr) continue;
    const auto received = owned->machine()->variables().subspan(kReceived, 2);
    if (received[1] != received[0] * 3) return fmt::format("{} came with {}", received[0], received[1]);
  }
  return std::nullopt;
}

Exchanges::Exchanges(const runtime::Plant& plant) {
  for (const auto& owned : plant.stations()) {
    const vm::Machine* const machine = owned->powered() ? owned->machine() : nullptr;
    if (machine == nullptr) continue;
    for (int n = 1; n <= vm::kContexts; ++n) {
      const vm::TaskContext& context = machine->context(n);
      if (context.state == vm::TaskState::Waiting && context.wait_ms == 0 &&
          vm::decode(machine->program().code(), context.pc).instruction.opcode == vm::Opcode::Movlnk)
        waiting_[fmt::format("{} of {}", vm::context_name(n), owned->config().name)] = context.commands;
    }
  }
}

std::optional<std::string> Exchanges::same_as(const Exchanges& before) const {
  for (const auto& [task, commands] : waiting_)
    if (const auto at = before.waiting_.find(task); at != before.waiting_.end() && at->second == commands)
      return task;
  return std::nullopt;
}

size_t heap_bytes() { return mallinfo2().uordblks; }

}  // namespace ipos::tests
