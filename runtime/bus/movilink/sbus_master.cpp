// SBus master. After a refused parameter the process data still go out, as both travel in one telegram on
// RS-485; after a missing answer the exchange ends (both ours).
#include "runtime/bus/movilink/sbus_master.hpp"

#include <cassert>

#include "runtime/bus/movilink/identifiers.hpp"

namespace ipos::runtime {

SbusMaster::SbusMaster(EventQueue& queue, uint32_t source, FrameSender& sender, uint64_t tag, Time timeout,
                       MovilinkClient& client)
    : queue_(queue), source_(source), sender_(sender), tag_(tag), timeout_(timeout), client_(client) {}

std::optional<ReturnCode> SbusMaster::start(Time now, const MovilinkJob& job) {
  assert(!busy());
  const auto format = telegram_format(job.format);
  const bool group = job.address >= kGroupAddressBase;
  const int32_t address = group ? job.address - kGroupAddressBase : job.address;
  if (!format || address < 0 || address >= kSbusAddresses) return return_codes::kWrongManagement;
  if (format->parameter) {
    if (!has_valid_parameter(job, group)) return return_codes::kWrongManagement;
    request_ = parameter_request(job);
  }
  format_ = *format;
  group_ = group;
  address_ = static_cast<uint8_t>(address);
  result_ = {};
  if (!group) {
    sender_.listen(sbus_identifier(Telegram::ParameterResponse, address_));
    sender_.listen(sbus_identifier(Telegram::ProcessInput, address_));
  }
  // SBus always carries three words: those beyond the format are 0.
  output_ = {};
  for (size_t i = 0; i < format_.words; ++i) output_[i] = static_cast<uint16_t>(job.output[i]);
  if (format_.parameter)
    send_request(now);
  else
    send_output(now);
  return std::nullopt;
}

void SbusMaster::abort() {
  queue_.cancel(timer_);
  if (busy()) sender_.withdraw(tag_);
  step_ = Step::Idle;
}

void SbusMaster::await(Time now, Step step) {
  queue_.cancel(timer_);
  timer_ = queue_.schedule(now + timeout_, source_, *this, 0);
  step_ = step;
}

// A frame the line does not take is not an error of its own: no answer will come.
void SbusMaster::send_request(Time now) {
  Frame frame;
  frame.id = sbus_identifier(group_ ? Telegram::GroupParameterRequest : Telegram::ParameterRequest, address_);
  frame.length = 8;
  frame.data = encode(request_);
  sender_.send(frame, tag_);
  await(now, Step::Parameter);
}

void SbusMaster::send_output(Time now) {
  const Telegram telegram = group_ ? Telegram::GroupProcessOutput : Telegram::ProcessOutput;
  sender_.send(process_frame(sbus_identifier(telegram, address_), output_), tag_);
  await(now, Step::Process);
}

bool SbusMaster::on_frame(Time now, const Frame& frame) {
  if (group_ || !is_plain(frame)) return false;
  if (step_ == Step::Parameter) {
    const ParameterTelegram response = decode_parameter(frame.data);
    if (frame.id != sbus_identifier(Telegram::ParameterResponse, address_) || frame.length != 8 ||
        response.service_code() != request_.service_code() || response.index != request_.index)
      return false;  // for example the late answer to an earlier request
    if (response.failed())
      result_.result = response.return_code().packed();
    else if (!is_write(static_cast<Service>(request_.service_code())))
      result_.read_value = static_cast<int32_t>(response.data);
    finish_parameter(now);
    return true;
  }
  const auto words = process_words(frame);
  if (step_ != Step::Process || frame.id != sbus_identifier(Telegram::ProcessInput, address_) || !words)
    return false;
  result_.words = format_.words;
  for (size_t i = 0; i < words->size(); ++i) result_.input[i] = static_cast<int16_t>((*words)[i]);
  finish(now);
  return true;
}

void SbusMaster::on_sent(Time now, uint64_t tag) {
  if (!group_ || tag != tag_) return;
  if (step_ == Step::Parameter)
    finish_parameter(now);
  else if (step_ == Step::Process)
    finish(now);
}

void SbusMaster::finish_parameter(Time now) {
  if (format_.words > 0)
    send_output(now);
  else
    finish(now);
}

void SbusMaster::on_event(Time now, uint32_t, uint64_t) {
  sender_.withdraw(tag_);
  result_.result = return_codes::kCommunication.packed();
  result_.reason = "no answer";
  finish(now);
}

void SbusMaster::finish(Time now) {
  queue_.cancel(timer_);
  step_ = Step::Idle;
  if (result_.result != 0) {
    result_.read_value.reset();
    result_.words = 0;
  }
  client_.on_exchange_done(now, result_);
}

}  // namespace ipos::runtime
