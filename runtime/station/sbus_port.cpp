// Who of the port's parts gets a frame, and what the user is told.
#include "runtime/station/sbus_port.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "runtime/bus/can/identifier_text.hpp"

namespace ipos::runtime {
namespace {

// Tags of frames by the part that sent them.
constexpr uint64_t kSlaveTag = 1;
constexpr uint64_t kMasterTag = 2;
constexpr uint64_t kGroupTag = 3;
constexpr uint64_t kClientTag = 4;
constexpr uint64_t kObjectTags = 0x100;  // and above
constexpr uint64_t kAcyclicObjectTags = kObjectTags + ObjectTable::kAcyclicTags;

constexpr MovilinkBus kBuses[] = {MovilinkBus::Sbus, MovilinkBus::Sbus2};

constexpr SbusNumbers kOlder = {"", "813", "814", "816", "817", "", ""};
constexpr SbusNumbers kSbus1 = {"880", "881", "882", "884", "885", "889", "886"};
constexpr SbusNumbers kSbus2 = {"890", "891", "892", "894", "895", "899", "896"};

}  // namespace

const SbusNumbers& sbus_numbers(const stdlib::UnitType& unit, int sbus) {
  return !unit.has(stdlib::Trait::NewSbusNumbers) ? kOlder : sbus == 1 ? kSbus1 : kSbus2;
}

SbusSettings sbus_settings(const UnitInterface& drive, int sbus) {
  const stdlib::UnitType& unit = drive.unit();
  const SbusNumbers& p = sbus_numbers(unit, sbus);
  const auto value = [&](std::string_view number) { return number.empty() ? 0 : drive.value(number); };
  SbusSettings settings;
  settings.slave.address = static_cast<uint8_t>(value(p.address));
  settings.slave.group = static_cast<uint8_t>(value(p.group));
  settings.slave.sync_id = static_cast<uint16_t>(value(p.sync_id) / 1000);  // coded in thousandths
  settings.slave.second_channel = value(p.second_channel) != 0;
  settings.slave.synchronous = unit.has(stdlib::Trait::SynchronousSbus);
  settings.slave.group_output = sbus != 1 || !sends_over_sbus(drive.value("750"));
  settings.baud = kBaudRates[std::min(static_cast<size_t>(value(p.baud)), kBaudRates.size() - 1)];
  settings.movilink = value(p.protocol) == 0;
  settings.canopen_address = static_cast<uint8_t>(value(p.canopen_address));
  return settings;
}

NodeId join(CanLine& line, std::optional<NodeId> node, std::string_view station, uint32_t baud,
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
                   std::string_view station, const SbusSettings& settings, Door& door, Journal& journal)
    : source_(source),
      door_(door),
      sender_(line, join(line, node, station, settings.baud, *this)),
      objects_(door.touch().server().unit(), settings.baud, sender_, kObjectTags, sbus),
      line_(line),
      station_(station),
      settings_(settings),
      journal_(journal),
      server_(door, sbus == 1),
      slave_(queue, source, sender_, kSlaveTag, settings.slave, {}, server_, server_, this),
      movilink_(door.touch().movilink()),
      bus_(kBuses[sbus - 1]),
      exchanges_(door, door.touch().movilink().client(bus_)),
      master_(queue, source, sender_, kMasterTag, kSbusReplyTimeout, exchanges_),
      client_exchanges_(door, door.touch().movilink().client(MovilinkBus::Canopen)),
      group_master_(sender_, kGroupTag, server_) {
  Unit& unit = door.touch();
  unit.movilink().connect(bus_, master_);
  if (unit.server().unit().has(stdlib::Trait::CanopenClient)) {
    client_.emplace(canopen::Place{queue, source, sender_, kClientTag}, kSbusReplyTimeout, client_exchanges_);
    unit.movilink().connect(MovilinkBus::Canopen, *client_);
  }
  unit.connect(sbus, objects_);
  objects_.set_profile(settings.slave);
  // Master/slave operation is a matter of SBus 1 (MDX60B/61B chapter 5.5.1).
  if (std::string why = group_master_.configure(sbus == 1 ? unit.server().value("750") : 0,
                                                settings.slave.group, settings.baud);
      !why.empty())
    note(queue.now(), Weight::Warning, std::move(why));
}

void SbusPort::note(Time now, Weight weight, std::string text) {
  journal_.note(now, weight, station_, std::move(text));
}

Time SbusPort::lead(Time now) {
  group_master_.tick(now);
  objects_.tick(door_.milliseconds().number(now), door_.variables_in_turn());
  return now + door_.milliseconds().length();
}

// Where all of its objects find room with the line.
Time SbusPort::tick_at_rest(Time now, Time until) {
  const Time next = tick(now);
  StandingFrames& standing = line_.standing();
  const OwnMilliseconds& own = door_.milliseconds();
  if (next >= until || !own.is_exact() || !standing.has_room(objects_.sending())) return next;
  objects_.leave(door_.variables_in_turn(), [&](uint32_t tag, const Frame& frame, int64_t due, uint32_t cycle) {
    standing.add({own.begin_of(due, now), until, frame, tag, cycle, source_, node()});
  });
  line_sends_ = true;
  return kNever;
}

void SbusPort::take_back() {
  line_.standing().remove(node());
  objects_.take_back();
}

void SbusPort::power_off() {
  objects_.stop();
  powered_ = false;
  line_.set_connected(node(), false);
}

void SbusPort::on_frame(Time now, const Frame& frame) {
  if (waits(frame)) return;
  if (master_.busy() && master_.on_frame(now, frame)) return tell_shared(now, frame);
  if (client_ && client_->busy() && client_->on_frame(now, frame)) return;
  const bool received = receive(now, frame);
  // A receive object with the sync identifier takes nothing away from the drive.
  if (!received || slave_.is_sync(frame)) slave_.on_frame(now, frame);
  tell_reasons(now);
}

// It is for variables alone and can wait until the program has come so far.
bool SbusPort::waits(const Frame& frame) {
  if (!door_.is_behind() || calls() || slave_.is_sync(frame)) return false;
  const auto receiver = objects_.receiver(frame);
  return receiver && objects_.fits(*receiver, frame) &&
         door_.post(*this, *receiver, {frame.data, frame.length});
}

void SbusPort::read(size_t object, const TelegramData& data) {
  objects_.take(object, Frame(0, data.length, data.bytes), door_.variables_in_turn());
}

void SbusPort::tell_reasons(Time now) {
  for (std::string& reason : server_.take_reasons()) note(now, Weight::Why, std::move(reason));
}

void SbusPort::want_each_again() {
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
           "object {} has the identifier of a telegram of this unit's own MOVLNK, {} of {} {}{}",
           id_words(frame.id), telegram_type(identifier->telegram).text,
           telegram_type(identifier->telegram).grouped ? "group" : "address", identifier->address,
           receives ? ": the telegram does not reach the receive object" : ": the identifier is used twice"));
}

