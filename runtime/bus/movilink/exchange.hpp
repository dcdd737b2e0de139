// One MOVLNK exchange as every bus does it (1053 1610 p. 47-49): what the command wants sent, what came back,
// and the master that carries it over one interface.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "runtime/bus/movilink/format.hpp"
#include "runtime/bus/movilink/parameter_telegram.hpp"
#include "runtime/bus/movilink/return_code.hpp"
#include "runtime/clock/event_queue.hpp"

namespace ipos::runtime {

// The elements of MOVLNK and MLDATA that go out.
struct MovilinkJob {
  int32_t address = 0;  // as the interface counts them
  int32_t format = 0;
  int32_t service = 0;
  int32_t index = 0;  // subindex in bits 16..23
  int32_t write_value = 0;
  std::array<int32_t, 3> output{};  // the low 16 bits are sent
};

// What came back; after an error neither read value nor input words.
struct MovilinkResult {
  uint32_t result = 0;                // 0 or a packed return code
  std::optional<int32_t> read_value;  // of a reading service
  uint8_t words = 0;                  // input words to store: as many as the format has
  std::array<int32_t, 3> input{};     // with sign
  std::string_view reason;            // why there was no answer, for people
};

// The parameter part of a job; nothing where a service or an index cannot be sent, or not to a group.
inline bool has_valid_parameter(const MovilinkJob& job, bool group) {
  if (job.service < 0 || job.index < 0 || job.index > 0xFF'FFFF) return false;
  const auto service = service_from_code(static_cast<uint32_t>(job.service));
  return service && *service != Service::None && (!group || is_write(*service));
}

inline ParameterTelegram parameter_request(const MovilinkJob& job) {
  return parameter_request(static_cast<Service>(job.service), static_cast<uint16_t>(job.index),
                           static_cast<uint8_t>(job.index >> 16), job.write_value);
}

class MovilinkClient {
 public:
  virtual void on_exchange_done(Time now, const MovilinkResult& result) = 0;

 protected:
  ~MovilinkClient() = default;
};

class MovilinkMaster {
 public:
  // Begins an exchange; must not be busy. A job that cannot be sent is refused at once (class 5, code 5);
  // otherwise the client hears the result later, never from within this call.
  virtual std::optional<ReturnCode> start(Time now, const MovilinkJob& job) = 0;

  // Gives up without a result: program stop or reset.
  virtual void abort() = 0;

 protected:
  ~MovilinkMaster() = default;
};

}  // namespace ipos::runtime
