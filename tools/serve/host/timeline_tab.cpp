// The timeline: what has happened when, as marks that one can go to. They are kept while time goes back and forth; when what
// came later is dropped, its marks go with it.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>

#include "tools/serve/host/tabs.hpp"

namespace ipos::tools::serve {
namespace {

constexpr size_t kMostMarks = 2'000;  // beyond that the oldest of the journal go first (ours)

struct Mark {
  int64_t us = 0;
  std::string kind;  // fault, check (of a test), journal, trigger, breakpoint, click
  std::string what;  // DI10, F26
  std::string station;
  std::string text;  // a whole sentence, where there is one
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(Mark, us, kind, what, station, text)

  auto operator<=>(const Mark&) const = default;
};

// "saw.lCount" without its station.
std::string without_station(const std::string& name) { return name.substr(name.find('.') + 1); }

// A command of the page, in a word or two.
std::string click_text(const Json& action) {
  const std::string act = action["act"];
  const auto text = [&](const char* key) { return action.contains(key) ? action[key].get<std::string>() : std::string(); };
  const auto on = [&](const char* yes, const char* no) { return action.value("on", false) ? yes : no; };
  if (act == "power") return on("power on", "power off");
  if (act == "mains") return on("mains on", "mains off");
  if (act == "reset") return "fault reset";
  if (act == "fault") return fmt::format("{}{}", text("kind"), on("", " ends"));
  if (act == "parameters.set") return action.contains("number") ? text("number") : fmt::format("parameter {}", action["index"].dump());
  if (act == "parameters.load") return "parameters loaded";
  if (act == "load") return "program loaded";
  if (act == "bus.send") return "telegram to " + text("bus");
  return without_station(text("name"));
}

class TimelineTab final : public Tab {
 public:
  explicit TimelineTab(PlantHost& host) : host_(host) {
    host.mark = [this](const char* kind, const std::string& what, const std::string& station, const std::string& text) {
      add({host_.us(), kind, what, station, text});
    };
    host.router().add_topic("timeline",
                            [this](Client& client, Subscription& subscription) { publish(client, subscription); });
  }

  void restarted() override {
    marks_.clear();
    ++changed_;
    dropped_ = nullptr;
  }
  void built(runtime::Plant&) override { journal_ = 0; }

  // What is run again has its marks already.
  void passed(runtime::Time now) override {
    const auto& entries = host_.plant().journal().entries();
    for (; journal_ < entries.size(); ++journal_) {
      const runtime::JournalEntry& entry = entries[journal_];
      const bool fault = entry.text.size() > 2 && entry.text[0] == 'F' && std::isdigit(entry.text[1]) != 0;
      add({now / runtime::kMicrosecond, fault ? "fault" : "journal",
           fault ? entry.text.substr(0, entry.text.find(' ')) : entry.text, entry.station, entry.text});
    }
  }

  void acted(const Json& action) override {
    std::string station;
    if (const auto found = action.find("station"); found != action.end() && found->is_string()) station = *found;
    if (const std::string name = action.value("name", std::string()); station.empty() && name.find('.') != std::string::npos)
      station = name.substr(0, name.find('.'));
    add({host_.us(), "click", click_text(action), station, {}});
  }

  void dropped(size_t changes) override {
    const int64_t now = host_.us();
    std::erase_if(marks_, [&](const Mark& mark) { return mark.us > now; });
    dropped_ = changes == 0 ? Json(nullptr) : Json{{"us", now}, {"clicks", changes}};
    ++changed_;
  }

  Json save() override { return {{"marks", marks_}, {"changed", changed_}, {"dropped", dropped_}}; }
  void load(const Json& state) override {
    marks_ = state["marks"].get<std::set<Mark>>();
    changed_ = state["changed"];
    dropped_ = state["dropped"];
  }

 private:
  void add(Mark mark) {
    if (!marks_.insert(std::move(mark)).second) return;
    ++changed_;
    if (marks_.size() <= kMostMarks) return;
    const auto of_journal = [](const Mark& one) { return one.kind == "journal"; };
    const auto oldest = std::find_if(marks_.begin(), marks_.end(), of_journal);
    marks_.erase(oldest == marks_.end() ? marks_.begin() : oldest);
  }

  void publish(Client& client, Subscription& subscription) {
    if (!subscription.fresh && subscription.mark == changed_) return;
    subscription.mark = changed_;
    host_.router().send(client, {{"event", "timeline"},
                                 {"us", host_.us()},
                                 {"furthest_us", host_.furthest_us()},
                                 {"marks", marks_},
                                 {"dropped", dropped_}});
  }

  PlantHost& host_;
  std::set<Mark> marks_;
  uint64_t changed_ = 1;  // grows with each change
  size_t journal_ = 0;    // entries looked at, of this plant
  Json dropped_ = nullptr;
};

}  // namespace

std::unique_ptr<Tab> make_timeline_tab(PlantHost& host) { return std::make_unique<TimelineTab>(host); }

}  // namespace ipos::tools::serve
