// The tab Watch: names to search, a list of each client, values to set and to force. Everything that has a name
// (station_signals.hpp) can be watched; variables, parameters and terminals can be set.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include "runtime/plant_file/signal.hpp"
#include "runtime/signals/plant_signals.hpp"
#include "stdlib/parameters.hpp"
#include "tools/serve/tabs.hpp"

namespace ipos::tools::serve {
namespace {

using signals::Signal;
using signals::Group;
using runtime::Station;

constexpr size_t kMostWatched = 1000;
constexpr size_t kLongBits = 32;

// In the order of the list.
constexpr Group kGroupOrder[] = {
    Group::Variable, Group::SystemVariable, Group::Drive,  Group::State,
    Group::Input,    Group::Output,         Group::Analog, Group::ProcessData,
    Group::Task,     Group::Parameter,      Group::Bus};

std::string lower(std::string_view text) {
  std::string out;
  for (const char c : text) out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

// Without the station's part.
std::string_view short_name(const Signal& signal) {
  return std::string_view(signal.name).substr(signal.station.size() + 1);
}

// A number as people write it: decimal or 0x..., 32 bits.
std::optional<int32_t> number_of(std::string_view text) {
  const bool negative = text.starts_with('-');
  if (negative) text.remove_prefix(1);
  const bool hex = text.starts_with("0x") || text.starts_with("0X");
  if (hex) text.remove_prefix(2);
  uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, hex ? 16 : 10);
  if (error != std::errc() || end != text.data() + text.size() || text.empty()) return std::nullopt;
  if (!hex && value > (negative ? 0x80000000U : 0x7FFFFFFFU)) return std::nullopt;
  return static_cast<int32_t>(negative ? 0U - value : value);
}

class WatchTab final : public Tab {
 public:
  explicit WatchTab(PlantHost& host) : host_(host) {
    Desk& desk = host.desk();
    desk.add_command("search", [this](const Desk::Call& call) { return search(call.arguments); });
    desk.add_command("watch", [this](const Desk::Call& call) { return watch(call); });
    desk.add_command("set", [this](const Desk::Call& call) { return set(call.arguments); });
    desk.add_command("force", [this](const Desk::Call& call) { return force(call.arguments); });
    desk.add_command("release", [this](const Desk::Call& call) { return release(call.arguments); });
    desk.add_command("forced", [this](const Desk::Call&) {
      Json names = Json::array();
      for (const auto& [name, value] : forced_) names.push_back(name);
      for (const auto& station : host_.plant().stations())
        for (const char* input : {"DI00", "DI01", "DI02", "DI03", "DI04", "DI05", "DI06", "DI07", "DI10",
                                  "DI11", "DI12", "DI13", "DI14", "DI15", "DI16", "DI17"})
          if (std::as_const(*station).inputs().line(static_cast<size_t>(runtime::parse_input(input))).forced)
            names.push_back(station->config().name + "." + input);
      return Json{{"names", std::move(names)}};
    });
    host.add_action("force", [this](const Json& action) { hold(Arguments(action), true); });
    host.add_action("release", [this](const Json& action) { hold(Arguments(action), false); });
    desk.add_topic("watch",
                   [this](Client& client, Subscription& subscription) { publish(client, subscription); });
    desk.on_closed = [this](const Client& client) { watched_.erase(client.number); };
  }

  void built(runtime::Plant&) override {
    known_.clear();
    watched_.clear();
    forced_.clear();
  }
  void load(const Json&) override { watched_.clear(); }

 private:
  // --- names ---

  const std::vector<Signal>& known() {
    if (!known_.empty()) return known_;
    known_ = signals::plant_signals(host_.plant());
    for (const auto& station : host_.plant().stations())
      for (const stdlib::Parameter& row : stdlib::parameter_table(*station->config().unit).rows())
        if (!row.number.empty() && row.index != 0)
          for (Signal& signal : signals::find_station_signals(*station, "P" + std::string(row.number)))
            known_.push_back(std::move(signal));
    return known_;
  }

  bool writable(const Signal& signal) const {
    switch (signal.group) {
      case Group::Variable:
      case Group::SystemVariable:
      case Group::Input: return true;
      case Group::Analog: return runtime::parse_analog_input(short_name(signal)) >= 0;
      case Group::Parameter: {
        const stdlib::Parameter* parameter = parameter_of(signal);
        return parameter != nullptr && parameter->writable;
      }
      default: return false;
    }
  }

