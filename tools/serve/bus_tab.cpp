// The tab Bus: a row an identifier, the trace of the last telegrams, and telegrams that a user sends. The page's own
// node hangs on a line without being connected until it sends: a line with a listener more would be another one.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <deque>
#include <map>
#include <tuple>

#include "runtime/bus/movilink/describe_serial.hpp"
#include "runtime/bus/movilink/serial_receiver.hpp"
#include "runtime/bus_plan/names.hpp"
#include "tools/serve/tabs.hpp"

namespace ipos::tools::serve {
namespace {

using runtime::Frame;
using runtime::Time;

constexpr size_t kKept = 100'000;  // telegrams of the trace
constexpr size_t kMostBytes = 18;  // of one (runtime::SerialBytes)
constexpr size_t kTraceAtOnce = 2'000;
constexpr size_t kMostRows = 4'096;  // identifiers that are told apart (ours)
constexpr auto kNamesAge = std::chrono::seconds(2);

std::string hex(std::span<const uint8_t> bytes) { return fmt::format("{:02X}", fmt::join(bytes, "")); }

std::vector<uint8_t> bytes_of(const std::string& text, size_t most) {
  std::vector<uint8_t> bytes;
  int high = -1;
  for (const char c : text) {
    if (c == ' ') continue;
    const int digit = c >= '0' && c <= '9'   ? c - '0'
                      : c >= 'a' && c <= 'f' ? c - 'a' + 10
                      : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                             : -1;
    if (digit < 0) throw Mistake(fmt::format("'{}' is no byte in hexadecimal", text));
    if (high < 0) {
      high = digit;
      continue;
    }
    bytes.push_back(static_cast<uint8_t>(high * 16 + digit));
    high = -1;
  }
  if (high >= 0) throw Mistake("the last byte has one digit only");
  if (bytes.size() > most) throw Mistake(fmt::format("a telegram has at most {} bytes here", most));
  return bytes;
}

struct Telegram {
  Time time = 0;
  uint32_t id = 0;
  uint8_t bus = 0;  // number in the reply to `plant`
  bool extended = false, remote = false, error = false;
  uint8_t length = 0;
  std::array<uint8_t, kMostBytes> data{};

