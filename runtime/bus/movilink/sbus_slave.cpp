// SBus slave. A request is executed on reception; only its answer waits, for the delay or the sync telegram
// (1053 1610 p. 45). Answers to PO take the input words at the moment they are sent.
#include "runtime/bus/movilink/sbus_slave.hpp"

namespace ipos::runtime {
namespace {

enum SlaveEvent : uint32_t { kSendInput, kSendResponse, kSendResponse2 };

constexpr Telegram kResponses[] = {Telegram::ParameterResponse, Telegram::ParameterResponse2};

// A response travels as the argument of its event: the slave needs no list of answers under way.
uint64_t pack(const ParameterTelegram& telegram) {
  uint64_t packed = 0;
  for (uint8_t byte : encode(telegram)) packed = packed << 8 | byte;
  return packed;
}

ParameterBytes unpack(uint64_t packed) {
  ParameterBytes bytes{};
  for (size_t i = bytes.size(); i-- > 0; packed >>= 8) bytes[i] = static_cast<uint8_t>(packed);
  return bytes;
}

}  // namespace

SbusSlave::SbusSlave(EventQueue& queue, uint32_t source, FrameSender& sender, uint64_t tag,
                     SlaveSettings settings, SlaveTiming timing, ParameterServer& parameters,
                     ProcessDataServer& process_data, SlaveObserver* observer)
    : queue_(queue),
      source_(source),
      sender_(sender),
      tag_(tag),
      settings_(settings),
      timing_(timing),
      parameters_(parameters),
      process_data_(process_data),
      observer_(observer) {
  listen();
}

void SbusSlave::configure(SlaveSettings settings) {
  settings_ = settings;
  listen();
  sync_output_.reset();
  sync_responses_ = {};
}

bool SbusSlave::is_sync(const Frame& frame) const {
  return settings_.synchronous && frame.id == settings_.sync_id;
}

bool SbusSlave::is_movilink(uint32_t id) const {
  const auto identifier = classify_identifier(id);
  return identifier && telegram_type(identifier->telegram).from_master &&
         identifier->address ==
             (telegram_type(identifier->telegram).grouped ? settings_.group : settings_.address) &&
         has_telegram(settings_, identifier->telegram);
}

void SbusSlave::listen() {
  for (const TelegramType& type : kTelegrams) {
    const uint32_t id = sbus_identifier(type.telegram, type.grouped ? settings_.group : settings_.address);
    if (is_movilink(id)) sender_.listen(id);
  }
  if (settings_.synchronous) sender_.listen(settings_.sync_id);
}

bool SbusSlave::on_frame(Time now, const Frame& frame) {
  const bool movilink = is_movilink(frame.id);
  if (!movilink && !is_sync(frame)) return false;
  if (frame.extended) {
    ignore(now, frame, Ignored::Extended);
    return false;  // not in the SBus numbering at all
  }
  if (frame.remote)
    ignore(now, frame, Ignored::Remote);
  else if (movilink)
    take_telegram(now, frame, classify_identifier(frame.id)->telegram);
  else
    take_sync(now);  // of any length and content (ours: the manual names none)
  return true;
}

void SbusSlave::take_telegram(Time now, const Frame& frame, Telegram telegram) {
  const bool parameter = telegram_type(telegram).parameter;
  const auto words = process_words(frame);
  if (parameter ? frame.length != 8 : !words) return ignore(now, frame, Ignored::WrongLength);
  switch (telegram) {
    case Telegram::ProcessOutput:
      process_data_.take_output(now, OutputChannel::Single, *words);
      queue_.schedule(now + timing_.process_delay, source_, *this, kSendInput);
      break;
    case Telegram::ProcessOutputSync:
      if (sync_output_) ignore(now, frame, Ignored::SyncReplaced);
      sync_output_ = words;
      break;
    case Telegram::GroupProcessOutput:
      if (!settings_.group_output) return ignore(now, frame, Ignored::GroupMaster);
      process_data_.take_output(now, OutputChannel::Group, *words);
      break;
    case Telegram::ParameterRequest: take_request(now, frame, 0); break;
    case Telegram::ParameterRequest2: take_request(now, frame, 1); break;
    case Telegram::GroupParameterRequest: take_group_request(now, frame); break;
    case Telegram::ProcessInput:
    case Telegram::ParameterResponse:
    case Telegram::ParameterResponse2: break;  // not from a master
  }
}

// A unit without sync telegram wants bit 6 to be 0 and has a return code for an incorrect management byte
// (MOVITRAC 07 chapter 4.2); it answers at once.
ParameterTelegram SbusSlave::carry_out(Time now, const ParameterTelegram& request) {
  if (request.synchronous() && !settings_.synchronous)
    return parameter_refusal(request, return_codes::kWrongManagement);
  return execute(now, parameters_, request);
}

void SbusSlave::take_request(Time now, const Frame& frame, uint8_t channel) {
  const ParameterTelegram request = decode_parameter(frame.data);
  const ParameterTelegram response = carry_out(now, request);
  if (!request.synchronous() || !settings_.synchronous) {
    queue_.schedule(now + timing_.parameter_delay, source_, *this, kSendResponse + channel, pack(response));
    return;
  }
  if (sync_responses_[channel]) ignore(now, frame, Ignored::AnswerReplaced);
  sync_responses_[channel] = response;
}

void SbusSlave::take_group_request(Time now, const Frame& frame) {
  const ParameterTelegram request = decode_parameter(frame.data);
  const auto service = service_from_code(request.service_code());
  if (!service || !is_write(*service)) return ignore(now, frame, Ignored::GroupService);
  const ParameterTelegram response = carry_out(now, request);
  if (response.failed()) ignore(now, frame, Ignored::GroupRefused, response.return_code());
}

void SbusSlave::take_sync(Time now) {
  const Time answer = now + timing_.process_delay;  // both kinds within the first millisecond of the cycle
  if (sync_output_) {
    process_data_.take_output(now, OutputChannel::Sync, *sync_output_);
    sync_output_.reset();
    queue_.schedule(answer, source_, *this, kSendInput);
  }
  process_data_.synchronize(now);
  for (uint32_t channel = 0; channel < sync_responses_.size(); ++channel) {
    if (!sync_responses_[channel]) continue;
    queue_.schedule(answer, source_, *this, kSendResponse + channel, pack(*sync_responses_[channel]));
    sync_responses_[channel].reset();
  }
}

void SbusSlave::on_event(Time now, uint32_t kind, uint64_t argument) {
  Frame frame;
  if (kind == kSendInput) {
    frame =
        process_frame(sbus_identifier(Telegram::ProcessInput, settings_.address), process_data_.input_after_tick(now));
  } else {
    frame.id = sbus_identifier(kResponses[kind - kSendResponse], settings_.address);
    frame.length = 8;
    frame.data = unpack(argument);
  }
  sender_.send(frame, tag_);  // an inactive line reports itself
}

void SbusSlave::ignore(Time now, const Frame& frame, Ignored reason, ReturnCode code) {
  if (observer_ != nullptr) observer_->on_ignored(now, frame, reason, code);
}

}  // namespace ipos::runtime
