// Questions to the drive one after the other, between the letters of the clients.
#include "tools/serve/drive_host.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/bus/movilink/format.hpp"
#include "stdlib/parameters.hpp"
#include "tools/cli/failure.hpp"
#include "tools/serve/parameter_rows.hpp"
#include "tools/serve/server.hpp"
#include "tools/serve/while.hpp"
#include "tools/unit/link_access.hpp"
#include "tools/unit/parameter_set.hpp"

namespace ipos::tools::serve {
namespace {

using stdlib::Parameter;
using stdlib::Service;
using namespace std::chrono_literals;

constexpr size_t kReadsAtOnce = 8;  // of a topic, then others have their turn
constexpr size_t kMostWatchedValues = 100;
constexpr auto kTimePeriod = 50ms;
constexpr int kLettersAtATime = 8;  // a client that floods does not hold the topics up
constexpr auto kAttends = 20ms;     // at a time, to what comes; then the drive has its turn
// Of a client. The server reads on, whatever waits here: a stop may be after it (server.hpp).
constexpr size_t kMostWaitingOrders = kMostUnanswered / 2;
constexpr size_t kLongestJog = 512;  // bytes of a message that may be one
constexpr auto kFarewell = 15s;      // to a drive that does not answer

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
          [this](const Desk::Call& call) {
            must_write(call);
            must_stand();
          }),
      manual_(link_, *access_, options_.address, [this] { tell_manual(); }) {
  desk_.hello = [this] {
    return Json{{"protocol", 1},
                {"version", options_.version},
                {"mode", "device"},
                {"title", access_->name()},
                {"writable", options_.may_write}};
  };
  desk_.on_closed = [this](const Client& client) { watched_.erase(client.number); };
  add_commands();
  for (const std::string& text : manual_.left())
    fmt::print(stderr, "ipos: an earlier run left something behind: {}\n", text);
  link_.before_question = [this] { attend(); };
}

// Where the port has gone there is nobody to be told: the drive's own monitoring has stopped it.
DriveHost::~DriveHost() {
  try {
    manual_.finish(kFarewell);
  } catch (const Failure&) {
    for (const std::string& text : manual_.left()) fmt::print(stderr, "ipos: {}\n", text);
  }
}

void DriveHost::run() {
  while (post_.open()) {
    attend();
    const auto now = WallClock::now();
    if (now >= next_time_) {
      next_time_ = now + kTimePeriod;
      desk_.send_all(time());
    }
    desk_.publish(now, false);
    const bool samples = scope_.wanted();
    if (samples) scope_.sample();
    bus_.turn(!samples);
    attend();
    for (int n = 0; n < kLettersAtATime && !waiting_.empty(); ++n) {
      const Letter letter = std::move(waiting_.front());
      waiting_.pop_front();
      arrived_ = letter.arrived;
      desk_.take(letter);
      if (letter.kind != LetterKind::Opened) continue;
      Client& client = desk_.clients().at(letter.client);
      desk_.send(client, time());
      desk_.send(client, manual());
    }
  }
}

void DriveHost::attend() {
  for (const auto until = WallClock::now() + kAttends; WallClock::now() < until;) {
    auto letter = post_.wait(0);
    if (!letter) break;
    if (letter->kind == LetterKind::Closed) manual_.let_go(letter->client);
    if (!overtakes(*letter)) {
      keep(std::move(*letter));
      continue;
    }
    arrived_ = letter->arrived;
    desk_.take(*letter);
  }
  if (!post_.open()) manual_.let_go();
  manual_.turn();
}

// What a hand does: it changes nothing that another order under way could be using. The order of a client that nobody
// knows yet waits.
bool DriveHost::overtakes(const Letter& letter) {
  if (letter.kind != LetterKind::Message || letter.body.size() > kLongestJog) return false;
  const auto client = desk_.clients().find(letter.client);
  if (client == desk_.clients().end()) return false;
  const Json message = Json::parse(letter.body, nullptr, false);
  if (!message.is_object()) return false;
  const Json order = message.value("do", Json());
  return order == "arm" || order == "jog";
}

void DriveHost::keep(Letter letter) {
  const auto is_of_client = [&](const Letter& one) {
    return one.kind == LetterKind::Message && one.client == letter.client;
  };
  if (letter.kind == LetterKind::Closed) std::erase_if(waiting_, is_of_client);
  if (letter.kind == LetterKind::Message && std::count_if(waiting_.begin(), waiting_.end(), is_of_client) >=
                                                static_cast<ptrdiff_t>(kMostWaitingOrders)) {
    const Json message = Json::parse(letter.body, nullptr, false);
    const Json id = message.is_object() ? message.value("id", Json()) : Json();
    desk_.fail(letter.client, id.is_number_integer() ? id : Json(),
               "too many orders of this client wait already");
    post_.send(LetterKind::Taken, letter.client, {});
    return;
  }
  waiting_.push_back(std::move(letter));
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

void DriveHost::must_stand() const {
  if (!manual_.stands()) throw Mistake("the drive is being moved by hand: let go of the button first");
}

void DriveHost::add_commands() {
  desk_.add_command("arm", [this](const Desk::Call& call) {
    if (!options_.may_write) throw Mistake("ipos serve was started without --write");
    call.client.armed = call.arguments.flag("yes");
    if (call.client.armed)
      manual_.may_write();
    else
      manual_.let_go(call.client.number);
    return Json::object();
  });
  desk_.add_command("plant", [this](const Desk::Call&) { return Json{{"plant", describe()}}; });
  desk_.add_command("watch", [this](const Desk::Call& call) { return watch(call); });
  desk_.add_command("set", [this](const Desk::Call& call) {
    must_write(call);
    must_stand();
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
    must_stand();
    const Target target = find_target(access_->unit(), call.arguments.text("number"));
    const int32_t value = value_of(target, call.arguments.text("value"));
    write_parameter(*access_, target.index, value, call.arguments.flag("volatile", false));
    return Json{{"text", text_of(target, value)}};
  });
  desk_.add_command("parameters.save", [this](const Desk::Call&) {
    must_stand();
    bool complete = true;
    const ParameterSet settings = read_settings(*access_, complete);
    return Json{{"file", name() + ".settings"}, {"text", to_text(settings)}};
  });
  desk_.add_command("parameters.load", [this](const Desk::Call& call) {
    must_write(call);
    must_stand();
    const While writes(writes_);
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

// A few at a time, and none while letters wait: a slow line must not keep the others waiting.
void DriveHost::publish_watch(Client& client, Subscription& subscription) {
  const auto found = watched_.find(client.number);
  if (found == watched_.end()) return;
  const std::vector<LiveItem>& items = found->second;
  Json values = Json::object();
  for (size_t n = 0; n < std::min(kReadsAtOnce, items.size()) && waiting_.empty(); ++n) {
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
  for (size_t n = 0; n < kReadsAtOnce && !rows.empty() && waiting_.empty(); ++n) {
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

// --- manual operation ---

// The stop is nobody's privilege.
Json DriveHost::jog(const Desk::Call& call) {
  const std::string direction = call.arguments.text("direction");
  if (direction == "stop") {
    manual_.stop(call.client.number);
    return Json::object();
  }
  must_write(call);
  if (direction != "cw" && direction != "ccw") throw Mistake("'direction' must be cw, ccw or stop");
  const double rpm = call.arguments.number("rpm", 0, 3000);
  if (writes_) throw Mistake("settings are being written to the drive: it is not moved meanwhile");
  manual_.hold(call.client.number, direction == "cw" ? rpm : -rpm, arrived_);
  return Json::object();
}

Json DriveHost::manual() const {
  return {
      {"event", "manual"}, {"moves", manual_.moves()}, {"alarm", manual_.alarm()}, {"left", manual_.left()}};
}

// Also to a client that does not keep up: it is about people.
void DriveHost::tell_manual() {
  const Json event = manual();
  if (std::string text = event.dump(); std::exchange(told_, text) == text) return;
  for (auto& [number, client] : desk_.clients()) desk_.send(client, event);
}

}  // namespace ipos::tools::serve
