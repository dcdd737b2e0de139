// Finds signals by name and samples them.
#include "tools/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "runtime/drive/indices.hpp"
#include "tools/failure.hpp"

namespace ipos::tools {
namespace {

using runtime::Station;

// Display values by name: those of the parameters that a drive keeps up to date.
struct NamedParameter {
  std::string_view name, number;
};
constexpr NamedParameter kNamedParameters[] = {
    {"speed", "000"},          {"frequency", "002"},         {"position", "003"}, {"current", "004"},
    {"active_current", "005"}, {"motor_utilization", "006"}, {"dc_link", "008"},  {"temperature", "014"},
};

// Fault number, or the condition of the unit.
std::string state_text(const Station& station) {
  const runtime::Drive& drive = station.drive().state();
  if (drive.fault() != 0) return fmt::format("F{:02}", drive.fault());
  return std::string(runtime::condition_text(drive.condition()));
}

const stdlib::Parameter* find_parameter(const Station& station, std::string_view number) {
  return stdlib::parameter_table(*station.config().unit).find(number);
}

std::string signals_of(const Station& station) {
  std::vector<std::string> names;
  for (const NamedParameter& row : kNamedParameters)
    if (find_parameter(station, row.number) != nullptr) names.emplace_back(row.name);
  names.insert(names.end(), {"setpoint", "status"});
  if (find_parameter(station, "000") != nullptr) names.emplace_back("parameters as P000");
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
  if (owner == nullptr) {
    std::vector<std::string> known;
    for (const auto& station : stations) known.push_back(station->config().name + ".");
    throw Failure(kUsage,
                  fmt::format("'{}' is no signal; signals begin with {}", name, fmt::join(known, ", ")));
  }
  if (!add(*owner, rest))
    throw Failure(kUsage, fmt::format("station '{}' has no signal '{}'; it has {}", owner->config().name,
                                      rest, signals_of(*owner)));
}

// False when the station has no such signal.
bool Recorder::add(Station& station, std::string_view name) {
  Signal signal;
  signal.name = fmt::format("{}.{}", station.config().name, name);
  if (name == "status") {
    signal.is_status = true;
    watched_.push_back({&station, state_text(station)});
    add(std::move(signal), [&station] { return station.status_word_1(); });
    return true;
  }
  if (name == "setpoint") {
    signal.unit = "rpm";
    signal.factor = 0.001;
    signal.decimals = 3;
    add(std::move(signal),
        [&station] { return int64_t{std::as_const(station).drive().state().axis().setpoint}; });
    return true;
  }
  const auto* named = std::find_if(std::begin(kNamedParameters), std::end(kNamedParameters),
                                   [&](const NamedParameter& row) { return row.name == name; });
  const stdlib::Parameter* parameter = nullptr;
  if (named != std::end(kNamedParameters))
    parameter = find_parameter(station, named->number);
  else if (name.starts_with('P') || name.find_first_not_of("0123456789") == std::string_view::npos)
    parameter = find_parameter(station, name);
  if (parameter != nullptr && parameter->index != 0) {
    const stdlib::DisplayScale scale = stdlib::display_scale(*parameter);
    if (parameter->display != "hex") signal.unit = parameter->display;
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
  return false;
}

void Recorder::add(Signal signal, Reader reader) {
  recording_.signals.push_back(std::move(signal));
  recording_.samples.emplace_back();
  readers_.push_back(std::move(reader));
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
