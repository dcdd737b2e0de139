// A telegram as a filter sees it, and what is paused.
#include "tools/serve/host/trace_choice.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace ipos::tools::serve {
namespace {

constexpr size_t kMostPaused = 500;  // identifiers (ours)

// Its words are made once, if at all.
class Looked final : public FilteredTelegram {
 public:
  Looked(LineMonitor& monitor, const BusSource& source, const Telegram& telegram)
      : monitor_(monitor), source_(source), telegram_(telegram) {}

  const std::string& line() const override { return monitor_.name(); }
  std::optional<uint32_t> id() const override {
    return monitor_.kind() == LineKind::Can ? std::optional(telegram_.id) : std::nullopt;
  }
  std::string identity() const override { return monitor_.identity_text(telegram_); }
  std::vector<uint32_t> addresses() const override { return monitor_.addresses(telegram_); }
  std::string data() const override { return hex_digits(telegram_.bytes()); }
  size_t length() const override { return telegram_.data.size(); }
  std::string sender() const override { return monitor_.sender_of(telegram_); }
  const std::string& words() const override {
    if (!words_) words_ = monitor_.text_of(telegram_);
    return *words_;
  }
  bool is_error() const override { return telegram_.error; }
  bool is_remote() const override { return telegram_.remote; }
  bool is_extended() const override { return telegram_.extended; }
  bool is_ours() const override { return source_.is_ours(line(), sender()); }

 private:
  LineMonitor& monitor_;
  const BusSource& source_;
  const Telegram& telegram_;
  mutable std::optional<std::string> words_;
};

}  // namespace

uint8_t line_number(const TraceChoice::Monitors& monitors, const std::string& name) {
  const auto found =
      std::find_if(monitors.begin(), monitors.end(), [&](const auto& monitor) { return monitor->name() == name; });
  if (found == monitors.end()) throw Mistake(fmt::format("there is no bus '{}'", name));
  return static_cast<uint8_t>(found - monitors.begin());
}

TraceChoice::TraceChoice(const Monitors& monitors, const BusSource& source, const Arguments& a)
    : monitors_(monitors),
      source_(source),
      line_(a.has("bus") ? std::optional(line_number(monitors, a.text("bus"))) : std::nullopt),
      filter_(a.text("filter", "")) {
  const Json paused = a.json().value("paused", Json::array());
  if (!paused.is_array() || paused.size() > kMostPaused)
    throw Mistake(fmt::format("'paused' must be a list of at most {}", kMostPaused));
  for (const Json& one : paused) {
    if (!one.is_object()) throw Mistake("what is paused is an object with bus, id and since");
    const Arguments of_one(one);
    paused_.push_back({line_number(monitors, of_one.text("bus")), static_cast<uint32_t>(of_one.whole("id", 0, UINT32_MAX)),
                       of_one.flag("extended", false), of_one.flag("remote", false),
                       static_cast<uint64_t>(of_one.whole("since", 0, INT64_MAX, 0))});
  }
}

bool TraceChoice::takes(const NumberedTelegram& one) const {
  const Telegram& telegram = one.telegram;
  const auto is_it = [&](const Paused& paused) {
    return paused.bus == telegram.bus && paused.id == telegram.id && paused.extended == telegram.extended &&
           paused.remote == telegram.remote && one.number > paused.since;
  };
  return std::none_of(paused_.begin(), paused_.end(), is_it) &&
         filter_.takes(Looked(*monitors_[telegram.bus], source_, telegram));
}

}  // namespace ipos::tools::serve