  std::span<const uint8_t> bytes() const { return {data.data(), remote ? size_t{0} : length}; }
};

class BusTab final : public Tab,
                     private runtime::CanObserver,
                     private runtime::SerialObserver,
                     private runtime::CanNode,
                     private runtime::SerialNode {
 public:
  explicit BusTab(PlantHost& host) : host_(host) {
    Desk& desk = host.desk();
    desk.add_command("bus.clear", [this](const Desk::Call&) {
      rows_.clear();
      for (BusState& bus : buses_) bus.errors = 0;
      return Json::object();
    });
    desk.add_command("bus.send", [this](const Desk::Call& call) {
      host_.act("bus.send", call.arguments.json());
      return Json::object();
    });
    host.add_action("bus.send", [this](const Json& action) { send(Arguments(action)); });
    desk.add_command("bus.decode", [this](const Desk::Call& call) { return decode(call.arguments); });
    desk.add_command("bus.trace", [this](const Desk::Call& call) { return trace(call.arguments); });
    desk.add_topic(
        "bus", [this](Client& client, Subscription& subscription) { publish_rows(client, subscription); });
    desk.add_topic(
        "trace", [this](Client& client, Subscription& subscription) { publish_trace(client, subscription); });
  }

  void built(runtime::Plant& plant) override {
    rows_.clear();
    trace_.clear();
    seen_ = 0;
    buses_.clear();
    receivers_.clear();
    names_known_ = {};
    for (const auto& line : plant.lines()) {
      buses_.push_back({line->name(), line, nullptr, 0, 0, {}});
      buses_.back().node = line->attach(kPageNode, line->baud(), *this);
      line->set_connected(buses_.back().node, false);
    }
    for (const auto& line : plant.serial_lines()) {
      buses_.push_back({line->name(), nullptr, &line->line(), 0, 0, {}});
      buses_.back().node = line->line().attach(kPageNode, line->baud(), *this);
      line->line().set_connected(buses_.back().node, false);
    }
    plant.add_observer(static_cast<runtime::CanObserver&>(*this));
    plant.add_observer(static_cast<runtime::SerialObserver&>(*this));
  }

  void passed(Time now) override {
    if (now % runtime::kSecond != 0) return;
    for (auto& [key, row] : rows_) {
      row.rate = row.count - row.count_before;
      row.count_before = row.count;
    }
  }

 private:
  struct BusState {
    std::string name;
    runtime::CanLine* can;
    runtime::Rs485Line* serial;
    runtime::NodeId node;
    uint64_t errors;
    std::string state;
  };
  struct Row {
    Telegram last;
    std::array<bool, kMostBytes> changed{};
    uint64_t count = 0, count_before = 0, rate = 0;
  };
  using Key = std::tuple<uint8_t, bool, bool, uint32_t>;

  uint8_t number_of(std::string_view name) const {
    const auto found =
        std::find_if(buses_.begin(), buses_.end(), [&](const BusState& bus) { return bus.name == name; });
    return static_cast<uint8_t>(found - buses_.begin());
  }
  BusState& bus_named(const std::string& name) {
    const uint8_t number = number_of(name);
    if (number == buses_.size()) throw Mistake(fmt::format("there is no bus '{}'", name));
    return buses_[number];
  }

  // --- what comes ---

  void on_frame(const runtime::CanLine& line, const runtime::FrameRecord& record) override {
    Telegram telegram;
    telegram.time = record.end;
    telegram.id = record.frame.id;
    telegram.bus = number_of(line.name());
    telegram.extended = record.frame.extended;
    telegram.remote = record.frame.remote;
    telegram.length = record.frame.length;
    std::copy(record.frame.data.begin(), record.frame.data.end(), telegram.data.begin());
    take(telegram);
  }
  void on_line_event(const runtime::CanLine& line, const runtime::LineEvent& event) override {
    BusState& bus = buses_[number_of(line.name())];
    ++bus.errors;
    bus.state = describe(line, event);
  }
  void on_character(const runtime::Rs485Line& line, runtime::NodeId,
                    const runtime::Character& character) override {
    const auto reception = receivers_[line.name()].take(character);
    if (!reception) return;
    Telegram telegram;
    telegram.time = reception->end;
    telegram.bus = number_of(line.name());
    telegram.error = !reception->telegram;
    telegram.length = reception->bytes.size;
    telegram.data = reception->bytes.data;
    telegram.id = telegram.length > 1 ? telegram.data[1] : 0;
    if (telegram.error) ++buses_[telegram.bus].errors;
    take(telegram);
  }
  void on_serial_event(const runtime::Rs485Line& line, const runtime::SerialEvent&) override {
    ++buses_[number_of(line.name())].errors;
  }
  // The page's node only sends.
  void on_frame(Time, const Frame&) override {}
  void on_sent(Time, const Frame&, uint64_t) override {}
  void on_not_sent(Time, const Frame&, uint64_t, runtime::NotSent) override {}
  void on_character(Time, const runtime::Character&) override {}
  void on_sent(Time) override {}

  void take(const Telegram& telegram) {
    host_.telegram_seen();
    ++seen_;
    if (trace_.size() == kKept) trace_.pop_front();
    trace_.push_back(telegram);
    const Key key{telegram.bus, telegram.extended, telegram.remote, telegram.id};
    if (rows_.size() >= kMostRows && rows_.count(key) == 0) return;
    Row& row = rows_[key];
    for (size_t n = 0; n < kMostBytes; ++n)
      row.changed[n] = row.count != 0 && n < telegram.length && telegram.data[n] != row.last.data[n];
    row.last = telegram;
    ++row.count;
  }

  // --- in words ---

  void look_up_names() {
    const auto now = WallClock::now();
    if (names_known_ != WallClock::time_point{} && now - names_known_ < kNamesAge) return;
    names_known_ = now;
    names_.clear();
    for (const BusState& bus : buses_)
      names_.push_back(bus.can != nullptr ? runtime::telegram_names(host_.plant(), bus.can)
                                          : runtime::serial_names(host_.plant()));
  }

  std::string text_of(const Telegram& telegram) {
    look_up_names();
    const runtime::TelegramNames& names = names_[telegram.bus];
    if (buses_[telegram.bus].can != nullptr) {
      Frame frame;
      frame.id = telegram.id;
      frame.length = telegram.length;
      frame.extended = telegram.extended;
      frame.remote = telegram.remote;
      std::copy_n(telegram.data.begin(), frame.data.size(), frame.data.begin());
      return runtime::describe(names, frame).text;
    }
    const auto read = runtime::decode_serial(telegram.bytes());
    return read ? runtime::describe(names, *read) : fmt::format("void: {}", hex(telegram.bytes()));
  }

  Json decode(const Arguments& a) {
    const Json frames = a.json().value("frames", Json());
    if (!frames.is_array() || frames.size() > 500) throw Mistake("'frames' must be a list of at most 500");
    Json texts = Json::array();
    for (const Json& row : frames) {
      if (!row.is_object()) throw Mistake("a frame is an object with bus, id and data");
      const Arguments of_row(row);
      Telegram telegram;
      bus_named(of_row.text("bus"));
      telegram.bus = number_of(of_row.text("bus"));
      telegram.id = static_cast<uint32_t>(of_row.whole("id", 0, runtime::kExtendedIdLimit - 1, 0));
      telegram.extended = of_row.flag("extended", telegram.id >= runtime::kStandardIdLimit);
      const auto bytes = bytes_of(of_row.text("data"), buses_[telegram.bus].can != nullptr ? 8 : kMostBytes);
      telegram.length = static_cast<uint8_t>(bytes.size());
      std::copy(bytes.begin(), bytes.end(), telegram.data.begin());
      texts.push_back(text_of(telegram));
    }
    return {{"texts", std::move(texts)}};
  }

  Json json_of(uint64_t n, const Telegram& telegram) {
    return {{"n", n},
            {"us", telegram.time / runtime::kMicrosecond},
            {"bus", buses_[telegram.bus].name},
            {"id", telegram.id},
            {"extended", telegram.extended},
            {"remote", telegram.remote},
            {"error", telegram.error},
            {"data", hex(telegram.bytes())},
            {"text", text_of(telegram)}};
  }

  Json trace(const Arguments& a) {
    const auto before = static_cast<uint64_t>(a.whole("before", 0, INT64_MAX, INT64_MAX));
    const auto limit = static_cast<size_t>(a.whole("limit", 1, 1000, 200));
    const std::string filter = a.text("filter", "");
    const uint64_t first = seen_ - trace_.size() + 1;
    Json rows = Json::array();
    for (size_t n = trace_.size(); n-- > 0 && rows.size() < limit;) {
      if (first + n >= before) continue;
      Json row = json_of(first + n, trace_[n]);
      const std::string words =
          fmt::format("{} {} {:X} {} {}", row["bus"].get<std::string>(), trace_[n].id, trace_[n].id,
                      row["data"].get<std::string>(), row["text"].get<std::string>());
      if (filter.empty() || words.find(filter) != std::string::npos) rows.push_back(std::move(row));
    }
    std::reverse(rows.begin(), rows.end());
    return {{"frames", std::move(rows)}};
  }

  // --- what is sent ---

  void send(const Arguments& a) {
    BusState& bus = bus_named(a.text("bus"));
    const auto bytes = bytes_of(a.text("data", ""), bus.can != nullptr ? 8 : kMostBytes);
    if (bus.serial != nullptr) {
      if (bytes.empty()) throw Mistake("a telegram needs bytes");
      bus.serial->set_connected(bus.node, true);
      if (!bus.serial->send(bus.node, bytes)) throw Mistake("the last one is still on its way");
      return;
    }
    Frame frame;
    frame.extended = a.flag("extended", false);
    frame.remote = a.flag("remote", false);
    frame.id = static_cast<uint32_t>(a.whole(
        "identifier", 0, (frame.extended ? runtime::kExtendedIdLimit : runtime::kStandardIdLimit) - 1));
    frame.length = static_cast<uint8_t>(bytes.size());
    std::copy(bytes.begin(), bytes.end(), frame.data.begin());
    bus.can->set_connected(bus.node, true);
    switch (bus.can->send(bus.node, frame, ++sent_)) {
      case runtime::SendStatus::Queued: return;
      case runtime::SendStatus::QueueFull: throw Mistake("too many telegrams wait for the line");
      case runtime::SendStatus::NotActive:
        throw Mistake("the line does not let the page take part: bus-off, or its wires are disturbed");
      case runtime::SendStatus::InvalidFrame: throw Mistake("this is no telegram");
    }
  }

  // --- what is news ---

  void publish_rows(Client& client, Subscription& subscription) {
    Json rows = Json::array();
    for (const auto& [key, row] : rows_) {
      const std::string about = fmt::format("{} {} {}", std::get<0>(key),
                                            std::get<1>(key) * 2 + std::get<2>(key), std::get<3>(key));
      if (!subscription.is_news(about, {row.count, row.rate})) continue;
      Json changed = Json::array();
      for (size_t n = 0; n < kMostBytes; ++n)
        if (row.changed[n]) changed.push_back(n);
      rows.push_back({{"bus", buses_[row.last.bus].name},
                      {"id", row.last.id},
                      {"extended", row.last.extended},
                      {"remote", row.last.remote},
                      {"count", row.count},
                      {"rate", row.rate},
                      {"data", hex(row.last.bytes())},
                      {"changed", std::move(changed)},
                      {"text", text_of(row.last)}});
    }
    Json buses = Json::object();
    for (const BusState& bus : buses_) {
      const runtime::LineLoad load =
          bus.can != nullptr ? bus.can->load(host_.plant().now()) : bus.serial->load(host_.plant().now());
      Json state{{"load", load.window_percent},
                 {"frames", load.frames},
                 {"errors", bus.errors},
                 {"state", bus.state}};
      if (subscription.is_news("bus " + bus.name, state)) buses[bus.name] = std::move(state);
    }
    if (rows.empty() && buses.empty() && !subscription.fresh) return;
    host_.desk().send(
        client,
        {{"event", "bus"}, {"us", host_.us()}, {"rows", std::move(rows)}, {"buses", std::move(buses)}});
  }

  void publish_trace(Client& client, Subscription& subscription) {
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
      bytes.append(reinterpret_cast<const char*>(telegram.data.data()), telegram.bytes().size());
    }
    host_.desk().send_binary(client, bytes);
  }

  PlantHost& host_;
  std::vector<BusState> buses_;
  std::map<std::string, runtime::SerialReceiver> receivers_;  // by line
  std::map<Key, Row> rows_;
  std::deque<Telegram> trace_;
  uint64_t seen_ = 0;
  uint64_t sent_ = 0;
  std::vector<runtime::TelegramNames> names_;  // as buses_
  WallClock::time_point names_known_{};
};

}  // namespace

std::unique_ptr<Tab> make_bus_tab(PlantHost& host) { return std::make_unique<BusTab>(host); }

}  // namespace ipos::tools::serve
