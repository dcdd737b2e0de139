// Finds signals by name and samples them.
#include "tools/recording/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "runtime/bus/log/candump.hpp"
#include "runtime/bus/log/serial_log.hpp"
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
  const auto add = [&](const std::string& bus) { text += fmt::format(", {}{}", bus, kFrames); };
  for (const auto& line : plant.lines()) add(line->name());
  for (const auto& line : plant.serial_lines()) add(line->line.name());
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
  const std::string bus(name.substr(0, name.size() - kFrames.size()));
  const auto& can = plant_.lines();
  const auto& serial = plant_.serial_lines();
  const bool is_can =
      std::any_of(can.begin(), can.end(), [&](const auto& line) { return line->name() == bus; });
  if (!is_can &&
      std::none_of(serial.begin(), serial.end(), [&](const auto& line) { return line->line.name() == bus; }))
    return false;
  if (track_of(bus)) return true;
  const auto observed = [&](const FrameTrack& track) { return track.is_can == is_can; };
  if (std::none_of(recording_.tracks.begin(), recording_.tracks.end(), observed)) {
    if (is_can)
      plant_.add_observer(static_cast<runtime::CanObserver&>(*this));
    else
      plant_.add_observer(static_cast<runtime::SerialObserver&>(*this));
  }
  recording_.tracks.push_back({bus, is_can});
  return true;
}

std::optional<size_t> Recorder::track_of(const std::string& bus) const {
  for (size_t n = 0; n < recording_.tracks.size(); ++n)
    if (recording_.tracks[n].bus == bus) return n;
  return std::nullopt;
}

// A telegram is known to be void some time after its last character.
void Recorder::add_frame(RecordedFrame frame) {
  auto& frames = recording_.frames;
  const auto behind =
      std::upper_bound(frames.begin(), frames.end(), frame.time,
                       [](runtime::Time time, const RecordedFrame& other) { return time < other.time; });
  frames.insert(behind, std::move(frame));
}

void Recorder::on_frame(const runtime::CanLine& line, const runtime::FrameRecord& record) {
  const std::optional<size_t> track = track_of(line.name());
  if (!track) return;
  const runtime::Frame& frame = record.frame;
  const std::string text = runtime::candump_line(record.end, line.name(), frame);
  const auto length = static_cast<std::ptrdiff_t>(frame.remote ? 0 : frame.length);
  add_frame({record.end, *track, frame.id, frame.extended, frame.remote,
             std::vector<uint8_t>(frame.data.begin(), frame.data.begin() + length),
             text.substr(text.rfind(' ') + 1)});
}

void Recorder::on_character(const runtime::Rs485Line& line, runtime::NodeId /*sender*/,
                            const runtime::Character& character) {
  if (track_of(line.name())) add_telegram(line.name(), receivers_[line.name()].take(character));
}

void Recorder::add_telegram(const std::string& bus, const std::optional<runtime::Reception>& reception) {
  if (!reception) return;
  const auto bytes = reception->bytes.span();
  add_frame({reception->end, *track_of(bus), 0, false, false,
             std::vector<uint8_t>(bytes.begin(), bytes.end()), runtime::reception_text(*reception)});
}

void Recorder::finish() {
  for (auto& [bus, receiver] : receivers_) add_telegram(bus, receiver.give_up());
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
