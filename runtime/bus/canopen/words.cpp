// NMT, SYNC, EMCY, PDO and error control in words.
#include "runtime/bus/canopen/words.hpp"

#include <fmt/format.h>

#include <utility>

#include "runtime/bus/can/identifier_text.hpp"
#include "runtime/bus/canopen/emergency.hpp"
#include "runtime/bus/canopen/nmt.hpp"

namespace ipos::runtime::canopen {
namespace {

std::string bytes_text(const Frame& frame) {
  std::string text;
  for (uint8_t n = 0; n < frame.length; ++n)
    text += fmt::format("{}{:02X}", n == 0 ? "" : " ", frame.data[n]);
  return text.empty() ? "no data" : text;
}

std::string word_text(const NodeName& name, Address address, uint16_t word) {
  const bool input = address.index == objects::kInput;
  const WordAssignment& assignment = input ? name.input : name.output;
  const uint8_t code =
      address.sub <= assignment.size() ? assignment[static_cast<size_t>(address.sub - 1)] : 0;
  if (code == 0) return fmt::format("{} {:04X}h", entry_name(address), word);
  return fmt::format("{} {} {}", entry_name(address), process_word_name(*name.unit, input, code),
                     process_word_text(input, code, word));
}

std::string mapped_text(const NodeName& name, const Mapping& mapping, const Frame& frame) {
  if (frame.length * 8U < bits_of(mapping))
    return fmt::format("{} of {} bytes: {}", frame.length, bits_of(mapping) / 8, bytes_text(frame));
  std::string text;
  size_t at = 0;
  for (const Mapped& mapped : mapping) {
    if (is_word(mapped))
      text += fmt::format(
          "{}{}", text.empty() ? "" : ", ",
          word_text(name, mapped.address, static_cast<uint16_t>(frame.data[at] | frame.data[at + 1] << 8)));
    at += mapped.bits / 8;
  }
  return text.empty() ? bytes_text(frame) : text;
}

std::string life_text(const Frame& frame) {
  if (frame.remote) return "guarding request";
  if (frame.length != 1) return fmt::format("{} bytes in place of 1: {}", frame.length, bytes_text(frame));
  const auto state = static_cast<uint8_t>(frame.data[0] & 0x7F);
  const std::string_view text = state_text(state);
  const std::string name = text.empty() ? fmt::format("state {:02X}h", state) : std::string(text);
  return (frame.data[0] & 0x80) != 0 ? name + ", toggle 1" : name;
}

}  // namespace

std::string emergency_text(const Frame& frame) {
  if (frame.length != 8)
    return fmt::format("EMCY with {} bytes in place of 8: {}", frame.length, bytes_text(frame));
  const auto& data = frame.data;
  const auto code = static_cast<uint16_t>(data[0] | data[1] << 8);
  std::string text = code == 0 ? "EMCY gone" : fmt::format("EMCY {:04X}h", code);
  for (const EmergencyRow& row : kEmergencies)
    if (row.code == code) text += fmt::format(" {}", row.text);
  text += fmt::format(", error register {:02X}h", data[2]);
  if (const unsigned status = data[4] | unsigned{data[5]} << 8; status != 0)
    text += fmt::format(", status word 1 {:04X}h", status);
  return text;
}

LineWords::LineWords(std::vector<NodeName> names) {
  find_messages();
  for (NodeName& one : names) name(std::move(one));
}

void LineWords::name(NodeName name) {
  if (name.unit == nullptr) name.unit = &stdlib::unit_with(stdlib::Trait::Canopen);
  NodeName& known = node(name.node).name;
  known = std::move(name);
}

LineWords::Listened& LineWords::node(uint8_t number) {
  const auto found = nodes_.find(number);
  if (found != nodes_.end()) return found->second;
  NodeName name{number, fmt::format("node {}", number), &stdlib::unit_with(stdlib::Trait::Canopen), {}, {}};
  Listened& added =
      nodes_.emplace(number, Listened{std::move(name), ObjectDictionary(number), {}, {}}).first->second;
  find_messages();
  return added;
}

// Which messages have which identifiers. The first PDO of one counts.
void LineWords::find_messages() {
  pdos_.clear();
  syncs_ = {identifier(Connection::Sync)};
  for (const auto& [number, listened] : nodes_) {
    syncs_.insert(listened.dictionary.value(objects::kSyncId) & objects::kIdMask);
    for (const bool transmit : {true, false})
      for (uint8_t n = 0; n < objects::kPdos; ++n) {
        const uint16_t first = transmit ? objects::kTransmitPdo : objects::kReceivePdo;
        const uint32_t cob_id = listened.dictionary.value(static_cast<uint16_t>(first + n), objects::kCobId);
        if ((cob_id & objects::kOff) == 0) pdos_.emplace(cob_id & objects::kIdMask, Pdo{number, transmit, n});
      }
  }
}

Description LineWords::describe(const Frame& frame) {
  const std::string id = id_text(frame.id, frame.extended) + ' ';
  if (frame.extended) return {false, id + bytes_text(frame)};
  if (const auto text = pdo_text(frame)) return {true, id + *text};
  if (syncs_.contains(frame.id)) return {true, id + "SYNC"};
  const auto addressed = connection_of(frame.id);
  if (!addressed) return {false, id + bytes_text(frame)};
  return {true, id + addressed_text(frame, *addressed)};
}

// Objects are known by what SDO write and boot-up sets back; of all other frames nothing is kept.
void LineWords::listen(const Frame& frame) {
  const auto addressed = connection_of(frame.id);
  if (frame.extended || !addressed) return;
  switch (addressed->connection) {
    case Connection::SdoRequest:
    case Connection::SdoResponse:
    case Connection::ErrorControl: describe(frame); return;
    default: return;
  }
}

// By the mapping that the node has as far as heard; nothing when no PDO that is on has this identifier.
std::optional<std::string> LineWords::pdo_text(const Frame& frame) {
  if (const auto addressed = connection_of(frame.id); addressed && addressed->node != 0)
    node(addressed->node);
  const auto found = pdos_.find(frame.id);
  if (found == pdos_.end()) return std::nullopt;
  const Pdo& pdo = found->second;
  const Listened& listened = node(pdo.node);
  const char* way = pdo.transmit ? "T" : "R";
  if (frame.remote) return fmt::format("{}PDO{} asked for -> {}", way, pdo.number + 1, listened.name.name);
  const uint16_t first = pdo.transmit ? objects::kTransmitMapping : objects::kReceiveMapping;
  const Mapping mapping = mapping_of(listened.dictionary, static_cast<uint16_t>(first + pdo.number));
  return fmt::format("{}PDO{} {} {} {}", way, pdo.number + 1, mapped_text(listened.name, mapping, frame),
                     pdo.transmit ? "<-" : "->", listened.name.name);
}

std::string LineWords::addressed_text(const Frame& frame, const Addressed& addressed) {
  if (addressed.connection == Connection::Nmt) return nmt_text(frame);
  const ConnectionRow& row = row_of(addressed.connection);
  Listened& talker = node(addressed.node);
  std::string text;
  switch (addressed.connection) {
    case Connection::Emergency: text = emergency_text(frame); break;
    case Connection::ErrorControl:
      text = life_text(frame);
      if (!frame.remote && frame.data[0] == static_cast<uint8_t>(State::BootUp)) {
        talker.dictionary.restore();
        find_messages();
      }
      break;
    case Connection::SdoRequest:
    case Connection::SdoResponse:
      if (frame.length != 8 || frame.remote)
        text = fmt::format("SDO with {} bytes in place of 8: {}", frame.length, bytes_text(frame));
      else
        text = row.from_node ? sdo_response_text(talker, frame.data) : sdo_request_text(talker, frame.data);
      break;
    default: text = fmt::format("{} not mapped: {}", row.text, bytes_text(frame));
  }
  const bool from_node = row.from_node && !frame.remote;
  return fmt::format("{} {} {}", text, from_node ? "<-" : "->", talker.name.name);
}

std::string LineWords::nmt_text(const Frame& frame) {
  if (frame.length != 2)
    return fmt::format("NMT with {} bytes in place of 2: {}", frame.length, bytes_text(frame));
  const std::string_view command = command_text(frame.data[0]);
  const uint8_t number = frame.data[1];
  const std::string target = number == 0       ? "all nodes"
                             : is_node(number) ? node(number).name.name
                                               : fmt::format("node {}", number);
  if (command.empty()) return fmt::format("NMT unknown command {:02X}h -> {}", frame.data[0], target);
  return fmt::format("NMT {} -> {}", command, target);
}

}  // namespace ipos::runtime::canopen
