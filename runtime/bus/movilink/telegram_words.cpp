// Parameter channel and process data in words.
#include "runtime/bus/movilink/telegram_words.hpp"

#include <fmt/format.h>

#include "runtime/bus/movilink/unit_words.hpp"
#include "stdlib/index_areas.hpp"
#include "stdlib/parameters.hpp"
#include "stdlib/units.hpp"

namespace ipos::runtime {
namespace {

constexpr uint16_t kCode = 16'000;       // index of the first program word

const stdlib::UnitType& unit_type(const UnitNames* unit) {
  return unit != nullptr && unit->unit != nullptr ? *unit->unit : stdlib::usual_unit();
}

struct IndexText {
  std::string name;
  const stdlib::Parameter* parameter = nullptr;
};

IndexText index_text(const UnitNames* unit, uint16_t index) {
  const stdlib::UnitType& type = unit_type(unit);
  if (index >= stdlib::kFirstVariables && index < stdlib::kFirstVariables + type.variables) {
    const uint32_t number = index - stdlib::kFirstVariables;
    const std::string name = unit == nullptr ? fmt::format("H{}", number) : unit->variable(number);
    return {name, nullptr};
  }
  if (index >= kCode && index < kCode + type.parameter_words)
    return {fmt::format("program word {}", index - kCode), nullptr};
  const stdlib::Parameter* row = stdlib::parameter_table(type).find(index);
  return row == nullptr ? IndexText{"unknown index", nullptr} : IndexText{std::string(row->name), row};
}

// Byte 6 and 7 (1053 1610 p. 31): "quantity 4 time, conversion -3 (ms)".
std::string scale_text(uint32_t data) {
  const auto quantity = static_cast<uint8_t>(data >> 8);
  const auto conversion = static_cast<int8_t>(data & 0xFF);
  if (quantity == stdlib::kNoQuantity) return fmt::format("no quantity, conversion {}", conversion);
  const std::string_view name = stdlib::quantity_name(quantity);
  const std::string_view unit = stdlib::unit_abbreviation(quantity, conversion);
  return fmt::format("quantity {} {}, conversion {}{}", quantity, name.empty() ? "unknown" : name, conversion,
                     unit.empty() ? "" : fmt::format(" ({})", unit));
}

// Bytes 4 and 5 the next index, 6 and 7 the attributes (p. 32).
std::string attribute_text(uint32_t data) {
  constexpr std::string_view kTexts[] = {
#define ATTRIBUTE(name, bit, text) text,
#include "stdlib/access_attributes.def"
  };
  const uint32_t next = data >> 16;
  std::string text = next == 0 ? "last index" : fmt::format("next index {}", next);
  text += fmt::format(", attributes {:04X}h", data & 0xFFFF);
  std::string list;
  for (size_t bit = 0; bit < std::size(kTexts); ++bit)
    if ((data >> bit & 1) != 0) list += fmt::format("{}{}", list.empty() ? "" : ", ", kTexts[bit]);
  return list.empty() ? text : fmt::format("{} ({})", text, list);
}

std::string value_text(const IndexText& index, Service service, uint32_t data) {
  if (service == Service::ReadScale) return scale_text(data);
  if (service == Service::ReadAttribute) return attribute_text(data);
  const auto value = static_cast<int32_t>(data);
  if (index.parameter == nullptr) return fmt::format("{}", value);
  return stdlib::parameter_text(*index.parameter, value);
}

}  // namespace

std::string parameter_words(const UnitNames* unit, const ParameterTelegram& telegram, bool request) {
  const auto service = service_from_code(telegram.service_code());
  const uint16_t first = unit == nullptr ? uint16_t{0} : unit->first_index;
  const IndexText index = telegram.index < first ? IndexText{"unknown index", nullptr}
                                                 : index_text(unit, static_cast<uint16_t>(telegram.index - first));
  std::string text =
      service ? std::string(service_text(*service)) : fmt::format("service {}", telegram.service_code());
  text += fmt::format(" {} {}", telegram.index, index.name);
  if (telegram.subindex != 0) text += fmt::format(", subindex {}", telegram.subindex);
  if (!request && telegram.failed())
    text += " refused: " + describe(telegram.return_code());
  else if (service && (request ? is_write(*service) : *service != Service::None))
    text += " = " + value_text(index, *service, telegram.data);
  if (request && service && is_write(*service) && telegram.data_length() != 4)
    text += fmt::format(", length {} in place of 4 bytes", telegram.data_length());
  return text;
}

std::string process_words_text(const UnitNames* unit, const std::string& what, bool input,
                               std::span<const uint16_t> words) {
  std::string text = what;
  for (size_t n = 0; n < words.size(); ++n) {
    const bool assigned = unit != nullptr && n < unit->output.size();  // a fieldbus may carry more words
    const uint8_t code = assigned ? (input ? unit->input : unit->output)[n] : uint8_t{0};
    const std::string_view name =
        unit == nullptr ? std::string_view{} : process_word_name(unit_type(unit), input, code);
    text += n == 0 ? " " : ", ";
    if (unit == nullptr || code == 0 || name.empty()) {
      text += fmt::format("{:04X}h", words[n]);
      continue;
    }
    text += fmt::format("{} {}", name, process_word_text(input, code, words[n]));
    const std::string bits = unit_word_text(unit_type(unit), input, code, words[n]);
    if (!bits.empty()) text += fmt::format(" ({})", bits);
  }
  return text;
}

}  // namespace ipos::runtime
