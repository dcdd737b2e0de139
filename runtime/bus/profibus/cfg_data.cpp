// Identifier octets. Bits 3-0 length - 1, 5-4 direction, 6 words, 7 consistency; direction 00 is the special
// format, where length octets and octets of the manufacturer follow.
#include "runtime/bus/profibus/cfg_data.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace ipos::profibus {
namespace {

constexpr Configuration kConfigurations[] = {
#define CONFIGURATION(set, octets, words, parameter_channel, identifiers, name) \
  {ConfigurationSet::set, octets, words, parameter_channel, identifiers, name},
#include "runtime/bus/profibus/configurations.def"
};

constexpr uint8_t kInput = 0x10, kOutput = 0x20, kWords = 0x40, kConsistent = 0x80, kLength = 0x0F;
constexpr uint8_t kSpecialInput = 0x40, kSpecialOutput = 0x80, kSpecialLength = 0x3F;
constexpr uint8_t kNoManufacturerData = 15;

CfgModule decode_simple(uint8_t identifier) {
  const uint8_t length = static_cast<uint8_t>((identifier & kLength) + 1);
  const bool words = (identifier & kWords) != 0, consistent = (identifier & kConsistent) != 0;
  CfgModule module;
  if ((identifier & kInput) != 0) {
    module.inputs = length;
    module.input_words = words;
    module.consistent_inputs = consistent;
  }
  if ((identifier & kOutput) != 0) {
    module.outputs = length;
    module.output_words = words;
    module.consistent_outputs = consistent;
  }
  return module;
}

// The length octet of outputs stands before that of inputs.
std::optional<CfgModule> decode_special(std::span<const uint8_t> cfg, size_t& at) {
  const uint8_t identifier = cfg[at++];
  const uint8_t manufacturer = identifier & kLength;
  CfgModule module;
  if ((identifier & kSpecialOutput) != 0) {
    if (at == cfg.size()) return std::nullopt;
    const uint8_t length = cfg[at++];
    module.outputs = static_cast<uint8_t>((length & kSpecialLength) + 1);
    module.output_words = (length & kWords) != 0;
    module.consistent_outputs = (length & kConsistent) != 0;
  }
  if ((identifier & kSpecialInput) != 0) {
    if (at == cfg.size()) return std::nullopt;
    const uint8_t length = cfg[at++];
    module.inputs = static_cast<uint8_t>((length & kSpecialLength) + 1);
    module.input_words = (length & kWords) != 0;
    module.consistent_inputs = (length & kConsistent) != 0;
  }
  if (manufacturer != kNoManufacturerData) {
    if (cfg.size() - at < manufacturer) return std::nullopt;
    at += manufacturer;
  }
  return module;
}

// Four words, consistent as a whole, in both directions.
CfgModule channel_module() { return decode_simple(0xF3); }

std::string amount(uint8_t count, bool words) {
  return fmt::format("{} {}{}", count, words ? "word" : "octet", count == 1 ? "" : "s");
}

std::string_view consistency(bool whole) { return whole ? ", consistent as a whole" : ""; }

}  // namespace

std::optional<std::vector<CfgModule>> decode_cfg(std::span<const uint8_t> cfg) {
  std::vector<CfgModule> modules;
  for (size_t at = 0; at < cfg.size();) {
    if ((cfg[at] & (kInput | kOutput)) != 0) {
      modules.push_back(decode_simple(cfg[at++]));
      continue;
    }
    const auto module = decode_special(cfg, at);
    if (!module) return std::nullopt;
    modules.push_back(*module);
  }
  return modules;
}

std::string describe(const CfgModule& module) {
  if (module.inputs == 0 && module.outputs == 0) return "empty place";
  if (module.inputs == module.outputs && module.input_words == module.output_words &&
      module.consistent_inputs == module.consistent_outputs)
    return fmt::format("inputs and outputs of {}{}", amount(module.inputs, module.input_words),
                       consistency(module.consistent_inputs));
  std::string text;
  if (module.inputs > 0)
    text = fmt::format("inputs of {}{}", amount(module.inputs, module.input_words),
                       consistency(module.consistent_inputs));
  if (module.outputs > 0)
    text += fmt::format("{}outputs of {}{}", text.empty() ? "" : "; ",
                        amount(module.outputs, module.output_words), consistency(module.consistent_outputs));
  return text;
}

// The rows of a set stand together.
std::span<const Configuration> configurations(ConfigurationSet set) {
  const auto of_set = [set](const Configuration& c) { return c.set == set; };
  const auto* first = std::find_if(std::begin(kConfigurations), std::end(kConfigurations), of_set);
  return {first, std::find_if_not(first, std::end(kConfigurations), of_set)};
}

const Configuration* find_configuration(std::span<const uint8_t> cfg, const AcceptedWords& accepted) {
  const auto modules = decode_cfg(cfg);
  if (!modules) return nullptr;
  size_t inputs = 0, outputs = 0;
  for (const CfgModule& module : *modules) {
    inputs += module.input_octets();
    outputs += module.output_octets();
  }
  const bool by_length = accepted.set == ConfigurationSet::Mc31;
  const bool channel = modules->size() > 1 && modules->front() == channel_module();
  const auto rows = configurations(accepted.set);
  const auto found = std::find_if(rows.begin(), rows.end(), [&](const Configuration& c) {
    return c.octets == inputs && c.words >= accepted.least && c.words <= accepted.most &&
           (by_length || c.parameter_channel == channel);
  });
  return inputs == outputs && found != rows.end() ? &*found : nullptr;
}

}  // namespace ipos::profibus
