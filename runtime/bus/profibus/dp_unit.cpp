// The parameter channel and the process data words of DP.
#include "runtime/bus/profibus/dp_unit.hpp"

#include <algorithm>

#include "runtime/bus/movilink/length_refusal.hpp"

namespace ipos::profibus {
namespace {

using runtime::ParameterTelegram;
namespace management = runtime::management;
namespace codes = runtime::return_codes;

constexpr size_t kChannelSize = 8;
constexpr int32_t kNoWatchdog = 65'000, kLongestShown = 64'999;
constexpr Time kHundredth = 10 * runtime::kMillisecond;

tl::expected<uint32_t, ReturnCode> carry_out(Time now, FieldbusParameters& parameters,
                                             const ParameterTelegram& request) {
  const auto service = runtime::service_from_code(request.service_code());
  if (service == runtime::Service::Read) return parameters.read(now, request.index);  // any length
  if (service != runtime::Service::Write) return tl::unexpected(codes::kWrongManagement);
  if (request.data_length() != 4) return tl::unexpected(codes::kTypeConflict);
  return parameters.write(now, request.index, request.data);
}

// The MOVILINK channel, except for the answer to a wrong length.
ParameterTelegram execute_movilink(Time now, runtime::ParameterServer& parameters,
                                   const ParameterTelegram& request) {
  const ParameterTelegram answer = runtime::execute(now, parameters, request, codes::kTypeConflict);
  const bool wrong_length = answer.failed() && answer.return_code() == codes::kTypeConflict;
  return wrong_length ? runtime::length_refusal(request) : answer;
}

}  // namespace

// The answer mirrors the request except for the data and bit 7.
ParameterTelegram execute(Time now, FieldbusParameters& parameters, const ParameterTelegram& request) {
  ParameterTelegram answer = request;
  answer.management &= static_cast<uint8_t>(~management::kFailed);
  const auto data = carry_out(now, parameters, request);
  if (!data) answer.management |= management::kFailed;
  answer.data = data ? *data : data.error().packed();
  return answer;
}

int32_t fieldbus_timeout(std::optional<Time> watchdog) {
  if (!watchdog) return kNoWatchdog;
  return static_cast<int32_t>(std::min<Time>(*watchdog / kHundredth, kLongestShown));
}

DpUnit::DpUnit(FieldbusParameters& parameters, FieldbusDrive& drive, Time processing)
    : drive_(drive),
      channel_([&parameters](Time now,
                             const ParameterTelegram& request) { return execute(now, parameters, request); },
               processing) {}

DpUnit::DpUnit(runtime::ParameterServer& parameters, FieldbusDrive& drive, Time processing)
    : drive_(drive),
      channel_(
          [&parameters](Time now, const ParameterTelegram& request) {
            return execute_movilink(now, parameters, request);
          },
          processing) {}

void DpUnit::configured(Time, const Configuration& configuration) { configuration_ = &configuration; }

void DpUnit::take_outputs(Time now, std::span<const uint8_t> outputs) {
  if (configuration_->parameter_channel) {
    runtime::ParameterBytes bytes{};
    std::copy_n(outputs.begin(), kChannelSize, bytes.begin());
    received_ = runtime::decode_parameter(bytes);
    if (channel_.take(now, received_)) accessed_ = now;
    outputs = outputs.subspan(kChannelSize);
  }
  send_words(now, outputs);
}

void DpUnit::send_words(Time now, std::span<const uint8_t> octets) {
  std::array<uint16_t, kMostWords> words{};
  for (size_t n = 0; n < octets.size() / 2; ++n)
    words[n] = static_cast<uint16_t>(octets[2 * n] << 8 | octets[2 * n + 1]);
  drive_.take_output(now, runtime::OutputChannel::Single, std::span(words).first(octets.size() / 2));
}

void DpUnit::read_inputs(Time now, std::span<uint8_t> inputs) {
  if (configuration_->parameter_channel) {
    const runtime::ParameterBytes bytes = runtime::encode(channel_.answer(now, received_));
    std::copy(bytes.begin(), bytes.end(), inputs.begin());
    inputs = inputs.subspan(kChannelSize);
  }
  const runtime::ProcessWords words = drive_.input(now);
  const FurtherWords further = drive_.further_input(now);
  for (size_t n = 0; n < inputs.size() / 2; ++n) {
    const uint16_t word = n < words.size() ? words[n] : further[n - words.size()];
    inputs[2 * n] = static_cast<uint8_t>(word >> 8);
    inputs[2 * n + 1] = static_cast<uint8_t>(word);
  }
}

void DpUnit::watchdog_set(Time now, std::optional<Time> period) {
  drive_.set_fieldbus_timeout(now, fieldbus_timeout(period));
}

void DpUnit::watchdog_expired(Time now) { drive_.fieldbus_timeout_expired(now); }

// A slave that leaves data exchange sets its outputs to 0: the drive stops.
void DpUnit::exchange_ended(Time now) {
  const std::array<uint8_t, 2 * kMostWords> zero{};
  send_words(now, std::span(zero).first(2 * size_t{configuration_->words}));
}

}  // namespace ipos::profibus
