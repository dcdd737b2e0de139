// Readers of signals, and what a report shows of them.
#include "tools/testing/probe.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "runtime/bus/movilink/describe_serial.hpp"
#include "runtime/bus_plan/names.hpp"
#include "runtime/signals/find.hpp"
#include "tools/input/sources.hpp"

namespace ipos::tools::testing {
namespace {

constexpr size_t kChanges = 4;
constexpr size_t kFrames = 8;
constexpr size_t kReasons = 8;

// "CONVEYOR.IPC:31:5: _Wait(300);" of "CONVEYOR.IPC:31:5"
std::string with_source(const std::string& place) {
  const size_t column = place.rfind(':');
  const size_t line = column == std::string::npos ? column : place.rfind(':', column - 1);
  if (line == std::string::npos) return place;
  size_t number = 0;
  std::from_chars(place.data() + line + 1, place.data() + column, number);
  const std::string text = source_line(place.substr(0, line), number);
  const size_t begin = text.find_first_not_of(" \t");
  return begin == std::string::npos ? place : place + ": " + text.substr(begin);
}

}  // namespace

Probe::Probe(runtime::Plant& plant, Listener on_event)
    : plant_(plant), on_event_(std::move(on_event)), words_(runtime::bus_names(plant)) {
  for (const auto& bus : plant.buses()) bus->add_observer(*this);
}

runtime::Station& Probe::station(const std::string& name) {
  return **std::find_if(plant_.stations().begin(), plant_.stations().end(),
                        [&](const auto& station) { return station->config().name == name; });
}

Reader Probe::reader_of(const Subject& subject, std::string& why) {
  if (subject.kind == Subject::Kind::ProcessData)
    return signals::find_in_group(station(subject.signal.station), signals::Group::ProcessData, subject.signal.name)->read;
  auto signal = signals::find_signal(plant_, subject.signal, why);
  if (!signal) return {};
  return [named = subject.signal, signal = *std::move(signal)] { return signals::value_for(named, signal); };
}

Reader Probe::follow(const Subject& subject, std::string& why) {
  for (const Followed& known : followed_)
    if (known.subject == subject) return known.read;
  Reader read = reader_of(subject, why);
  if (read) followed_.push_back({subject, read, {}});
  return read;
}

void Probe::sample(Time now) {
  for (Followed& followed : followed_) {
    const int64_t value = followed.read();
    if (!followed.changes.empty() && followed.changes.back().value == value) continue;
    followed.changes.push_back({now, value});
    if (followed.changes.size() > kChanges) followed.changes.pop_front();
  }
}

void Probe::on_message(const runtime::Bus& bus, const runtime::BusMessage& message) {
  on_event_(bus.name(), message.end, message.text, message.meaning);
  shown_.push_back({&bus, message});
  if (shown_.size() <= kFrames) return;
  const Shown& gone = shown_.front();
  if (gone.message.frame) words_.listen(gone.bus->name(), *gone.message.frame);
  shown_.pop_front();
}

// As `ipos bus decode --names` of this plant says it.
std::string Probe::words_of(const Shown& shown, runtime::BusWords& words) const {
  const runtime::BusMessage& message = shown.message;
  if (message.frame) return words.describe(shown.bus->name(), *message.frame).text;
  if (runtime::is_serial(shown.bus->kind()))
    if (const auto telegram = runtime::decode_serial(message.bytes))
      return runtime::describe(words.serial_names(), *telegram);
  return message.meaning;
}

std::vector<std::string> Probe::tasks_of(const std::string& name) const {
  std::vector<std::string> tasks;
  for (const auto& station : plant_.stations()) {
    const vm::Machine* machine = station->machine();
    if (machine == nullptr || (!name.empty() && station->config().name != name)) continue;
    const vm::Fault& fault = machine->fault();
    if (fault.number != 0)
      tasks.push_back(fmt::format("{}: ended by F{:02}, {}, at {}", station->config().name, fault.number,
                                  fault.reason, with_source(station->source_place(fault.address))));
    else if (station->program_over())
      tasks.push_back(fmt::format("{}: the program has ended", station->config().name));
    for (int task = 1; task <= vm::kTasks; ++task) {
      const vm::TaskContext& context = machine->task(task);
      if (context.state == vm::TaskState::Stopped) continue;
      tasks.push_back(fmt::format("{}: task {} {} {}", station->config().name, task,
                                  context.state == vm::TaskState::Waiting ? "waits at" : "is at",
                                  with_source(station->source_place(context.pc))));
    }
  }
  return tasks;
}

void Probe::describe(const Subject& subject, Finding& finding) const {
  const std::string& station = subject.signal.station;
  for (const Followed& followed : followed_) {
    if (followed.changes.empty() || (!station.empty() && followed.subject.signal.station != station))
      continue;
    const Change& last = followed.changes.back();
    const Subject& of = followed.subject;
    std::string text = of.is_old() ? of.text() : fmt::format("{}.{}", of.signal.station, of.signal.name);
    text += fmt::format(" = {} since {}", of.value_text(last.value), time_text(last.time));
    for (size_t n = followed.changes.size() - 1; n-- > 0;)
      text += fmt::format(", {} from {}", of.value_text(followed.changes[n].value), time_text(followed.changes[n].time));
    finding.values.push_back(std::move(text));
  }
  finding.tasks = tasks_of(station);
  // The programs have defined their objects by now.
  runtime::BusWords words = words_;
  words.use(runtime::bus_names(plant_));
  for (const Shown& shown : shown_)
    finding.frames.push_back(fmt::format("{:>12}  {} {} | {}", time_text(shown.message.end),
                                         shown.bus->name(), shown.message.text, words_of(shown, words)));
  for (const runtime::JournalEntry& entry : plant_.journal().entries()) {
    if (!station.empty() && !entry.station.empty() && entry.station != station) continue;
    finding.reasons.push_back(fmt::format("{:>12}  {}{}{}", time_text(entry.time), entry.station,
                                          entry.station.empty() ? "" : ": ", entry.text));
    if (finding.reasons.size() > kReasons) finding.reasons.erase(finding.reasons.begin());
  }
}

}  // namespace ipos::tools::testing
