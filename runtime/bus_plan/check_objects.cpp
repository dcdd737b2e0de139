// What can be wrong with variable objects (1053 1610 p. 51-56, 64), and what the trial run did not see.
#include <fmt/format.h>

#include <algorithm>

#include "runtime/bus_plan/checks.hpp"

namespace ipos::runtime {
namespace {

class ObjectCheck {
 public:
  ObjectCheck(const LineRoster& roster, const LinePlan& plan, std::vector<Finding>& findings)
      : roster_(roster), plan_(plan), findings_(findings) {}

  void run() {
    for (const Member& member : roster_.members) {
      if (member.station == nullptr) continue;
      for (const ObjectDefinition& definition : objects_of(member).definitions()) closed(member, definition);
      used_once(member);
      started(member);
    }
    formats();
  }

 private:
  void find(FindingKind kind, std::string text) { findings_.push_back({kind, plan_.name, std::move(text)}); }

  static std::string name(const Member& member, const ObjectDefinition& definition) {
    return fmt::format("{}: object {} in {}", member.name, object_words(definition.object),
                       structure_name(*member.station, definition.variable));
  }

  void closed(const Member& member, const ObjectDefinition& definition) {
    const auto station = std::find_if(plan_.closed.begin(), plan_.closed.end(),
                                      [&](const ClosedIdentifiers& c) { return c.station == member.name; });
    const bool receive = definition.kind == ObjectKind::Receive;
    const auto has = [&](const std::vector<uint32_t>& list) {
      return std::find(list.begin(), list.end(), static_cast<uint32_t>(definition.object)) != list.end();
    };
    if (station != plan_.closed.end() && has(receive ? station->receive : station->transmit))
      find(FindingKind::MovilinkIdentifier,
           fmt::format("{} cannot be {}: {}", name(member, definition), receive ? "received" : "sent",
                       user_of(member, static_cast<uint32_t>(definition.object))));
    else if (!definition.accepted)
      find(FindingKind::ObjectRefused, fmt::format("{}: {}", name(member, definition), definition.why));
  }

  // Rule 2 of p. 51. Two that send are found with the senders of the whole line.
  void used_once(const Member& member) {
    const auto& definitions = objects_of(member).definitions();
    for (const ObjectDefinition& sent : definitions)
      for (const ObjectDefinition& received : definitions)
        if (sent.accepted && received.accepted && sent.object == received.object &&
            sent.kind != ObjectKind::Receive && received.kind == ObjectKind::Receive)
          find(FindingKind::DoubleIdentifier,
               fmt::format("identifier {} is sent ({}) and received ({}) by {}", object_words(sent.object),
                           structure_name(*member.station, sent.variable),
                           structure_name(*member.station, received.variable), member.name));
  }

  // "it is the PO of address 1, which unit2 receives"; the station's own use first.
  std::string user_of(const Member& member, uint32_t id) const {
    const PlannedUse* found = nullptr;
    for (const PlannedIdentifier& identifier : plan_.identifiers)
      if (identifier.id == id)
        for (const PlannedUse& use : identifier.uses)
          if (use.movilink && (found == nullptr || use.station == member.name)) found = &use;
    if (found == nullptr) return "it belongs to MOVILINK";
    return fmt::format("it is the {} that {} {}", found->what, found->station,
                       found->transmits ? "sends" : "receives");
  }

  void started(const Member& member) {
    const auto& definitions = objects_of(member).definitions();
    const bool needs_start = std::any_of(
        definitions.begin(), definitions.end(),
        [](const ObjectDefinition& d) { return d.accepted && d.kind != ObjectKind::TransmitAcyclic; });
    if (needs_start && !objects_of(member).started())
      find(
          FindingKind::NotStarted,
          fmt::format("{} defines cyclic or receive objects, but _SBusCommOn was not reached: they stay dead",
                      member.name));
  }

  void formats() {
    for (const Member& sender : roster_.members)
      for (const Member& receiver : roster_.members) {
        if (sender.station == nullptr || receiver.station == nullptr) continue;
        for (const ObjectDefinition& sent : objects_of(sender).definitions())
          for (const ObjectDefinition& received : objects_of(receiver).definitions())
            if (sent.accepted && received.accepted && sent.object == received.object &&
                sent.kind != ObjectKind::Receive && received.kind == ObjectKind::Receive &&
                sent.format != received.format)
              find(FindingKind::Formats,
                   fmt::format("object {} is sent by {} with {} and received by {} with {}",
                               object_words(sent.object), sender.name, format_text(*sent.format),
                               receiver.name, format_text(*received.format)));
      }
  }

  static std::string format_text(VariableFormat format) {
    return fmt::format("{} bytes {}", format.length,
                       format.layout == VariableLayout::Motorola ? "MOTOROLA" : "INTEL");
  }

  const LineRoster& roster_;
  const LinePlan& plan_;
  std::vector<Finding>& findings_;
};

// Has the command that stands at this structure been carried out?
bool was_reached(const Station& station, const vm::Instruction& command) {
  const auto operand = static_cast<uint32_t>(command.operands[command.opcode == vm::Opcode::Scom ? 1 : 0]);
  if (command.opcode == vm::Opcode::Movlnk) return station.has_called(operand);
  for (const int number : {1, 2}) {
    const SbusPort* port = station.sbus(number);
    const CanopenPort* canopen = station.canopen(number);
    if (port == nullptr && canopen == nullptr) continue;
    const VariableObjects& objects = port != nullptr ? port->objects() : canopen->objects();
    for (const ObjectDefinition& definition : objects.definitions())
      if (definition.variable == operand && static_cast<int32_t>(definition.kind) == command.operands[0])
        return true;
  }
  return false;
}

}  // namespace

void check_objects(const LineRoster& roster, const LinePlan& plan, std::vector<Finding>& findings) {
  ObjectCheck(roster, plan, findings).run();
}

void check_reached(const Plant& plant, std::vector<Finding>& findings) {
  for (const auto& station : plant.stations()) {
    if (station->image() == nullptr) continue;
    const std::vector<uint32_t>& code = station->image()->code;
    for (uint32_t address = 0; address < code.size();) {
      const vm::Decoded decoded = vm::decode(code, address);
      if (decoded.status != vm::DecodeStatus::Ok) break;
      const vm::Instruction& command = decoded.instruction;
      const bool concerned = command.opcode == vm::Opcode::Scom || command.opcode == vm::Opcode::Movlnk;
      if (concerned && !was_reached(*station, command)) {
        const std::string place = station->source_place(address);
        findings.push_back({FindingKind::NotReached, station->config().sbus,
                            fmt::format("{}: {} at {} was not reached", station->config().name,
                                        command.opcode == vm::Opcode::Scom ? "SCOM" : "MOVLNK",
                                        place.empty() ? fmt::format("word {}", address) : place)});
      }
      address += decoded.words;
    }
  }
}

}  // namespace ipos::runtime
