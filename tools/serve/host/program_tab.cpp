// The tab Program: sources with the line that executes, coverage, breakpoints and steps, all by the debugger.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "tools/serve/host/tabs.hpp"

namespace ipos::tools::serve {
namespace {

using debug::Breakpoint;

constexpr size_t kMostBreakpoints = 256;

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
  }

  void restarted() override { covered_.clear(); }
  // Going back builds the plant, too; what was executed stays covered then.
  void built(runtime::Plant& plant) override {
    if (!covered_.empty()) return;
    covered_.assign(plant.stations().size(), {});
    for (size_t n = 0; n < covered_.size(); ++n)
      if (const vm::Image* image = plant.stations()[n]->image())
        covered_[n].commands.assign(image->code.size(), false);
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
    return all;
  }
  void load(const Json& state) override {
    for (uint32_t station = 0; station < covered_.size(); ++station)
      for (const Json& address : state[station]) executes(station, address.get<uint32_t>());
  }

 private:
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
      const auto text = host_.sources().text(image.files[n]);
      Json file{{"name", image.files[n]}, {"lines", lines}};
      file["text"] = text ? Json(*text) : Json(nullptr);
      files.push_back(std::move(file));
    }
    Json tasks = Json::array();
    for (int task = 1; task <= vm::kTasks; ++task) tasks.push_back(fmt::format("task {}", task));
    return {{"files", std::move(files)}, {"tasks", std::move(tasks)}};
  }

  Json json_of(const Breakpoint& point) const {
    const debug::SourcePlace place = code_of(point.station).place(point.address);
    return {
        {"number", point.id},           {"station", host_.plant().stations()[point.station]->config().name},
        {"file", place.file},           {"line", place.line},
        {"condition", point.condition}, {"hits", point.hits}};
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
    if (const auto now = host_.router().clock().now(); now >= looks_) {
      looks_ = now + std::chrono::seconds(1);
      changed_.clear();
      for (const auto& one : host_.plant().stations())
        if (one->image() != nullptr)
          for (const std::string& file : one->image()->files)
            if (host_.sources().has_changed(file)) changed_.insert(file);
    }
    Json names = Json::array();
    for (const std::string& file : host_.plant().stations()[station]->image()->files)
      if (changed_.contains(file)) names.push_back(file);
    return names;
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
    const bool other_tasks = subscription.is_news("tasks", tasks);
    const bool other_points = subscription.is_news("points", points);
    const bool other_sources = subscription.is_news("changed", changed);
    if (!other_tasks && !other_points && !other_sources && subscription.mark == covered.order.size()) return;
    std::map<std::string, std::set<uint32_t>> lines;
    for (; subscription.mark < covered.order.size(); ++subscription.mark) {
      const debug::SourcePlace place = debugger.code(number)->place(covered.order[subscription.mark]);
      if (place.line != 0) lines[place.file].insert(place.line);
    }
    host_.router().send(client, {{"event", "program"},
                               {"us", host_.us()},
                               {"station", name},
                               {"tasks", std::move(tasks)},
                               {"covered", Json(lines)},
                               {"changed", changed},
                               {"breakpoints", std::move(points)}});
  }

  PlantHost& host_;
  std::vector<Covered> covered_;  // by station
  std::set<std::string> changed_;  // sources
  WallClock::time_point looks_{};
};

}  // namespace

std::unique_ptr<Tab> make_program_tab(PlantHost& host) { return std::make_unique<ProgramTab>(host); }

}  // namespace ipos::tools::serve
