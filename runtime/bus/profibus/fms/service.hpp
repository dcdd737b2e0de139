// A service as one side asks for it and how it ends, whatever carries it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/bus/profibus/fms/connection.hpp"
#include "runtime/bus/profibus/fms/objects.hpp"

namespace ipos::profibus::fms {

// The services that a person asks for, by the words of plant files and verbs: "read".
struct ServiceKey {
  std::string_view key;
  Service service;
};
inline constexpr ServiceKey kServiceKeys[] = {{"read", Service::Read},         {"write", Service::Write},
                                              {"ov", Service::GetOvLong},      {"identify", Service::Identify},
                                              {"status", Service::Status},     {"initiate", Service::Initiate},
                                              {"abort", Service::Abort}};
std::optional<Service> service_of_key(std::string_view key);
std::string service_keys();  // "read, write, ..."

struct Request {
  Service service = Service::Read;
  uint16_t index = 0;
  Octets data;
  friend bool operator==(const Request&, const Request&) = default;
};

enum class End : uint8_t { Positive, Error, Rejected, Aborted };

enum class Reason : uint8_t {
#define FMS_REASON(name, originator, text) name,
#include "runtime/bus/profibus/fms/reasons.def"
};
std::string_view reason_text(uint8_t reason);  // also of numbers that are none

struct Response {
  End end = End::Positive;
  Octets data;                      // of Read and Status
  std::optional<Object> object;     // of Get-OV
  std::vector<std::string> texts;   // of Identify: vendor, model, revision
  ReturnCode error;                 // class, code and additional of Error
  uint8_t reason = 0;               // of Rejected and Aborted
  friend bool operator==(const Response&, const Response&) = default;

  static Response failed(ReturnCode error) { return {End::Error, {}, {}, {}, error, 0}; }
  static Response rejected(Reason why) { return {End::Rejected, {}, {}, {}, {}, static_cast<uint8_t>(why)}; }
  static Response aborted(Reason why) { return {End::Aborted, {}, {}, {}, {}, static_cast<uint8_t>(why)}; }
};

std::string describe(const Request& request);  // "Write 1025 = 00 00 09 50"
// "00 00 09 50", "error 08 00 00 15: value too large", "rejected: ..", "aborted: ..".
std::string describe(const Response& response);

}  // namespace ipos::profibus::fms
