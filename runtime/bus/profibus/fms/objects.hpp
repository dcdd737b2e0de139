// What an FMS service may ask of a device: objects by their index, as its object list describes them (EN 50170 volume 2, FMS;
// MOVITRAC 31 PROFIBUS, 4.2). Who has the objects implements ObjectList; the server knows only this.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include <tl/expected.hpp>

#include "runtime/bus/movilink/return_code.hpp"
#include "runtime/bus/profibus/octets/octets.hpp"
#include "runtime/clock/event_queue.hpp"

namespace ipos::profibus::fms {

using runtime::Time;
using stdlib::ReturnCode;
using profibus::Octets;

enum class Access : uint8_t { All, Read, Write };
constexpr std::string_view access_text(Access access) {  // as the manual prints it
  return access == Access::All ? "read all / write all" : access == Access::Read ? "read all" : "write all";
}

// As Get-OV describes it: a simple variable (object code 7) of type octet string (10), without password,
// groups, name and extension.
struct Object {
  static constexpr uint8_t kObjectCode = 7;
  static constexpr uint8_t kDataType = 10;

  uint16_t index;
  uint8_t length;
  Access access;
  std::string_view name;  // for people; the description has none
  friend bool operator==(const Object&, const Object&) = default;
};

// The errors of the object list; those of the device pass through. Codes of FMS class 6, access.
namespace errors {
inline constexpr ReturnCode kAccessDenied{6, 3, 0};
inline constexpr ReturnCode kUnsupported{6, 6, 0};
inline constexpr ReturnCode kNoObject{6, 7, 0};
inline constexpr ReturnCode kTypeConflict = stdlib::return_codes::kTypeConflict;
}  // namespace errors

// What an access costs beside the frames on the line: so many parameter services of the device.
struct Accessed {
  Octets data;  // of a read
  uint32_t services = 0;
};

class ObjectList {
 public:
  virtual std::optional<Object> find(uint16_t index) const = 0;
  virtual tl::expected<Accessed, ReturnCode> read(Time now, uint16_t index) = 0;
  virtual tl::expected<Accessed, ReturnCode> write(Time now, uint16_t index, std::span<const uint8_t> data) = 0;

 protected:
  ~ObjectList() = default;
};

}  // namespace ipos::profibus::fms
