// Keywords of a GSD file of revision 1, one a line. Texts stay within 32 characters of plain ASCII.
#include "runtime/bus/profibus/gsd.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "runtime/bus/profibus/cfg_data.hpp"

namespace ipos::profibus {
namespace {

constexpr int kMinSlaveInterval = 10;  // x 100 us between two requests, ours

std::string module_text(const Configuration& configuration) {
  std::string identifiers;
  for (const uint8_t identifier : configuration.cfg_data())
    identifiers += fmt::format("{}0x{:02X}", identifiers.empty() ? "" : ",", identifier);
  return fmt::format("Module=\"{}\" {}\nEndModule\n", configuration.name, identifiers);
}

}  // namespace

std::string gsd_text(const OptionType& option) {
  std::string text = "#Profibus_DP\n";
  text += fmt::format(
      "; {}, written by ipos from the tables of its simulated slave\n"
      "GSD_Revision=1\n"
      "Vendor_Name=\"SEW-EURODRIVE\"\n"
      "Model_Name=\"{}\"\n"
      "Revision=\"1.0\"\n"
      "Ident_Number=0x{:04X}\n"
      "Protocol_Ident=0\n"
      "Station_Type=0\n"
      "FMS_supp={:d}\n"
      "Hardware_Release=\"1.0\"\n"
      "Software_Release=\"1.0\"\n",
      option.gsd_file, option.model, option.ident, option.fms);
  for (auto rate = std::rbegin(kBaudRates); rate != std::rend(kBaudRates); ++rate)
    text += fmt::format("{}_supp=1\n", rate->keyword);
  for (auto rate = std::rbegin(kBaudRates); rate != std::rend(kBaudRates); ++rate)
    text += fmt::format("MaxTsdr_{}={}\n", rate->keyword, rate->max_tsdr);
  std::vector<Configuration> rows;
  for (const Configuration& row : configurations(option.accepts.set))
    if (row.words <= option.accepts.most) rows.push_back(row);
  size_t modules = 0;
  uint8_t octets = 0;
  for (const Configuration& configuration : rows) {
    modules = std::max(modules, configuration.identifiers.size());
    octets = std::max(octets, configuration.octets);
  }
  text += fmt::format(
      "Redundancy=0\n"
      "Repeater_Ctrl_Sig=2\n"
      "24V_Pins=0\n"
      "Freeze_Mode_supp=1\n"
      "Sync_Mode_supp=1\n"
      "Auto_Baud_supp=1\n"
      "Set_Slave_Add_supp=0\n"
      "Min_Slave_Intervall={}\n"
      "Modular_Station=1\n"
      "Max_Module={}\n"
      "Max_Input_Len={}\n"
      "Max_Output_Len={}\n"
      "Max_Data_Len={}\n"
      "Max_Diag_Data_Len={}\n",
      kMinSlaveInterval, modules, octets, octets, 2 * octets, kStandardDiagSize + 2);
  for (const Configuration& configuration : rows) text += module_text(configuration);
  return text;
}

}  // namespace ipos::profibus
