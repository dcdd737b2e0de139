// Rows and trace as the monitors tell them, and what is news of them.
#include "tools/serve/host/bus_traffic.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace ipos::tools::serve {
namespace {

constexpr size_t kTraceAtOnce = 2'000;
constexpr size_t kMostRows = 4'096;  // identifiers that are told apart (ours)

std::string hex(std::span<const uint8_t> bytes) { return fmt::format("{:02X}", fmt::join(bytes, "")); }

}  // namespace

BusTraffic::BusTraffic(Router& router, BusSource& source, Copies& copies)
    : router_(router), source_(source), trace_(copies) {
  router.add_command("bus.clear", [this](const Router::Call&) {
    rows_.clear();
    for (const auto& monitor : monitors_) monitor->errors = 0;
    return Json::object();
  });
  router.add_command("bus.send", [this](const Router::Call& call) {
    source_.send(call);
    return Json::object();
  });
  router.add_command("bus.decode", [this](const Router::Call& call) { return decode(call.arguments); });
  router.add_command("bus.trace", [this](const Router::Call& call) { return trace(call.arguments); });
  router.add_topic("bus",
                 [this](Client& client, Subscription& subscription) { publish_rows(client, subscription); });
  router.add_topic("trace",
                 [this](Client& client, Subscription& subscription) { publish_trace(client, subscription); });
}

void BusTraffic::clear() {
  monitors_.clear();
  rows_.clear();
  waiting_.clear();
  seen_ = 0;
}

void BusTraffic::second_passed() {
  for (auto& [key, row] : rows_) {
    row.rate = row.count - row.count_before;
    row.count_before = row.count;
  }
}

void BusTraffic::send(const Arguments& arguments) {
  monitors_[number_of(arguments.text("bus"))]->send(arguments);
}

std::vector<uint8_t> BusTraffic::octets_of(const Arguments& arguments) const {
  return monitors_[number_of(arguments.text("bus"))]->read(arguments.text("data", ""));
}

uint8_t BusTraffic::number_of(const std::string& name) const {
  const auto found =
      std::find_if(monitors_.begin(), monitors_.end(), [&](const auto& monitor) { return monitor->name() == name; });
  if (found == monitors_.end()) throw Mistake(fmt::format("there is no bus '{}'", name));
  return static_cast<uint8_t>(found - monitors_.begin());
}

void BusTraffic::take(Telegram telegram) {
  if (!hears_) return;
  source_.heard();
  telegram.time = source_.shown(telegram.time);
  waiting_.push_back(std::move(telegram));
}

void BusTraffic::settle() {
  if (waiting_.empty()) return;
  for (const auto& monitor : monitors_) monitor->renew_names(source_.line_now());
  for (Telegram& telegram : waiting_) note(std::move(telegram));
  waiting_.clear();
}

void BusTraffic::note(Telegram telegram) {
  telegram.words = monitors_[telegram.bus]->words_of(telegram);
  trace_.add(++seen_, telegram);
  const Key key{telegram.bus, telegram.extended, telegram.remote, telegram.id};
  if (rows_.size() >= kMostRows && rows_.count(key) == 0) return;
  Row& row = rows_[key];
  std::vector<uint8_t> compared = monitors_[telegram.bus]->compared(telegram);
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
    telegram.data = monitors_[telegram.bus]->read(of_row.text("data"));
    texts.push_back(monitors_[telegram.bus]->text_if_heard(telegram));
  }
  return {{"texts", std::move(texts)}};
}

Json BusTraffic::json_of(uint64_t n, const Telegram& telegram) {
  Json json{{"n", n},
            {"us", telegram.time / runtime::kMicrosecond},
            {"bus", monitors_[telegram.bus]->name()},
            {"id", telegram.id},
            {"extended", telegram.extended},
            {"remote", telegram.remote},
            {"error", telegram.error},
            {"data", hex(telegram.bytes())},
            {"text", monitors_[telegram.bus]->text_of(telegram)}};
  json.update(monitors_[telegram.bus]->identity(telegram));
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

Json BusTraffic::trace(const Arguments& a) {
  const auto before = static_cast<uint64_t>(a.whole("before", 0, INT64_MAX, INT64_MAX));
  const auto limit = static_cast<size_t>(a.whole("limit", 1, 1000, 200));
  const std::string filter = a.text("filter", "");
  const auto line = a.has("bus") ? std::optional(number_of(a.text("bus"))) : std::nullopt;
  Json rows = Json::array();
  look_back(line, [&](const NumberedTelegram& one) {
    if (one.number >= before) return true;
    LineMonitor& monitor = *monitors_[one.telegram.bus];
    if (filter.empty() ||
        fmt::format("{} {} {} {}", monitor.name(), monitor.identity_text(one.telegram), hex(one.telegram.bytes()),
                    monitor.text_of(one.telegram))
                .find(filter) != std::string::npos)
      rows.push_back(json_of(one.number, one.telegram));
    return rows.size() < limit;
  });
  std::reverse(rows.begin(), rows.end());
  return {{"frames", std::move(rows)}};
}

void BusTraffic::publish_rows(Client& client, Subscription& subscription) {
  Json rows = Json::array();
  for (const auto& [key, row] : rows_) {
    const std::string about =
        fmt::format("{} {} {}", std::get<0>(key), std::get<1>(key) * 2 + std::get<2>(key), std::get<3>(key));
    if (!subscription.is_news(about, {row.count, row.rate})) continue;
    LineMonitor& monitor = *monitors_[row.last.bus];
    Json json{{"bus", monitor.name()},
              {"id", row.last.id},
              {"extended", row.last.extended},
              {"remote", row.last.remote},
              {"count", row.count},
              {"rate", row.rate},
              {"data", hex(row.last.bytes())},
              {"changed", row.changed},
              {"text", monitor.text_of(row.last)}};
    json.update(monitor.identity(row.last));
    rows.push_back(std::move(json));
  }
  Json buses = Json::object();
  for (const auto& monitor : monitors_) {
    const runtime::LineLoad load = monitor->load(source_.line_now());
    Json state{{"load", load.window_percent},
               {"frames", load.frames},
               {"errors", monitor->errors},
               {"state", monitor->state}};
    if (subscription.is_news("bus " + monitor->name(), state)) buses[monitor->name()] = std::move(state);
  }
  if (rows.empty() && buses.empty() && !subscription.fresh) return;
  router_.send(client, {{"event", "bus"},
                      {"us", us(source_.line_now())},
                      {"rows", std::move(rows)},
                      {"buses", std::move(buses)}});
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
