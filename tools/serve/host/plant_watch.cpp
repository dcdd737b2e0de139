// The values of a plant for the tab Watch: names to search, values to set and to force. Everything that has a name
// (runtime/signals) can be watched; variables, parameters and terminals can be set.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <set>

#include "runtime/plant/actions.hpp"
#include "runtime/plant_file/signal.hpp"
#include "runtime/signals/find.hpp"
#include "stdlib/parameters.hpp"
#include "tools/serve/host/tabs.hpp"
#include "tools/serve/host/watch_tab.hpp"

namespace ipos::tools::serve {
namespace {

using signals::Group;
using signals::Signal;

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

class PlantWatch final : public Tab, private WatchSource {
 public:
  explicit PlantWatch(PlantHost& host) : host_(host), tab_(host.router(), *this) {
    Router& router = host.router();
    router.add_command("search", [this](const Router::Call& call) { return search(call.arguments); });
    router.add_command("force", [this](const Router::Call& call) { return force(call.arguments); });
    router.add_command("release", [this](const Router::Call& call) { return release(call.arguments); });
    router.add_command("forced", [this](const Router::Call&) {
      Json names = Json::array();
      for (const signals::Hold& held : host_.plant().surroundings().holds().all()) names.push_back(held.signal.name);
      for (const auto& station : host_.plant().stations())
        for (const Signal& input : signals::signals_of(*station, Group::Input))
          if (host_.plant().surroundings().holds().find(input) == nullptr && is_forced(input)) names.push_back(input.name);
      return Json{{"names", std::move(names)}};
    });
    host.add_action("force", [this](const Json& action) { hold(Arguments(action), true); });
    host.add_action("release", [this](const Json& action) { hold(Arguments(action), false); });
  }

  void built(runtime::Plant&) override {
    known_.clear();
    tab_.forget();
  }
  void loaded(uint32_t) override {
    known_.clear();
    tab_.forget();
  }
  void load(const Json&) override { tab_.forget(); }

 private:
  // --- names ---

  const std::vector<Signal>& known() {
    if (!known_.empty()) return known_;
    known_ = signals::plant_signals(host_.plant());
    for (const auto& station : host_.plant().stations())
      for (Signal& signal : signals::signals_of(*station, Group::Parameter)) known_.push_back(std::move(signal));
    return known_;
  }

  Json row(const Signal& signal) const override {
    return {{"name", signal.name},
            {"group", signals::group_text(signal.group)},
            {"unit", signal.unit},
            {"text", signal.meaning},
            {"writable", signal.is_writable()}};
  }

  Json search(const Arguments& a) {
    const std::string text = lower(a.text("text", ""));
    const std::string station = a.text("station", "");
    const std::string group = a.text("group", "");
    const auto limit = static_cast<size_t>(a.whole("limit", 1, 1000, 100));
    Json names = Json::array();
    size_t total = 0;
    std::map<std::string, std::vector<std::pair<Group, size_t>>> counts;  // by station
    for (const Group wanted : kGroupOrder) {
      if (!group.empty() && group != signals::group_text(wanted)) continue;
      for (const Signal& signal : known()) {
        if (signal.group != wanted || (!station.empty() && signal.station != station)) continue;
        if (lower(signal.name).find(text) == std::string::npos &&
            lower(signal.meaning).find(text) == std::string::npos)
          continue;
        ++total;
        auto& groups = counts[signal.station];
        if (groups.empty() || groups.back().first != wanted) groups.emplace_back(wanted, 0);
        ++groups.back().second;
        if (names.size() < limit) names.push_back(row(signal));
      }
    }
    Json groups = Json::array();
    for (const Group row : kGroupOrder)
      if (std::any_of(known().begin(), known().end(),
                      [row](const Signal& signal) { return signal.group == row; }))
        groups.push_back(signals::group_text(row));
    return {{"names", std::move(names)}, {"total", total}, {"groups", std::move(groups)}, {"tree", tree(counts)}};
  }

  // Stations in the order of the plant, then gateways and lines, each with its groups and how many were found.
  Json tree(const std::map<std::string, std::vector<std::pair<Group, size_t>>>& counts) {
    Json tree = Json::array();
    std::set<std::string> done;
    for (const Signal& signal : known()) {
      const auto found = counts.find(signal.station);
      if (found == counts.end() || !done.insert(signal.station).second) continue;
      Json groups = Json::array();
      for (const auto& [group, count] : found->second)
        groups.push_back({{"name", signals::group_text(group)}, {"count", count}});
      tree.push_back({{"station", signal.station}, {"groups", std::move(groups)}});
    }
    return tree;
  }

