// As the schemas of FMI 3.0 and FMI-LS-BUS 1.0 have them.
#include "tools/fmu/bus_terminals.hpp"

#include <fmt/format.h>

#include "runtime/fmi/names.hpp"
#include "tools/cli/xml_text.hpp"

namespace ipos::tools {
namespace {

constexpr std::string_view kMembers[fmi::kTerminalMembers] = {"Rx_Data", "Tx_Data", "Rx_Clock", "Tx_Clock", "BusNotifications"};

}  // namespace

std::string member_name(const fmi::BusTerminal& terminal, fmi::TerminalMember member) {
  return fmi::structured_name(terminal.name(), fmt::format("{}.{}", terminal.name(), kMembers[static_cast<size_t>(member)]));
}

std::string terminals_xml(const fmi::Terminals& terminals) {
  std::string out = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiTerminalsAndIcons fmiVersion=\"3.0\">\n  <Terminals>\n";
  for (const auto& terminal : terminals) {
    const auto member = [&](std::string_view indent, fmi::TerminalMember each) {
      out += fmt::format("{}<TerminalMemberVariable variableKind=\"signal\" variableName=\"{}\" memberName=\"{}\"/>\n", indent,
                         xml_attribute(member_name(*terminal, each)), kMembers[static_cast<size_t>(each)]);
    };
    out += fmt::format(
        "    <Terminal terminalKind=\"org.fmi-ls-bus.network-terminal\" name=\"{}\" matchingRule=\"org.fmi-ls-bus.transceiver\" "
        "description=\"{}\">\n",
        xml_attribute(terminal->name()), terminal->is_of_the_line() ? "place of a node on the CAN line" : "CAN line of the plant");
    for (size_t n = 0; n < static_cast<size_t>(fmi::TerminalMember::BusNotifications); ++n)
      member("      ", static_cast<fmi::TerminalMember>(n));
    out += "      <Terminal terminalKind=\"org.fmi-ls-bus.network-terminal.configuration\" name=\"Configuration\" matchingRule=\"bus\">\n";
    member("        ", fmi::TerminalMember::BusNotifications);
    out += "      </Terminal>\n    </Terminal>\n";
  }
  return out + "  </Terminals>\n</fmiTerminalsAndIcons>\n";
}

// The schema wants this description to the letter.
std::string manifest_xml(bool is_bus_simulation) {
  return fmt::format(
         "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
         "<fmiLayeredStandardManifest xmlns:fmi-ls=\"http://fmi-standard.org/fmi-ls-manifest\" "
         "fmi-ls:fmi-ls-name=\"org.fmi-standard.fmi-ls-bus\" fmi-ls:fmi-ls-version=\"1.0.0\" "
         "fmi-ls:fmi-ls-description=\"Layered Standard for the simulation of bus communication on a Physical Signal Abstraction or "
         "Network Abstraction based level.\" isBusSimulationFMU=\"{}\"/>\n",
         is_bus_simulation);
}

}  // namespace ipos::tools
