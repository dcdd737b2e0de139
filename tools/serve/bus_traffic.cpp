// Rows and trace as the ears tell them, and what is news of them.
#include "tools/serve/bus_traffic.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace ipos::tools::serve {
namespace {

constexpr size_t kKept = 100'000;  // telegrams of the trace
constexpr size_t kTraceAtOnce = 2'000;
constexpr size_t kMostRows = 4'096;  // identifiers that are told apart (ours)

std::string hex(std::span<const uint8_t> bytes) { return fmt::format("{:02X}", fmt::join(bytes, "")); }

}  // namespace

BusTraffic::BusTraffic(Desk& desk, BusSource& source) : desk_(desk), source_(source) {
  desk.add_command("bus.clear", [this](const Desk::Call&) {
    rows_.clear();
    for (const auto& ear : ears_) ear->errors = 0;
    return Json::object();
  });
  desk.add_command("bus.send", [this](const Desk::Call& call) {
    source_.send(call);
    return Json::object();
  });
  desk.add_command("bus.decode", [this](const Desk::Call& call) { return decode(call.arguments); });
  desk.add_command("bus.trace", [this](const Desk::Call& call) { return trace(call.arguments); });
  desk.add_topic("bus",
                 [this](Client& client, Subscription& subscription) { publish_rows(client, subscription); });
  desk.add_topic("trace",
                 [this](Client& client, Subscription& subscription) { publish_trace(client, subscription); });
}

void BusTraffic::clear() {
  ears_.clear();
  rows_.clear();
  trace_.clear();
  seen_ = 0;
}

void BusTraffic::second_passed() {
  for (auto& [key, row] : rows_) {
    row.rate = row.count - row.count_before;
    row.count_before = row.count;
  }
}

void BusTraffic::send(const Arguments& arguments) {
  ears_[number_of(arguments.text("bus"))]->send(arguments);
}

uint8_t BusTraffic::number_of(const std::string& name) const {
  const auto found =
      std::find_if(ears_.begin(), ears_.end(), [&](const auto& ear) { return ear->name() == name; });
  if (found == ears_.end()) throw Mistake(fmt::format("there is no bus '{}'", name));
  return static_cast<uint8_t>(found - ears_.begin());
}

void BusTraffic::take(Telegram telegram) {
  source_.heard();
  ++seen_;
  telegram.time = source_.shown(telegram.time);
  if (trace_.size() == kKept) trace_.pop_front();
  trace_.push_back(telegram);
  const Key key{telegram.bus, telegram.extended, telegram.remote, telegram.id};
  if (rows_.size() >= kMostRows && rows_.count(key) == 0) return;
  Row& row = rows_[key];
  std::vector<uint8_t> compared = ears_[telegram.bus]->compared(telegram);
  row.changed.clear();
  for (size_t n = 0; n < compared.size(); ++n)
    if (row.count != 0 && (n >= row.compared.size() || compared[n] != row.compared[n]))
      row.changed.push_back(n);
  row.compared = std::move(compared);
  row.last = std::move(telegram);
  ++row.count;
}

Json BusTraffic::decode(const Arguments& a) {
  const Json frames = a.json().value("frames", Json());
  if (!frames.is_array() || frames.size() > 500) throw Mistake("'frames' must be a list of at most 500");
  Json texts = Json::array();
  for (const Json& row : frames) {
    if (!row.is_object()) throw Mistake("a frame is an object with bus, id and data");
    const Arguments of_row(row);
    Telegram telegram;
    telegram.bus = number_of(of_row.text("bus"));
    telegram.id =
        static_cast<uint32_t>(of_row.whole("id", 0, UINT32_MAX, 0)) & (runtime::kExtendedIdLimit - 1);
    telegram.extended = of_row.flag("extended", telegram.id >= runtime::kStandardIdLimit);
    telegram.data = ears_[telegram.bus]->read(of_row.text("data"));
    texts.push_back(ears_[telegram.bus]->text_if_heard(telegram));
  }
  return {{"texts", std::move(texts)}};
}

