// Questions to the drive one after the other, between the messages of the clients.
#include "tools/serve/drive_host.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/bus/movilink/format.hpp"
#include "stdlib/parameters.hpp"
#include "tools/cli/failure.hpp"
#include "tools/links/link_access.hpp"
#include "tools/parameters/parameter_set.hpp"
#include "tools/serve/host/parameter_rows.hpp"
#include "tools/serve/server.hpp"
#include "tools/serve/while.hpp"

namespace ipos::tools::serve {
namespace {

using stdlib::Parameter;
using stdlib::Service;
using namespace std::chrono_literals;

constexpr auto kTimePeriod = 50ms;
constexpr int kMessagesAtATime = 8;  // a client that floods does not hold the topics up
constexpr auto kAttends = 20ms;     // at a time, to what comes; then the drive has its turn
// Of a client. The server reads on, whatever waits here: a stop may be after it (server.hpp).
constexpr size_t kMostWaitingOrders = kMostUnanswered / 2;
constexpr size_t kLongestJog = 512;  // bytes of a message that may be one
constexpr auto kFarewell = 15s;      // to a drive that does not answer

}  // namespace

DriveHost::DriveHost(std::unique_ptr<BusLink> link, Options options, Mailbox& mailbox)
    : mailbox_(mailbox),
      router_(mailbox, clock_),
      options_(std::move(options)),
      link_(*link),
      access_(open_unit(std::move(link), options_.address, options_.unit)),
      scope_(router_, copies_, *access_, name(), [this] { return us() / 1000 * runtime::kMillisecond; }),
      bus_(
          router_, copies_, link_, {*access_, name(), options_.address}, [this] { return us() * runtime::kMicrosecond; },
          [this](const Router::Call& call) { check_writing(call); }),
      parameters_(router_, *this),
      watch_(router_, *this),
      manual_(link_, *access_, options_.address, [this] { tell_manual(); }) {
  router_.hello = [this] {
    return Json{{"protocol", 1},
                {"version", options_.version},
                {"mode", "device"},
                {"title", access_->name()},
                {"writable", options_.may_write}};
  };
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
  while (mailbox_.open()) {
    attend();
    const auto now = WallClock::now();
    if (now >= next_time_) {
      next_time_ = now + kTimePeriod;
      router_.send_all(time());
    }
    router_.publish(now, false);
    const bool samples = scope_.wanted();
    if (samples) scope_.sample();
    bus_.turn(!samples);
    attend();
    for (int n = 0; n < kMessagesAtATime && !waiting_.empty(); ++n) {
      const Message message = std::move(waiting_.front());
      waiting_.pop_front();
      arrived_ = message.arrived;
      router_.take(message);
      if (message.kind != MessageKind::Opened) continue;
      Client& client = router_.clients().at(message.client);
      router_.send(client, time());
      router_.send(client, manual());
    }
  }
}

void DriveHost::attend() {
  for (const auto until = WallClock::now() + kAttends; WallClock::now() < until;) {
    auto message = mailbox_.wait(0);
    if (!message) break;
    if (message->kind == MessageKind::Closed) manual_.let_go(message->client);
    if (!overtakes(*message)) {
      keep(std::move(*message));
      continue;
    }
    arrived_ = message->arrived;
    router_.take(*message);
  }
  if (!mailbox_.open()) manual_.let_go();
  manual_.turn();
}

// What a hand does: it changes nothing that another order under way could be using. The order of a client that nobody
// knows yet waits.
bool DriveHost::overtakes(const Message& message) {
  if (message.kind != MessageKind::Text || message.body.size() > kLongestJog) return false;
  const auto client = router_.clients().find(message.client);
  if (client == router_.clients().end()) return false;
  const Json said = Json::parse(message.body, nullptr, false);
  if (!said.is_object()) return false;
  const Json order = said.value("do", Json());
  return order == "arm" || order == "jog";
}

void DriveHost::keep(Message message) {
  const auto is_of_client = [&](const Message& one) {
    return one.kind == MessageKind::Text && one.client == message.client;
  };
  if (message.kind == MessageKind::Closed) std::erase_if(waiting_, is_of_client);
  if (message.kind == MessageKind::Text && std::count_if(waiting_.begin(), waiting_.end(), is_of_client) >=
                                                static_cast<ptrdiff_t>(kMostWaitingOrders)) {
    const Json said = Json::parse(message.body, nullptr, false);
    const Json id = said.is_object() ? said.value("id", Json()) : Json();
    router_.fail(message.client, id.is_number_integer() ? id : Json(),
               "too many orders of this client wait already");
    mailbox_.send(MessageKind::Taken, message.client, {});
    return;
  }
  waiting_.push_back(std::move(message));
}

Json DriveHost::time() const {
  return {{"event", "time"}, {"us", us()},      {"running", true}, {"speed", 1},
          {"rate", 1},       {"generation", 1}, {"over", false},   {"stopped", nullptr}};
}

int64_t DriveHost::us() const {
  return std::chrono::duration_cast<std::chrono::microseconds>(WallClock::now() - begin_).count();
}
std::string DriveHost::name() const { return fmt::format("unit{}", options_.address); }

void DriveHost::must_write(const Router::Call& call) const {
  if (!options_.may_write) throw Mistake("this is a real drive, and ipos serve was started without --write");
  if (!call.client.armed) throw Mistake("this is a real drive: confirm first that it may be written to");
}

void DriveHost::must_stand() const {
  if (!manual_.stands()) throw Mistake("the drive is being moved by hand: let go of the button first");
}

void DriveHost::add_commands() {
  router_.add_command("arm", [this](const Router::Call& call) {
    if (!options_.may_write) throw Mistake("ipos serve was started without --write");
    call.client.armed = call.arguments.flag("yes");
    if (call.client.armed)
      manual_.may_write();
    else
      manual_.let_go(call.client.number);
    return Json::object();
  });
  router_.add_command("plant", [this](const Router::Call&) { return Json{{"plant", describe()}}; });
  router_.add_command("jog", [this](const Router::Call& call) { return jog(call); });
  router_.add_topic("plant",
                  [this](Client& client, Subscription& subscription) { bus_.publish(client, subscription); });
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

// --- values ---

std::vector<signals::Signal> DriveHost::find(const std::string& asked) {
  const std::string prefix = name() + ".";
  const std::string own = asked.starts_with(prefix) ? asked.substr(prefix.size()) : asked;
  const std::vector<LiveItem> items = live_items(access_->unit(), {own}, nullptr, {});
  std::vector<signals::Signal> found;
  for (const LiveItem& item : items) {
    const Parameter* parameter = item.target.parameter;
    signals::Signal signal;
    signal.name = prefix + (items.size() == 1 ? own : item.name);
    signal.station = name();
    if (parameter != nullptr) {
      signal.group = signals::Group::Parameter;
      signal.unit = parameter->display;
      signal.meaning = parameter->name;
    }
    targets_[signal.name] = item.target;
    found.push_back(std::move(signal));
  }
  return found;
}

Json DriveHost::row(const signals::Signal& signal) const {
  const Target target = targets_.at(signal.name);
  return {{"name", signal.name},
          {"group", target.parameter != nullptr ? "parameters" : "variables"},
          {"unit", signal.unit},
          {"text", signal.meaning},
          {"writable", target.parameter == nullptr || target.parameter->writable}};
}

Json DriveHost::value(const signals::Signal& signal) {
  const Target target = targets_.at(signal.name);
  const AccessReply reply = access_->execute(Service::Read, target.index, 0);
  if (!reply) return nullptr;
  return {{"value", *reply},
          {"text", text_of(target, *reply)},
          {"hex", fmt::format("{:08X} h", static_cast<uint32_t>(*reply))},
          {"forced", false}};
}

Json DriveHost::set(const Router::Call& call) {
  check_writing(call);
  const Target target = find_target(access_->unit(), call.arguments.text("name"));
  const int32_t value = value_of(target, call.arguments.text("value"));
  write_parameter(*access_, target.index, value, true);
  return {{"text", text_of(target, value)}};
}

// --- parameters ---

std::shared_ptr<ParameterAccess> DriveHost::unit(const Arguments& arguments, const char* key) {
  const std::string asked = arguments.text(key, name());
  if (asked != name()) throw Mistake(fmt::format("there is no unit '{}', only {}", asked, name()));
  return std::shared_ptr<ParameterAccess>(std::shared_ptr<void>(), access_.get());
}

void DriveHost::check_writing(const Router::Call& call) const {
  must_write(call);
  must_stand();
}

void DriveHost::write(const Json& order) {
  write_parameter(*access_, order["index"].get<uint16_t>(), order["value"].get<int32_t>(), order["volatile"].get<bool>());
}

Json DriveHost::write_file(const Json& order) {
  const While writes(writes_);
  return load_settings(*access_, order["text"].get<std::string>());
}

// --- manual operation ---

// The stop is nobody's privilege.
Json DriveHost::jog(const Router::Call& call) {
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
  for (auto& [number, client] : router_.clients()) router_.send(client, event);
}

}  // namespace ipos::tools::serve
