// Questions to the drive one after the other, between the letters of the clients.
#include "tools/serve/drive_host.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/bus/movilink/format.hpp"
#include "runtime/os_port/port_names.hpp"
#include "stdlib/parameters.hpp"
#include "tools/serve/parameter_rows.hpp"
#include "tools/unit/link_access.hpp"
#include "tools/unit/parameter_set.hpp"

namespace ipos::tools::serve {
namespace {

using stdlib::Parameter;
using stdlib::Service;
using namespace std::chrono_literals;

constexpr size_t kReadsAtOnce = 8;  // of a topic, then others have their turn
constexpr size_t kMostWatchedValues = 100;
constexpr auto kJogHolds = 300ms;  // without a `jog` it stops
constexpr auto kJogPeriod = 50ms;  // of the process data; drives monitor them from 10 ms on (P812, P815)
constexpr auto kTimePeriod = 50ms;
constexpr int kLettersAtATime = 8;     // a client that floods does not hold a jog up
constexpr double kDigitsOfRpm = 5;    // a speed word counts 0.2 rpm (1053 1610 p. 42)
constexpr uint16_t kEnable = 0x0006;  // control word 1: no inhibit, no rapid stop, no stop
constexpr uint16_t kStop = 0x0002;    // the stop with the ramp of the setpoint

// The list without a drive: what its table knows.
class TableAccess final : public ParameterAccess {
 public:
  explicit TableAccess(const ParameterAccess& of) : of_(of) {}
  AccessReply execute(Service service, uint16_t index, int32_t) override {
    const Parameter* parameter = stdlib::parameter_table(unit()).find(index);
    const int64_t limit = service == Service::ReadMinimum ? parameter->minimum() : parameter->maximum();
    if (service != Service::ReadMinimum && service != Service::ReadMaximum)
      return tl::unexpected(AccessError{{}, "not asked yet"});
    return static_cast<int32_t>(static_cast<uint32_t>(limit));
  }
  std::string name() const override { return of_.name(); }
  const stdlib::UnitType& unit() const override { return of_.unit(); }

