// What the tab Bus tells of its lines: a row an identifier, the trace of the last telegrams, load and errors. It knows
// neither plant nor drive: a source has their time and says how telegrams of a client go out.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "tools/serve/host/line_monitor.hpp"
#include "tools/serve/host/router.hpp"
#include "tools/serve/host/trace_memory.hpp"

namespace ipos::tools::serve {

class BusSource {
 public:
  virtual runtime::Time line_now() const = 0;
  // What the page shows for a time of the lines.
  virtual runtime::Time shown(runtime::Time of_line) const { return of_line; }
  virtual void heard() {}
  // Somebody on the line who is of the plant, or this program itself; the others are behind a port.
  virtual bool is_ours(const std::string& /*line*/, const std::string& /*node*/) const { return true; }
  // What a telegram says, value by value, and which channel of the scope follows it. Null: there are no such channels here.
  virtual Json fields_of(const std::string& /*line*/, const Telegram&) const { return nullptr; }
  // The command `bus.send`; it ends in BusTraffic::send().
  virtual void send(const Router::Call& call) = 0;

 protected:
  ~BusSource() = default;
};

class BusTraffic final {
 public:
  // Adds its commands and its topics.
  BusTraffic(Router& router, BusSource& source, Copies& copies);

  // The lines are others: nothing is known any more. Then all of them are followed, and then they are complete.
  void clear();
  void dropped() { trace_.forget_later(); }
  void complete() {
    if (hears_) trace_.restart(monitors_.size());
  }
  template <typename Line, typename... Names>
  void follow(Line& line, Names... names) {
    const auto number = static_cast<uint8_t>(monitors_.size());
    const auto hear = [this, number](Telegram telegram) {
      telegram.bus = number;
      take(std::move(telegram));
    };
    monitors_.push_back(listen(line, router_.clock(), hear, std::move(names)...));
  }
  // The millisecond is over: what came in it is told.
  void settle();
  // This process only runs again what was: the trace is that of the others.
  void stop_hearing() { hears_ = false; }
  // `rate` counts from second to second.
  void second_passed();
  void send(const Arguments& arguments);
  // What it would send.
  std::vector<uint8_t> octets_of(const Arguments& arguments) const;

 private:
  struct Row {
    Telegram last;
    std::vector<uint8_t> compared;
    std::vector<size_t> changed;
    uint64_t count = 0, count_before = 0, rate = 0;
  };
  using Key = std::tuple<uint8_t, bool, bool, uint32_t>;

  void take(Telegram telegram);
  void note(Telegram telegram);
  uint8_t number_of(const std::string& name) const;  // a Mistake: there is none
  int64_t us(runtime::Time of_line) const { return source_.shown(of_line) / runtime::kMicrosecond; }
  Json decode(const Arguments& arguments);
  void publish_rows(Client& client, Subscription& subscription);

  // bus_trace.cpp
  // From the newest one back, of one line or of all; until `look` returns false.
  void look_back(std::optional<uint8_t> line, const std::function<bool(const NumberedTelegram&)>& look) const;
  // Of one line, the first one with this number or a later one.
  uint64_t find(size_t line, uint64_t number) const;
  Json json_of(uint64_t n, const Telegram& telegram) const;
  Json trace(const Arguments& arguments) const;
  Json telegram(const Arguments& arguments) const;
  std::optional<NumberedTelegram> partner_of(size_t line, uint64_t at, bool answer) const;
  Json saved(const Arguments& arguments) const;  // bus_save.cpp
  void publish_trace(Client& client, Subscription& subscription);

  Router& router_;
  BusSource& source_;
  std::vector<std::unique_ptr<LineMonitor>> monitors_;
  std::map<Key, Row> rows_;
  std::vector<Telegram> waiting_;  // for the end of the millisecond
  TraceMemory trace_;              // their times are those shown
  uint64_t seen_ = 0;
  bool hears_ = true;
};

}  // namespace ipos::tools::serve
