// The tab Program: sources with the line that executes, coverage, breakpoints and steps, all by the debugger.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "runtime/signals/find.hpp"
#include "tools/serve/host/running_texts.hpp"
#include "tools/serve/host/tabs.hpp"

namespace ipos::tools::serve {
namespace {

using debug::Breakpoint;

constexpr size_t kMostBreakpoints = 256;
constexpr uint32_t kNowhere = UINT32_MAX;  // of a breakpoint whose line has no command in this program
constexpr size_t kMostValues = 200;

class ProgramTab final : public Tab {
 public:
  explicit ProgramTab(PlantHost& host) : host_(host) {
    Router& router = host.router();
    router.add_command("program", [this](const Router::Call& call) { return program(call.arguments); });
    router.add_command("break.set", [this](const Router::Call& call) { return set_breakpoint(call.arguments); });
    router.add_command("break.clear", [this](const Router::Call& call) {
      auto& all = host_.debugger().breakpoints();
      const int64_t number = call.arguments.whole("number", 0, INT32_MAX);
      if (std::erase_if(all, [&](const Breakpoint& point) { return point.id == number; }) == 0)
        throw Mistake("there is no such breakpoint");
      return Json::object();
    });
    router.add_command("breaks", [this](const Router::Call&) { return Json{{"breakpoints", breakpoints({})}}; });
    router.add_command("program.step", [this](const Router::Call& call) { return step(call); });
    router.add_topic("program",
                   [this](Client& client, Subscription& subscription) { publish(client, subscription); });
    router.add_topic("values",
                     [this](Client& client, Subscription& subscription) { publish_values(client, subscription); });
  }

  void restarted() override {
    covered_.clear();
    changed_.clear();
  }
  // Going back builds the plant, too; what was executed stays covered then.
  void built(runtime::Plant& plant) override {
    asked_.clear();
    versions_.clear();
    for (uint32_t n = 0; n < plant.stations().size() && !points_.empty(); ++n) place_points(n);
    if (!covered_.empty()) return;
    covered_.resize(plant.stations().size());
    for (uint32_t n = 0; n < covered_.size(); ++n) begin_coverage(plant, n);
  }

  void loaded(uint32_t station) override {
    asked_.clear();
    versions_.clear();
    place_points(station);
    begin_coverage(host_.plant(), station);
  }

  void executes(uint32_t station, uint32_t address) override {
    Covered& covered = covered_[station];
    if (address >= covered.commands.size() || covered.commands[address]) return;
    covered.commands[address] = true;
    covered.order.push_back(address);
  }

  Json save() override {
    Json all = Json::array();
    for (const Covered& covered : covered_) all.push_back(covered.order);
    Json points = Json::array(), texts = Json::array();
    for (const auto& [number, point] : points_) {
      const Json text = *point.text;
      auto known = std::find(texts.begin(), texts.end(), text);
      if (known == texts.end()) known = texts.insert(texts.end(), text);
      points.push_back({number, point.file, point.line, known - texts.begin()});
    }
    return {{"covered", std::move(all)}, {"points", std::move(points)}, {"texts", std::move(texts)}};
  }
  // This copy may be older than a program that was loaded: what was executed of that one does not count here.
  void load(const Json& state) override {
    asked_.clear();
    versions_.clear();
    for (uint32_t station = 0; station < covered_.size(); ++station)
      for (const Json& address : state["covered"][station]) executes(station, address.get<uint32_t>());
    std::vector<std::shared_ptr<const std::string>> texts;
    for (const Json& text : state["texts"]) texts.push_back(std::make_shared<const std::string>(text.get<std::string>()));
    points_.clear();
    for (const Json& one : state["points"])
      points_[one[0].get<int>()] = {one[1].get<std::string>(), one[2].get<uint32_t>(), texts.at(one[3].get<size_t>())};
    for (uint32_t station = 0; station < covered_.size(); ++station) place_points(station);
  }

 private:
  // Where a breakpoint was set, and in which text: in another one it stands at the line that is the same.
  struct Point {
    std::string file;
    uint32_t line = 0;
    std::shared_ptr<const std::string> text;
  };

  void begin_coverage(const runtime::Plant& plant, uint32_t station) {
    covered_[station] = {};
    if (const vm::Image* image = plant.stations()[station]->image())
      covered_[station].commands.assign(image->code.size(), false);
  }

  void place_points(uint32_t station) {
    const debug::CodeMap* const code = host_.debugger().code(station);
    for (Breakpoint& breakpoint : host_.debugger().breakpoints()) {
      const auto found = points_.find(breakpoint.id);
      if (breakpoint.station != station || found == points_.end()) continue;
      Point& point = found->second;
      if (auto now = host_.texts().text(station, point.file); now && *now != *point.text) {
        point.line = line_in(*point.text, *now, point.line);
        point.text = std::make_shared<const std::string>(std::move(*now));
      }
      const auto address = code == nullptr ? std::nullopt : code->address_of(point.file, point.line);
      breakpoint.address = address.value_or(kNowhere);
    }
  }

