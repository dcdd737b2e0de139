// Finds signals by name and samples them.
#include "tools/recording/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "runtime/bus/log/candump.hpp"
#include "runtime/bus/log/serial_log.hpp"
#include "runtime/drive/indices.hpp"
#include "runtime/plant/signal.hpp"
#include "tools/cli/failure.hpp"

namespace ipos::tools {
namespace {

using runtime::Station;

// The signals with a name of their own: a display value, which the drive keeps up to date in its parameter; a
// variable; or what only the simulation knows.
struct NamedSignal {
  std::string_view name;
  std::string_view parameter;  // number
  int variable = -1;           // of units that position
  int64_t (*read)(const Station&) = nullptr;
  std::string_view unit{};
  double factor = 1;
  int decimals = 0;
  size_t bits = 0;
};

template <int32_t runtime::AxisState::*member>
int64_t axis(const Station& station) {
  return station.drive().state().axis().*member;
}

using runtime::AxisState;
constexpr NamedSignal kNamedSignals[] = {
    {"speed", "000"},
    {"frequency", "002"},
    {"position", "003"},
    {"current", "004"},
    {"active_current", "005"},
    {"motor_utilization", "006"},
    {"dc_link", "008"},
    {"temperature", "014"},
    {"setpoint", "", -1, axis<&AxisState::setpoint>, "rpm", 0.001, 3},
    {"shaft_speed", "", -1, axis<&AxisState::speed>, "rpm", 0.001, 3},
    {"torque", "", -1, axis<&AxisState::torque>, "%Mn", 0.001, 3},
    {"position_setpoint", "", 491, nullptr, "inc"},
    {"position_target", "", 492, nullptr, "inc"},
    {"lag", "", 495, nullptr, "inc"},
    {"status", "", -1, [](const Station& station) -> int64_t { return station.status_word_1(); }, "", 1, 0,
     16},
    {"fault", "", -1, [](const Station& station) -> int64_t { return station.fault(); }},
};
constexpr std::string_view kFrames = ".frames";

// Fault number, or the condition of the unit.
std::string state_text(const Station& station) {
  const runtime::Drive& drive = station.drive().state();
  if (drive.fault() != 0) return fmt::format("F{:02}", drive.fault());
  return std::string(runtime::condition_text(drive.condition()));
}

const stdlib::Parameter* find_parameter(const Station& station, std::string_view number) {
  return stdlib::parameter_table(*station.config().unit).find(number);
}

bool has(const Station& station, const NamedSignal& row) {
  if (row.read != nullptr) return true;
  if (row.variable >= 0)
    return station.image() != nullptr && station.config().unit->generation != stdlib::Generation::M07;
  return find_parameter(station, row.parameter) != nullptr;
}

std::string signals_of(const Station& station) {
  std::vector<std::string> names;
  for (const NamedSignal& row : kNamedSignals)
    if (has(station, row)) names.emplace_back(row.name);
  if (find_parameter(station, "000") != nullptr) names.emplace_back("parameters as P000");
  names.emplace_back("inputs as DI00");
  names.emplace_back("outputs as DO01");
  if (station.image() != nullptr) {
    names.push_back(fmt::format("variables H0 to H{}", station.config().unit->variables - 1));
    for (const vm::Symbol& symbol : station.image()->symbols) names.push_back(symbol.name);
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

std::string Signal::text(int64_t sample) const {
  return fmt::format("{:.{}f}", static_cast<double>(sample) * factor, decimals);
}

Recorder::Recorder(runtime::Plant& plant, const std::vector<std::string>& names) : plant_(plant) {
  for (const std::string& name : names) add(name);
  if (!names.empty()) return;
  for (const auto& station : plant.stations())
    for (const std::string_view name : {"speed", "setpoint", "status"}) add(*station, name);
}

void Recorder::add(const std::string& name) {
  auto& stations = plant_.stations();
  Station* owner = nullptr;
  std::string_view rest = name;
  for (const auto& station : stations) {
    // Names of stations may contain dots themselves: the longest that fits.
    const std::string prefix = station->config().name + ".";
    if (!name.starts_with(prefix) || (owner != nullptr && prefix.size() <= name.size() - rest.size()))
      continue;
    owner = station.get();
    rest = std::string_view(name).substr(prefix.size());
  }
  if (owner == nullptr && stations.size() == 1) owner = stations.front().get();
  if (owner != nullptr && add(*owner, rest)) return;
  if (add_frames(name)) return;
  std::vector<std::string> buses;
  for (const auto& line : plant_.lines()) buses.push_back(line->name() + std::string(kFrames));
  for (const auto& line : plant_.serial_lines()) buses.push_back(line->line.name() + std::string(kFrames));
  const std::string frames = buses.empty() ? "" : fmt::format("; the buses have {}", fmt::join(buses, ", "));
  if (owner == nullptr) {
    std::vector<std::string> known;
    for (const auto& station : stations) known.push_back(station->config().name + ".");
    throw Failure(kUsage, fmt::format("'{}' is no signal; signals begin with {}{}", name,
                                      fmt::join(known, ", "), frames));
  }
  throw Failure(kUsage, fmt::format("station '{}' has no signal '{}'; it has {}{}", owner->config().name,
                                    rest, signals_of(*owner), frames));
}

// False when the station has no such signal.
bool Recorder::add(Station& station, std::string_view name) {
  Signal signal;
  signal.name = fmt::format("{}.{}", station.config().name, name);
  signal.station = station.config().name;
  const auto* named = std::find_if(std::begin(kNamedSignals), std::end(kNamedSignals),
                                   [&](const NamedSignal& row) { return row.name == name; });
  const stdlib::Parameter* parameter = nullptr;
  if (named != std::end(kNamedSignals) && has(station, *named)) {
    signal.unit = named->unit;
    signal.factor = named->factor;
    signal.decimals = named->decimals;
    signal.bits = named->bits;
    if (name == "status") {
      signal.is_status = true;
      watched_.push_back({&station, state_text(station)});
    }
    if (named->read != nullptr) {
      add(std::move(signal), [&station, read = named->read] { return read(station); });
      return true;
    }
    if (named->variable >= 0) {
      add(std::move(signal),
          [&station, number = static_cast<uint32_t>(named->variable)] { return station.variable(number); });
      return true;
    }
    parameter = find_parameter(station, named->parameter);
  } else if (name.starts_with('P') || name.find_first_not_of("0123456789") == std::string_view::npos) {
    parameter = find_parameter(station, name);
  }
  if (parameter != nullptr && parameter->index != 0) {
    const stdlib::DisplayScale scale = stdlib::display_scale(*parameter);
    if (parameter->display == "hex")
      signal.bits = 32;
    else
      signal.unit = parameter->display;
    signal.factor = scale.factor;
    signal.decimals = scale.decimals;
    add(std::move(signal), [&station, parameter] {
      return parameter->number_of(std::as_const(station).drive().parameters().value(parameter->index));
    });
    return true;
  }
  if (const auto variable = station.find_variable(name)) {
    add(std::move(signal), [&station, number = *variable] { return station.variable(number); });
    return true;
  }
  if (const int line = runtime::parse_input(name); line >= 0) {
    add(std::move(signal), [&station, line = static_cast<size_t>(line)] {
      return std::as_const(station).inputs().line(line).value();
    });
    return true;
  }
  if (const int bit = runtime::parse_output(name); bit >= 0) {
    add(std::move(signal), [&station, bit] { return station.outputs() >> bit & 1; });
    return true;
  }
  return false;
}

void Recorder::add(Signal signal, Reader reader) {
  recording_.signals.push_back(std::move(signal));
  recording_.samples.emplace_back();
  readers_.push_back(std::move(reader));
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
  for (size_t n = 0; n < readers_.size(); ++n) recording_.samples[n].push_back(readers_[n]());
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