  const Station* station_of(const Signal& signal) const {
    for (const auto& station : host_.plant().stations())
      if (station->config().name == signal.station) return station.get();
    return nullptr;
  }
  const stdlib::Parameter* parameter_of(const Signal& signal) const {
    const Station* station = station_of(signal);
    return station == nullptr ? nullptr
                              : stdlib::parameter_table(*station->config().unit).find(short_name(signal));
  }

  Json json_of(const Signal& signal) const {
    return {{"name", signal.name},
            {"group", signals::group_text(signal.group)},
            {"unit", signal.unit},
            {"text", signal.meaning},
            {"writable", writable(signal)}};
  }

  Json search(const Arguments& a) {
    const std::string text = lower(a.text("text", ""));
    const std::string station = a.text("station", "");
    const std::string group = a.text("group", "");
    const auto limit = static_cast<size_t>(a.whole("limit", 1, 1000, 100));
    Json names = Json::array();
    size_t total = 0;
    for (const Group wanted : kGroupOrder) {
      if (!group.empty() && group != signals::group_text(wanted)) continue;
      for (const Signal& signal : known()) {
        if (signal.group != wanted || (!station.empty() && signal.station != station)) continue;
        if (lower(signal.name).find(text) == std::string::npos &&
            lower(signal.meaning).find(text) == std::string::npos)
          continue;
        ++total;
        if (names.size() < limit) names.push_back(json_of(signal));
      }
    }
    Json groups = Json::array();
    for (const Group row : kGroupOrder)
      if (std::any_of(known().begin(), known().end(),
                      [row](const Signal& signal) { return signal.group == row; }))
        groups.push_back(signals::group_text(row));
    return {{"names", std::move(names)}, {"total", total}, {"groups", std::move(groups)}};
  }

  std::vector<Signal> find(const std::string& name) const {
    auto found = signals::find_signals(host_.plant(), name);
    if (!found) throw Mistake(found.error());
    return std::move(*found);
  }
  Signal find_one(const std::string& name) const {
    auto found = find(name);
    if (found.size() != 1)
      throw Mistake(fmt::format("'{}' stands for {} values; name one", name, found.size()));
    return std::move(found.front());
  }

  Json watch(const Desk::Call& call) {
    std::vector<Signal> signals;
    for (const std::string& name : call.arguments.texts("names", kMostWatched))
      for (Signal& signal : find(name)) signals.push_back(std::move(signal));
    if (signals.size() > kMostWatched)
      throw Mistake(fmt::format("these are {} values, at most {} are watched", signals.size(), kMostWatched));
    call.client.watched.clear();
    Json names = Json::array();
    for (const Signal& signal : signals) {
      call.client.watched.push_back(signal.name);
      names.push_back(json_of(signal));
    }
    watched_[call.client.number] = std::move(signals);
    if (const auto topic = call.client.subscriptions.find("watch"); topic != call.client.subscriptions.end())
      topic->second.sent.clear();
    return {{"names", std::move(names)}};
  }

  // --- values ---

  Json value_json(const Signal& signal) const {
    const int64_t sample = signal.read();
    Json json{{"text", signal.text(sample)}, {"forced", is_forced(signal)}};
    const double value = static_cast<double>(sample) * signal.factor;
    json["value"] = signal.decimals == 0 ? Json(std::llround(value)) : Json(value);
    const size_t bits = signal.bits > 1 ? signal.bits : kLongBits;
    json["hex"] = bits > 16 ? fmt::format("{:08X} h", static_cast<uint32_t>(sample))
                            : fmt::format("{:04X} h", static_cast<uint16_t>(sample));
    if (signal.group == Group::Parameter)
      if (const stdlib::Parameter* parameter = parameter_of(signal);
          parameter != nullptr && !parameter->texts.empty())
        json["text"] = stdlib::parameter_text(*parameter, static_cast<int32_t>(sample));
    return json;
  }

  bool is_forced(const Signal& signal) const {
    if (forced_.count(signal.name) != 0) return true;
    if (signal.group != Group::Input) return false;
    const int line = runtime::parse_input(short_name(signal));
    return line >= 0 && station_of(signal)->inputs().line(static_cast<size_t>(line)).forced.has_value();
  }

  void publish(Client& client, Subscription& subscription) {
    auto found = watched_.find(client.number);
    if (found == watched_.end()) {  // the plant is another one
      std::vector<Signal> signals;
      for (const std::string& name : client.watched)
        for (Signal& signal : find(name)) signals.push_back(std::move(signal));
      found = watched_.emplace(client.number, std::move(signals)).first;
    }
    Json values = Json::object();
    for (const Signal& signal : found->second) {
      const Station* station = station_of(signal);
      Json now = station != nullptr && !station->powered() ? Json(nullptr) : value_json(signal);
      if (subscription.is_news(signal.name, now)) values[signal.name] = std::move(now);
    }
    if (values.empty() && !subscription.fresh) return;
    host_.desk().send(client, {{"event", "watch"}, {"us", host_.us()}, {"values", std::move(values)}});
  }

