// Words from one line to the other, and who does not answer.
#include "runtime/station/gateway.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace ipos::runtime {
namespace {

constexpr uint64_t kServiceTag = 0x1000;  // after those of the process data
constexpr size_t kGatewayChannelOctets = 8;
constexpr size_t kDriveWords = std::tuple_size_v<ProcessWords>;
constexpr size_t kDriveOctets = 2 * kDriveWords;

// Three words of each drive, no more and no less.
profibus::OptionType option_for(size_t drives) {
  profibus::OptionType option = profibus::option_type(profibus::OptionKind::Gateway);
  option.accepts.least = option.accepts.most = static_cast<uint8_t>(kDriveWords * drives);
  return option;
}

}  // namespace

Gateway::Gateway(EventQueue& queue, uint32_t source, ProfibusBus& profibus, CanLine& sbus,
                 const ControlConfig& config, const GatewayConfig& gateway, ControlSettings settings,
                 Journal& journal)
    : Control(config),
      queue_(queue),
      source_(source),
      gateway_(gateway),
      journal_(journal),
      line_(sbus),
      control_(queue, source, std::move(settings)),
      master_(queue, source, sender_, kServiceTag, kSbusReplyTimeout, channel_),
      channel_(master_, [this](uint8_t address) { return serves(address); }),
      option_(option_for(control_.settings().targets.size())),
      dp_(queue, profibus.source(), profibus.line(), config.name, option_,
          {gateway.profibus.address, false, false}, *this, this),
      watched_(control_.settings().targets.size()) {
  dp_.power_on(false);
}

void Gateway::start() {
  port_ = std::make_unique<LinePort>(line_, line_.attach(name(), line_.baud(), *this));
  sender_.use(*port_);
  begin();
}

void Gateway::begin() {
  control_.start(*port_);
  started_ = queue_.now();
  queue_.schedule(started_ + kGatewayCycle, source_, *this, 0);
}

void Gateway::power_off() {
  if (!powered_) return;
  powered_ = false;
  dp_.power_off();
  line_.set_connected(port_->node(), false);
  queue_.cancel_all(*this);
  control_.stop();
  master_.abort();
  channel_.power_off();
  configuration_ = nullptr;
  received_ = {};
  lost_ = 0;
  for (size_t n = 0; n < watched_.size(); ++n) {
    watched_[n].lost = false;
    control_.set_output(n, {});
  }
  noted_.reset();
}

void Gateway::power_on() {
  if (powered_) return;
  powered_ = true;
  line_.restart(port_->node());
  line_.set_connected(port_->node(), true);
  dp_.power_on(false);
  begin();
}

bool Gateway::serves(uint8_t address) const {
  const auto& targets = control_.settings().targets;
  return std::any_of(targets.begin(), targets.end(),
                     [address](const ControlTarget& target) { return target.address == address; });
}

std::vector<Gateway::Drive> Gateway::drives() const {
  std::vector<Drive> drives;
  for (size_t n = 0; n < watched_.size(); ++n) drives.push_back(drive(n));
  return drives;
}

Gateway::Drive Gateway::drive(size_t n) const {
  const ControlTarget& target = control_.settings().targets[n];
  return {target.address, watched_[n].lost, watched_[n].losses, control_.answers(n), target.output};
}

ProcessWords Gateway::input(size_t n) const {
  return watched_[n].lost ? ProcessWords{} : control_.answers(n).input;
}

bool Gateway::exchanges() const {
  return powered_ && dp_.slave().state() == profibus::SlaveState::DataExchange;
}

// --- SBus

void Gateway::on_frame(Time now, const Frame& frame) {
  if (master_.busy() && master_.on_frame(now, frame)) return;
  control_.on_frame(now, frame);
}

void Gateway::on_sent(Time now, const Frame& /*frame*/, uint64_t tag) {
  if (tag == kServiceTag) master_.on_sent(now, tag);
}

void Gateway::on_event(Time now, uint32_t, uint64_t) {
  queue_.schedule(now + kGatewayCycle, source_, *this, 0);
  lost_ = 0;
  for (size_t n = 0; n < watched_.size(); ++n) {
    const bool silent = now - std::max(control_.answers(n).last, started_) > kSbusReplyTimeout;
    if (silent) lost_ = static_cast<uint8_t>(lost_ | 1U << n);
    if (std::exchange(watched_[n].lost, silent) == silent) continue;
    if (silent) ++watched_[n].losses;
    const int address = control_.settings().targets[n].address;
    journal_.note(now, silent ? Weight::Warning : Weight::Why, name(),
                  silent
                      ? fmt::format("the drive with SBus address {} does not answer: its input words are 0, "
                                    "its parameters give 06 02 00 00",
                                    address)
                      : fmt::format("the drive with SBus address {} answers again", address));
  }
  dp_.slave().set_fault(now, lost_ == 0 ? std::nullopt : std::optional(lost_));
}

// --- PROFIBUS

void Gateway::configured(Time, const profibus::Configuration& configuration) {
  configuration_ = &configuration;
}

void Gateway::take_outputs(Time now, std::span<const uint8_t> outputs) {
  if (configuration_->parameter_channel) {
    ParameterBytes bytes{};
    std::copy_n(outputs.begin(), kGatewayChannelOctets, bytes.begin());
    received_ = decode_parameter(bytes);
    channel_.take(now, received_);
    outputs = outputs.subspan(kGatewayChannelOctets);
  }
  for (size_t n = 0; n < watched_.size(); ++n) {
    ProcessWords words{};
    for (size_t word = 0; word < words.size(); ++word) {
      const size_t at = kDriveOctets * n + 2 * word;
      words[word] = static_cast<uint16_t>(outputs[at] << 8 | outputs[at + 1]);
    }
    control_.set_output(n, words);
  }
}

void Gateway::read_inputs(Time, std::span<uint8_t> inputs) {
  if (configuration_->parameter_channel) {
    const ParameterBytes bytes = encode(channel_.answer(received_));
    std::copy(bytes.begin(), bytes.end(), inputs.begin());
    inputs = inputs.subspan(kGatewayChannelOctets);
  }
  for (size_t n = 0; n < watched_.size(); ++n) {
    const ProcessWords words = input(n);
    for (size_t word = 0; word < words.size(); ++word) {
      const size_t at = kDriveOctets * n + 2 * word;
      inputs[at] = static_cast<uint8_t>(words[word] >> 8);
      inputs[at + 1] = static_cast<uint8_t>(words[word]);
    }
  }
}

// The drives stop (control word 0), and the SBus goes on.
void Gateway::exchange_ended(Time) {
  for (size_t n = 0; n < watched_.size(); ++n) control_.set_output(n, {});
}

void Gateway::on_note(Time now, profibus::SlaveNote what, uint8_t master) {
  if (const Noted one{what, master}; std::exchange(noted_, one) == one) return;
  journal_.note(now, Weight::Why, name(),
                fmt::format("PROFIBUS: {}{}", profibus::slave_note_text(what),
                            master == profibus::kNoMaster ? "" : fmt::format(" (master {})", master)));
}

}  // namespace ipos::runtime
