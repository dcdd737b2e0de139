// Tables and rules of the communication relationship list.
#include "runtime/bus/profibus/fms/connection.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace ipos::profibus::fms {
namespace {

constexpr ServiceType kServices[] = {
#define FMS_SERVICE(name, feature, confirmed, number, of_object, text) \
  {Service::name, feature, confirmed, number, of_object, text},
#include "runtime/bus/profibus/fms/services.def"
};

constexpr Connection kConnections[] = {
#define FMS_CONNECTION(cref, type, lsap, scc, rcc, sac, rac, interval, send_high, send_low, receive_high, \
                       receive_low, features)                                                             \
  {cref,                                                                                                  \
   LinkType::type,                                                                                     \
   lsap,                                                                                                  \
   {scc, rcc, sac, rac},                                                                                  \
   interval,                                                                                              \
   {send_high, send_low, receive_high, receive_low},                                                      \
   Features(features)},
#include "runtime/bus/profibus/fms/connections.def"
};

constexpr std::string_view kLinkTypes[] = {"MSAZ", "MSAZ_SI", "MSZY", "MSZY_SI"};

}  // namespace

std::span<const ServiceType> service_types() { return kServices; }
const ServiceType& service_type(Service service) { return kServices[static_cast<size_t>(service)]; }

bool Features::has(Service service, int from) const {
  const int feature = service_type(service).feature;
  return feature >= 0 && (octets_ >> (kBits - 1 - from - feature) & 1) != 0;
}

std::array<uint8_t, 6> Features::octets() const {
  std::array<uint8_t, 6> octets{};
  for (size_t n = 0; n < octets.size(); ++n)
    octets[n] = static_cast<uint8_t>(octets_ >> (kBits - 8 - static_cast<int>(8 * n)));
  return octets;
}

std::vector<std::string> Features::services() const {
  std::vector<std::string> list;
  for (const ServiceType& type : kServices) {
    if (requests(type.service)) list.push_back(fmt::format("{}.request", type.text));
    if (responds(type.service)) list.push_back(fmt::format("{}.indication", type.text));
  }
  return list;
}

std::string_view link_type_text(LinkType type) { return kLinkTypes[static_cast<size_t>(type)]; }

std::span<const Connection> connections() { return kConnections; }

const Connection* find_connection(uint8_t cref) {
  for (const Connection& connection : kConnections)
    if (connection.cref == cref) return &connection;
  return nullptr;
}

const Connection* connection_at(uint8_t lsap) {
  for (const Connection& connection : kConnections)
    if (connection.lsap == lsap) return &connection;
  return nullptr;
}

std::string describe(const Connection& c) {
  return fmt::format("{} {} O {} All All {} {} {} {} {}", c.cref, link_type_text(c.type), c.lsap,
                     c.counters.scc, c.counters.rcc, c.counters.sac, c.counters.rac, c.interval);
}

MasterEntry master_entry(const Connection& slave, uint8_t address) {
  return {slave.type,
          slave.lsap,
          address,
          {slave.counters.rcc, slave.counters.scc, slave.counters.rac, slave.counters.sac},
          slave.interval,
          {slave.pdu.receive_high, slave.pdu.receive_low, slave.pdu.send_high, slave.pdu.send_low},
          slave.features.mirrored()};
}

std::vector<std::string> check_master_entry(const MasterEntry& master, const Connection& slave) {
  std::vector<std::string> broken;
  if (master.type != slave.type)
    broken.push_back(fmt::format("the link type is {}, that of the slave {}", link_type_text(master.type),
                                 link_type_text(slave.type)));
  if (master.rsap != slave.lsap)
    broken.push_back(fmt::format("RSAP is {}, LSAP of the slave {}", master.rsap, slave.lsap));
  for (const ServiceType& type : kServices)
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

}  // namespace ipos::profibus::fms