  // --- what is set ---

  Json set(const Arguments& a) {
    const Signal signal = find_one(a.text("name"));
    const std::string text = a.text("value");
    const std::string name(short_name(signal));
    if (!writable(signal)) throw Mistake(fmt::format("{} cannot be set", signal.name));
    if (signal.group == Group::Input) {
      host_.act("input",
                {{"station", signal.station}, {"name", name}, {"action", "set"}, {"on", level_of(text)}});
    } else if (signal.group == Group::Analog) {
      host_.act("analog", {{"station", signal.station}, {"name", name}, {"action", "set"}, {"value", text}});
    } else if (signal.group == Group::Parameter) {
      const stdlib::Parameter& parameter = *parameter_of(signal);
      const auto value = stdlib::parse_parameter_text(parameter, text);
      if (!value) throw Mistake(value.error());
      host_.act(
          "parameters.set",
          {{"station", signal.station}, {"index", parameter.index}, {"value", *value}, {"volatile", true}});
    } else {
      const auto value = number_of(text);
      if (!value)
        throw Mistake(fmt::format("'{}' is no number of 32 bits; write it decimal or as 0x1F", text));
      host_.debugger().write(debug::evaluate_place(host_.plant(), host_.station_number(signal.station), name),
                             *value);
    }
    return {{"text", value_json(signal)["text"]}};
  }

  static bool level_of(const std::string& text) {
    if (text == "1" || text == "on") return true;
    if (text == "0" || text == "off") return false;
    throw Mistake(fmt::format("'{}' is no level; write 0 or 1", text));
  }

  Json force(const Arguments& a) {
    const Signal signal = find_one(a.text("name"));
    const std::string text = a.text("value");
    const std::string name(short_name(signal));
    if (signal.group == Group::Input) {
      host_.act("input",
                {{"station", signal.station}, {"name", name}, {"action", "force"}, {"on", level_of(text)}});
    } else if (signal.group == Group::Variable || signal.group == Group::SystemVariable) {
      const auto value = number_of(text);
      if (!value)
        throw Mistake(fmt::format("'{}' is no number of 32 bits; write it decimal or as 0x1F", text));
      host_.act("force", {{"name", signal.name}, {"value", *value}});
    } else {
      throw Mistake(fmt::format("{} cannot be forced; variables and inputs can", signal.name));
    }
    return {{"text", text}};
  }

  Json release(const Arguments& a) {
    const Signal signal = find_one(a.text("name"));
    if (!is_forced(signal)) throw Mistake(fmt::format("{} is not forced", signal.name));
    if (signal.group == Group::Input)
      host_.act(
          "input",
          {{"station", signal.station}, {"name", std::string(short_name(signal))}, {"action", "release"}});
    else
      host_.act("release", {{"name", signal.name}});
    return Json::object();
  }

  void hold(const Arguments& a, bool on) {
    const Signal signal = find_one(a.text("name"));
    runtime::Stimulus stimulus;
    stimulus.signal = {signal.station, runtime::SignalKind::Variable, std::string(short_name(signal)), 0};
    stimulus.action = on ? runtime::Stimulus::Action::Force : runtime::Stimulus::Action::Release;
    stimulus.at = host_.plant().now();
    std::string why;
    const auto port = signals::SignalPort::find(host_.plant().stations(), stimulus.signal, why);
    if (!port) throw Mistake(why);
    if (on) {
      stimulus.value = static_cast<int32_t>(a.whole("value", INT32_MIN, INT32_MAX));
      if (const auto refused = port->write(stimulus.value)) throw Refusal(*refused);
      forced_[signal.name] = stimulus.value;
    } else {
      forced_.erase(signal.name);
    }
    host_.plant().surroundings().add(*port, stimulus);
  }

  PlantHost& host_;
  std::vector<Signal> known_;
  std::map<uint16_t, std::vector<Signal>> watched_;  // by client
  std::map<std::string, int32_t> forced_;                 // variables
};

}  // namespace

std::unique_ptr<Tab> make_watch_tab(PlantHost& host) { return std::make_unique<WatchTab>(host); }

}  // namespace ipos::tools::serve