// A receive object takes the frame. One that brings the values that are there already changes nothing.
bool SbusPort::receive(Time now, const Frame& frame) {
  const auto receiver = objects_.receiver(frame);
  if (!receiver) return false;
  const std::span<const int32_t> variables = door_.variables();
  if (variables.empty()) return false;
  if (objects_.has_taken(*receiver, frame, variables)) {
    if (door_.variables_rest() && !calls() && !slave_.is_sync(frame)) {
      line_.rest(node(), frame);
      rests_ = true;
    }
    return true;
  }
  std::string why;
  const bool taken = objects_.on_frame(frame, door_.variables_to_write(objects_.data_of(*receiver)), why);
  if (!why.empty()) note(now, Weight::Warning, std::move(why));
  return taken;
}

void SbusPort::on_sent(Time now, const Frame& frame, uint64_t tag) {
  if (kObjectTags <= tag && tag < kAcyclicObjectTags) return;  // nobody waits for a cyclic object
  if (tag == kMasterTag) {
    master_.on_sent(now, tag);
    tell_shared(now, frame);
  }
  if (tag < kAcyclicObjectTags) return;
  if (const auto variables = door_.touch().variables(); !variables.empty()) objects_.on_sent(tag, variables);
}

void SbusPort::on_not_sent(Time /*now*/, const Frame& /*frame*/, uint64_t tag, NotSent reason) {
  // A disturbed frame is sent again by the controller; nobody else learns of it.
  if (tag < kAcyclicObjectTags || reason == NotSent::Corrupted || !powered_) return;
  if (const auto variables = door_.touch().variables(); !variables.empty())
    objects_.on_not_sent(tag, variables);
}

// No manual says what a drive does; it asks its controller to come back at once (ours).
void SbusPort::on_bus_off(Time /*now*/) { sender_.recover(); }

void SbusPort::on_ignored(Time now, const Frame& frame, Ignored reason, ReturnCode code) {
  std::string text = fmt::format("SBus telegram {} {}", id_words(frame.id), ignored_text(reason));
  if (code != ReturnCode{}) text += fmt::format(" ({})", describe(code));
  note(now, Weight::Why, std::move(text));
}

}  // namespace ipos::runtime
