// RS-485: words and parameter channel of the last request to an address and of its last answer. Stations have the
// addresses of P810 and P811; every other one can be named.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

#include "runtime/bus/movilink/serial_telegram.hpp"
#include "runtime/signals/telegram_lines.hpp"

namespace ipos::signals {

using namespace runtime;

namespace {

constexpr int kHighestAddress = 255;

// One address of a line.
class AddressSignals {
 public:
  AddressSignals(SerialBus& bus, uint8_t address, std::string whose)
      : bus_(bus), address_(address), whose_(std::move(whose)) {}

  // What one telegram to or of it says.
  std::vector<TelegramValue> said_by(const SerialTelegram& telegram) {
    said_.emplace();
    std::copy(telegram.words.begin(), telegram.words.end(), said_->words.begin());
    said_->parameter = telegram.parameter;
    add_content(telegram.response, telegram.format.words, telegram.format.parameter);
    std::vector<TelegramValue> values;
    for (size_t n = 0; n < made_.size(); ++n) values.push_back({std::move(made_[n]), values_[n]});
    return values;
  }

  // `answered`: somebody answers to the address, so that there are answers to look at.
  std::vector<Signal> all(bool answered) {
    add_way(false);
    if (answered) add_way(true);
    return std::move(made_);
  }

 private:
  void add_way(bool response) {
    add(response ? "answers" : "requests",
        fmt::format("{} since it is looked at", response ? "answers" : "requests"), 0, response,
        [](const LastTelegram& last) { return static_cast<int64_t>(last.count); });
    add_content(response, kSbusProcessWords, true);
  }

  void add_content(bool response, size_t words, bool parameter) {
    for (size_t n = 0; n < words; ++n)
      add(fmt::format("{}{}", response ? "PI" : "PO", n + 1), "process word", kTelegramWordBits, response,
          [n](const LastTelegram& last) -> int64_t { return last.words[n]; });
    for (const TelegramField& field : telegram_fields())
      if (parameter && field.message == TelegramMessage::Parameter)
        add(fmt::format("{}_{}", response ? "answer" : "request", field.name), field.meaning, field.bits,
            response,
            [&field](const LastTelegram& last) { return number_in(encode(last.parameter), field); });
  }

  template <typename Read>
  void add(std::string_view word, std::string_view meaning, size_t bits, bool response, Read read) {
    Signal& signal = made_.emplace_back(telegram_signal(
        bus_, fmt::format("{}", address_), word,
        fmt::format("{} {}: {}", response ? "answer of" : "request to", whose_, meaning), bits));
    if (said_) values_.push_back(read(*said_));
    signal.read = [&bus = bus_, address = address_, response, read]() -> int64_t {
      return read(bus.last_telegrams().of(address, response));
    };
  }

  SerialBus& bus_;
  uint8_t address_;
  std::string whose_;
  std::vector<Signal> made_;
  std::optional<LastTelegram> said_;  // a telegram whose values are wanted
  std::vector<int64_t> values_;       // of it, one a signal
};

class SerialTelegrams final : public TelegramLine {
 public:
  SerialTelegrams(const PlantParts& plant, SerialBus& bus) : plant_(plant), bus_(bus) {}

  const Bus& bus() const override { return bus_; }

  std::vector<Signal> listed() const override {
    std::vector<std::pair<uint8_t, std::string>> addresses;
    const auto note = [&addresses](int32_t number, const std::string& whose) {
      const auto address = static_cast<uint8_t>(number);
      const auto same = [address](const auto& known) { return known.first == address; };
      if (std::none_of(addresses.begin(), addresses.end(), same)) addresses.emplace_back(address, whose);
    };
    for (const auto& station : plant_.stations()) {
      const SerialConfig& serial = station->config().serial;
      if (serial.x13.bus != bus_.name() && serial.xt.bus != bus_.name()) continue;
      const UnitInterface& drive = std::as_const(*station).drive();
      note(drive.value("810"), station->config().name);
      if (const int32_t group = drive.value("811"); group != kNoGroupAddress)
        note(group, fmt::format("group {}", group));
    }
    std::sort(addresses.begin(), addresses.end());
    std::vector<Signal> all;
    for (const auto& [address, whose] : addresses)
      for (Signal& signal : AddressSignals(bus_, address, whose).all(is_answered(address)))
        all.push_back(std::move(signal));
    return all;
  }

  std::optional<std::string> identity(std::string_view text) const override {
    const auto address = number_of(text);
    return address ? std::optional(fmt::format("{}", *address)) : std::nullopt;
  }

  std::vector<Signal> all_of(std::string_view identity) const override {
    return AddressSignals(bus_, *number_of(identity), fmt::format("address {}", identity)).all(true);
  }
  std::vector<TelegramValue> values_of(const HeardTelegram& heard) const override {
    const auto telegram = decode_serial(heard.bytes);
    if (!telegram) return {};
    return AddressSignals(bus_, telegram->address, fmt::format("address {}", telegram->address)).said_by(*telegram);
  }

 private:
  static std::optional<uint8_t> number_of(std::string_view text) {
    int number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size() || number < 0 || number > kHighestAddress)
      return std::nullopt;
    return static_cast<uint8_t>(number);
  }

  const PlantParts& plant_;
  SerialBus& bus_;
};

}  // namespace

std::unique_ptr<TelegramLine> telegrams_of(const PlantParts& plant, SerialBus& bus) {
  return std::make_unique<SerialTelegrams>(plant, bus);
}

}  // namespace ipos::signals
