// ipos scan: which addresses of a bus answer, and what is there.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "stdlib/faults.hpp"
#include "stdlib/index_areas.hpp"
#include "stdlib/parameters.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/terminal.hpp"
#include "tools/cli/verbs.hpp"
#include "tools/links/dp_units.hpp"
#include "tools/links/link_access.hpp"
#include "tools/links/link_options.hpp"
#include "tools/parameters/param_columns.hpp"

namespace ipos::tools {
namespace {

using stdlib::Service;

constexpr uint16_t kStatus = 8310;    // P010..P013, status word 1 in the low word

struct ScanFlags {
  LinkFlags link;
  int from = 0;
  int to = -1;  // the last one of the bus
};

std::string firmware_of(const stdlib::UnitType* unit, const AccessReply& reply) {
  if (!reply) return "-";
  const stdlib::Parameter* row = unit ? stdlib::parameter_table(*unit).find(stdlib::kFirmwareIndex) : nullptr;
  return row ? stdlib::parameter_text(*row, *reply) : std::to_string(*reply);
}

// Status word 1 (1053 1610 p. 41): with bit 5 the high byte is the number of a fault.
std::string fault_of(const AccessReply& reply) {
  constexpr uint32_t kFaultBit = 1U << 5;
  if (!reply) return "-";
  const auto word = static_cast<uint32_t>(*reply);
  if ((word & kFaultBit) == 0) return "no fault";
  const auto number = static_cast<uint8_t>(word >> 8);
  const stdlib::FaultRow* row = stdlib::find_fault(number);
  return fmt::format("F{:02} {}", number, row ? row->name : "unknown fault");
}

// What a master of class 2 may ask each of them, no matter which master locked it.
int scan_profibus(const ScanFlags& flags) {
  DpStation line(flags.link);
  const int last = std::min<int>(flags.to < 0 ? profibus::kLastStation : flags.to, profibus::kLastStation);
  const bool progress = is_terminal(STDERR_FILENO);
  std::vector<std::vector<std::string>> lines{dp_scan_heads()};
  for (int n = flags.from; n <= last; ++n) {
    if (n == kPcAddress) continue;
    if (progress) fmt::print(stderr, "\r\033[Kaddress {} of {}", n, last);
    if (auto row = dp_scan_row(line, static_cast<uint8_t>(n))) lines.push_back(std::move(*row));
  }
  if (progress) fmt::print(stderr, "\r\033[K");
  if (lines.size() > 1) {
    fmt::print("{}", columns(lines));
    return kGood;
  }
  fmt::print(stderr,
             "ipos: {}: nobody answers at {}..{}: unit on, address (P073), {} baud, A and B not exchanged?\n",
             flags.link.port, flags.from, last, line.baud());
  return kFindings;
}

int scan(ScanFlags flags) {
  check_profibus(flags.link);
  if (flags.link.profibus) return scan_profibus(flags);
  flags.link.repeats = false;
  const auto link = BusLink::open(flags.link);
  const int first = std::max<int>(flags.from, link->first_address());
  const int last = flags.to < 0 ? link->last_address() : std::min<int>(flags.to, link->last_address());
  const bool progress = is_terminal(STDERR_FILENO);
  std::vector<std::vector<std::string>> lines{{"address", "unit", "firmware", "fault"}};
  std::string trouble;
  for (int n = first; n <= last; ++n) {
    if (progress) fmt::print(stderr, "\r\033[Kaddress {} of {}", n, last);
    const auto address = static_cast<uint8_t>(n);
    const AccessReply firmware = link->execute(address, Service::Read, stdlib::kFirmwareIndex, 0);
    if (!firmware && !firmware.error().code) {
      trouble = firmware.error().trouble;
      continue;
    }
    const stdlib::UnitType* unit = identify(*link, address);
    const AccessReply status = link->execute(address, Service::Read, kStatus, 0);
    lines.push_back({std::to_string(n), std::string(unit ? unit->title : "unknown unit"),
                     firmware_of(unit, firmware), fault_of(status)});
  }
  if (progress) fmt::print(stderr, "\r\033[K");
  if (lines.size() > 1) {
    fmt::print("{}", columns(lines));
    return kGood;
  }
  fmt::print(stderr, "ipos: {}: nobody answers at {}..{}; at the last one: {}\n", flags.link.port, first,
             last, trouble);
  return kFindings;
}

}  // namespace

void add_scan(cli::Verb& app) {
  auto flags = std::make_shared<ScanFlags>();
  cli::Verb& verb = app.verb("scan", "addresses of a real bus that answer, with unit type and firmware");
  verb.option("PORT", flags->link.port, "can0, slcan:/dev/ttyACM0, /dev/ttyUSB0, ...").required();
  verb.option("--from", flags->from, "first address, default 0, on CANopen 1").between(0, 127);
  verb.option("--to", flags->to,
              "last address; default 63 on SBus, 99 on RS-485, 127 on CANopen, 125 on PROFIBUS")
      .between(0, 127);
  add_link_options(verb, flags->link, false);
  add_profibus_option(verb, flags->link);
  verb.footer("Example:\n  ipos scan /dev/ttyUSB0 --to 10");
  verb.runs([flags] { return scan(*flags); });
}

}  // namespace ipos::tools
