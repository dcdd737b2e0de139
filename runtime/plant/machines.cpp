// Wiring by names and units, then step after step.
#include "runtime/plant/machines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "runtime/signals/find.hpp"

namespace ipos::runtime {
namespace {

constexpr size_t kMostWords = 200;  // lines of a machine that are told in a run (ours)

std::string seconds(Time time) { return fmt::format("{:.3f} s", static_cast<double>(time) / 1e9); }

}  // namespace

Machines::Machines(EventQueue& queue, uint32_t& next_source, const PlantFile& file, Journal& journal)
    : queue_(queue), journal_(journal) {
  for (const MachineConfig& config : file.machines)
    machines_.emplace_back(*this, config, machines_.size(), next_source++);
}

void Machines::connect(const PlantParts& plant, std::vector<PlantError>& errors) {
  for (Machine& machine : machines_) connect(plant, machine, errors);
  for (const Machine& machine : machines_)
    for (const Link& link : machine.outputs)
      for (const Machine& other : machines_)
        for (const Link& first : other.outputs) {
          const bool before = std::pair(other.number, &first) < std::pair(machine.number, &link);
          if (before && first.signal.shares_terminal(link.signal))
            errors.push_back({link.place, fmt::format("{} is given by machine '{}' already", link.signal.name, other.config.name)});
        }
}

void Machines::connect(const PlantParts& plant, Machine& machine, std::vector<PlantError>& errors) {
  const MachineConfig& config = machine.config;
  if (config.model == nullptr)
    return errors.push_back({config.fmu_place, fmt::format("machine '{}': an FMU cannot be opened here; `ipos run`, test, "
                                                           "debug and serve of Linux can",
                                                           config.name)});
  machine.wiring.name = config.name;
  machine.wiring.limit = config.limit;
  using Role = MachineVariable::Role;
  for (const MachineWire& row : config.inputs)
    wire(plant, machine, row, Role::Input, machine.inputs, machine.wiring.inputs, errors);
  for (const MachineWire& row : config.outputs)
    wire(plant, machine, row, Role::Output, machine.outputs, machine.wiring.outputs, errors);
  for (const MachineSetting& row : config.parameters) {
    const auto variable = config.model->find(row.variable, Role::Parameter);
    if (!variable)
      errors.push_back({row.place, fmt::format("machine '{}': {}", config.name, variable.error())});
    else if (variable->is_whole && row.value != std::floor(row.value))
      errors.push_back({row.place, fmt::format("machine '{}': {} takes whole numbers", config.name, row.variable)});
    else
      machine.wiring.parameters.push_back({variable->number, row.value});
  }
  machine.in.resize(machine.inputs.size());
  machine.out.resize(machine.outputs.size());
  machine.samples.resize(machine.outputs.size());
}

void Machines::wire(const PlantParts& plant, const Machine& machine, const MachineWire& row, MachineVariable::Role role,
                    std::vector<Link>& links, std::vector<uint32_t>& numbers, std::vector<PlantError>& errors) {
  const auto refuse = [&](const std::string& why) {
    errors.push_back({row.place, fmt::format("machine '{}': {}", machine.config.name, why)});
  };
  const auto variable = machine.config.model->find(row.variable, role);
  if (!variable) return refuse(variable.error());
  if (signals::is_pattern(row.signal)) return refuse(fmt::format("'{}' is a pattern; write one signal", row.signal));
  auto found = signals::find_signals(plant, row.signal);
  if (!found) return refuse(found.error());
  if (found->size() != 1) return refuse(fmt::format("'{}' stands for {} signals; write one of them", row.signal, found->size()));
  const signals::Signal& signal = found->front();
  if (role == MachineVariable::Role::Output && !signal.is_writable())
    return refuse(fmt::format("{} can only be read", signal.name));
  const signals::OwnNumber own = signals::own_number(signal);
  // Where one of the two has no unit, the numbers are the same.
  const bool converts = variable->unit && own.unit;
  if (converts && !signals::measure_the_same(*own.unit, *variable->unit))
    return refuse(fmt::format("{} is in {}, and {} in {}", row.variable, variable->unit->name, signal.name, own.unit->name));
  const PhysicalUnit plain;
  const PhysicalUnit of_signal = converts ? *own.unit : plain;
  links.push_back({signal, own.per_sample, of_signal, converts ? *variable->unit : plain, row.place});
  numbers.push_back(variable->number);
}

void Machines::start() {
  for (Machine& machine : machines_) {
    if (const std::string remark = machine.config.model->remark(machine.config.every); !remark.empty())
      journal_.note(queue_.now(), Weight::Warning, machine.config.name, remark);
    queue_.schedule(queue_.now(), machine.source, machine, 0);
  }
}

void Machines::Machine::on_event(Time now, uint32_t /*kind*/, uint64_t /*argument*/) { all.pass(*this, now); }

void Machines::pass(Machine& machine, Time now) {
  for (size_t n = 0; n < machine.inputs.size(); ++n) {
    const Link& link = machine.inputs[n];
    machine.in[n] = signals::converted(static_cast<double>(link.signal.read()) * link.per_sample, link.of_signal, link.of_variable);
  }
  const bool begins = machine.run == nullptr;
  if (begins) machine.run = machine.config.model->make(machine.wiring);
  const MachineRun::Done done =
      begins ? machine.run->start(machine.in, machine.out)
             : machine.run->step(now - machine.config.every, machine.config.every, machine.in, machine.out);
  tell_words(machine, now);
  if (!done) return fail(machine, now, done.error());
  for (size_t n = 0; n < machine.out.size(); ++n)
    if (!std::isfinite(machine.out[n]))
      return fail(machine, now, fmt::format("it gives no number for {}", machine.config.outputs[n].variable));
  give(machine, now);
  queue_.schedule(now + machine.config.every, machine.source, machine, 0);
}

// What was written and is still there is not written again; a process word comes each time, like telegrams of a master.
void Machines::give(Machine& machine, Time now) {
  for (size_t n = 0; n < machine.outputs.size(); ++n) {
    Link& link = machine.outputs[n];
    const signals::Signal& signal = link.signal;
    const double number = signals::converted(machine.out[n], link.of_variable, link.of_signal) / link.per_sample;
    const double within = std::clamp(number, static_cast<double>(signal.limits.least), static_cast<double>(signal.limits.most));
    const int64_t sample = signal.bits == 1 ? (machine.out[n] != 0 ? 1 : 0) : std::llround(within);
    machine.samples[n] = sample;
    if (signal.is_input()) {
      const auto level = static_cast<int32_t>(sample);
      if (std::as_const(*signal.owner).inputs().line(signal.number).driven != level) signal.line().driven = level;
    } else if (signal.group == signals::Group::ProcessData || link.written != sample || signal.read() != sample) {
      link.written = sample;
      const auto refused = signal.write(sample);
      if (refused && !link.given_up)
        journal_.note(now, Weight::Warning, machine.config.name, fmt::format("{} refused: {}", signal.name, *refused));
      link.given_up = refused.has_value();
    }
  }
  for (MachineWatcher* watcher : watchers_) watcher->on_given(machine.number, now, machine.samples);
}

// The journal tells a line once, however often it comes.
void Machines::tell_words(Machine& machine, Time now) {
  for (MachineWord& word : machine.run->take_words()) {
    if (machine.told > kMostWords) return;
    if (machine.told == kMostWords) word = {true, "says more, which is not told"};
    const size_t before = journal_.entries().size();
    journal_.note(now, word.warns ? Weight::Warning : Weight::Why, machine.config.name, std::move(word.text));
    machine.told += journal_.entries().size() - before;
  }
}

void Machines::fail(Machine& machine, Time now, const std::string& why) {
  const std::string text = fmt::format("machine '{}' at {}: {}", machine.config.name, seconds(now), why);
  failures_.push_back({machine.config.place, text});
  journal_.tell(now, Weight::Fault, machine.config.name, why);
}

bool Machines::gives_states() const {
  return std::all_of(machines_.begin(), machines_.end(),
                     [](const Machine& machine) { return machine.config.model->gives_state(); });
}

std::optional<std::vector<std::string>> Machines::save() {
  std::vector<std::string> states;
  if (!gives_states()) return std::nullopt;
  for (Machine& machine : machines_) {
    std::optional<std::string> state = machine.run == nullptr ? std::string() : machine.run->save();
    if (!state) return std::nullopt;
    states.push_back(*std::move(state));
  }
  return states;
}

void Machines::restore(const std::vector<std::string>& states) {
  for (size_t n = 0; n < states.size(); ++n) {
    Machine& machine = machines_[n];
    if (machine.run == nullptr) continue;
    if (const auto done = machine.run->restore(states[n]); !done) fail(machine, queue_.now(), done.error());
  }
}

}  // namespace ipos::runtime
