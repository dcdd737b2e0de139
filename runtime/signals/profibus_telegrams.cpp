// PROFIBUS: words and parameter channel of the last Data_Exchange with a slave, where they stand by its configuration; its
// diagnosis; and Global_Control. Slaves are those of the plant and those that a master of the plant plans.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <utility>

#include "runtime/bus/profibus/cfg_data.hpp"
#include "runtime/signals/telegram_lines.hpp"
#include "runtime/station/dp_slaves.hpp"

namespace ipos::signals {

using namespace runtime;

namespace {

constexpr size_t kChannelOctets = 8;
constexpr size_t kUsualWords = 3;
constexpr size_t kMostDpWords = kMostGatewayDrives * kUsualWords;

using profibus::Configuration;

// Octets of a Data_Exchange in their two parts.
struct ExchangeParts {
  ExchangeParts(std::span<const uint8_t> octets, const Configuration* configuration) {
    const bool has_channel = configuration != nullptr && configuration->parameter_channel;
    const size_t first = has_channel ? std::min(kChannelOctets, octets.size()) : 0;
    channel = octets.first(first);
    words = octets.subspan(first);
  }
  int64_t word(size_t n) const {
    return 2 * n + 1 < words.size() ? int64_t{words[2 * n]} << 8 | words[2 * n + 1] : 0;
  }

  std::span<const uint8_t> channel, words;
};

// One address of a line.
class DpSignals {
 public:
  DpSignals(const PlantParts& plant, ProfibusBus& bus, uint8_t address, std::string whose)
      : plant_(plant), bus_(bus), address_(address), whose_(std::move(whose)) {}

  void add_slave(size_t words, bool channel) {
    for (const bool answer : {false, true}) {
      const std::string_view way = answer ? "answer of" : "request to";
      add(answer ? "answers" : "requests",
          fmt::format("frames {} {} since it is looked at", answer ? "of" : "to", whose_), 0, nullptr,
          [answer](const LastDpFrames& last) {
            return static_cast<int64_t>(answer ? last.answers : last.requests);
          });
      for (size_t n = 0; n < words; ++n)
        add_exchange(fmt::format("{}{}", answer ? "PI" : "PO", n + 1),
                     fmt::format("{} {}: process word", way, whose_), kTelegramWordBits, answer,
                     [n](const ExchangeParts& parts) { return parts.word(n); });
      for (const TelegramField& field : telegram_fields())
        if (channel && field.message == TelegramMessage::Parameter)
          add_exchange(fmt::format("{}_{}", answer ? "answer" : "request", field.name),
                       fmt::format("{} {}: {}", way, whose_, field.meaning), field.bits, answer,
                       [&field](const ExchangeParts& parts) { return number_in(parts.channel, field); });
    }
    add_fields(TelegramMessage::SlaveDiag, &LastDpFrames::diagnosis);
  }
  // What one frame to or of it says.
  std::vector<TelegramValue> said_by(const profibus::FdlFrame& frame) {
    said_.emplace();
    if (frame.is_request())
      note_request(frame, *said_);
    else
      note_answer(frame, *said_);
    const Configuration* configuration = dp_configuration_of(plant_, bus_, address_);
    add_slave(configuration == nullptr ? 0 : configuration->words,
              configuration != nullptr && configuration->parameter_channel);
    add_commands();
    std::vector<TelegramValue> values;
    for (size_t n = 0; n < made.size(); ++n) values.push_back({std::move(made[n]), values_[n]});
    return values;
  }
  void add_commands() { add_fields(TelegramMessage::GlobalControl, &LastDpFrames::command); }

  std::vector<Signal> made;