  struct Covered {
    std::vector<bool> commands;   // by address
    std::vector<uint32_t> order;  // in which they were executed first
  };

  const debug::CodeMap& code_of(uint32_t station) const {
    const debug::CodeMap* code = host_.debugger().code(station);
    if (code == nullptr)
      throw Mistake(fmt::format("{} has no program", host_.plant().stations()[station]->config().name));
    return *code;
  }

  Json program(const Arguments& a) const {
    const uint32_t station = host_.station_number(a.text("station"));
    code_of(station);
    const vm::Image& image = *host_.plant().stations()[station]->image();
    Json files = Json::array();
    for (size_t n = 0; n < image.files.size(); ++n) {
      std::set<uint32_t> lines;
      for (const vm::LineEntry& entry : image.lines)
        if (entry.file == n) lines.insert(entry.line);
      const auto text = host_.texts().text(station, image.files[n]);
      Json file{{"name", image.files[n]}, {"lines", lines}};
      file["text"] = text ? Json(*text) : Json(nullptr);
      files.push_back(std::move(file));
    }
    Json tasks = Json::array();
    for (int task = 1; task <= vm::kTasks; ++task) tasks.push_back(fmt::format("task {}", task));
    return {{"files", std::move(files)}, {"tasks", std::move(tasks)}};
  }

  Json json_of(const Breakpoint& point) const {
    debug::SourcePlace place;
    if (const debug::CodeMap* const code = host_.debugger().code(point.station); code != nullptr && point.address != kNowhere)
      place = code->place(point.address);
    else if (const auto set = points_.find(point.id); set != points_.end())
      place = {set->second.file, set->second.line, 0};
    return {
        {"number", point.id},           {"station", host_.plant().stations()[point.station]->config().name},
        {"file", place.file},           {"line", place.line},
        {"condition", point.condition}, {"hits", point.hits}};
  }
  // Tells two programs of the station apart, so that a page hears of another one however it came: built, loaded, or by going
  // back before it was loaded.
  const std::string& version(uint32_t station) {
    std::string& version = versions_[station];
    if (version.empty()) {
      const vm::Image& image = *host_.plant().stations()[station]->image();
      const auto code = vm::write_image(image);
      std::string all(code.begin(), code.end());
      for (const std::string& file : image.files) all += host_.texts().text(station, file).value_or("");
      version = version_of(all);
    }
    return version;
  }

  Json breakpoints(std::optional<uint32_t> station) const {
    Json list = Json::array();
    for (const Breakpoint& point : host_.debugger().breakpoints())
      if (!point.temporary && (!station || point.station == *station)) list.push_back(json_of(point));
    return list;
  }

  Json set_breakpoint(const Arguments& a) {
    const uint32_t station = host_.station_number(a.text("station"));
    const std::string file = a.text("file");
    const auto line = static_cast<uint32_t>(a.whole("line", 1, INT32_MAX));
    const auto address = code_of(station).address_of(file, line);
    if (!address) throw Mistake(fmt::format("there is no command at or behind line {} of {}", line, file));
    auto& all = host_.debugger().breakpoints();
    if (all.size() >= kMostBreakpoints)
      throw Mistake(fmt::format("there are {} breakpoints already", kMostBreakpoints));
    const std::string condition = a.text("condition", "");
    if (!condition.empty())
      debug::evaluate(host_.plant(), station, condition);  // throws what is wrong with it
    const auto known = std::find_if(all.begin(), all.end(), [&](const Breakpoint& point) {
      return point.station == station && point.address == *address && !point.temporary;
    });
    if (known != all.end()) {
      known->condition = condition;
      return {{"breakpoint", json_of(*known)}};
    }
    all.push_back({host_.debugger().next_id(), station, *address, condition, "", "", false, true, 0});
    if (auto text = host_.texts().text(station, file))
      points_[all.back().id] = {file, line, std::make_shared<const std::string>(std::move(*text))};
    return {{"breakpoint", json_of(all.back())}};
  }

  Json step(const Router::Call& call) {
    struct Kind {
      std::string_view word;
      debug::Motion motion;
    };
    static constexpr Kind kKinds[] = {{"over", debug::Motion::Over},
                                      {"into", debug::Motion::Into},
                                      {"out", debug::Motion::Out},
                                      {"command", debug::Motion::Instruction}};
    const uint32_t station = host_.station_number(call.arguments.text("station"));
    code_of(station);
    const std::string word = call.arguments.text("kind", "over");
    const auto* const kind =
        std::find_if(std::begin(kKinds), std::end(kKinds), [&](const Kind& row) { return row.word == word; });
    if (kind == std::end(kKinds)) throw Mistake("'kind' must be over, into, out or command");
    const auto task = static_cast<int>(call.arguments.whole("task", 1, vm::kTasks, 1));
    const vm::Machine* machine = host_.debugger().machine(station);
    if (machine == nullptr || machine->task(task).state == vm::TaskState::Stopped)
      throw Mistake(fmt::format("task {} of {} does not run", task, call.arguments.text("station")));
    host_.order(
        call, host_.debugger().order_for(kind->motion, {station, task}, call.arguments.flag("back", false)));
    return nullptr;
  }