 private:
  const ParameterAccess& of_;
};

}  // namespace

DriveHost::DriveHost(std::unique_ptr<BusLink> link, Options options, Post& post)
    : post_(post),
      desk_(post),
      options_(std::move(options)),
      link_(*link),
      access_(open_unit(std::move(link), options_.address, options_.unit)),
      scope_(desk_, *access_, name(), [this] { return us() / 1000 * runtime::kMillisecond; }),
      bus_(
          desk_, link_, {*access_, name(), options_.address}, [this] { return us() * runtime::kMicrosecond; },
          [this](const Desk::Call& call) { must_write(call); }) {
  desk_.hello = [this] {
    return Json{{"protocol", 1},
                {"version", options_.version},
                {"mode", "device"},
                {"title", access_->name()},
                {"writable", options_.may_write}};
  };
  desk_.on_closed = [this](const Client& client) {
    watched_.erase(client.number);
    if (jog_ && jog_->client == client.number) end_jog();
  };
  add_commands();
}

DriveHost::~DriveHost() {
  if (jog_) end_jog();
}

void DriveHost::run() {
  while (post_.open()) {
    const auto now = WallClock::now();
    if (jog_ && now >= jog_->ends) end_jog();
    if (jog_ && now >= jog_->next) {
      jog_->next = now + kJogPeriod;
      send_words(jog_->words);
    }
    if (now >= next_time_) {
      next_time_ = now + kTimePeriod;
      desk_.send_all(time());
    }
    desk_.publish(now, false);
    const bool samples = scope_.wanted();
    if (samples) scope_.sample();
    bus_.turn(!samples);
    for (int n = 0; n < kLettersAtATime; ++n) {
      const auto letter = post_.wait(0);
      if (!letter) break;
      desk_.take(*letter);
      if (letter->kind == LetterKind::Opened) desk_.send(desk_.clients().at(letter->client), time());
    }
  }
}

Json DriveHost::time() const {
  return {{"event", "time"}, {"us", us()},      {"running", true}, {"speed", 1},
          {"rate", 1},       {"generation", 1}, {"over", false},   {"stopped", nullptr}};
}

int64_t DriveHost::us() const {
  return std::chrono::duration_cast<std::chrono::microseconds>(WallClock::now() - begin_).count();
}
std::string DriveHost::name() const { return fmt::format("unit{}", options_.address); }

void DriveHost::must_write(const Desk::Call& call) const {
  if (!options_.may_write) throw Mistake("this is a real drive, and ipos serve was started without --write");
  if (!call.client.armed) throw Mistake("this is a real drive: confirm first that it may be written to");
}

void DriveHost::add_commands() {
  desk_.add_command("arm", [this](const Desk::Call& call) {
    if (!options_.may_write) throw Mistake("ipos serve was started without --write");
    call.client.armed = call.arguments.flag("yes");
    return Json::object();
  });
  desk_.add_command("plant", [this](const Desk::Call&) { return Json{{"plant", describe()}}; });
  desk_.add_command("watch", [this](const Desk::Call& call) { return watch(call); });
  desk_.add_command("set", [this](const Desk::Call& call) {
    must_write(call);
    const Target target = find_target(access_->unit(), call.arguments.text("name"));
    const int32_t value = value_of(target, call.arguments.text("value"));
    write_parameter(*access_, target.index, value, true);
    return Json{{"text", text_of(target, value)}};
  });
  desk_.add_command("parameters", [this](const Desk::Call&) {
    TableAccess table(*access_);
    return parameter_list(table);
  });
  desk_.add_command("parameters.set", [this](const Desk::Call& call) {
    must_write(call);
    const Target target = find_target(access_->unit(), call.arguments.text("number"));
    const int32_t value = value_of(target, call.arguments.text("value"));
    write_parameter(*access_, target.index, value, call.arguments.flag("volatile", false));
    return Json{{"text", text_of(target, value)}};
  });
  desk_.add_command("parameters.save", [this](const Desk::Call&) {
    bool complete = true;
    const ParameterSet settings = read_settings(*access_, complete);
    return Json{{"file", name() + ".settings"}, {"text", to_text(settings)}};
  });
  desk_.add_command("parameters.load", [this](const Desk::Call& call) {
    must_write(call);
    return load_settings(*access_, call.arguments.text("text"));
  });
  desk_.add_command("jog", [this](const Desk::Call& call) { return jog(call); });
  desk_.add_topic("plant",
                  [this](Client& client, Subscription& subscription) { bus_.publish(client, subscription); });
  desk_.add_topic(
      "watch", [this](Client& client, Subscription& subscription) { publish_watch(client, subscription); });
  desk_.add_topic("parameters", [this](Client& client, Subscription& subscription) {
    publish_parameters(client, subscription);
  });
}

Json DriveHost::describe() const {
  const stdlib::UnitType& unit = access_->unit();
  const Json station{{"name", name()},
                     {"unit", unit.name},
                     {"title", unit.title},
                     {"program", ""},
                     {"drive", true},
                     {"inputs", Json::array()},
                     {"outputs", Json::array()},
                     {"analog", Json::array()},
                     {"lines", Json::array({bus_.line()})}};
  return {{"stations", Json::array({station})},
          {"buses", Json::array({bus_.describe()})},
          {"controls", Json::array()},
          {"wires", Json::array()},
          {"switches", Json::array()}};
}

Json DriveHost::watch(const Desk::Call& call) {
  const std::vector<std::string> names = call.arguments.texts("names", kMostWatchedValues);
  std::vector<std::string> own;
  const std::string prefix = name() + ".";
  for (const std::string& text : names)
    own.push_back(text.starts_with(prefix) ? text.substr(prefix.size()) : text);
  std::vector<LiveItem> items = live_items(access_->unit(), own, nullptr, {});
  Json rows = Json::array();
  for (size_t n = 0; n < items.size(); ++n) {
    const Parameter* parameter = items[n].target.parameter;
    items[n].name = prefix + own[n];
    rows.push_back({{"name", items[n].name},
                    {"group", parameter != nullptr ? "parameters" : "variables"},
                    {"unit", parameter != nullptr ? std::string(parameter->display) : ""},
                    {"text", parameter != nullptr ? std::string(parameter->name) : ""},
                    {"writable", parameter == nullptr || parameter->writable}});
  }
  watched_[call.client.number] = std::move(items);
  if (const auto topic = call.client.subscriptions.find("watch"); topic != call.client.subscriptions.end())
    topic->second.sent.clear();
  return {{"names", std::move(rows)}};
}

// A few at a time: a slow line must not keep the others waiting.
void DriveHost::publish_watch(Client& client, Subscription& subscription) {
  const auto found = watched_.find(client.number);
  if (found == watched_.end()) return;
  const std::vector<LiveItem>& items = found->second;
  Json values = Json::object();
  for (size_t n = 0; n < std::min(kReadsAtOnce, items.size()); ++n) {
    const LiveItem& item = items[subscription.mark++ % items.size()];
    const AccessReply reply = access_->execute(Service::Read, item.target.index, 0);
    Json now = nullptr;
    if (reply)
      now = {{"value", *reply},
             {"text", text_of(item.target, *reply)},
             {"hex", fmt::format("{:08X} h", static_cast<uint32_t>(*reply))},
             {"forced", false}};
    if (subscription.is_news(item.name, now)) values[item.name] = std::move(now);
  }
  if (!values.empty()) desk_.send(client, {{"event", "watch"}, {"us", us()}, {"values", std::move(values)}});
}

void DriveHost::publish_parameters(Client& client, Subscription& subscription) {
  const auto rows = stdlib::parameter_table(access_->unit()).by_index();
  Json values = Json::object();
  for (size_t n = 0; n < kReadsAtOnce && !rows.empty(); ++n) {
    const Parameter& parameter = *rows[subscription.mark++ % rows.size()];
    const AccessReply reply = access_->execute(Service::Read, parameter.index, 0);
    if (!reply) continue;
    Json now = value_json(parameter, *reply);
    const std::string index = std::to_string(parameter.index);
    if (subscription.is_news(index, now)) values[index] = std::move(now);
  }
  if (!values.empty())
    desk_.send(client,
               {{"event", "parameters"}, {"us", us()}, {"station", name()}, {"values", std::move(values)}});
}

// --- manual operation (MDX60B/61B 4.4.3): control is taken at the first jog and given back at its end ---

Json DriveHost::jog(const Desk::Call& call) {
  must_write(call);
  const std::string direction = call.arguments.text("direction");
  if (direction == "stop") {
    if (jog_) end_jog();
    return Json::object();
  }
  if (direction != "cw" && direction != "ccw") throw Mistake("'direction' must be cw, ccw or stop");
  const double rpm = call.arguments.number("rpm", 0, 3000);
  if (jog_ && jog_->client != call.client.number) throw Mistake("another client moves the drive");
  if (!jog_) {
    Jog jog;
    jog.client = call.client.number;
    take_control(jog);
    jog_ = std::move(jog);
  }
  const auto speed = static_cast<int16_t>(rpm * kDigitsOfRpm * (direction == "cw" ? 1 : -1));
  jog_->words = {kEnable, static_cast<uint16_t>(speed), 0};
  jog_->ends = WallClock::now() + kJogHolds;
  jog_->next = {};
  return Json::object();
}

void DriveHost::take_control(Jog& jog) {
  const bool serial = runtime::kind_of_port(link_.port_name()) == runtime::PortKind::Serial;
  const stdlib::ParameterTable& table = stdlib::parameter_table(access_->unit());
  const auto value = [&](const char* number, const char* text) {
    const Parameter* parameter = table.find(std::string_view(number));
    const auto wanted = parameter == nullptr ? tl::expected<int32_t, std::string>(0)
                                             : stdlib::parse_parameter_text(*parameter, text);
    if (parameter == nullptr || !wanted)
      throw Mistake(fmt::format("this unit has no P{} = {}", number, text));
    const AccessReply now = access_->execute(Service::Read, parameter->index, 0);
    if (!now) throw Mistake(why(table, Service::Read, parameter->index, 0, now.error()));
    return std::tuple(parameter->index, *wanted, *now);
  };
  for (const auto& [number, text] : {std::pair{"870", "CTRL. WORD 1"}, {"871", "SPEED"}}) {
    const auto [index, wanted, now] = value(number, text);
    if (now != wanted) throw Mistake(fmt::format("manual operation needs P{} = {}", number, text));
  }
  try {
    for (const char* number : {"100", "101"}) {
      const auto [index, wanted, now] = value(number, serial ? "RS-485" : "SBus");
      if (now == wanted) continue;
      write_parameter(*access_, index, wanted, true);
      jog.before.emplace_back(index, now);
    }
  } catch (const Mistake&) {
    for (const auto& [index, before] : jog.before) access_->execute(Service::WriteVolatile, index, before);
    throw;
  }
}

void DriveHost::end_jog() {
  const Jog ended = std::exchange(jog_, std::nullopt).value();
  send_words({kStop, 0, 0});
  for (const auto& [index, before] : ended.before) access_->execute(Service::WriteVolatile, index, before);
}

// The next ones come soon; a drive that hears none stops by itself.
void DriveHost::send_words(const std::array<uint16_t, 3>& words) {
  link_.send_process_data(options_.address, words);
}

}  // namespace ipos::tools::serve
