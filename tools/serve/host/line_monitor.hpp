// A monitor of one line of any kind, for the tab Bus: what the line carries as telegrams, their words, its load and errors,
// and the hand that sends what a user has written. The hand is on the line only after it has sent: a line with a
// station more would be another one.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "runtime/bus/can/line.hpp"
#include "runtime/bus/movilink/describe.hpp"
#include "runtime/bus/profibus/line.hpp"
#include "runtime/bus/rs485/line.hpp"
#include "runtime/bus/words/can_words.hpp"
#include "runtime/bus/words/dp_words.hpp"
#include "tools/logs/writing/writer.hpp"
#include "tools/serve/host/arguments.hpp"
#include "tools/serve/host/message.hpp"
#include "tools/serve/host/telegram.hpp"

namespace ipos::tools::serve {

// The name under which the page hangs on the lines.
inline constexpr const char* kPageNode = "the page";

class LineMonitor {
 public:
  using Hear = std::function<void(Telegram)>;

  virtual ~LineMonitor() = default;
  virtual const std::string& name() const = 0;
  virtual runtime::LineLoad load(runtime::Time now) const = 0;
  // After the millisecond in which telegrams came, before their words are made: a station on the line may have got another
  // name, or a new object, since the last time.
  virtual void renew_names(runtime::Time /*now*/) {}
  // Its words, where they depend on what goes before on the line; asked for once, in the order of the line.
  virtual std::string words_of(const Telegram&) { return {}; }
  virtual std::string text_of(const Telegram& telegram) = 0;
  // The same of one that was not heard, as if it came next.
  virtual std::string text_if_heard(const Telegram& telegram) { return text_of(telegram); }
  // What a filter finds it by, beside data and words.
  virtual std::string identity_text(const Telegram& telegram) const = 0;
  // Who sent it, as the line calls him; empty: several at once, or nobody knows.
  virtual std::string sender_of(const Telegram& telegram) const = 0;
  // What it is known by in a filter: source and destination, or the address of the unit; empty where it has none.
  virtual std::vector<uint32_t> addresses(const Telegram&) const { return {}; }
  // Whether `later` is what the other side says to `question`. A question that is asked again is a new one.
  virtual bool answers(const Telegram& question, const Telegram& later) const = 0;
  // So many telegrams later at most (ours, where the line says nothing of it).
  virtual size_t answered_within() const { return 500; }
  // Into a log of a form that has a place for it.
  virtual LineKind kind() const = 0;
  virtual void write(LogWriter& log, const Telegram& telegram) const = 0;
  // Members of its row that only this kind of line has.
  virtual Json identity(const Telegram&) const { return Json::object(); }
  // The bytes in which a change is news.
  virtual std::vector<uint8_t> compared(const Telegram& telegram) const { return telegram.data; }
  // What a client has written as `data`.
  virtual std::vector<uint8_t> read(const std::string& text) const = 0;
  // The command `bus.send`; a Mistake says why not.
  virtual void send(const Arguments& arguments) = 0;

  uint64_t errors = 0;
  std::string state;  // the last event of the line, in words
};

// The name of a node by its number on the line; empty where that is nobody's.
template <typename Line>
std::string node_name(const Line& line, uint16_t node) {
  return node < line.node_count() ? line.node_name(node) : std::string();
}
inline uint16_t sender_number(runtime::NodeId node) {
  return node < Telegram::kNobody ? static_cast<uint16_t>(node) : Telegram::kNobody;
}

// "00060BB8"
std::string hex_digits(std::span<const uint8_t> bytes);

// "0006 0BB8" in bytes, at most so many; a Mistake says what is wrong.
std::vector<uint8_t> bytes_of(const std::string& text, size_t most);

// The names of a line grow old: they are looked up again when they may have changed.
class NamesAge {
 public:
  explicit NamesAge(const Clock& clock) : clock_(clock) {}
  // True now and then, and the first time.
  bool is_over();

 private:
  const Clock& clock_;
  std::optional<WallClock::time_point> known_;
};

// Who is on a CAN line. What the words of a frame depend on must be known in the millisecond of the frame: so many objects
// are defined by now.
struct CanNamesNow {
  std::function<runtime::CanLineNames()> names;
  std::function<size_t()> objects = [] { return size_t{0}; };
};
using SerialNamesNow = std::function<runtime::TelegramNames()>;
using DpNamesNow = std::function<std::vector<runtime::DpSlaveNames>()>;

// What the words of telegrams mean may change with every parameter; it is looked at so often.
inline constexpr runtime::Time kNamesStay = 100 * runtime::kMillisecond;

// The line must outlive the monitor.
std::unique_ptr<LineMonitor> listen(runtime::CanLine& line, const Clock& clock, LineMonitor::Hear hear, CanNamesNow names);
std::unique_ptr<LineMonitor> listen(runtime::Rs485Line& line, const Clock& clock, LineMonitor::Hear hear, SerialNamesNow names);
std::unique_ptr<LineMonitor> listen(profibus::Line& line, const Clock& clock, LineMonitor::Hear hear, DpNamesNow names);

}  // namespace ipos::tools::serve
