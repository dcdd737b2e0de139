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

namespace ipos::profibus::fms {

using runtime::Time;

enum class Service : uint8_t {
#define FMS_SERVICE(name, feature, confirmed, number, of_object, text) name,
#include "runtime/bus/profibus/fms/services.def"
};
struct ServiceType {
  Service service;
  int8_t feature;  // -1: none
  bool confirmed;
  int8_t number;  // on the line; -1: none
  bool of_object;
  std::string_view text;
};
std::span<const ServiceType> service_types();
const ServiceType& service_type(Service service);

// Six octets, octet 1 the most significant.
class Features {
 public:
  constexpr Features() = default;
  constexpr explicit Features(uint64_t octets) : octets_(octets) {}

  bool requests(Service service) const { return has(service, 0); }
  bool responds(Service service) const { return has(service, kResponder); }
  std::array<uint8_t, 6> octets() const;
  // The services as the manual lists them: "Read.indication", "Event-Notification.request".
  std::vector<std::string> services() const;
  // The responder's services as those of a requester: what a master may ask of this slave.
  Features mirrored() const { return Features(octets_ << kResponder & kMask); }
  friend bool operator==(const Features&, const Features&) = default;

 private:
  static constexpr int kResponder = 24, kBits = 48;
  static constexpr uint64_t kMask = 0xFFFF'FFFF'FFFF;
  bool has(Service service, int from) const;

  uint64_t octets_ = 0;
};

// Master-slave, acyclic or cyclic (ZY), without or with slave initiative (SI).
enum class LinkType : uint8_t { MSAZ, MSAZ_SI, MSZY, MSZY_SI };
std::string_view link_type_text(LinkType type);
constexpr bool is_cyclic(LinkType type) {
  return type == LinkType::MSZY || type == LinkType::MSZY_SI;
}

// Most octets of a protocol data unit.
struct PduSizes {
  uint8_t send_high = 0, send_low = 0, receive_high = 0, receive_low = 0;
  friend bool operator==(const PduSizes&, const PduSizes&) = default;
};

// Services that may run at one time: confirmed sent and received, acknowledged sent and received.
struct Counters {
  uint8_t scc = 0, rcc = 0, sac = 0, rac = 0;
  friend bool operator==(const Counters&, const Counters&) = default;
};

// An entry of a slave: all are open, so any access point of any master may connect.
struct Connection {
  uint8_t cref;
  LinkType type;
  uint8_t lsap;
  Counters counters;
  uint16_t interval;  // of 10 ms; 0: not watched
  PduSizes pdu;
  Features features;

  Time watch_time() const { return 10 * runtime::kMillisecond * interval; }
};

std::span<const Connection> connections();
const Connection* find_connection(uint8_t cref);
const Connection* connection_at(uint8_t lsap);
// A line of the list as printed: "7 MSAZ O 25 All All 0 1 0 0 0".
std::string describe(const Connection& connection);

// An entry of a master that leads to a slave: defined, as it names address and access point.
struct MasterEntry {
  LinkType type = LinkType::MSAZ;
  uint8_t rsap = 0;
  uint8_t radr = 0;
  Counters counters;
  uint16_t interval = 0;
  PduSizes pdu;
  Features features;
  friend bool operator==(const MasterEntry&, const MasterEntry&) = default;
};

// The entry with which a master reaches all of a connection of the slave with this address.
MasterEntry master_entry(const Connection& slave, uint8_t address);

// The three rules of 4.4, and that type and access point are those of the slave; each broken one in words.
std::vector<std::string> check_master_entry(const MasterEntry& master, const Connection& slave);

}  // namespace ipos::profibus::fms
