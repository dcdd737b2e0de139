// RS-485 slave. The parameter channel is carried out before the process data, as they stand in the PDU
// (ours); the answer takes input words and handshake bit at the moment it is sent.
#include "runtime/bus/movilink/serial_slave.hpp"

#include <utility>

namespace ipos::runtime {
namespace {

enum SerialSlaveEvent : uint32_t { kAnswer, kLink };

}  // namespace

SerialSlave::SerialSlave(EventQueue& queue, uint32_t source, SerialSender& sender,
                         SerialSlaveSettings settings, SerialSlaveTiming timing, ParameterServer& parameters,
                         ProcessDataServer& process_data, MasterSlaveDrive& drive,
                         SerialSlaveObserver* observer)
    : queue_(queue),
      source_(source),
      sender_(sender),
      settings_(settings),
      timing_(timing),
      parameters_(parameters),
      process_data_(process_data),
      drive_(drive),
      observer_(observer),
      cyclic_(parameters, timing.processing) {}

void SerialSlave::on_character(Time now, const Character& character) {
  if (character.start < own_end_) return;
  const auto reception = receiver_.take(character);
  if (!reception) return;
  if (!reception->telegram) return reject(now, *reception, reception->telegram.error());
  if (!reception->telegram->response) take_request(now, *reception);
}

void SerialSlave::on_sent(Time now) {
  own_end_ = now;
  receiver_.occupied(now);
}

bool SerialSlave::is_for_me(uint8_t address) const {
  switch (address_kind(address)) {
    case AddressKind::Single: return address == settings_.address;
    case AddressKind::Group: return address == settings_.group;
    case AddressKind::Universal:
    case AddressKind::Broadcast: return true;
    case AddressKind::NoGroup:
    case AddressKind::Local:
    case AddressKind::None: return false;
  }
  return false;
}

void SerialSlave::take_request(Time now, const Reception& reception) {
  const SerialTelegram& request = *reception.telegram;
  if (!is_for_me(request.address)) return reject(now, reception, SerialError::Address);
  if (settings_.master_here) return ignore(now, request, Ignored::MasterHere);
  const bool answered = is_answered(request.address);
  const std::span<const uint16_t> words(request.words.data(), request.format.words);
  if (settings_.follows_master && address_kind(request.address) == AddressKind::Group &&
      request.format == kSetpointFormat)
    return take_setpoint(now, request.words);
  if (!request.format.acyclic) {
    heard_cyclic_ = true;
    process_data_.cyclic_request(now);
  }
  if (request.format.parameter) take_parameter(now, request, answered);
  if (!words.empty())
    process_data_.take_output(now, answered ? OutputChannel::Single : OutputChannel::Group, words);
  if (!answered) return;
  request_ = request;
  queue_.cancel(answer_);  // the master has not waited for the last one
  answer_ = queue_.schedule(now + timing_.response_delay, source_, *this, kAnswer);
}

// The connection check begins with the first setpoint (ours), as P812 does.
void SerialSlave::take_setpoint(Time now, const ProcessWords& words) {
  queue_.cancel(link_timeout_);
  link_timeout_ = queue_.schedule(now + kLinkTimeout, source_, *this, kLink);
  drive_.setpoint_received(now, words);
}

// Nobody answers a group, so there is nothing to read (p. 21).
void SerialSlave::take_parameter(Time now, const SerialTelegram& request, bool answered) {
  const auto service = service_from_code(request.parameter.service_code());
  if (!answered && service != Service::None && (!service || !is_write(*service)))
    return ignore(now, request, Ignored::GroupService);
  if (request.format.acyclic) {
    const ParameterTelegram result = execute(now, parameters_, request.parameter);
    if (answered) acyclic_answer_ = result;
    if (!answered && result.failed()) ignore(now, request, Ignored::GroupRefused, result.return_code());
  } else if (cyclic_.take(now, request.parameter) && !answered && cyclic_.result().failed()) {
    ignore(now, request, Ignored::GroupRefused, cyclic_.result().return_code());
  }
}

void SerialSlave::on_event(Time now, uint32_t kind, uint64_t /*argument*/) {
  if (kind == kAnswer) return send_answer(now);
  link_timeout_ = kNoEvent;
  if (!settings_.follows_master) return;
  statistics_.count(SerialError::Timeout);
  drive_.link_lost(now);
}

void SerialSlave::send_answer(Time now) {
  answer_ = kNoEvent;
  SerialTelegram response = request_;
  response.response = true;
  if (response.format.parameter)
    response.parameter = response.format.acyclic ? acyclic_answer_ : cyclic_.answer(now, request_.parameter);
  if (response.format.words > 0) response.words = process_data_.input(now);
  sender_.send(encode(response).span());  // a line that is not there reports itself
}

void SerialSlave::reject(Time now, const Reception& reception, SerialError error) {
  statistics_.count(error);
  if (observer_ != nullptr) observer_->on_rejected(now, reception, error);
}

void SerialSlave::ignore(Time now, const SerialTelegram& request, Ignored reason, ReturnCode code) {
  if (observer_ != nullptr) observer_->on_ignored(now, request, reason, code);
}

}  // namespace ipos::runtime