  std::vector<Signal> find(const std::string& name) override {
    auto found = signals::find_signals(host_.plant(), name);
    if (!found) throw Mistake(found.error());
    return std::move(*found);
  }
  Signal find_one(const std::string& name) {
    auto found = find(name);
    if (found.size() != 1)
      throw Mistake(fmt::format("'{}' stands for {} values; name one", name, found.size()));
    return std::move(found.front());
  }

  // --- values ---

  size_t most() const override { return kMostWatched; }
  bool answers_at_once() const override { return true; }
  int64_t us() const override { return host_.us(); }
  Json value(const Signal& signal) override {
    return signal.owner != nullptr && !signal.owner->powered() ? Json(nullptr) : value_json(signal);
  }

  Json value_json(const Signal& signal) const {
    const int64_t sample = signal.read();
    Json json{{"text", signal.text(sample)}, {"forced", is_forced(signal)}};
    const double value = static_cast<double>(sample) * signal.factor;
    json["value"] = signal.decimals == 0 ? Json(std::llround(value)) : Json(value);
    const size_t bits = signal.bits > 1 ? signal.bits : kLongBits;
    json["hex"] = bits > 16 ? fmt::format("{:08X} h", static_cast<uint32_t>(sample))
                            : fmt::format("{:04X} h", static_cast<uint16_t>(sample));
    if (signal.parameter != nullptr && !signal.parameter->texts.empty()) json["text"] = signal.words(sample);
    return json;
  }

  bool is_forced(const Signal& signal) const {
    return signals::is_forced(host_.plant().surroundings().holds(), signal);
  }

  // --- what is set ---

  static int64_t sample_of(const Signal& signal, const std::string& text) {
    const auto parsed = signal.parse(text);
    const auto wrong = parsed ? signal.check(parsed->sample) : parsed.error();
    if (wrong && signal.is_variable())
      throw Mistake(fmt::format("'{}' is no number of 32 bits; write it decimal or as 0x1F", text));
    if (wrong) throw Mistake(*wrong);
    return parsed->sample;
  }

  Json set(const Router::Call& call) override {
    const Arguments& a = call.arguments;
    const Signal signal = find_one(a.text("name"));
    const std::string text = a.text("value");
    if (!signal.is_writable()) throw Mistake(fmt::format("{} cannot be set", signal.name));
    const int64_t sample = sample_of(signal, text);
    if (signal.group == Group::Input)
      act(signal, "input", {{"action", "set"}, {"on", sample != 0}});
    else if (signal.group == Group::Analog)
      act(signal, "analog", {{"action", "set"}, {"value", text}});
    else if (signal.parameter != nullptr)
      host_.act("parameters.set",
                {{"station", signal.station}, {"index", signal.number}, {"value", static_cast<int32_t>(sample)}, {"volatile", true}});
    else
      host_.write(*debug::find_value(host_.plant(), host_.station_number(signal.station), signal.name),
                  static_cast<int32_t>(sample));
    return {{"text", value_json(signal)["text"]}};
  }

  Json force(const Arguments& a) {
    const Signal signal = find_one(a.text("name"));
    const std::string text = a.text("value");
    if (signal.put == nullptr || signal.group == Group::Analog)
      throw Mistake(fmt::format("{} cannot be forced; variables, parameters, words and inputs can", signal.name));
    const int64_t sample = sample_of(signal, text);
    if (signal.group == Group::Input)
      act(signal, "input", {{"action", "force"}, {"on", sample != 0}});
    else
      host_.act("force", {{"name", signal.name}, {"value", sample}});
    return {{"text", text}};
  }

  Json release(const Arguments& a) {
    const Signal signal = find_one(a.text("name"));
    if (!is_forced(signal)) throw Mistake(fmt::format("{} is not forced", signal.name));
    if (signal.group == Group::Input)
      act(signal, "input", {{"action", "release"}});
    else
      host_.act("release", {{"name", signal.name}});
    return Json::object();
  }

  // Of an input: by its terminal.
  void act(const Signal& signal, const char* action, Json details) {
    details["station"] = signal.station;
    details["name"] = std::string(runtime::input_name(signal.number));
    host_.act(action, std::move(details));
  }

  void hold(const Arguments& a, bool on) {
    const Signal signal = find_one(a.text("name"));
    runtime::PlantActions actions(host_.plant(), kPerson);
    if (!on) return actions.release(signal);
    if (const auto refused = actions.force(signal, a.whole("value", INT32_MIN, UINT32_MAX))) throw Refusal(*refused);
  }

  PlantHost& host_;
  WatchTab tab_;
  std::vector<Signal> known_;
};

}  // namespace

std::unique_ptr<Tab> make_watch_tab(PlantHost& host) { return std::make_unique<PlantWatch>(host); }

}  // namespace ipos::tools::serve
