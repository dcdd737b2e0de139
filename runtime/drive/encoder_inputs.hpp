// What hangs on the encoder sockets of a unit beside its own motor encoder X15: the shafts of other drives, as counts
// of their motor encoders.
#pragma once

#include <cstdint>
#include <optional>

namespace ipos::runtime {

struct EncoderInputs {
  std::optional<int32_t> x14;  // external encoder; nothing: it follows the motor
  std::optional<int32_t> x42;  // master encoder of the DRS card; nothing: none is there

  bool operator==(const EncoderInputs&) const = default;
};

}  // namespace ipos::runtime
