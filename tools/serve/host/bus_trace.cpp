// The trace of the last telegrams: those that somebody looks at, and one of them in detail.
#include <fmt/format.h>

#include <algorithm>

#include "tools/serve/host/bus_traffic.hpp"
#include "tools/serve/host/trace_choice.hpp"

namespace ipos::tools::serve {
namespace {

constexpr size_t kTraceAtOnce = 2'000;
// One question looks at so many telegrams, and makes the words of so many (ours): the plant waits meanwhile. It says how
// far it has come, and whoever wants the rest asks again.
constexpr size_t kMostLooks = 100'000, kMostWords = 10'000;

}  // namespace

Json BusTraffic::json_of(uint64_t n, const Telegram& telegram) const {
  LineMonitor& monitor = *monitors_[telegram.bus];
  const std::string sender = monitor.sender_of(telegram);
  Json json{{"n", n},
            {"us", telegram.time / runtime::kMicrosecond},
            {"took_us", static_cast<double>(telegram.took) / static_cast<double>(runtime::kMicrosecond)},
            {"bus", monitor.name()},
            {"id", telegram.id},
            {"extended", telegram.extended},
            {"remote", telegram.remote},
            {"error", telegram.error},
            {"sender", sender},
            {"ours", source_.is_ours(monitor.name(), sender)},
            {"dlc", telegram.data.size()},
            {"data", hex_digits(telegram.bytes())},
            {"text", monitor.text_of(telegram)}};
  json.update(monitor.identity(telegram));
  return json;
}

void BusTraffic::look_back(std::optional<uint8_t> line,
                           const std::function<bool(const NumberedTelegram&)>& look) const {
  std::vector<uint64_t> ends(monitors_.size()), firsts(monitors_.size());
  for (size_t n = 0; n < monitors_.size(); ++n) {
    firsts[n] = trace_.first(n);
    ends[n] = !line || *line == n ? trace_.end(n) : firsts[n];
  }
  for (;;) {
    std::optional<size_t> newest;
    uint64_t number = 0;
    for (size_t n = 0; n < monitors_.size(); ++n)
      if (ends[n] > firsts[n] && trace_.number(n, ends[n] - 1) > number) {
        newest = n;
        number = trace_.number(n, ends[n] - 1);
      }
    if (!newest || !look(trace_.at(*newest, --ends[*newest]))) return;
  }
}

uint64_t BusTraffic::find(size_t line, uint64_t number) const {
  uint64_t least = trace_.first(line), end = trace_.end(line);
  while (least < end) {
    const uint64_t middle = (least + end) / 2;
    if (trace_.number(line, middle) < number)
      least = middle + 1;
    else
      end = middle;
  }
  return least;
}

Json BusTraffic::trace(const Arguments& a) const {
  const auto before = static_cast<uint64_t>(a.whole("before", 0, INT64_MAX, INT64_MAX));
  const auto after = static_cast<uint64_t>(a.whole("after", 0, INT64_MAX, 0));
  const auto limit = static_cast<size_t>(a.whole("limit", 1, 1000, 200));
  const TraceChoice choice(monitors_, source_, a);
  Json rows = Json::array(), reached = nullptr;
  size_t looks = 0;
  const size_t most = choice.needs_words() ? kMostWords : kMostLooks;
  look_back(choice.line(), [&](const NumberedTelegram& one) {
    if (one.number >= before) return true;
    if (one.number <= after) return false;
    if (++looks > most) {
      reached = one.number + 1;
      return false;
    }
    if (choice.takes(one)) rows.push_back(json_of(one.number, one.telegram));
    return rows.size() < limit;
  });
  std::reverse(rows.begin(), rows.end());
  return {{"frames", std::move(rows)}, {"last", seen_}, {"reached", std::move(reached)}};
}

// The question before an answer, or the answer behind a question; none where the question is asked again first.
std::optional<NumberedTelegram> BusTraffic::partner_of(size_t line, uint64_t at, bool answer) const {
  const LineMonitor& monitor = *monitors_[line];
  const Telegram one = trace_.at(line, at).telegram;
  const uint64_t first = trace_.first(line), end = trace_.end(line);
  for (uint64_t n = 1; n <= monitor.answered_within(); ++n) {
    if (answer ? at + n >= end : at < first + n) return std::nullopt;
    NumberedTelegram other = trace_.at(line, answer ? at + n : at - n);
    const Telegram& telegram = other.telegram;
    if (answer ? monitor.answers(one, telegram) : monitor.answers(telegram, one)) return other;
    if (telegram.id == one.id && telegram.extended == one.extended && telegram.remote == one.remote) return std::nullopt;
  }
  return std::nullopt;
}

Json BusTraffic::telegram(const Arguments& a) const {
  const size_t line = number_of(a.text("bus"));
  const auto number = static_cast<uint64_t>(a.whole("n", 1, INT64_MAX));
  const uint64_t at = find(line, number);
  if (at == trace_.end(line) || trace_.number(line, at) != number)
    throw Mistake(fmt::format("telegram {} of {} is not kept any more", number, monitors_[line]->name()));
  const NumberedTelegram one = trace_.at(line, at);
  const auto row = [&](const std::optional<NumberedTelegram>& other) {
    return other ? json_of(other->number, other->telegram) : Json(nullptr);
  };
  const Json fields = source_.fields_of(monitors_[line]->name(), one.telegram);
  return {{"telegram", json_of(one.number, one.telegram)},
          {"from_us", (one.telegram.time - one.telegram.took) / runtime::kMicrosecond},
          {"fields", fields.is_null() ? Json::array() : fields},
          {"channels", !fields.is_null()},
          {"answer", row(partner_of(line, at, true))},
          {"question", row(partner_of(line, at, false))}};
}

void BusTraffic::publish_trace(Client& client, Subscription& subscription) {
  const uint64_t known = subscription.fresh ? seen_ : subscription.mark;
  std::vector<NumberedTelegram> news;
  look_back({}, [&](const NumberedTelegram& one) {
    if (one.number <= known) return false;
    news.push_back(one);
    return news.size() < kTraceAtOnce;
  });
  subscription.mark = seen_;
  if (news.empty()) return;
  std::string bytes;
  const auto put = [&bytes](const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  put(uint8_t{2});
  put(uint8_t{0});
  put(uint16_t{0});
  put(static_cast<uint32_t>(seen_ - known - news.size()));
  for (auto one = news.rbegin(); one != news.rend(); ++one) {
    const Telegram& telegram = one->telegram;
    put(static_cast<uint64_t>(telegram.time));
    put(static_cast<uint32_t>(one->number));
    put(telegram.id);
    put(telegram.bus);
    put(static_cast<uint8_t>((telegram.extended ? 1 : 0) | (telegram.remote ? 2 : 0) |
                             (telegram.error ? 4 : 0)));
    put(static_cast<uint16_t>(telegram.bytes().size()));
    bytes.append(reinterpret_cast<const char*>(telegram.bytes().data()), telegram.bytes().size());
  }
  router_.send_binary(client, bytes);
}

}  // namespace ipos::tools::serve
