// MOVLNK over RS-485. Nothing is taken from a response but what the handshake confirms; so a slave that was
// switched off meanwhile cannot make an old answer look like a new one.
#include "runtime/bus/movilink/serial_master.hpp"

#include <cassert>
#include <utility>

namespace ipos::runtime {

SerialMaster::SerialMaster(EventQueue& queue, SerialRequester& requester, MovilinkClient& client)
    : queue_(queue), requester_(requester), client_(client) {}

std::optional<ReturnCode> SerialMaster::start(Time now, const MovilinkJob& job) {
  assert(!busy());
  const auto format = telegram_format(job.format);
  if (!format || job.address < 0 || job.address > kBroadcastAddress) return return_codes::kWrongManagement;
  const auto address = static_cast<uint8_t>(job.address);
  const AddressKind kind = address_kind(address);
  if (kind == AddressKind::None || kind == AddressKind::Local) return return_codes::kWrongManagement;
  if (format->parameter && !has_valid_parameter(job, !is_answered(address)))
    return return_codes::kWrongManagement;
  telegram_ = {};
  telegram_.address = address;
  telegram_.format = *format;
  service_ = format->parameter ? parameter_request(job) : ParameterTelegram{};
  for (size_t n = 0; n < format->words; ++n) telegram_.words[n] = static_cast<uint16_t>(job.output[n]);
  if (!format->parameter || format->acyclic)
    request(now, Step::Single, false);
  else if (!is_answered(address))
    request(now, Step::Prepare, false);
  else if (known_[address])
    request(now, Step::Prepare, *known_[address]);
  else
    request(now, Step::Learn, false);
  return std::nullopt;
}

void SerialMaster::abort() {
  if (busy()) known_[telegram_.address].reset();
  step_ = Step::Idle;
  requester_.abort(queue_.now(), *this);
}

void SerialMaster::request(Time now, Step step, bool bit) {
  if (step != step_) begun_ = now;
  step_ = step;
  bit_ = bit;
  telegram_.parameter = service_;
  // What the bit of the slave is, shows by a service that does nothing.
  if (step == Step::Learn) telegram_.parameter = parameter_request(Service::None, 0, 0, 0);
  if (bit) telegram_.parameter.management |= management::kHandshake;
  requester_.start(now, telegram_, *this);
}

void SerialMaster::on_request_done(Time now, RequestEnd end, const SerialTelegram* response) {
  if (end != RequestEnd::Answered && end != RequestEnd::Sent) return fail(now, request_end_text(end));
  advance(now, response);
}

void SerialMaster::advance(Time now, const SerialTelegram* response) {
  if (step_ == Step::Single) return finish(now, response);
  if (response == nullptr) {  // a group: both values of the bit, so one of them is a change for every member
    known_ = {};
    return step_ == Step::Prepare ? request(now, Step::Hand, true) : finish(now, nullptr);
  }
  if (response->parameter.synchronous() != bit_) {
    if (now - begun_ >= kHandshakeTimeout) return fail(now, "the handshake bit did not come back");
    return request(now, step_, bit_);
  }
  switch (step_) {
    case Step::Learn: return request(now, Step::Prepare, bit_);
    case Step::Prepare: return request(now, Step::Hand, !bit_);
    case Step::Hand: known_[telegram_.address] = bit_; return finish(now, response);
    case Step::Idle:
    case Step::Single: return;
  }
}

void SerialMaster::finish(Time now, const SerialTelegram* response) {
  MovilinkResult result;
  if (response != nullptr) {
    const TelegramFormat format = telegram_.format;
    const ParameterTelegram& channel = response->parameter;
    if (format.parameter &&
        (channel.service_code() != service_.service_code() || channel.index != service_.index))
      return fail(now, "the response is to another parameter");
    if (format.parameter && channel.failed())
      result.result = channel.return_code().packed();
    else if (format.parameter && !is_write(static_cast<Service>(service_.service_code())))
      result.read_value = static_cast<int32_t>(channel.data);
    if (result.result == 0) result.words = format.words;
    for (size_t n = 0; n < result.words; ++n) result.input[n] = static_cast<int16_t>(response->words[n]);
  }
  step_ = Step::Idle;
  client_.on_exchange_done(now, result);
}

void SerialMaster::fail(Time now, std::string_view reason) {
  known_[telegram_.address].reset();
  step_ = Step::Idle;
  MovilinkResult result;
  result.result = return_codes::kCommunication.packed();
  result.reason = reason;
  client_.on_exchange_done(now, result);
}

}  // namespace ipos::runtime
