// [station.encoders]: which shaft hangs on which encoder socket of a station. The keys are the sockets' names.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "runtime/plant_file/toml_text.hpp"

namespace ipos::runtime {

enum class EncoderSocket : uint8_t {
  X14,  // external encoder (IPOSplus p. 86)
  X42,  // master encoder of the DRS card
};
inline constexpr std::array<std::string_view, 2> kEncoderSockets = {"X14", "X42"};

struct EncoderUse {
  EncoderSocket socket;
  std::string shaft;  // the station whose motor turns it
  FilePlace place;
};

}  // namespace ipos::runtime
