// Each command is a step of its own: before it the context's place is known, and by its depth of calls in which function it is.
#include "tools/profile/profiler.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace ipos::tools::profile {

Profiler::Profiler(runtime::Plant& plant) {
  for (const auto& station : plant.stations()) {
    const vm::Image* image = station->image();
    if (image == nullptr) continue;
    Tally tally{station.get(), {}, {"?"}, {}, {}};
    tally.places.resize(image->code.size());
    // A function has a copy for each task and interrupt that calls it; what is behind the @ tells them apart.
    for (const vm::FunctionEntry& function : image->functions)
      tally.functions.push_back(function.name.substr(0, function.name.find('@')));
    size_t function = 0, line = 0;
    for (uint32_t address = 0; address < image->code.size(); ++address) {
      while (function < image->functions.size() && image->functions[function].address <= address) ++function;
      while (line < image->lines.size() && image->lines[line].address <= address) ++line;
      tally.places[address].function = function;
      if (line != 0) tally.places[address].line = {image->files[image->lines[line - 1].file], image->lines[line - 1].line};
    }
    numbers_[station.get()] = tallies_.size();
    tallies_.push_back(std::move(tally));
    station->use_runner(*this);
  }
}

// The frame of a call on this way; each way has one.
size_t Profiler::Tally::entered(int task, size_t parent, size_t function) {
  std::vector<Frame>& all = frames[static_cast<size_t>(task - 1)];
  const auto same = std::find_if(all.begin(), all.end(),
                                 [&](const Frame& frame) { return frame.parent == parent && frame.function == function; });
  const auto number = static_cast<size_t>(same - all.begin());
  if (same == all.end()) all.push_back({function, parent, 0, {}});
  ++all[number].calls;
  return number;
}

Profiler::Frame& Profiler::Tally::frame_of(const vm::TaskContext& context, int number) {
  Stand& stand = stands[static_cast<size_t>(number - 1)];
  std::vector<Frame>& all = frames[static_cast<size_t>(context.task - 1)];
  if (stand.frame == SIZE_MAX || context.commands == 0) {  // begins
    stand = {entered(context.task, SIZE_MAX, places[context.pc].function), 0};
  }
  for (; stand.depth > context.depth; --stand.depth)
    if (all[stand.frame].parent != SIZE_MAX) stand.frame = all[stand.frame].parent;
  if (stand.depth < context.depth) {  // a command calls once at most
    stand = {entered(context.task, stand.frame, places[context.pc].function), context.depth};
  }
  return all[stand.frame];
}

bool Profiler::run(runtime::Station& station, vm::Machine& machine, vm::TickSteps& steps) {
  Tally& tally = tallies_[numbers_.at(&station)];
  // A program that was written through indices 16000 + n may be longer than the one of the source.
  const auto is_known = [&](uint32_t address) { return address < tally.places.size(); };
  std::array<uint32_t, vm::kTasks> used{};
  while (const int task = steps.task()) {
    const int number = machine.active_context(task);
    const vm::TaskContext& context = machine.context(number);
    const uint32_t address = context.pc;
    if (is_known(address)) {
      Cost& cost = tally.frame_of(context, number).costs[address];
      ++cost.commands;
      cost.ms += 1.0 / steps.rates().commands[static_cast<size_t>(task - 1)];
    }
    ++used[static_cast<size_t>(task - 1)];
    steps.step(machine);
  }
  for (int task = 1; task <= vm::kTasks; ++task) {
    const int number = machine.active_context(task);
    const vm::TaskContext& context = machine.context(number);
    const uint32_t most = steps.rates().commands[static_cast<size_t>(task - 1)];
    const uint32_t left = most - std::min(most, used[static_cast<size_t>(task - 1)]);
    if (context.state != vm::TaskState::Waiting || left == 0 || !is_known(context.pc)) continue;
    tally.frame_of(context, number).costs[context.pc].waits += static_cast<double>(left) / most;
  }
  return true;
}

std::vector<Task> Profiler::tasks() const {
  std::vector<Task> all;
  for (const Tally& tally : tallies_)
    for (size_t task = 0; task < tally.frames.size(); ++task) {
      if (tally.frames[task].empty()) continue;
      Task& out = all.emplace_back();
      out.name = fmt::format("{}.task{}", tally.station->config().name, task + 1);
      for (const Frame& frame : tally.frames[task]) {
        Node& node = out.nodes.emplace_back(Node{tally.functions[frame.function], frame.parent, frame.calls, {}});
        for (const auto& [address, cost] : frame.costs) node.lines[tally.places[address].line] += cost;
      }
    }
  return all;
}

}  // namespace ipos::tools::profile
