// The tab Scope of a plant: its channels are the signals of the plant, and it triggers on faults, telegrams and program
// lines, too.
#include <fmt/format.h>

#include <algorithm>

#include "runtime/signals/find.hpp"
#include "tools/serve/host/scope.hpp"
#include "tools/serve/host/tabs.hpp"

namespace ipos::tools::serve {
namespace {

using signals::Signal;
using runtime::Time;

class ScopeTab final : public Tab,
                       private ScopeSource,
                       private runtime::CanObserver,
                       private runtime::SerialObserver {
 public:
  explicit ScopeTab(PlantHost& host) : host_(host), scope_(host.router(), *this, host.copies()) {}

  void built(runtime::Plant& plant) override {
    scope_.propose(first_channels(plant));
    scope_.built();
    old_faults_.clear();
    for (const auto& station : plant.stations()) old_faults_.push_back(station->fault());
    plant.add_observer(static_cast<runtime::CanObserver&>(*this));
    plant.add_observer(static_cast<runtime::SerialObserver&>(*this));
  }

  // Of a plant with many stations fewer of each, but of as many as there is room for.
  static std::vector<std::string> first_channels(const runtime::Plant& plant) {
    std::vector<std::string> names;
    const size_t room = std::max<size_t>(1, Scope::kMostChannels / std::max<size_t>(1, plant.stations().size()));
    for (const auto& station : plant.stations()) {
      std::vector<Signal> signals = signals::default_signals(*station);
      if (signals.size() > room) signals.resize(room);
      for (Signal& signal : signals) names.push_back(std::move(signal.name));
    }
    return names;
  }

  void runs_again(Tab& first) override { scope_.fill_for(static_cast<ScopeTab&>(first).scope_); }
  void restarted() override { scope_.restarted(); }
  void loaded(uint32_t) override { scope_.renamed(); }
  void restore(const Json& settings) override { scope_.restore(settings.value("scope", Json())); }
  void tend() override { scope_.tend(); }
  void dropped(size_t) override { scope_.dropped(); }
  bool follows_commands() override { return event_.kind == "line"; }

  void passed(Time now) override {
    look_for_faults(now);
    scope_.passed(now);
  }

  void executes(uint32_t station, uint32_t address) override {
    if (event_.kind == "line" && event_.station == station && event_.address == address)
      scope_.happened(host_.plant().now(), "the line executes");
  }

  Json save() override { return scope_.save(); }
  void load(const Json& state) override { scope_.load(state); }

 private:
  // What the trigger waits for.
  struct Event {
    std::string kind;
    std::optional<uint32_t> station;  // of fault and line; none: any
    std::string bus;                  // of telegram; empty: any
    std::optional<uint32_t> id;
    uint32_t address = 0;  // of line
  };

  std::vector<Signal> find_channels(const std::string& name) override {
    auto found = signals::find_signals(host_.plant(), name);
    if (!found) throw Mistake(found.error());
    return std::move(*found);
  }
  Time now() const override { return host_.plant().now(); }
  void stop(const std::string& why) override { host_.stop("trigger", why); }
  void triggered(const std::string& why) override { host_.mark("trigger", "trigger", "", why); }
  std::unique_ptr<SecondRun> run_again() override { return host_.run_again(); }

  void watch_for(const std::string& kind, const Arguments& a) override {
    Event event;
    event.kind = kind;
    if (kind == "fault") {
      if (a.has("station")) event.station = host_.station_number(a.text("station"));
    } else if (kind == "telegram") {
      event.bus = a.text("bus", "");
      if (a.has("id")) event.id = static_cast<uint32_t>(a.whole("id", 0, UINT32_MAX));
    } else if (kind == "line") {
      event.station = host_.station_number(a.text("station"));
      const debug::CodeMap* code = host_.debugger().code(*event.station);
      const auto address =
          code == nullptr
              ? std::nullopt
              : code->address_of(a.text("file"), static_cast<uint32_t>(a.whole("line", 1, INT32_MAX)));
      if (!address) throw Mistake("there is no command at or behind this line");
      event.address = *address;
    } else if (kind != "none" && kind != "level" && kind != "edge") {
      throw Mistake("'kind' must be none, level, edge, fault, telegram or line");
    }
    event_ = std::move(event);
  }

  void look_for_faults(Time now) {
    const auto& stations = host_.plant().stations();
    for (uint32_t n = 0; n < stations.size(); ++n) {
      const uint8_t fault = stations[n]->fault();
      const bool is_new = fault != std::exchange(old_faults_[n], fault) && fault != 0;
      if (is_new && event_.kind == "fault" && (!event_.station || *event_.station == n))
        scope_.happened(now, fmt::format("{} has fault F{:02}", stations[n]->config().name, fault));
    }
  }

  void on_frame(const runtime::CanLine& line, const runtime::FrameRecord& record) override {
    if (event_.kind != "telegram" || (!event_.bus.empty() && line.name() != event_.bus)) return;
    if (!event_.id || *event_.id == record.frame.id) scope_.happened(record.end, "a telegram");
  }
  void on_line_event(const runtime::CanLine&, const runtime::LineEvent&) override {}
  void on_character(const runtime::Rs485Line& line, runtime::NodeId,
                    const runtime::Character& character) override {
    if (event_.kind == "telegram" && !event_.id && line.name() == event_.bus)
      scope_.happened(character.end, "a telegram");
  }
  void on_serial_event(const runtime::Rs485Line&, const runtime::SerialEvent&) override {}

  PlantHost& host_;
  Scope scope_;
  Event event_;
  std::vector<uint8_t> old_faults_;
};

}  // namespace

std::unique_ptr<Tab> make_scope_tab(PlantHost& host) { return std::make_unique<ScopeTab>(host); }

}  // namespace ipos::tools::serve
