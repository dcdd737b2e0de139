// The GSD files, read by a small reader of the test that knows the keywords the standard makes mandatory.
#include "runtime/bus/profibus/gsd.hpp"

#include <set>
#include <sstream>
#include <tuple>

#include "runtime/bus/profibus/cfg_data.hpp"
#include "tests/runtime/bus/profibus/gsd_reader.hpp"
#include "tests/runtime/bus/profibus/octets.hpp"

namespace ipos::tests {
namespace {

TEST(GsdFile, BothUnits) {
  PROVES("DP-ID-03");
  for (const OptionType& option : option_types()) {
    Gsd gsd = read_gsd(gsd_text(option));
    EXPECT_TRUE(gsd.problems.empty()) << gsd.problems.front();
    for (const char* mandatory : {"GSD_Revision",       "Vendor_Name",         "Model_Name",
                                  "Revision",           "Ident_Number",        "Protocol_Ident",
                                  "Station_Type",       "Hardware_Release",    "Software_Release",
                                  "Freeze_Mode_supp",   "Sync_Mode_supp",      "Auto_Baud_supp",
                                  "Set_Slave_Add_supp", "Min_Slave_Intervall", "Modular_Station",
                                  "Max_Module",         "Max_Input_Len",       "Max_Output_Len",
                                  "Max_Data_Len",       "Max_Diag_Data_Len",   "FMS_supp"})
      EXPECT_EQ(gsd.keys.count(mandatory), 1U) << mandatory;
    const std::pair<const char*, const char*> kTsdr[] = {{"9.6", "60"},   {"19.2", "60"}, {"93.75", "60"},
                                                         {"187.5", "60"}, {"500", "100"}, {"1.5M", "150"}};
    for (const auto& [rate, tsdr] : kTsdr) {
      EXPECT_EQ(gsd.keys[std::string(rate) + "_supp"], "1");
      EXPECT_EQ(gsd.keys[std::string("MaxTsdr_") + rate], tsdr);
    }
    EXPECT_EQ(gsd.keys.count("3M_supp"), 0U);
  }
  for (const OptionKind kind : {OptionKind::Ffp31, OptionKind::Size0}) {
    Gsd gsd = read_gsd(gsd_text(option_type(kind)));
    EXPECT_EQ(gsd.keys["Max_Input_Len"], "14");
    EXPECT_EQ(gsd.keys["Max_Data_Len"], "28");
    EXPECT_EQ(gsd.keys["Max_Module"], "2");
    EXPECT_EQ(gsd.keys["Max_Diag_Data_Len"], "8");
    std::set<std::string> modules;
    for (const auto& [name, identifiers] : gsd.modules) modules.insert(identifiers);
    EXPECT_EQ(modules,
              (std::set<std::string>{"0xF0", "0xF1", "0xF2", "0xF3,0xF0", "0xF3,0xF1", "0xF3,0xF2"}));
  }
  Gsd combi = read_gsd(gsd_text(option_type(OptionKind::Ffp31))),
      small = read_gsd(gsd_text(option_type(OptionKind::Size0)));
  EXPECT_EQ(combi.keys["Ident_Number"], "0x3100");
  EXPECT_EQ(small.keys["Ident_Number"], "0x3111");
  EXPECT_EQ(combi.keys["FMS_supp"], "1");
  EXPECT_EQ(small.keys["FMS_supp"], "0");
  EXPECT_EQ(option_type(OptionKind::Ffp31).gsd_file, "SEW_3100.GSD");
  EXPECT_EQ(option_type(OptionKind::Size0).gsd_file, "SEW_3111.GSD");
}

// One to ten words with and without the channel; a MOVIDRIVE A has three. A gateway has three words a drive.
TEST(GsdFile, CardsOfMovidriveAndGateway) {
  const auto identifiers = [](int word) {
    std::ostringstream text;
    text << "0xF" << std::hex << std::uppercase << word - 1;
    return text.str();
  };
  for (const auto& [kind, words, ident, most] : {std::tuple(OptionKind::Dfp11, 3, "0x6000", "14"),
                                                 std::tuple(OptionKind::Dfp21, 10, "0x6003", "28")}) {
    Gsd gsd = read_gsd(gsd_text(option_type(kind)));
    std::set<std::string> expected, modules;
    for (int word = 1; word <= words; ++word) {
      expected.insert(identifiers(word));
      expected.insert("0xF3," + identifiers(word));
    }
    for (const auto& [name, octets] : gsd.modules) modules.insert(octets);
    EXPECT_EQ(modules, expected);
    EXPECT_EQ(gsd.keys["Ident_Number"], ident);
    EXPECT_EQ(gsd.keys["Max_Input_Len"], most);
    EXPECT_EQ(gsd.keys["FMS_supp"], "0");
  }
  Gsd gateway = read_gsd(gsd_text(option_type(OptionKind::Gateway)));
  EXPECT_EQ(gateway.modules.size(), 16U);
  EXPECT_EQ(gateway.modules.back().second, "0xF3,0xF2,0xF2,0xF2,0xF2,0xF2,0xF2,0xF2,0xF2");
  EXPECT_EQ(gateway.keys["Max_Output_Len"], "56") << "8 + 8 x 6";
  EXPECT_EQ(gateway.keys["Max_Module"], "9");
}

TEST(GsdFile, WholeText) {
  EXPECT_EQ(
      gsd_text(option_type(OptionKind::Dfp11)),
      "#Profibus_DP\n"
      "; SEW_6000.GSD, written by ipos from the tables of its simulated slave\n"
      "GSD_Revision=1\nVendor_Name=\"SEW-EURODRIVE\"\nModel_Name=\"MOVIDRIVE A DFP11A/DP\"\n"
      "Revision=\"1.0\"\nIdent_Number=0x6000\nProtocol_Ident=0\nStation_Type=0\nFMS_supp=0\n"
      "Hardware_Release=\"1.0\"\nSoftware_Release=\"1.0\"\n"
      "9.6_supp=1\n19.2_supp=1\n93.75_supp=1\n187.5_supp=1\n500_supp=1\n1.5M_supp=1\n"
      "MaxTsdr_9.6=60\nMaxTsdr_19.2=60\nMaxTsdr_93.75=60\nMaxTsdr_187.5=60\nMaxTsdr_500=100\n"
      "MaxTsdr_1.5M=150\n"
      "Redundancy=0\nRepeater_Ctrl_Sig=2\n24V_Pins=0\nFreeze_Mode_supp=1\nSync_Mode_supp=1\n"
      "Auto_Baud_supp=1\nSet_Slave_Add_supp=0\nMin_Slave_Intervall=10\nModular_Station=1\n"
      "Max_Module=2\nMax_Input_Len=14\nMax_Output_Len=14\nMax_Data_Len=28\nMax_Diag_Data_Len=8\n"
      "Module=\"1 PD\" 0xF0\nEndModule\nModule=\"2 PD\" 0xF1\nEndModule\nModule=\"3 PD\" 0xF2\nEndModule\n"
      "Module=\"Param + 1 PD\" 0xF3,0xF0\nEndModule\nModule=\"Param + 2 PD\" 0xF3,0xF1\nEndModule\n"
      "Module=\"Param + 3 PD\" 0xF3,0xF2\nEndModule\n");
}

}  // namespace
}  // namespace ipos::tests
