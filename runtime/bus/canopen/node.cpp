// Which part of a node gets a frame, and what a change of its state brings about.
#include "runtime/bus/canopen/node.hpp"

#include <algorithm>
#include <bit>

#include "runtime/bus/canopen/connections.hpp"

namespace ipos::runtime::canopen {

std::string_view ignored_text(IgnoredMessage reason) {
  static constexpr std::string_view kTexts[] = {
#define IGNORED_MESSAGE(name, text) text,
#include "runtime/bus/canopen/ignored.def"
  };
  return kTexts[static_cast<size_t>(reason)];
}

Node::Node(const Place& place, uint8_t number, const stdlib::UnitType& type, NodeTiming timing,
           ParameterServer& parameters, Unit& unit, NodeObserver* observer)
    : place_(place),
      timing_(timing),
      unit_(unit),
      observer_(observer),
      dictionary_(number),
      access_(dictionary_, type, parameters, unit, state_, *this),
      server_(access_),
      sdo_timeout_(place, *this, 0),
      receive_{
          {{dictionary_, unit, 0}, {dictionary_, unit, 1}, {dictionary_, unit, 2}, {dictionary_, unit, 3}}},
      transmit_{{{place, dictionary_, unit, 0},
                 {place, dictionary_, unit, 1},
                 {place, dictionary_, unit, 2},
                 {place, dictionary_, unit, 3}}},
      emergency_(place, dictionary_, state_),
      error_control_(place, dictionary_, state_, *this) {}

void Node::start(Time now) { reset_communication(now); }

void Node::reset_communication(Time now) {
  state_ = State::BootUp;
  place_.queue.cancel_all(*this);  // answers under way
  for (uint64_t n = 0; n < kTags; ++n) place_.sender.withdraw(place_.tag + n);
  sdo_timeout_.stop();
  server_.reset();
  for (TransmitPdo& pdo : transmit_) pdo.stop();
  dictionary_.restore();
  for (size_t n = 0; n < too_short_.size(); ++n) note_length(now, n, false);
  emergency_.reset();
  for (ReceivePdo& pdo : receive_) pdo.configure();
  for (TransmitPdo& pdo : transmit_) pdo.configure(now);
  listen();
  error_control_.boot_up(now);
  enter(now, State::PreOperational);
}

void Node::enter(Time now, State state) {
  if (state_ == state) return;
  state_ = state;
  for (ReceivePdo& pdo : receive_) pdo.drop();
  unit_.state_changed(now, state);
  for (TransmitPdo& pdo : transmit_)
    if (has_pdo(state))
      pdo.start(now);
    else
      pdo.stop();
  if (!has_sdo(state)) {
    server_.reset();
    sdo_timeout_.stop();
  }
  emergency_.may_send(now);
  unit_.follow_again(now);
}

// What it has listened to before does no harm.
void Node::listen() {
  const uint8_t number = dictionary_.node();
  FrameSender& sender = place_.sender;
  sender.listen(identifier(Connection::Nmt));
  sender.listen(identifier(Connection::SdoRequest, number));
  sender.listen(identifier(Connection::ErrorControl, number));
  sync_id_ = dictionary_.value(objects::kSyncId) & objects::kIdMask;
  sender.listen(sync_id_);
  for (const ReceivePdo& pdo : receive_)
    if (pdo.id()) sender.listen(*pdo.id());
  for (const TransmitPdo& pdo : transmit_)
    if (pdo.id()) sender.listen(*pdo.id());
  if (const auto partner = error_control_.partner())
    sender.listen(identifier(Connection::ErrorControl, *partner));
}

bool Node::on_frame(Time now, const Frame& frame) {
  if (frame.extended) return false;
  if (frame.remote) return take_remote(now, frame);
  const uint8_t number = dictionary_.node();
  bool mine = take_pdo(now, frame);
  if (frame.id == identifier(Connection::Nmt)) {
    take_nmt(now, frame);
    return true;
  }
  if (frame.id == sync_id_) {
    take_sync(now, frame);
    mine = true;
  }
  if (frame.id == identifier(Connection::SdoRequest, number)) {
    take_sdo(now, frame);
    mine = true;
  }
  const auto partner = error_control_.partner();
  if (partner && frame.id == identifier(Connection::ErrorControl, *partner)) {
    error_control_.on_heartbeat(now);
    mine = true;
  }
  return mine;
}

bool Node::take_remote(Time now, const Frame& frame) {
  if (frame.id == identifier(Connection::ErrorControl, dictionary_.node())) {
    if (!error_control_.on_remote(now)) ignore(now, frame, IgnoredMessage::NotGuarded);
    return true;
  }
  bool mine = false;
  for (TransmitPdo& pdo : transmit_)
    if (pdo.id() == frame.id) {
      mine = true;
      if (has_pdo(state_))
        pdo.on_remote(now);
      else
        ignore(now, frame, IgnoredMessage::WrongState);
    }
  return mine;
}

bool Node::take_pdo(Time now, const Frame& frame) {
  bool mine = false;
  for (size_t n = 0; n < receive_.size(); ++n) {
    ReceivePdo& pdo = receive_[n];
    if (pdo.id() != frame.id) continue;
    mine = true;
    if (!has_pdo(state_)) {
      ignore(now, frame, IgnoredMessage::WrongState);
      continue;
    }
    const ReceivePdo::Outcome outcome = pdo.take(now, frame);
    note_length(now, n, outcome == ReceivePdo::Outcome::TooShort);
    if (outcome == ReceivePdo::Outcome::TooShort) ignore(now, frame, IgnoredMessage::PdoTooShort);
    if (outcome == ReceivePdo::Outcome::TooLong) ignore(now, frame, IgnoredMessage::PdoTooLong);
  }
  return mine;
}

// An error until each of them that was too short has come long enough, or is received no more (that it ends so is ours).
void Node::note_length(Time now, size_t pdo, bool too_short) {
  if (too_short_[pdo] == too_short) return;
  too_short_[pdo] = too_short;
  const bool any = std::find(too_short_.begin(), too_short_.end(), true) != too_short_.end();
  emergency_.set(now, Cause::PdoTooShort, any, unit_.status(now).status_word_1);
}

void Node::take_nmt(Time now, const Frame& frame) {
  if (frame.length != 2) return ignore(now, frame, IgnoredMessage::WrongLength);
  if (frame.data[1] != 0 && frame.data[1] != dictionary_.node()) return;
  switch (static_cast<NmtCommand>(frame.data[0])) {
    case NmtCommand::Start: return enter(now, State::Operational);
    case NmtCommand::Stop: return enter(now, State::Stopped);
    case NmtCommand::EnterPreOperational: return enter(now, State::PreOperational);
    case NmtCommand::ResetNode: unit_.reset_node(now); return reset_communication(now);
    case NmtCommand::ResetCommunication: return reset_communication(now);
  }
  ignore(now, frame, IgnoredMessage::WrongCommand);
}

// What is sent is sampled before what was received acts.
void Node::take_sync(Time now, const Frame& frame) {
  if (frame.length != 0) return ignore(now, frame, IgnoredMessage::WrongLength);
  if (!has_sync(state_)) return ignore(now, frame, IgnoredMessage::WrongState);
  for (TransmitPdo& pdo : transmit_) pdo.on_sync(now);
  for (ReceivePdo& pdo : receive_) pdo.on_sync(now);
  unit_.synchronize(now);
}

void Node::take_sdo(Time now, const Frame& frame) {
  if (!has_sdo(state_)) return ignore(now, frame, IgnoredMessage::WrongState);
  if (frame.length != 8) return ignore(now, frame, IgnoredMessage::WrongLength);
  const auto answer = server_.take(now, frame.data);
  if (server_.is_busy())
    sdo_timeout_.start(now + timing_.sdo_timeout);
  else
    sdo_timeout_.stop();
  if (answer)
    place_.queue.schedule(now + timing_.sdo_delay, place_.source, *this, 0, std::bit_cast<uint64_t>(*answer));
}

// An answer is due; the node may have been stopped since the request.
void Node::on_event(Time /*now*/, uint32_t /*kind*/, uint64_t argument) {
  if (has_sdo(state_)) send_sdo(std::bit_cast<SdoBytes>(argument));
}

void Node::on_timer(Time /*now*/, uint32_t /*kind*/) { send_sdo(server_.expire()); }

void Node::send_sdo(const SdoBytes& bytes) {
  place_.sender.send({identifier(Connection::SdoResponse, dictionary_.node()), 8, bytes}, place_.tag);
}

void Node::on_written(Time now, Address address, Rule rule) {
  if (rule == Rule::Output) {
    Words words{};
    const auto word = static_cast<unsigned>(address.sub - 1);
    words[word] = static_cast<uint16_t>(dictionary_.value(address.index, address.sub));
    return unit_.take_output(now, words, static_cast<uint16_t>(1U << word));
  }
  if (rule == Rule::ErrorCount) {
    for (const ObjectDictionary::Entry& entry : dictionary_.entries())
      if (entry.address.index == objects::kErrorField) dictionary_.set(entry.address, 0);
    return;
  }
  const uint16_t index = address.index;
  const auto pdo = static_cast<size_t>(index % objects::kPdos);
  if (index >= objects::kReceivePdo && index < objects::kTransmitPdo) {
    receive_[pdo].configure();
    note_length(now, pdo, false);
  } else if (index >= objects::kTransmitPdo && index < objects::kOutput) {
    transmit_[pdo].configure(now);
    unit_.follow_again(now);
  } else if (index == objects::kEmergencyId || index == objects::kEmergencyInhibit)
    emergency_.may_send(now);
  else
    error_control_.configure(now);
  listen();
}

void Node::on_partner(Time now, bool lost) {
  emergency_.set(now, Cause::PartnerLost, lost, unit_.status(now).status_word_1);
  if (lost)
    unit_.partner_lost(now);
  else
    unit_.partner_back(now);
}

void Node::unit_changed(Time now) {
  const UnitStatus status = unit_.status(now);
  emergency_.set(now, Cause::Fault, status.fault, status.status_word_1);
  emergency_.set(now, Cause::MainsMissing, status.mains_missing, status.status_word_1);
  unsigned which = 0;
  for (const TransmitPdo& pdo : transmit_)
    if (pdo.sends_on_change()) which |= pdo.words();
  if (which == 0) return;
  const Words words = unit_.input(now, static_cast<uint16_t>(which));
  for (TransmitPdo& pdo : transmit_) pdo.inputs_changed(now, words);
}

void Node::ignore(Time now, const Frame& frame, IgnoredMessage reason) {
  if (observer_ != nullptr) observer_->on_ignored(now, frame, reason);
}

}  // namespace ipos::runtime::canopen
