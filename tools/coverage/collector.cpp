// Counting goes by single steps: before each the command is known, after it whether it has jumped.
#include "tools/coverage/collector.hpp"

#include <algorithm>

#include "compiler/asm/disassembler.hpp"

namespace ipos::tools::coverage {

Collector::Collector(runtime::Plant& plant) {
  for (const auto& station : plant.stations()) {
    const vm::Image* image = station->image();
    if (image == nullptr || image->lines.empty()) continue;
    Tally& tally = tallies_[station.get()];
    tally.image = *image;
    tally.next.resize(image->code.size());
    tally.counts.resize(image->code.size());
    tally.calls.resize(image->code.size());
    for (const compiler::CodeItem& item : compiler::code_items(image->code)) {
      tally.next[item.address] = item.address + item.words;
      const vm::Flow flow = item.command ? vm::coding(item.command->opcode).flow : vm::Flow::Next;
      tally.calls[item.address] = flow == vm::Flow::Call || flow == vm::Flow::SystemCall;
    }
    station->use_runner(*this);
  }
}

bool Collector::run(runtime::Station& station, vm::Machine& machine, vm::TickSteps& steps) {
  Tally& tally = tallies_.at(&station);
  // Code that was changed through indices 16000 + n is not that of the source any more.
  if (!std::ranges::equal(machine.program().code(), tally.image.code)) {
    while (steps.task() != 0) steps.step(machine, UINT32_MAX);
    return true;
  }
  while (const int task = steps.task()) {
    const int number = machine.active_context(task);
    const vm::TaskContext& context = machine.context(number);
    const uint32_t address = context.pc;
    CommandCount& count = tally.counts[address];
    bool& called = tally.called[static_cast<size_t>(number - 1)];
    if (called || context.commands == 0) ++count.entered;
    steps.step(machine);
    const bool passed = context.pc == tally.next[address];
    ++count.executed;
    if (passed) ++count.passed;
    called = !passed && tally.calls[address];
  }
  return true;
}

Coverage Collector::coverage() const {
  Coverage all;
  for (const auto& [station, tally] : tallies_) all.merge(fold(tally.image, tally.counts));
  return all;
}

}  // namespace ipos::tools::coverage