Json BusTraffic::json_of(uint64_t n, const Telegram& telegram) {
  Json json{{"n", n},
            {"us", telegram.time / runtime::kMicrosecond},
            {"bus", ears_[telegram.bus]->name()},
            {"id", telegram.id},
            {"extended", telegram.extended},
            {"remote", telegram.remote},
            {"error", telegram.error},
            {"data", hex(telegram.bytes())},
            {"text", ears_[telegram.bus]->text_of(telegram)}};
  json.update(ears_[telegram.bus]->identity(telegram));
  return json;
}

Json BusTraffic::trace(const Arguments& a) {
  const auto before = static_cast<uint64_t>(a.whole("before", 0, INT64_MAX, INT64_MAX));
  const auto limit = static_cast<size_t>(a.whole("limit", 1, 1000, 200));
  const std::string filter = a.text("filter", "");
  const uint64_t first = seen_ - trace_.size() + 1;
  Json rows = Json::array();
  for (size_t n = trace_.size(); n-- > 0 && rows.size() < limit;) {
    if (first + n >= before) continue;
    const Telegram& telegram = trace_[n];
    BusEar& ear = *ears_[telegram.bus];
    const std::string words = fmt::format("{} {} {} {}", ear.name(), ear.identity_text(telegram),
                                          hex(telegram.bytes()), ear.text_of(telegram));
    if (filter.empty() || words.find(filter) != std::string::npos)
      rows.push_back(json_of(first + n, telegram));
  }
  std::reverse(rows.begin(), rows.end());
  return {{"frames", std::move(rows)}};
}

void BusTraffic::publish_rows(Client& client, Subscription& subscription) {
  Json rows = Json::array();
  for (const auto& [key, row] : rows_) {
    const std::string about =
        fmt::format("{} {} {}", std::get<0>(key), std::get<1>(key) * 2 + std::get<2>(key), std::get<3>(key));
    if (!subscription.is_news(about, {row.count, row.rate})) continue;
    BusEar& ear = *ears_[row.last.bus];
    Json json{{"bus", ear.name()},
              {"id", row.last.id},
              {"extended", row.last.extended},
              {"remote", row.last.remote},
              {"count", row.count},
              {"rate", row.rate},
              {"data", hex(row.last.bytes())},
              {"changed", row.changed},
              {"text", ear.text_of(row.last)}};
    json.update(ear.identity(row.last));
    rows.push_back(std::move(json));
  }
  Json buses = Json::object();
  for (const auto& ear : ears_) {
    const runtime::LineLoad load = ear->load(source_.line_now());
    Json state{{"load", load.window_percent},
               {"frames", load.frames},
               {"errors", ear->errors},
               {"state", ear->state}};
    if (subscription.is_news("bus " + ear->name(), state)) buses[ear->name()] = std::move(state);
  }
  if (rows.empty() && buses.empty() && !subscription.fresh) return;
  desk_.send(client, {{"event", "bus"},
                      {"us", us(source_.line_now())},
                      {"rows", std::move(rows)},
                      {"buses", std::move(buses)}});
}

void BusTraffic::publish_trace(Client& client, Subscription& subscription) {
  const uint64_t first = seen_ - trace_.size();  // of those that are kept
  uint64_t from = subscription.fresh ? seen_ : std::max(subscription.mark, first);
  if (seen_ - from > kTraceAtOnce) from = seen_ - kTraceAtOnce;
  const uint64_t lost = subscription.fresh ? 0 : from - subscription.mark;
  subscription.mark = seen_;
  if (from == seen_) return;
  std::string bytes;
  const auto put = [&bytes](const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  put(uint8_t{2});
  put(uint8_t{0});
  put(uint16_t{0});
  put(static_cast<uint32_t>(lost));
  for (uint64_t n = from; n < seen_; ++n) {
    const Telegram& telegram = trace_[n - first];
    put(static_cast<uint64_t>(telegram.time));
    put(static_cast<uint32_t>(n + 1));
    put(telegram.id);
    put(telegram.bus);
    put(static_cast<uint8_t>((telegram.extended ? 1 : 0) | (telegram.remote ? 2 : 0) |
                             (telegram.error ? 4 : 0)));
    put(static_cast<uint16_t>(telegram.bytes().size()));
    bytes.append(reinterpret_cast<const char*>(telegram.bytes().data()), telegram.bytes().size());
  }
  desk_.send_binary(client, bytes);
}

}  // namespace ipos::tools::serve
