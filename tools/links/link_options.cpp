// --port, --baud, --canopen, --quiet, --unit and --address.
#include "tools/links/link_options.hpp"

#include <fmt/format.h>

#include <charconv>

#include "runtime/bus/canopen/connections.hpp"
#include "runtime/bus/movilink/serial_telegram.hpp"
#include "runtime/os_port/port_names.hpp"
#include "runtime/plant_file/plant_file.hpp"
#include "stdlib/parameters.hpp"
#include "stdlib/unit_names.hpp"
#include "tools/cli/failure.hpp"

namespace ipos::tools {

namespace {

std::string check_patience(const std::string& text) {
  const runtime::Time time = runtime::parse_duration(text);
  return time >= runtime::kMillisecond && time <= 20 * runtime::kSecond ? ""
                                                                          : "'" + text + "' is no time from 1ms to 20s";
}

}  // namespace

void add_link_options(cli::Verb& verb, LinkFlags& flags, bool port) {
  if (port)
    verb.option("--port", flags.port,
                "reach a unit over a real port: can0, slcan:/dev/ttyACM0, /dev/ttyUSB0 or /dev/ttyUSB0@16ms");
  verb.option("--baud", flags.baud, "rate of the bus; default 500000 on CAN and PROFIBUS, 9600 on RS-485")
      .one_of(
          {"9600", "19200", "57600", "93750", "125000", "187500", "250000", "500000", "1000000", "1500000"});
  verb.flag("--canopen", flags.canopen, "the units are CANopen nodes (P880 = 1): SDO in place of MOVILINK");
  verb.option("--patience", flags.patience,
              "how much longer than a unit may take an answer is waited for: 1ms to 20s, default 30ms")
      .check(check_patience, "TIME");
  verb.flag("--quiet", flags.quiet, "do not tell what the port cannot do; only when it goes away");
}

void add_profibus_option(cli::Verb& verb, LinkFlags& flags) {
  verb.flag("--profibus", flags.profibus,
            "the units are PROFIBUS-DP slaves at a serial port (docs/guide/units-at-ports.md)");
}

void check_profibus(const LinkFlags& flags) {
  if (!flags.profibus) return;
  if (flags.canopen) throw Failure(kUsage, "either --canopen or --profibus");
  if (runtime::kind_of_port(flags.port) != runtime::PortKind::Serial)
    throw Failure(kUsage, fmt::format("--profibus: {} is a CAN port", flags.port));
}

std::string check_unit(const std::string& name) {
  if (const stdlib::UnitType* unit = stdlib::find_unit_or_plate(name))
    return stdlib::parameter_table(*unit).rows().empty() ? "unit " + name + " has no list of parameters" : "";
  return stdlib::no_unit_text(name);
}

std::string check_address(const std::string& text) {
  int address = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), address);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  if (whole &&
      ((address >= 0 && address <= runtime::canopen::kMaxNode) || address == runtime::kUniversalAddress))
    return "";
  return "'" + text +
         "' is no address of a unit: 0..63 on SBus, 0..99 or 254 on RS-485, 1..127 on CANopen, "
         "0..125 on PROFIBUS";
}

}  // namespace ipos::tools
