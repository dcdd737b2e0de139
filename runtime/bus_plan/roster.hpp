// Who is on each line of a plant, in the order of the cable, with all the planner has to know of him.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/plant/plant.hpp"

namespace ipos::runtime {

struct Member {
  std::string name;
  const Station* station = nullptr;  // null: a master control
  const SbusPort* port = nullptr;    // null: a node of CANopen, or a control
  const CanopenPort* canopen = nullptr;
  int sbus = 1;  // 1 or 2
  Control* control = nullptr;
  uint32_t place = 0;  // line in the plant file
};

struct LineRoster {
  const CanLine* line;
  const BusConfig* config;
  std::vector<Member> members;

  const Member* slave_at(uint8_t address) const;
  bool has_group(uint8_t group) const;
};

// Its variable objects, over whichever profile.
inline const VariableObjects& objects_of(const Member& member) {
  return member.port != nullptr ? member.port->objects() : member.canopen->objects();
}

// Of a station on a line.
inline const SbusSettings& settings_of(const Member& member) {
  return member.port != nullptr ? member.port->settings() : member.canopen->settings();
}

// The process data that it sends over MOVILINK as a control of whichever kind; null: none.
const ControlSettings* movilink_of(const Member& member);
// The nodes that it is the master of; null: it is none.
const canopen::MasterSettings* canopen_of(const Member& member);

std::vector<LineRoster> line_rosters(const Plant& plant);

// What the trial run showed of one identifier on a line.
struct SeenTelegram {
  uint64_t count = 0;
  Time last = 0;
  Time closest = kNever;  // shortest distance of two
};
using SeenTelegrams = std::map<uint32_t, SeenTelegram>;

// "PO of address 33", "object 1024"
std::string telegram_name(Telegram telegram, uint8_t address);

// "TrCycl" for the structure of an object, or "H420".
std::string structure_name(const Station& station, uint32_t variable);

}  // namespace ipos::runtime
