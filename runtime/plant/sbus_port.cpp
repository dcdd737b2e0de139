// Who of the port's parts gets a frame, and what the user is told.
#include "runtime/plant/sbus_port.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace ipos::runtime {
namespace {

// Tags of frames by the part that sent them.
constexpr uint64_t kSlaveTag = 1;
constexpr uint64_t kMasterTag = 2;
constexpr uint64_t kGroupTag = 3;
constexpr uint64_t kObjectTags = 0x100;  // and above
constexpr uint64_t kAcyclicObjectTags = kObjectTags + ObjectTable::kAcyclicTags;

constexpr MovilinkBus kBuses[] = {MovilinkBus::Sbus, MovilinkBus::Sbus2};

struct SbusParameters {
  std::string_view protocol, address, group, baud, sync_id, second_channel;
};
constexpr SbusParameters kOlder = {"", "813", "814", "816", "817", ""};
constexpr SbusParameters kSbus1 = {"880", "881", "882", "884", "885", "889"};
constexpr SbusParameters kSbus2 = {"890", "891", "892", "894", "895", "899"};

}  // namespace

SbusSettings sbus_settings(const DriveServer& drive, int sbus) {
  const stdlib::Generation generation = drive.unit().generation;
  const SbusParameters& p = generation != stdlib::Generation::B ? kOlder : sbus == 1 ? kSbus1 : kSbus2;
  const auto value = [&](std::string_view number) { return number.empty() ? 0 : drive.value(number); };
  SbusSettings settings;
  settings.slave.address = static_cast<uint8_t>(value(p.address));
  settings.slave.group = static_cast<uint8_t>(value(p.group));
  settings.slave.sync_id = static_cast<uint16_t>(value(p.sync_id) / 1000);  // coded in thousandths
  settings.slave.second_channel = value(p.second_channel) != 0;
  settings.slave.synchronous = generation != stdlib::Generation::M07;
  settings.slave.group_output = sbus != 1 || !sends_over_sbus(drive.value("750"));
  settings.baud = kBaudRates[std::min(static_cast<size_t>(value(p.baud)), kBaudRates.size() - 1)];
  settings.movilink = value(p.protocol) == 0;
  return settings;
}

NodeId SbusPort::connect(CanLine& line, std::optional<NodeId> node, std::string_view station, uint32_t baud,
                         CanNode& port) {
  if (!node) {
    node = line.attach(std::string(station), baud, port);
  } else {
    line.replace(*node, port);
    line.set_baud(*node, baud);
    line.restart(*node);
    line.set_connected(*node, true);
  }
  line.close_filter(*node);  // the parts of the port open it for what they take
  return *node;
}

SbusPort::SbusPort(EventQueue& queue, uint32_t source, CanLine& line, std::optional<NodeId> node, int sbus,
                   std::string_view station, const SbusSettings& settings, DriveServer& drive,
                   MovilinkCommand& movilink, Journal& journal)
    : sender_(line, connect(line, node, station, settings.baud, *this)),
      objects_(drive.unit(), settings.baud, sender_, kObjectTags, sbus),
      line_(line),
      station_(station),
      settings_(settings),
      drive_(drive),
      journal_(journal),
      slave_(queue, source, sender_, kSlaveTag, settings.slave, {}, drive, drive, this),
      movilink_(movilink),
      bus_(kBuses[sbus - 1]),
      master_(queue, source, sender_, kMasterTag, kSbusReplyTimeout, movilink.client(bus_)),
      group_master_(sender_, kGroupTag, drive) {
  movilink.connect(bus_, master_);
  objects_.set_profile(settings.slave);
  // Master/slave operation is a matter of SBus 1 (MDX60B/61B chapter 5.5.1).
  if (std::string why =
          group_master_.configure(sbus == 1 ? drive.value("750") : 0, settings.slave.group, settings.baud);
      !why.empty())
    note(queue.now(), Weight::Warning, std::move(why));
  leads_ = group_master_.active();
}

void SbusPort::note(Time now, Weight weight, std::string text) {
  journal_.note(now, weight, station_, std::move(text));
}

void SbusPort::stop_program() { objects_.stop(); }

void SbusPort::power_off() {
  objects_.stop();
  variables_ = {};
  line_.set_connected(node(), false);
}

