// Communication relationships of FMS: the list of the MOVITRAC 31, what features mean, and the rules by which an
// entry of a master fits one of the slave (MOVITRAC 31 PROFIBUS, 4.3 and 4.4).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/clock/event_queue.hpp"

namespace ipos::profibus {

using runtime::Time;

enum class FmsService : uint8_t {
#define FMS_SERVICE(name, feature, confirmed, text) name,
#include "runtime/bus/profibus/fms_services.def"
};
struct FmsServiceType {
  FmsService service;
  int8_t feature;  // -1: none
  bool confirmed;
  std::string_view text;
};
const FmsServiceType& fms_service_type(FmsService service);

// Six octets, octet 1 the most significant.
class FmsFeatures {
 public:
  constexpr FmsFeatures() = default;
  constexpr explicit FmsFeatures(uint64_t octets) : octets_(octets) {}

  bool requests(FmsService service) const { return has(service, 0); }
  bool responds(FmsService service) const { return has(service, kResponder); }
  std::array<uint8_t, 6> octets() const;
  // The services as the manual lists them: "Read.indication", "Event-Notification.request".
  std::vector<std::string> services() const;
  // The responder's services as those of a requester: what a master may ask of this slave.
  FmsFeatures mirrored() const { return FmsFeatures(octets_ << kResponder & kMask); }
  friend bool operator==(const FmsFeatures&, const FmsFeatures&) = default;

 private:
  static constexpr int kResponder = 24, kBits = 48;
  static constexpr uint64_t kMask = 0xFFFF'FFFF'FFFF;
  bool has(FmsService service, int from) const;

  uint64_t octets_ = 0;
};

// Master-slave, acyclic or cyclic (ZY), without or with slave initiative (SI).
enum class FmsLinkType : uint8_t { MSAZ, MSAZ_SI, MSZY, MSZY_SI };
std::string_view fms_link_type_text(FmsLinkType type);
constexpr bool is_cyclic(FmsLinkType type) {
  return type == FmsLinkType::MSZY || type == FmsLinkType::MSZY_SI;
}

// Most octets of a protocol data unit.
struct FmsPduSizes {
  uint8_t send_high = 0, send_low = 0, receive_high = 0, receive_low = 0;
  friend bool operator==(const FmsPduSizes&, const FmsPduSizes&) = default;
};

// Services that may run at one time: confirmed sent and received, acknowledged sent and received.
struct FmsCounters {
  uint8_t scc = 0, rcc = 0, sac = 0, rac = 0;
  friend bool operator==(const FmsCounters&, const FmsCounters&) = default;
};

// An entry of a slave: all are open, so any access point of any master may connect.
struct FmsConnection {
  uint8_t cref;
  FmsLinkType type;
  uint8_t lsap;
  FmsCounters counters;
  uint16_t interval;  // of 10 ms; 0: not watched
  FmsPduSizes pdu;
  FmsFeatures features;

  Time watch_time() const { return 10 * runtime::kMillisecond * interval; }
};

std::span<const FmsConnection> fms_connections();
const FmsConnection* find_fms_connection(uint8_t cref);
// A line of the list as printed: "7 MSAZ O 25 All All 0 1 0 0 0".
std::string describe(const FmsConnection& connection);

// An entry of a master that leads to a slave: defined, as it names address and access point.
struct FmsMasterEntry {
  FmsLinkType type = FmsLinkType::MSAZ;
  uint8_t rsap = 0;
  uint8_t radr = 0;
  FmsCounters counters;
  uint16_t interval = 0;
  FmsPduSizes pdu;
  FmsFeatures features;
  friend bool operator==(const FmsMasterEntry&, const FmsMasterEntry&) = default;
};

// The entry with which a master reaches all of a connection of the slave with this address.
FmsMasterEntry master_entry(const FmsConnection& slave, uint8_t address);

// The three rules of 4.4, and that type and access point are those of the slave; each broken one in words.
std::vector<std::string> check_master_entry(const FmsMasterEntry& master, const FmsConnection& slave);

}  // namespace ipos::profibus
