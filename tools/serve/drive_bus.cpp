// The names of the drive for the words of its telegrams, and a telegram of a client between two questions.
#include "tools/serve/drive_bus.hpp"

#include "stdlib/parameters.hpp"
#include "tools/serve/unmonitored.hpp"

namespace ipos::tools::serve {
namespace {

constexpr runtime::Time kListens = 5 * runtime::kMillisecond;  // at once; then messages have their turn
// An answer to a client's telegram on a half duplex line: the longest telegram at 9.6 kbaud twice, and the drive's time.
constexpr runtime::Time kAnswer = 150 * runtime::kMillisecond;

// P870 to P872, P873 to P875: what the process data words mean. False where the drive is silent.
bool ask_words(ParameterAccess& access, int first, runtime::WordAssignment& words) {
  for (size_t n = 0; n < words.size(); ++n) {
    const std::string number = std::to_string(first + static_cast<int>(n));
    const stdlib::Parameter* row = stdlib::parameter_table(access.unit()).find(std::string_view(number));
    if (row == nullptr) continue;
    const AccessReply reply = access.execute(stdlib::Service::Read, row->index, 0);
    if (!reply && !reply.error().code) return false;
    if (reply) words[n] = static_cast<uint8_t>(*reply);
  }
  return true;
}

}  // namespace

DriveBus::DriveBus(Router& router, Copies& copies, BusLink& link, const Drive& drive, std::function<runtime::Time()> now,
                   std::function<void(const Router::Call&)> must_write)
    : router_(router),
      link_(link),
      drive_(drive),
      now_(std::move(now)),
      must_write_(std::move(must_write)),
      traffic_(router, *this, copies) {
  runtime::UnitNames unit;
  unit.name = drive.name;
  unit.unit = &drive.access.unit();
  unit.settings.address = drive.address;
  names_.units.push_back(std::move(unit));
  ask_names();
  const auto names = [this] { return names_; };
  if (link.can_line() != nullptr)
    traffic_.follow(*link.can_line(), CanNamesNow{[names] { return runtime::CanLineNames{names(), {}}; }});
  else
    traffic_.follow(*link.serial_line(), names);
  traffic_.complete();
}

void DriveBus::ask_names() {
  runtime::UnitNames& unit = names_.units.front();
  known_ = ask_words(drive_.access, 870, unit.output) && ask_words(drive_.access, 873, unit.input);
}

const std::string& DriveBus::line() const {
  return link_.can_line() != nullptr ? link_.can_line()->name() : link_.serial_line()->name();
}

runtime::LineLoad DriveBus::load() const {
  return link_.can_line() != nullptr ? link_.can_line()->load(link_.now())
                                     : link_.serial_line()->load(link_.now());
}

Json DriveBus::describe() const {
  const bool can = link_.can_line() != nullptr;
  return {{"name", line()},
          {"kind", can ? "can" : "rs485"},
          {"baud", can ? link_.can_line()->baud() : link_.serial_line()->baud()},
          {"stations", Json::array({drive_.name})},
          {"faults", Json::array()},
          {"fault_rules", Json::object()}};
}

void DriveBus::publish(Client& client, Subscription& subscription) const {
  const runtime::LineLoad now = load();
  Json state{{"load", now.window_percent}, {"frames", now.frames}, {"faults", Json::array()}};
  if (!subscription.is_news("b", state)) return;
  router_.send(client, {{"event", "plant"},
                      {"us", now_() / runtime::kMicrosecond},
                      {"stations", Json::object()},
                      {"buses", {{line(), std::move(state)}}}});
}

void DriveBus::turn(bool waits) {
  if (waits) link_.serve(kListens);
  traffic_.settle();
  if (now_() < next_second_) return;
  next_second_ = now_() + runtime::kSecond;
  traffic_.second_passed();
  if (!known_) ask_names();
}

void DriveBus::send(const Router::Call& call) {
  must_write_(call);
  const auto enabling = link_.can_line() != nullptr
                            ? enabling_on_can(call.arguments, !link_.carries_process_data())
                            : enabling_on_serial(call.arguments);
  if (enabling) refuse_unmonitored(link_, *enabling);
  traffic_.send(call.arguments);
  // The next question would talk into the answer.
  link_.serve(link_.can_line() != nullptr ? kListens : kAnswer);
}

}  // namespace ipos::tools::serve