 private:
  void add_fields(TelegramMessage message, profibus::Octets LastDpFrames::*octets) {
    for (const TelegramField& field : telegram_fields())
      if (field.message == message)
        add(field.name, fmt::format("{}: {}", whose_, field.meaning), field.bits, octets,
            [&field, octets](const LastDpFrames& last) { return number_in(last.*octets, field); });
  }
  template <typename Read>
  void add_exchange(std::string_view word, std::string meaning, size_t bits, bool answer, Read read) {
    add(word, std::move(meaning), bits, answer ? &LastDpFrames::inputs : &LastDpFrames::outputs,
        [&plant = plant_, &bus = bus_, address = address_, answer,
         read](const LastDpFrames& last) -> int64_t {
          return read(
              ExchangeParts(answer ? last.inputs : last.outputs, dp_configuration_of(plant, bus, address)));
        });
  }
  template <typename Read>
  void add(std::string_view word, std::string meaning, size_t bits, profibus::Octets LastDpFrames::*octets, Read read) {
    if (said_) {
      if (octets == nullptr || ((*said_).*octets).empty()) return;  // it does not carry it
      values_.push_back(read(*said_));
    }
    Signal& signal =
        made.emplace_back(telegram_signal(bus_, fmt::format("{}", address_), word, std::move(meaning), bits));
    signal.read = [&bus = bus_, address = address_, read]() -> int64_t {
      return read(bus.last_frames().of(address));
    };
  }

  const PlantParts& plant_;
  ProfibusBus& bus_;
  uint8_t address_;
  std::string whose_;
  std::optional<LastDpFrames> said_;  // a frame whose values are wanted
  std::vector<int64_t> values_;       // of it, one a signal
};

class ProfibusTelegrams final : public TelegramLine {
 public:
  ProfibusTelegrams(const PlantParts& plant, ProfibusBus& bus) : plant_(plant), bus_(bus) {}

  const Bus& bus() const override { return bus_; }

  std::vector<Signal> listed() const override {
    std::vector<Signal> all;
    const auto take = [&all](DpSignals&& signals) {
      for (Signal& signal : signals.made) all.push_back(std::move(signal));
    };
    for (int number = 0; number <= profibus::kLastStation; ++number) {
      const auto address = static_cast<uint8_t>(number);
      const std::string name = dp_slave_at(plant_, bus_, address).name;
      if (name.empty() && dp_plan_of(plant_, bus_, address) == nullptr) continue;
      const Configuration* configuration = dp_configuration_of(plant_, bus_, address);
      DpSignals signals(plant_, bus_, address, name.empty() ? fmt::format("address {}", address) : name);
      signals.add_slave(configuration == nullptr ? kUsualWords : configuration->words,
                        configuration != nullptr && configuration->parameter_channel);
      take(std::move(signals));
    }
    DpSignals commands(plant_, bus_, profibus::kBroadcast, "all slaves");
    commands.add_commands();
    take(std::move(commands));
    return all;
  }

  std::optional<std::string> identity(std::string_view text) const override {
    const auto address = number_of(text);
    return address ? std::optional(fmt::format("{}", *address)) : std::nullopt;
  }

  std::vector<Signal> all_of(std::string_view identity) const override {
    DpSignals signals(plant_, bus_, *number_of(identity), fmt::format("address {}", identity));
    signals.add_slave(kMostDpWords, true);
    signals.add_commands();
    return std::move(signals.made);
  }
  std::vector<TelegramValue> values_of(const HeardTelegram& heard) const override {
    const auto frame = profibus::decode(heard.bytes);
    if (!frame || !frame->has_control()) return {};
    const uint8_t address = frame->is_request() ? frame->destination : frame->source;
    const std::string name = dp_slave_at(plant_, bus_, address).name;
    return DpSignals(plant_, bus_, address, name.empty() ? fmt::format("address {}", address) : name).said_by(*frame);
  }

 private:
  static std::optional<uint8_t> number_of(std::string_view text) {
    int number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size() || number < 0 ||
        number > profibus::kBroadcast)
      return std::nullopt;
    return static_cast<uint8_t>(number);
  }

  const PlantParts& plant_;
  ProfibusBus& bus_;
};

}  // namespace

std::unique_ptr<TelegramLine> telegrams_of(const PlantParts& plant, ProfibusBus& bus) {
  return std::make_unique<ProfibusTelegrams>(plant, bus);
}

}  // namespace ipos::signals
