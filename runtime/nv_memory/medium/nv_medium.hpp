// The medium under the non-volatile memory, so that tests can cut the power at any byte. Offsets count from
// its beginning; what was never written reads as 0 or is not there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include <tl/expected.hpp>

namespace ipos::runtime {

class NvMedium {
 public:
  virtual ~NvMedium() = default;

  // How many bytes there are to read, fewer than asked for at the end of the medium; or why it failed.
  virtual tl::expected<size_t, std::string> read(uint64_t offset, std::span<uint8_t> out) = 0;
  // Nothing when it was done, else why not. After a failure any part may have been written.
  virtual std::optional<std::string> write(uint64_t offset, std::span<const uint8_t> bytes) = 0;
  // What was written before is on the medium when this returns.
  virtual std::optional<std::string> sync() = 0;
};

}  // namespace ipos::runtime
