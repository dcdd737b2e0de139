// Names and patterns, the same for every kind of bus; what a line carries says telegram_lines.hpp.
#include "runtime/signals/telegrams.hpp"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "runtime/signals/telegram_lines.hpp"

namespace ipos::signals {

using namespace runtime;

namespace {

constexpr TelegramField kFields[] = {
#define FIELD(message, name, byte, bytes, intel, is_signed, mask, bits, meaning) \
  {TelegramMessage::message, name, byte, bytes, intel, is_signed, mask, bits, meaning},
#include "runtime/signals/telegram_fields.def"
};

std::vector<std::unique_ptr<TelegramLine>> telegram_lines(const PlantParts& plant) {
  std::vector<std::unique_ptr<TelegramLine>> lines;
  for (const auto& bus : plant.buses())
    lines.push_back(visit(*bus, [&plant](auto& line) { return telegrams_of(plant, line); }));
  return lines;
}

}  // namespace

std::span<const TelegramField> telegram_fields() { return kFields; }

int64_t number_in(std::span<const uint8_t> data, const TelegramField& field) {
  uint32_t number = 0;
  for (uint8_t n = 0; n < field.bytes; ++n) {
    const size_t at = field.intel ? size_t{field.byte} + field.bytes - 1 - n : size_t{field.byte} + n;
    number = number << 8 | (at < data.size() ? data[at] : 0U);
  }
  number &= field.mask;
  if (field.mask == 0x80) return number == 0 ? 0 : 1;
  return field.is_signed ? int64_t{static_cast<int32_t>(number)} : int64_t{number};
}

Signal telegram_signal(const Bus& bus, std::string_view identity, std::string_view word,
                            std::string meaning, size_t bits) {
  Signal made;
  made.station = bus.name();
  made.name = fmt::format("{}.{}.{}", bus.name(), identity, word);
  made.group = Group::Bus;
  made.meaning = std::move(meaning);
  made.bits = bits;
  return made;
}

std::vector<Signal> telegram_signals(const PlantParts& plant) {
  std::vector<Signal> all;
  for (const auto& line : telegram_lines(plant))
    for (Signal& signal : line->listed()) all.push_back(std::move(signal));
  return all;
}

std::optional<Signal> find_telegram_signal(const PlantParts& plant, std::string_view name) {
  for (const auto& line : telegram_lines(plant)) {
    const std::string& bus = line->bus().name();
    if (!name.starts_with(bus + ".")) continue;
    const std::string_view rest = name.substr(bus.size() + 1);
    const size_t dot = rest.find('.');
    if (dot == std::string_view::npos) continue;
    const auto identity = line->identity(rest.substr(0, dot));
    if (!identity) continue;
    const std::string full = fmt::format("{}.{}.{}", bus, *identity, rest.substr(dot + 1));
    if (auto found = find_among(line->listed(), full)) return found;
    if (auto found = find_among(line->all_of(*identity), full)) return found;
  }
  return std::nullopt;
}

std::vector<TelegramValue> values_of_telegram(const PlantParts& plant, const Bus& bus,
                                              const HeardTelegram& telegram) {
  for (const auto& line : telegram_lines(plant))
    if (&line->bus() == &bus) return line->values_of(telegram);
  return {};
}

std::vector<Signal> match_telegram_signals(const PlantParts& plant, std::string_view pattern) {
  std::vector<Signal> found;
  for (const auto& line : telegram_lines(plant)) {
    const std::string& bus = line->bus().name();
    for (size_t dot = pattern.find('.'); dot != std::string_view::npos; dot = pattern.find('.', dot + 1)) {
      const std::string_view rest = pattern.substr(dot + 1);
      const size_t behind_id = rest.find('.');
      if (behind_id == std::string_view::npos || !matches(pattern.substr(0, dot), bus)) continue;
      const std::string_view ids = rest.substr(0, behind_id), words = rest.substr(behind_id + 1);
      const size_t before_bit = words.rfind('.');
      for (const Signal& signal : line->listed()) {
        const std::string_view own = std::string_view(signal.name).substr(bus.size() + 1);
        const std::string_view word = own.substr(own.find('.') + 1);
        if (!matches(ids, own.substr(0, own.find('.')))) continue;
        if (before_bit != std::string_view::npos && matches(words.substr(0, before_bit), word))
          for (size_t bit = 0; bit < bit_count(signal); ++bit)
            if (matches(words.substr(before_bit + 1), fmt::format("{}", bit)))
              found.push_back(bit_of(signal, bit));
        if (matches(words, word)) found.push_back(signal);
      }
      break;
    }
  }
  return found;
}

}  // namespace ipos::signals
