// Tables and rules of the communication relationship list.
#include "runtime/bus/profibus/fms_connection.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace ipos::profibus {
namespace {

constexpr FmsServiceType kFmsServices[] = {
#define FMS_SERVICE(name, feature, confirmed, text) {FmsService::name, feature, confirmed, text},
#include "runtime/bus/profibus/fms_services.def"
};

constexpr FmsConnection kConnections[] = {
#define FMS_CONNECTION(cref, type, lsap, scc, rcc, sac, rac, interval, send_high, send_low, receive_high, \
                       receive_low, features)                                                             \
  {cref,                                                                                                  \
   FmsLinkType::type,                                                                                     \
   lsap,                                                                                                  \
   {scc, rcc, sac, rac},                                                                                  \
   interval,                                                                                              \
   {send_high, send_low, receive_high, receive_low},                                                      \
   FmsFeatures(features)},
#include "runtime/bus/profibus/fms_connections.def"
};

constexpr std::string_view kLinkTypes[] = {"MSAZ", "MSAZ_SI", "MSZY", "MSZY_SI"};

}  // namespace

const FmsServiceType& fms_service_type(FmsService service) { return kFmsServices[static_cast<size_t>(service)]; }

bool FmsFeatures::has(FmsService service, int from) const {
  const int feature = fms_service_type(service).feature;
  return feature >= 0 && (octets_ >> (kBits - 1 - from - feature) & 1) != 0;
}

std::array<uint8_t, 6> FmsFeatures::octets() const {
  std::array<uint8_t, 6> octets{};
  for (size_t n = 0; n < octets.size(); ++n)
    octets[n] = static_cast<uint8_t>(octets_ >> (kBits - 8 - static_cast<int>(8 * n)));
  return octets;
}

std::vector<std::string> FmsFeatures::services() const {
  std::vector<std::string> list;
  for (const FmsServiceType& type : kFmsServices) {
    if (requests(type.service)) list.push_back(fmt::format("{}.request", type.text));
    if (responds(type.service)) list.push_back(fmt::format("{}.indication", type.text));
  }
  return list;
}

std::string_view fms_link_type_text(FmsLinkType type) { return kLinkTypes[static_cast<size_t>(type)]; }

std::span<const FmsConnection> fms_connections() { return kConnections; }

const FmsConnection* find_fms_connection(uint8_t cref) {
  for (const FmsConnection& connection : kConnections)
    if (connection.cref == cref) return &connection;
  return nullptr;
}

std::string describe(const FmsConnection& c) {
  return fmt::format("{} {} O {} All All {} {} {} {} {}", c.cref, fms_link_type_text(c.type), c.lsap,
                     c.counters.scc, c.counters.rcc, c.counters.sac, c.counters.rac, c.interval);
}

FmsMasterEntry master_entry(const FmsConnection& slave, uint8_t address) {
  return {slave.type,
          slave.lsap,
          address,
          {slave.counters.rcc, slave.counters.scc, slave.counters.rac, slave.counters.sac},
          slave.interval,
          {slave.pdu.receive_high, slave.pdu.receive_low, slave.pdu.send_high, slave.pdu.send_low},
          slave.features.mirrored()};
}

std::vector<std::string> check_master_entry(const FmsMasterEntry& master, const FmsConnection& slave) {
  std::vector<std::string> broken;
  if (master.type != slave.type)
    broken.push_back(fmt::format("the link type is {}, that of the slave {}", fms_link_type_text(master.type),
                                 fms_link_type_text(slave.type)));
  if (master.rsap != slave.lsap)
    broken.push_back(fmt::format("RSAP is {}, LSAP of the slave {}", master.rsap, slave.lsap));
  for (const FmsServiceType& type : kFmsServices)
    if (master.features.requests(type.service) && !slave.features.responds(type.service))
      broken.push_back(fmt::format("{}.request, which the slave does not have as an indication", type.text));
  if (master.pdu.receive_high < slave.pdu.send_high)
    broken.push_back(fmt::format("high priority: the master receives {} octets, the slave sends {}",
                                 master.pdu.receive_high, slave.pdu.send_high));
  if (master.pdu.receive_low < slave.pdu.send_low)
    broken.push_back(fmt::format("low priority: the master receives {} octets, the slave sends {}",
                                 master.pdu.receive_low, slave.pdu.send_low));
  if (master.counters.scc != slave.counters.rcc)
    broken.push_back(fmt::format("SCC is {}, RCC of the slave {}", master.counters.scc, slave.counters.rcc));
  if (master.counters.rcc != slave.counters.scc)
    broken.push_back(fmt::format("RCC is {}, SCC of the slave {}", master.counters.rcc, slave.counters.scc));
  return broken;
}

}  // namespace ipos::profibus
