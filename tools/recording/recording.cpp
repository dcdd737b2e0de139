// Finds signals by name and samples them.
#include "tools/recording/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "runtime/plant/bus.hpp"
#include "tools/cli/failure.hpp"

namespace ipos::tools {
namespace {

using runtime::Station;

constexpr std::string_view kFrames = ".frames";

// Fault number, or the condition of the unit.
std::string state_text(const Station& station) {
  const runtime::Drive& drive = station.drive().state();
  if (drive.fault() != 0) return fmt::format("F{:02}", drive.fault());
  return std::string(runtime::condition_text(drive.condition()));
}

std::string frames_text(const runtime::Plant& plant) {
  std::string text;
  for (const auto& bus : plant.buses()) text += fmt::format(", {}{}", bus->name(), kFrames);
  return text;
}

}  // namespace

bool is_binary(const Recording& recording, size_t number) {
  const Signal& signal = recording.signals[number];
  if (signal.bits != 0) return signal.bits == 1;
  const auto& samples = recording.samples[number];
  const auto beyond = [](int64_t sample) { return sample != 0 && sample != 1; };
  return signal.unit.empty() && signal.factor == 1 &&
         std::find(samples.begin(), samples.end(), 1) != samples.end() &&
         std::none_of(samples.begin(), samples.end(), beyond);
}

Recorder::Recorder(runtime::Plant& plant, const std::vector<std::string>& names) : plant_(plant) {
  for (const std::string& name : names) add(name);
  if (!names.empty()) return;
  for (const auto& station : plant.stations())
    for (const std::string_view name : {"speed", "setpoint", "status"})
      for (Signal& signal : runtime::find_station_signals(*station, name)) add(std::move(signal));
}

void Recorder::add(const std::string& name) {
  if (add_frames(name)) return;
  auto found = runtime::find_signals(plant_, name);
  if (!found) throw Failure(kUsage, found.error() + frames_text(plant_));
  for (Signal& signal : *found) add(std::move(signal));
}

void Recorder::add(Signal signal) {
  if (signal.is_status)
    for (const auto& station : plant_.stations())
      if (station->config().name == signal.station) watched_.push_back({station.get(), state_text(*station)});
  recording_.signals.push_back(std::move(signal));
  recording_.samples.emplace_back();
}

bool Recorder::add_frames(std::string_view name) {
  if (!name.ends_with(kFrames)) return false;
  runtime::Bus* bus = plant_.find_bus(name.substr(0, name.size() - kFrames.size()));
  if (bus == nullptr) return false;
  if (track_of(bus->name())) return true;
  bus->add_observer(*this);
  recording_.tracks.push_back({bus->name(), bus->kind() == runtime::BusKind::Can});
  return true;
}

std::optional<size_t> Recorder::track_of(const std::string& bus) const {
  for (size_t n = 0; n < recording_.tracks.size(); ++n)
    if (recording_.tracks[n].bus == bus) return n;
  return std::nullopt;
}

// A telegram is known to be void some time after its last character.
void Recorder::on_message(const runtime::Bus& bus, const runtime::BusMessage& message) {
  auto& frames = recording_.frames;
  const auto behind =
      std::upper_bound(frames.begin(), frames.end(), message.end,
                       [](runtime::Time time, const RecordedFrame& other) { return time < other.time; });
  const runtime::Frame frame = message.frame.value_or(runtime::Frame{});
  frames.insert(behind, {message.end, *track_of(bus.name()), frame.id, frame.extended, frame.remote,
                         message.bytes, message.meaning.empty() ? message.text : message.meaning});
}

void Recorder::finish() {
  for (const FrameTrack& track : recording_.tracks) plant_.find_bus(track.bus)->finish();
}

void Recorder::sample(runtime::Time now) {
  if (now % runtime::kMillisecond != 0) return;
  recording_.times.push_back(now);
  for (size_t n = 0; n < recording_.signals.size(); ++n)
    recording_.samples[n].push_back(recording_.signals[n].read());
  note_changes(now);
}

void Recorder::note_changes(runtime::Time now) {
  for (Watched& watched : watched_) {
    const std::string text = state_text(*watched.station);
    if (text == watched.state) continue;
    watched.state = text;
    const std::string who = plant_.stations().size() == 1 ? "" : watched.station->config().name + ": ";
    recording_.events.push_back({now, who + text, text.starts_with('F')});
  }
}

}  // namespace ipos::tools
