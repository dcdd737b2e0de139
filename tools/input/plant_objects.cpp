// The objects are those that compiler/analysis finds in the images; who is on a line, and which identifiers belong to MOVILINK
// and CANopen there, is what the bus plan knows.
#include "tools/input/plant_objects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>

#include "compiler/analysis/maps.hpp"
#include "compiler/diag/places.hpp"
#include "runtime/bus/movilink/identifiers.hpp"
#include "runtime/bus/movilink/variable_telegram.hpp"
#include "runtime/bus_plan/identifiers.hpp"
#include "runtime/bus_plan/roster.hpp"
#include "runtime/plant_file/outer_port.hpp"
#include "runtime/scom/object_table.hpp"

namespace ipos::tools {
namespace {

using runtime::FindingKind;
using runtime::LineRoster;
using runtime::Member;
using runtime::VariableFormat;

struct ObjectUse {
  const runtime::Station* station;
  int sbus;          // 1 or 2
  uint32_t address;  // of the command
  bool sends;
  int32_t object;
  std::optional<VariableFormat> format;  // none: not known, or refused
};

// Of one line.
struct LineObjects {
  std::vector<ObjectUse> uses;
  bool all_known = true;
};

class LineCheck {
 public:
  LineCheck(const LineRoster& roster, std::vector<ObjectFinding>& findings) : roster_(roster), findings_(findings) {
    for (const Member& member : roster.members)
      if (member.station != nullptr && member.station->image() != nullptr) collect(member);
  }

  void run() {
    formats();
    if (!objects_.all_known || !is_closed()) return;
    nobody(true);
    nobody(false);
  }

 private:
  static bool is_on_second(int64_t object) { return object >= 0 && (object & runtime::kSbus2Object) != 0; }

  static bool has_objects(const vm::Image& image) {
    for (uint32_t address = 0; address < image.code.size();) {
      const vm::Decoded decoded = vm::decode(image.code, address);
      if (decoded.status != vm::DecodeStatus::Ok) return false;
      if (decoded.instruction.opcode == vm::Opcode::Scom) return true;
      address += decoded.words;
    }
    return false;
  }

  void collect(const Member& member) {
    const runtime::Station& station = *member.station;
    if (!has_objects(*station.image())) return;
    const bool both = (station.sbus(1) != nullptr || station.canopen(1) != nullptr) &&
                      (station.sbus(2) != nullptr || station.canopen(2) != nullptr);
    for (const auto& telegram : compiler::program_maps(*station.image(), station.config().unit->variables).telegrams) {
      if (!telegram.object) {
        objects_.all_known = false;
        continue;
      }
      // On a unit with one line the other bus is refused, or the bit is part of the number; the program tells of that.
      if (both && is_on_second(*telegram.object) != (member.sbus == 2)) continue;
      const auto number = static_cast<int32_t>(*telegram.object);
      objects_.uses.push_back({&station, member.sbus, telegram.address, telegram.kind != "receive",
                               member.sbus == 2 ? number & ~runtime::kSbus2Object : number,
                               telegram.format ? runtime::variable_format(static_cast<int32_t>(*telegram.format)) : std::nullopt});
    }
  }

  // Nobody from outside sends or receives on it.
  bool is_closed() const {
    const bool control = std::any_of(roster_.members.begin(), roster_.members.end(), [](const Member& m) { return m.control != nullptr; });
    return roster_.members.size() > 1 && !control && roster_.config->port.empty();
  }

  // MOVILINK and CANopen, in this plant or after a change of addresses.
  bool is_of_profile(int32_t object) const {
    if (runtime::classify_identifier(static_cast<uint32_t>(object))) return true;
    const auto planned = planned_identifiers(roster_);
    return std::any_of(planned.begin(), planned.end(), [&](const runtime::PlannedIdentifier& one) {
      return one.id == static_cast<uint32_t>(object) &&
             std::any_of(one.uses.begin(), one.uses.end(), [](const runtime::PlannedUse& use) { return use.movilink; });
    });
  }

