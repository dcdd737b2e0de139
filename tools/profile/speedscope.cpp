// A profile in the file format of speedscope (https://www.speedscope.app/file-format-schema.json), which is a published
// schema: frames once, then of each task samples, each a stack of frames, with their weights.
#include <nlohmann/json.hpp>

#include "tools/profile/profile.hpp"

namespace ipos::tools::profile {
namespace {

using Json = nlohmann::ordered_json;

class Frames {
 public:
  // The same name and line are one frame.
  size_t number(const std::string& name, const Line& line) {
    const auto [found, is_new] = numbers_.try_emplace({name, line}, list_.size());
    if (is_new) {
      Json frame{{"name", name}};
      if (!line.file.empty()) {
        frame["file"] = line.file;
        frame["line"] = line.line;
      }
      list_.push_back(std::move(frame));
    }
    return found->second;
  }
  Json take() { return std::move(list_); }

 private:
  std::map<std::pair<std::string, Line>, size_t> numbers_;
  Json list_ = Json::array();
};

class Samples {
 public:
  void add(std::vector<size_t> stack, double ms) {
    if (ms <= 0) return;
    samples_.push_back(std::move(stack));
    weights_.push_back(ms);
    total_ += ms;
  }
  Json profile(const std::string& name) {
    return {{"type", "sampled"}, {"name", name},           {"unit", "milliseconds"},       {"startValue", 0},
            {"endValue", total_}, {"samples", std::move(samples_)}, {"weights", std::move(weights_)}};
  }

 private:
  Json samples_ = Json::array();
  Json weights_ = Json::array();
  double total_ = 0;
};

std::vector<size_t> stack_of(const Task& task, size_t node, Frames& frames) {
  std::vector<size_t> stack;
  for (; node != SIZE_MAX; node = task.nodes[node].parent)
    stack.insert(stack.begin(), frames.number(task.nodes[node].function, {}));
  return stack;
}

}  // namespace

std::string speedscope(const std::vector<Task>& tasks, const std::string& name) {
  Frames frames;
  Json profiles = Json::array();
  for (const Task& task : tasks) {
    Samples samples;
    for (size_t n = 0; n < task.nodes.size(); ++n) {
      const std::vector<size_t> stack = stack_of(task, n, frames);
      for (const auto& [line, cost] : task.nodes[n].lines) {
        std::vector<size_t> here = stack;
        here.push_back(frames.number(line.text(), line));
        samples.add(here, cost.ms);
        here.push_back(frames.number("waits", {}));
        samples.add(std::move(here), cost.waits);
      }
    }
    profiles.push_back(samples.profile(task.name));
  }
  const Json file{{"$schema", "https://www.speedscope.app/file-format-schema.json"},
                  {"name", name},
                  {"exporter", "ipos"},
                  {"activeProfileIndex", 0},
                  {"shared", {{"frames", frames.take()}}},
                  {"profiles", std::move(profiles)}};
  return file.dump() + "\n";
}

}  // namespace ipos::tools::profile
