// The log of a line as Wireshark's CANopen dissector reads it, frame by frame, against our own words.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "runtime/bus/canopen/master.hpp"
#include "runtime/bus/canopen/words.hpp"
#include "runtime/bus/log/candump.hpp"
#include "tests/runtime/bus/canopen/node_rig.hpp"

namespace ipos::tests {
namespace {

std::vector<std::string> lines_of(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), &pclose);
  std::vector<std::string> lines;
  std::array<char, 1024> part;
  while (fgets(part.data(), part.size(), pipe.get()) != nullptr) {
    lines.emplace_back(part.data());
    lines.back().pop_back();
  }
  return lines;
}

// How the dissector says what, and how we do.
const std::pair<std::string, std::string> kSame[] = {
    {"NMT: Reset communication [All]", "NMT reset communication -> all nodes"},
    {"NMT: Start remote node [0x5]", "NMT start -> node 5"},
    {"NMT: Stop remote node [0x5]", "NMT stop -> node 5"},
    {"NMT Error Control: Boot-up [0x5]", "boot-up <- node 5"},
    {"NMT Error Control: Operational [0x5]", "operational"},
    {"NMT Error Control: Stopped [0x5]", "stopped"},
    {"NMT Error Control: Pre-operational [0x5]", "pre-operational"},
    {"Default-SDO (rx): Initiate upload request", "SDO read "},
    {"Default-SDO (tx): Initiate upload response", " <- node 5"},
    {"Default-SDO (rx): Upload segment request", "SDO next segment of "},
    {"Default-SDO (tx): Upload segment response", "SDO segment "},
    {"Default-SDO (rx): Initiate download request", "SDO write "},
    {"Default-SDO (tx): Initiate download response", "SDO written "},
    {"Default-SDO (rx): Download segment request", "SDO segment "},
    {"Default-SDO (tx): Download segment response", "SDO segment taken of "},
    {"Default-SDO (tx): Abort transfer", "SDO abort "},
    {"Default-SDO (rx): Abort transfer", "SDO abort "},
    {"Default-SDO (rx): Block upload", "SDO block read "},
    {"SYNC", "SYNC"},
    {"PDO1 (tx)", "TPDO1 "},
    {"PDO1 (rx)", "RPDO1 "},
    {"PDO2 (tx)", "TPDO2 "},
    {"EMCY", "EMCY "}};

TEST(CanopenDissector, ReadsTheLogAsWeDo) {
  if (std::system("command -v tshark > /dev/null 2>&1") != 0)
    GTEST_SKIP() << "tshark is not installed; install it to compare with Wireshark's dissector";
  NodeRig rig;
  std::ostringstream log;
  CandumpLog observer(log);
  rig.line.add_observer(observer);
  const auto sdo = [&](const SdoBytes& bytes) { rig.ask({0x605, 8, bytes}); };
  rig.ask({0x000, 2, {0x82, 0}});
  sdo({0x40, 0x00, 0x18, 0x02});
  sdo({0x40, 0x08, 0x10, 0x00});
  for (const uint8_t toggle : {uint8_t{0x60}, uint8_t{0x70}, uint8_t{0x60}}) sdo({toggle});
  sdo({0x21, 0x7E, 0x20, 0x00, 4});
  sdo({0x07, 1, 2, 3, 4});
  sdo({0x23, 0x7E, 0x20, 0x00, 1, 2, 3, 4});
  sdo({0x2F, 0x00, 0x10, 0x00, 1});
  sdo({0xA0, 0x08, 0x10, 0x00});
  sdo({0x80, 0x08, 0x10, 0x00, 0, 0, 4, 5});
  rig.nmt(NmtCommand::Start);
  rig.ask({0x205, 6, {6, 0, 1, 2, 3, 4}});
  rig.sync();
  rig.ask({0x285, 2, {1, 2}});
  rig.station.unit.state = {0x2B22, true, false};
  rig.station.node.unit_changed(rig.queue.now());
  rig.ask({0x705, 1, {}, false, true});
  rig.nmt(NmtCommand::Stop);
  rig.ask({0x705, 1, {}, false, true});

  const auto path = std::filesystem::temp_directory_path() / "ipos_canopen_dissector.log";
  std::ofstream(path) << log.str();
  const auto lines = lines_of("tshark -r " + path.string() +
                              " -d can.subdissector,canopen -T fields -E separator=';' -e _ws.col.Info"
                              " -e canopen.sdo.main_idx -e canopen.em.err_code 2>/dev/null");
  std::filesystem::remove(path);
  const auto entries = parse_candump(log.str());
  ASSERT_TRUE(entries.has_value());
  ASSERT_EQ(lines.size(), entries->size());
  LineWords words;
  std::set<std::string> kinds;
  size_t numbers = 0;
  for (size_t n = 0; n < lines.size(); ++n) {
    const std::string ours = words.describe((*entries)[n].frame).text;
    const std::string info = lines[n].substr(0, lines[n].find(';'));
    if ((*entries)[n].frame.remote) continue;  // the dissector leaves them to that of CAN
    bool found = false;
    for (const auto& [theirs, text] : kSame) {
      if (theirs != info) continue;
      found = true;
      kinds.insert(info);
      EXPECT_NE(ours.find(text), std::string::npos) << info << " / " << ours;
    }
    EXPECT_TRUE(found) << info << " / " << ours;
    // The index and the error code, too.
    unsigned value = 0;
    const std::string rest = lines[n].substr(info.size());
    if (sscanf(rest.c_str(), ";0x%x", &value) == 1 || sscanf(rest.c_str(), ";;0x%x", &value) == 1) {
      std::array<char, 8> hex{};
      snprintf(hex.data(), hex.size(), "%04Xh", value);
      ++numbers;
      EXPECT_NE(ours.find(hex.data()), std::string::npos) << lines[n] << " / " << ours;
    }
  }
  EXPECT_GE(kinds.size(), 18U);
  EXPECT_GE(numbers, 14U);
}

}  // namespace
}  // namespace ipos::tests
