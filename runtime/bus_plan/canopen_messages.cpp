// Reads the communication objects of CiA 301.
#include "runtime/bus_plan/canopen_messages.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/bus/canopen/connections.hpp"

namespace ipos::runtime {
namespace {

namespace objects = canopen::objects;
using canopen::Connection;
using canopen::ObjectDictionary;

constexpr Time kInhibitUnit = 100 * kMicrosecond;

void add_pdo(const ObjectDictionary& dictionary, uint8_t number, bool transmit,
             std::vector<CanopenMessage>& messages) {
  const auto communication =
      static_cast<uint16_t>((transmit ? objects::kTransmitPdo : objects::kReceivePdo) + number);
  const auto mapping =
      static_cast<uint16_t>((transmit ? objects::kTransmitMapping : objects::kReceiveMapping) + number);
  const uint32_t cob_id = dictionary.value(communication, objects::kCobId);
  if ((cob_id & objects::kOff) != 0) return;
  const auto type = static_cast<uint8_t>(dictionary.value(communication, objects::kType));
  CanopenMessage message{cob_id & objects::kIdMask, fmt::format("{}PDO{}", transmit ? "T" : "R", number + 1),
                         transmit, static_cast<uint8_t>(bits_of(mapping_of(dictionary, mapping)) / 8)};
  if (transmit && canopen::pdo_types::is_synchronous(type)) {
    message.syncs = std::max<unsigned>(type, 1);  // type 0: at the worst at each
  } else if (transmit && canopen::pdo_types::is_event(type)) {
    const Time inhibit = dictionary.value(communication, objects::kInhibitTime) * kInhibitUnit;
    const Time event = dictionary.value(communication, objects::kEventTimer) * kMillisecond;
    message.period = inhibit != 0 ? inhibit : event;
  } else {
    message.asked = transmit;
  }
  messages.push_back(std::move(message));
}

}  // namespace

std::vector<CanopenMessage> canopen_messages(const canopen::Node& node) {
  const ObjectDictionary& dictionary = node.dictionary();
  const uint8_t number = dictionary.node();
  std::vector<CanopenMessage> messages;
  const auto add = [&](uint32_t id, const char* what, bool transmits, uint8_t bytes, Time period = 0) {
    messages.push_back({id, what, transmits, bytes, period == 0, 0, period});
  };
  add(canopen::identifier(Connection::Nmt), "NMT", false, 2);
  add(dictionary.value(objects::kSyncId) & objects::kIdMask, "SYNC", false, 0);
  if (const uint32_t id = dictionary.value(objects::kEmergencyId); (id & objects::kOff) == 0)
    add(id & objects::kIdMask, "EMCY", true, 8);
  for (const bool transmit : {true, false})
    for (uint8_t n = 0; n < objects::kPdos; ++n) add_pdo(dictionary, n, transmit, messages);
  add(canopen::identifier(Connection::SdoResponse, number), "SDO response", true, 8);
  add(canopen::identifier(Connection::SdoRequest, number), "SDO request", false, 8);
  const Time heartbeat = dictionary.value(objects::kProducerHeartbeat) * kMillisecond;
  add(canopen::identifier(Connection::ErrorControl, number), "guarding or heartbeat", true, 1, heartbeat);
  return messages;
}

}  // namespace ipos::runtime