void SbusPort::on_frame(Time now, const Frame& frame) {
  if (drive_.late() && keeps(frame)) return;
  drive_.catch_up();
  if (master_.busy() && master_.on_frame(now, frame)) return tell_shared(now, frame);
  const bool received = !variables_.empty() && receive(now, frame);
  // A receive object with the sync identifier takes nothing away from the drive.
  if (!received || slave_.is_sync(frame)) slave_.on_frame(now, frame);
  if (drive_.has_reasons()) tell_reasons(now);
}

// It is for variables alone and can wait until the program has come so far.
bool SbusPort::keeps(const Frame& frame) {
  if (variables_.empty() || master_.busy() || slave_.is_sync(frame)) return false;
  const auto receiver = objects_.receiver(frame);
  return receiver && objects_.fits(*receiver, frame) && drive_.keep(*this, *receiver, frame);
}

void SbusPort::tell_reasons(Time now) {
  if (std::string refused = drive_.take_reason(); !refused.empty())
    note(now, Weight::Why, "refused " + std::move(refused));
  for (std::string& obstacle : drive_.take_obstacles()) note(now, Weight::Why, std::move(obstacle));
}

void SbusPort::want_again() {
  if (!std::exchange(rests_, false)) return;
  objects_.each_received(
      [this](uint32_t id, uint32_t /*data*/, VariableFormat /*format*/) { line_.want_again(node(), id); });
}

// An object with an identifier of the unit's own MOVLNK (1053 1610 p. 51, rule 2).
void SbusPort::tell_shared(Time now, const Frame& frame) {
  const ObjectDefinition* object = objects_.object(frame.id);
  const auto identifier = classify_identifier(frame.id);
  if (object == nullptr || !identifier) return;
  const bool receives = object->kind == ObjectKind::Receive;
  note(now, Weight::Warning,
       fmt::format(
           "object {} has the identifier of a telegram of this unit's own MOVLNK, {} of {} {}{}", frame.id,
           telegram_type(identifier->telegram).text,
           telegram_type(identifier->telegram).grouped ? "group" : "address", identifier->address,
           receives ? ": the telegram does not reach the receive object" : ": the identifier is used twice"));
}

// A receive object takes the frame. One that brings the values that are there already wakes nobody.
bool SbusPort::receive(Time now, const Frame& frame) {
  const auto receiver = objects_.receiver(frame);
  if (!receiver) return false;
  const bool steady = drive_.make_up_variables();
  if (objects_.has_taken(*receiver, frame, variables_)) {
    if (steady && !master_.busy() && !slave_.is_sync(frame)) {
      line_.rest(node(), frame);
      rests_ = true;
    }
    return true;
  }
  drive_.expect_variables(objects_.data_of(*receiver));
  std::string why;
  const bool taken = objects_.on_frame(frame, variables_, why);
  if (!why.empty()) note(now, Weight::Warning, std::move(why));
  return taken;
}

void SbusPort::on_sent(Time now, const Frame& frame, uint64_t tag) {
  if (tag == kMasterTag) {
    master_.on_sent(now, tag);
    tell_shared(now, frame);
  }
  if (tag < kAcyclicObjectTags || variables_.empty()) return;
  drive_.wake();
  objects_.on_sent(tag, variables_);
}

void SbusPort::on_not_sent(Time /*now*/, const Frame& /*frame*/, uint64_t tag, NotSent reason) {
  // A disturbed frame is sent again by the controller; nobody else learns of it.
  if (tag < kAcyclicObjectTags || variables_.empty() || reason == NotSent::Corrupted) return;
  drive_.wake();
  objects_.on_not_sent(tag, variables_);
}

// No manual says what a drive does; it asks its controller to come back at once (ours).
void SbusPort::on_bus_off(Time /*now*/) { sender_.recover(); }

void SbusPort::on_ignored(Time now, const Frame& frame, Ignored reason, ReturnCode code) {
  std::string text = fmt::format("SBus telegram {} {}", frame.id, ignored_text(reason));
  if (code != ReturnCode{}) text += fmt::format(" ({})", describe(code));
  note(now, Weight::Why, std::move(text));
}

}  // namespace ipos::runtime
