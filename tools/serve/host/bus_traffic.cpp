// Rows as the monitors tell them, and what is news of them; the trace is in bus_trace.cpp.
#include "tools/serve/host/bus_traffic.hpp"

#include <fmt/format.h>

#include "tools/serve/host/trace_choice.hpp"

namespace ipos::tools::serve {
namespace {

constexpr size_t kMostRows = 4'096;  // identifiers that are told apart (ours)

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
  router.add_command("bus.telegram", [this](const Router::Call& call) { return telegram(call.arguments); });
  router.add_command("bus.save", [this](const Router::Call& call) { return saved(call.arguments); });
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

uint8_t BusTraffic::number_of(const std::string& name) const { return line_number(monitors_, name); }

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
              {"data", hex_digits(row.last.bytes())},
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

}  // namespace ipos::tools::serve
