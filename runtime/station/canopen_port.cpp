// What the messages of a CANopen line do in the unit, and what the user is told.
#include "runtime/station/canopen_port.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>

#include "runtime/bus/can/identifier_text.hpp"

namespace ipos::runtime {
namespace {

constexpr uint64_t kNodeObjectTags = 0x100;  // of frames, and above; the node has those from 1 on
constexpr uint64_t kNodeAcyclicTags = kNodeObjectTags + ObjectTable::kAcyclicTags;
static_assert(1 + canopen::kTags <= kNodeObjectTags);

// Variable telegrams do not depend on the profile (chapter 5.5.3 of 11264926); over CANopen no identifier is closed to
// them (ours).
constexpr uint8_t kNobody = 0xFF;
const SlaveSettings kNoMovilink = [] {
  SlaveSettings settings;
  settings.address = settings.group = kNobody;
  settings.synchronous = settings.second_channel = false;
  return settings;
}();

constexpr uint16_t kFaultBit = 1U << 5;                   // of status word 1
constexpr uint8_t kSbusTimeout = 47, kSbus2Timeout = 46;  // with the responses of P836 and P837

}  // namespace

CanopenPort::CanopenPort(EventQueue& queue, uint32_t source, CanLine& line, std::optional<NodeId> node,
                         int sbus, std::string_view station, const SbusSettings& settings, Door& door,
                         Journal& journal)
    : door_(door),
      sender_(line, join(line, node, station, settings.baud, *this)),
      objects_(door.touch().server().unit(), settings.baud, sender_, kNodeObjectTags, sbus),
      line_(line),
      sbus_(sbus),
      station_(station),
      settings_(settings),
      journal_(journal),
      server_(door, sbus == 1) {
  door.touch().connect(sbus, objects_);
  objects_.set_profile(kNoMovilink);
  const canopen::Place place{queue, source, sender_, 1};
  canopen::Unit& unit = *this;
  canopen::NodeObserver* observer = this;
  node_.emplace(place, settings.canopen_address, door.look().server().unit(), canopen::NodeTiming{}, server_,
                unit, observer);
  node_->start(queue.now());
}

void CanopenPort::power_off() {
  objects_.stop();
  node_.reset();  // and what it waits for
  line_.set_connected(node(), false);
}

void CanopenPort::on_frame(Time now, const Frame& frame) {
  if (!node_) return;
  receive(now, frame);
  node_->on_frame(now, frame);
  if (!door_.has_reasons()) return;
  for (std::string& reason : server_.take_reasons()) note(now, Weight::Why, std::move(reason));
}

// A receive object takes the frame; the node may, too (ours).
void CanopenPort::receive(Time now, const Frame& frame) {
  const auto receiver = objects_.receiver(frame);
  if (!receiver || door_.variables().empty()) return;
  std::string why;
  objects_.on_frame(frame, door_.variables_to_write(objects_.data_of(*receiver)), why);
  if (!why.empty()) note(now, Weight::Warning, std::move(why));
}

void CanopenPort::on_sent(Time /*now*/, const Frame& /*frame*/, uint64_t tag) {
  if (tag < kNodeAcyclicTags) return;
  if (const auto variables = door_.touch().variables(); !variables.empty()) objects_.on_sent(tag, variables);
}

// As over MOVILINK: a disturbed frame is sent again by the controller.
void CanopenPort::on_not_sent(Time /*now*/, const Frame& /*frame*/, uint64_t tag, NotSent reason) {
  if (tag < kNodeAcyclicTags || reason == NotSent::Corrupted || !node_) return;
  if (const auto variables = door_.touch().variables(); !variables.empty())
    objects_.on_not_sent(tag, variables);
}

void CanopenPort::note(Time now, Weight weight, std::string text) {
  journal_.note(now, weight, station_, std::move(text));
}

void CanopenPort::take_output(Time now, const canopen::Words& words, uint16_t written) {
  size_t count = 0;
  canopen::each_word(written, [&](size_t n) {
    output_[n] = words[n];
    count = n + 1;
  });
  if (count == 0) return;
  exchanges_ = true;
  server_.take_output(now, OutputChannel::Single, std::span(output_).first(count));
}

canopen::Words CanopenPort::input(Time /*now*/, uint16_t which) {
  canopen::Words words{};
  const Drive& drive = door_.look().drive();
  canopen::each_word(which, [&](size_t n) {
    words[n] = n < kProcessWords ? drive.pi_word(n) : drive.further_pi()[n - kProcessWords];
  });
  return words;
}

canopen::UnitStatus CanopenPort::status(Time /*now*/) {
  const Drive& drive = door_.look().drive();
  const uint16_t status = drive.status_word_1();
  return {status, (status & kFaultBit) != 0, drive.runs_on_24v()};
}

// After operational the drive stops rapidly until process data come again (ours): control word and setpoints 0.
void CanopenPort::state_changed(Time now, canopen::State state) {
  if (canopen::has_pdo(state) || !std::exchange(exchanges_, false)) return;
  output_ = {};
  server_.take_output(now, OutputChannel::Single, output_);
  note(now, Weight::Why,
       fmt::format("CANopen: the node is {} and exchanges no process data: they count as 0",
                   canopen::state_text(static_cast<uint8_t>(state))));
}

void CanopenPort::reset_node(Time now) {
  note(now, Weight::Why, "CANopen: reset node resets the communication; the drive goes on");
}

void CanopenPort::partner_lost(Time now) {
  note(now, Weight::Warning,
       fmt::format("CANopen: guarding or heartbeat of the master stayed away on SBus {}", sbus_));
  door_.touch().drive().raise_fault(sbus_ == 1 ? kSbusTimeout : kSbus2Timeout);
}

void CanopenPort::partner_back(Time now) {
  note(now, Weight::Why,
       fmt::format("CANopen: guarding or heartbeat of the master is back on SBus {}", sbus_));
}

void CanopenPort::on_ignored(Time now, const Frame& frame, canopen::IgnoredMessage reason) {
  note(now, Weight::Why,
       fmt::format("CANopen message {} {}", id_words(frame.id), canopen::ignored_text(reason)));
}

}  // namespace ipos::runtime
