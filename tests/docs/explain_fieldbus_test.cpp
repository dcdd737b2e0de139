// ipos explain and the words of CANopen and PROFIBUS: what logs print is known, from the tables that print it. Codes and
// meanings are those of CiA 301 and EN 50170.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "runtime/bus/canopen/connections.hpp"
#include "runtime/bus/canopen/emergency.hpp"
#include "runtime/bus/canopen/object_dictionary.hpp"
#include "tests/harness/contains.hpp"
#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

std::string explained(std::vector<std::string> words) {
  words.insert(words.begin(), "explain");
  const CommandResult output = run_ipos(words);
  EXPECT_EQ(output.exit_code, 0) << fmt::format("{}: {}", fmt::join(words, " "), output.err);
  return output.out;
}

TEST(ExplainFieldbus, ObjectsAbortsAndEmergenciesAsTheyArePrinted) {
  EXPECT_TRUE(contains(explained({"1017h"}), "1017h: object of CANopen, "));
  EXPECT_TRUE(contains(explained({"0x1017"}), "16 bits, read and write, default 0h"));
  EXPECT_TRUE(contains(explained({"1800h:2"}), "default 1h")) << "the transmission type of 11264926 p. 55";
  EXPECT_TRUE(contains(explained({"1a00h"}), "1A00h:1 ")) << "in any case of letters, with its entries";
  EXPECT_TRUE(contains(explained({"2000h:10"}), "PO10"));
  EXPECT_TRUE(contains(explained({"2070h"}), "P870")) << "2070h = 8304";
  EXPECT_TRUE(contains(explained({"05030000h"}), "toggle bit not alternated"));
  EXPECT_TRUE(contains(explained({"0609", "0011h"}), "sub-index does not exist")) << "as the pages write it";
  EXPECT_TRUE(contains(explained({"8130h"}), "life guarding or heartbeat missed"));
}

// 06 02 00 00 is the gateway's return code and an abort of SDO.
TEST(ExplainFieldbus, ANumberThatMeansTwoThings) {
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"06", "02", "00", "00"}, {"0x06020000"}, {"06020000h"}, {"0602", "0000h"}}) {
    const std::string text = explained(words);
    EXPECT_TRUE(contains(text, "hardware error: no communication")) << words[0];
    EXPECT_TRUE(contains(text, "object does not exist")) << words[0];
  }
  EXPECT_TRUE(contains(explained({"05", "05", "00", "00"}), "wrong coding of the management byte"));
  EXPECT_FALSE(contains(explained({"0x08000010"}), "SDO")) << "no abort has this code";
}

TEST(ExplainFieldbus, StatesServicesAndBits) {
  EXPECT_TRUE(contains(explained({"pre-operational"}), "7Fh"));
  EXPECT_TRUE(contains(explained({"NMT", "reset", "node"}), "81h"));
  EXPECT_TRUE(contains(explained({"EMCY"}), "080h + node, sent by the node"));
  EXPECT_TRUE(contains(explained({"TPDO2"}), "280h + node"));
  EXPECT_TRUE(contains(explained({"Set_Prm"}), "access point 61"));
  EXPECT_TRUE(contains(explained({"SAP", "60"}), "Slave_Diag"));
  EXPECT_TRUE(contains(explained({"prm_fault"}), "octet 1, mask 40h"));
  EXPECT_TRUE(contains(explained({"Ext_Diag"}), "a bit for each lost drive"));
  EXPECT_TRUE(contains(explained({"RS"}), "service or access point not available"));
  EXPECT_TRUE(contains(explained({"6000h"}), "ident number"));
  EXPECT_TRUE(contains(explained({"heartbeat"}), "1017h")) << "found by a word";
}

// Each row of the tables behind what the monitor prints.
TEST(ExplainFieldbus, KnowsEveryRow) {
  std::vector<std::string> names;
#define ABORT(name, code, text) names.push_back(fmt::format("{:08X}h", code));
#include "runtime/bus/canopen/abort_codes.def"
#define NMT_STATE(name, code, text) names.push_back(text);
#define NMT_COMMAND(name, code, text) names.push_back(fmt::format("NMT {}", text));
#include "runtime/bus/canopen/nmt_commands.def"
#define DP_SERVICE(name, access_point, text) names.push_back(text);
#include "runtime/bus/profibus/dp_services.def"
#define DIAG_BIT(name, octet, mask, by, text) names.push_back(text);
#include "runtime/bus/profibus/diag_bits.def"
#define FDL_REQUEST(name, code, text) names.push_back(text);
#include "runtime/bus/profibus/fdl_functions.def"
  using namespace runtime::canopen;
  for (const ConnectionRow& row : kConnections) names.emplace_back(row.text);
  for (const EmergencyRow& row : kEmergencies) names.push_back(fmt::format("{:04X}h", row.code));
  for (const ObjectRow& row : object_rows()) names.push_back(fmt::format("{:04X}h", row.index));
  EXPECT_GT(names.size(), 120U);
  for (const std::string& name : names) EXPECT_TRUE(contains(explained({name}), ": ")) << name;
}

}  // namespace
}  // namespace ipos::tests
