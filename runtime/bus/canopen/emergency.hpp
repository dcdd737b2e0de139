// The EMCY producer of a node: its messages (1014h, 1015h), the error register 1001h and the list of errors
// 1003h.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <string_view>

#include "runtime/bus/canopen/nmt.hpp"
#include "runtime/bus/canopen/object_dictionary.hpp"
#include "runtime/bus/canopen/place.hpp"

namespace ipos::runtime::canopen {

enum class Cause : uint8_t {
#define EMERGENCY(name, code, error_register, status, text) name,
#include "runtime/bus/canopen/emergencies.def"
};

struct EmergencyRow {
  uint16_t code;
  uint8_t error_register;
  bool status;
  std::string_view text;
};
inline constexpr EmergencyRow kEmergencies[] = {
#define EMERGENCY(name, code, error_register, status, text) {code, error_register, status, text},
#include "runtime/bus/canopen/emergencies.def"
};

class Emergency final : private Timer::Owner {
 public:
  // `state` is that of the node.
  Emergency(const Place& place, ObjectDictionary& dictionary, const State& state);

  void set(Time now, Cause cause, bool present, uint16_t status_word_1);
  void may_send(Time now);  // the state or an entry has changed
  void reset();             // communication restarts; errors stay

 private:
  void on_timer(Time now, uint32_t /*kind*/) override { may_send(now); }
  uint8_t error_register() const;
  void record(uint16_t code, uint16_t status_word_1);

  Place place_;
  ObjectDictionary& dictionary_;
  const State& state_;
  std::array<bool, std::size(kEmergencies)> present_{};
  std::deque<std::array<uint8_t, 8>> waiting_;
  Timer inhibit_;
};

}  // namespace ipos::runtime::canopen