  const ObjectUse* partner_of(const ObjectUse& use) const {
    const auto found = std::find_if(objects_.uses.begin(), objects_.uses.end(), [&](const ObjectUse& other) {
      return other.object == use.object && other.sends != use.sends && !is_same(other, use);
    });
    return found == objects_.uses.end() ? nullptr : &*found;
  }

  // One unit may use an identifier once, so it is no partner of its own.
  static bool is_same(const ObjectUse& a, const ObjectUse& b) { return a.station == b.station && a.sbus == b.sbus; }

  bool is_alone(const ObjectUse& use) const {
    return use.object >= 0 && use.object < static_cast<int32_t>(runtime::kStandardIdLimit) && partner_of(use) == nullptr &&
           !is_of_profile(use.object);
  }

  void nobody(bool sends) {
    for (const ObjectUse& use : objects_.uses)
      if (use.sends == sends && is_alone(use))
        find(sends ? FindingKind::NobodyReceives : FindingKind::NobodySends, use,
             fmt::format("nobody on {} {} object {}, which {} {} here{}", roster_.config->name, sends ? "receives" : "sends",
                         runtime::object_words(use.object), use.station->config().name, sends ? "sends" : "expects", others(use)));
  }

  // What may have been meant.
  std::string others(const ObjectUse& use) const {
    std::string text;
    for (const ObjectUse& other : objects_.uses) {
      if (other.sends == use.sends || is_same(other, use) || !is_alone(other)) continue;
      const std::string words = fmt::format("{} {} {}", other.station->config().name, other.sends ? "sends" : "expects",
                                            runtime::object_words(other.object));
      if (text.find(words) == std::string::npos) text += (text.empty() ? "; " : ", ") + words;
    }
    return text;
  }

  void formats() {
    for (const ObjectUse& use : objects_.uses) {
      if (use.sends || !use.format) continue;
      for (const ObjectUse& sent : objects_.uses) {
        if (!sent.sends || !sent.format || sent.object != use.object || is_same(sent, use) || *sent.format == *use.format) continue;
        find(FindingKind::Formats, use,
             fmt::format("object {} is received by {} with {}, but {} sends it with {}{}", runtime::object_words(use.object),
                         use.station->config().name, format_text(*use.format), sent.station->config().name, format_text(*sent.format),
                         sent.format->length == use.format->length ? "" : ": no telegram is taken"));
      }
    }
  }

  static std::string format_text(VariableFormat format) {
    return fmt::format("{} bytes {}", format.length, format.layout == runtime::VariableLayout::Motorola ? "MOTOROLA" : "INTEL");
  }

  void find(FindingKind kind, const ObjectUse& use, const std::string& text) {
    Told place{"warning", "", 0, 0, text, std::string(runtime::finding_type(kind).code)};
    const vm::Image& image = *use.station->image();
    const auto next = std::upper_bound(image.lines.begin(), image.lines.end(), use.address,
                                       [](uint32_t at, const vm::LineEntry& entry) { return at < entry.address; });
    if (next != image.lines.begin()) {
      const vm::LineEntry& entry = *std::prev(next);
      place.file = image.files[entry.file];
      place.line = entry.line;
      place.column = entry.column;
    }
    findings_.push_back({{kind, roster_.config->name, text}, std::move(place)});
  }

  const LineRoster& roster_;
  std::vector<ObjectFinding>& findings_;
  LineObjects objects_;
};

}  // namespace

std::vector<ObjectFinding> object_findings(const runtime::Plant& plant) {
  std::vector<ObjectFinding> findings;
  for (const LineRoster& roster : runtime::line_rosters(plant)) LineCheck(roster, findings).run();
  return findings;
}

std::string text_of(const ObjectFinding& one) {
  const Told& place = one.place;
  if (place.file.empty()) return fmt::format("ipos: warning: {} [{}]", place.text, place.code);
  return fmt::format("{}:{}:{}: warning: {} [{}]", compiler::printable(place.file), place.line, place.column, place.text, place.code);
}

void tell_objects(const runtime::Plant& plant, BuildRecord* record) {
  for (const ObjectFinding& one : object_findings(plant))
    if (record != nullptr)
      record->tell(one.place);
    else
      fmt::print(stderr, "{}\n", text_of(one));
}

}  // namespace ipos::tools