  // Looked at once a second.
  Json changed_sources(uint32_t station) {
    Changed& changed = changed_[station];
    if (const auto now = host_.router().clock().now(); now >= changed.due) {
      changed.due = now + std::chrono::seconds(1);
      changed.files = Json::array();
      for (const std::string& file : host_.plant().stations()[station]->image()->files)
        if (const auto text = host_.texts().text(station, file); text && host_.files().has_changed(file, *text))
          changed.files.push_back(file);
    }
    return changed.files;
  }

  // What stands beside the lines: `names` of the station's program. Those that it does not have are left out.
  void publish_values(Client& client, Subscription& subscription) {
    const Arguments a(subscription.options);
    std::string station;
    auto [entry, is_new] = asked_.try_emplace(client.number);
    std::vector<signals::Signal>& asked = entry->second;
    try {
      station = a.text("station");
      if (is_new || subscription.fresh) {
        asked.clear();
        for (const std::string& name : a.texts("names", kMostValues))
          if (auto found = signals::find_signals(host_.plant(), station + "." + name); found && found->size() == 1)
            asked.push_back(std::move(found->front()));
      }
    } catch (const Mistake&) {  // it was subscribed without them
      return;
    }
    Json values = Json::object();
    for (const signals::Signal& signal : asked) {
      const Json text = signal.text(signal.read());
      if (subscription.is_news(signal.name, text)) values[std::string(signal.own_name())] = text;
    }
    if (values.empty() && !subscription.fresh) return;
    host_.router().send(client, {{"event", "values"}, {"us", host_.us()}, {"station", station}, {"values", std::move(values)}});
  }

  void publish(Client& client, Subscription& subscription) {
    const std::string name = Arguments(subscription.options).text("station", "");
    const auto& stations = host_.plant().stations();
    const auto found = std::find_if(stations.begin(), stations.end(),
                                    [&](const auto& station) { return station->config().name == name; });
    if (found == stations.end()) return;
    const auto number = static_cast<uint32_t>(found - stations.begin());
    const debug::Debugger& debugger = host_.debugger();
    if (debugger.code(number) == nullptr) return;
    Json tasks = Json::array();
    for (const debug::TaskRef& task : debugger.tasks(true)) {
      if (task.station != number) continue;
      Json row{{"task", task.task},
               {"state", debugger.task_state(task)},
               {"file", ""},
               {"line", 0},
               {"function", ""}};
      if (const auto frames = debugger.frames(task); !frames.empty()) {
        row["file"] = frames.front().place.file;
        row["line"] = frames.front().place.line;
        row["function"] = frames.front().function;
      }
      tasks.push_back(std::move(row));
    }
    Json points = breakpoints(number);
    const Json changed = changed_sources(number);
    const Covered& covered = covered_[number];
    const bool other_program = subscription.is_news("version", version(number));
    const bool other_tasks = subscription.is_news("tasks", tasks);
    const bool other_points = subscription.is_news("points", points);
    const bool other_sources = subscription.is_news("changed", changed);
    if (!other_program && !other_tasks && !other_points && !other_sources && subscription.mark == covered.order.size()) return;
    std::map<std::string, std::set<uint32_t>> lines;
    for (; subscription.mark < covered.order.size(); ++subscription.mark) {
      const debug::SourcePlace place = debugger.code(number)->place(covered.order[static_cast<size_t>(subscription.mark)]);
      if (place.line != 0) lines[place.file].insert(place.line);
    }
    host_.router().send(client, {{"event", "program"},
                               {"us", host_.us()},
                               {"station", name},
                               {"version", version(number)},
                               {"tasks", std::move(tasks)},
                               {"covered", Json(lines)},
                               {"changed", changed},
                               {"breakpoints", std::move(points)}});
  }

  PlantHost& host_;
  std::vector<Covered> covered_;  // by station
  std::map<int, Point> points_;   // by the number of the breakpoint
  struct Changed {
    Json files = Json::array();
    WallClock::time_point due{};
  };
  std::map<uint32_t, Changed> changed_;         // by station
  std::map<uint32_t, std::string> versions_;    // by station, of the programs that run
  std::map<uint16_t, std::vector<signals::Signal>> asked_;  // by client
};

}  // namespace

std::unique_ptr<Tab> make_program_tab(PlantHost& host) { return std::make_unique<ProgramTab>(host); }

}  // namespace ipos::tools::serve
