// Cfg_Data, what Chk_Cfg carries and Get_Cfg returns: identifier octets that say which inputs and outputs
// master and slave exchange, and the configurations that a card accepts (MOVITRAC 31 PROFIBUS, 3.1.1).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/bus/profibus/fdl_frame.hpp"

namespace ipos::profibus {

// One identifier: 1 to 16 octets or words in the simple format, 1 to 64 in the special one.
struct CfgModule {
  uint8_t inputs = 0;  // in units of octets or words
  uint8_t outputs = 0;
  bool input_words = false;
  bool output_words = false;
  bool consistent_inputs = false;  // over the whole length; else over one octet or word
  bool consistent_outputs = false;

  size_t input_octets() const { return size_t{inputs} * (input_words ? 2 : 1); }
  size_t output_octets() const { return size_t{outputs} * (output_words ? 2 : 1); }
  friend bool operator==(const CfgModule&, const CfgModule&) = default;
};

// Nothing where an identifier is cut off.
std::optional<std::vector<CfgModule>> decode_cfg(std::span<const uint8_t> cfg);

// "inputs and outputs of 3 words, consistent as a whole"
std::string describe(const CfgModule& module);

// Of which interface a configuration is.
enum class ConfigurationSet : uint8_t { Mc31, Movidrive, Gateway };

struct Configuration {
  ConfigurationSet set;
  uint8_t octets;  // in each direction
  uint8_t words;   // of process data
  bool parameter_channel;
  std::string_view identifiers;  // as printed
  std::string_view name;

  Octets cfg_data() const { return {identifiers.begin(), identifiers.end()}; }
};

std::span<const Configuration> configurations(ConfigurationSet set = ConfigurationSet::Mc31);

// What a card accepts of a set.
struct AcceptedWords {
  ConfigurationSet set = ConfigurationSet::Mc31;
  uint8_t least = 1;
  uint8_t most = 3;
};

// The one that Cfg_Data asks for: inputs and outputs of equal length, which alone decides for MOVITRAC 31. Else
// nullptr.
const Configuration* find_configuration(std::span<const uint8_t> cfg, const AcceptedWords& accepted = {});

}  // namespace ipos::profibus
