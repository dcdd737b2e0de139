// Telegrams in words as the manuals have them, by `ipos bus decode` of a log that is written here; and the life of a memory, as
// `ipos run` tells it at its end.
#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "tests/harness/contains.hpp"
#include "tests/harness/proves.hpp"
#include "tests/stdlib/printed_quantities.hpp"
#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

// The lines that decode makes of frames such as "00B#000613880000", one of a line each.
std::vector<std::string> decoded(const std::vector<std::string>& frames, const std::string& plant = "") {
  const TemporaryFolder folder;
  std::string log;
  for (size_t n = 0; n < frames.size(); ++n)
    log += "(0." + std::to_string(100'000 + n) + ") sbus " + frames[n] + "\n";
  folder.write("a.log", log);
  std::vector<std::string> arguments = {"bus", "decode", "a.log"};
  if (!plant.empty()) {
    folder.write("p.toml", plant);
    arguments.insert(arguments.end(), {"--names", "p.toml"});
  }
  const CommandResult result = run_ipos(arguments, folder.path());
  EXPECT_EQ(result.exit_code, 0) << result.err;
  std::vector<std::string> lines;
  std::string line;
  for (const char c : result.out) {
    if (c == '\n')
      lines.push_back(std::exchange(line, ""));
    else
      line += c;
  }
  return lines;
}

std::string hex_id(int id) {
  char text[8];
  std::snprintf(text, sizeof text, "%03X", static_cast<unsigned>(id));
  return text;
}

TEST(DecodedRows, RequestAndResponseAreNotMixedUp) {
  PROVES("M07-SBUS-19");
  std::vector<std::string> frames;
  for (int address = 0; address < 64; ++address)
    for (const int id : {8 * address + 515, 8 * address + 516})
      frames.push_back(hex_id(id) + "#3100207E00000000");
  const std::vector<std::string> lines = decoded(frames);
  ASSERT_EQ(lines.size(), 128U);
  for (size_t n = 0; n < lines.size(); ++n) {
    EXPECT_TRUE(lines[n].ends_with((n % 2 == 0 ? " -> address " : " <- address ") + std::to_string(n / 2)))
        << lines[n];
    EXPECT_TRUE(contains(lines[n], "read 8318")) << lines[n];
  }
}

// Bits 4 and 5 of the management octet; units use four octets, 11.
TEST(DecodedRows, LengthsOfTheData) {
  PROVES("MLK-03");
  const std::vector<std::string> lines = decoded(
      {"20B#0200211600000BB8", "20B#1200211600000BB8", "20B#2200211600000BB8", "20B#3200211600000BB8"});
  ASSERT_EQ(lines.size(), 4U);
  for (size_t n = 0; n < 3; ++n)
    EXPECT_TRUE(contains(lines[n], "length " + std::to_string(n + 1) + " in place of 4 bytes")) << lines[n];
  EXPECT_FALSE(contains(lines[3], "in place of")) << lines[3];
}

std::string unit_of_address(int address, const std::string& parameters) {
  return "[[station]]\nname = \"unit" + std::to_string(address) +
         "\"\nunit = \"mc07\"\nsbus = \"sbus\"\n[station.parameters]\nP813 = " + std::to_string(address) +
         "\n" + parameters;
}

// Unit 1 as in the sample of MOVITRAC 07 chapter 5.1; unit 2 shows its control word in place of a speed.
const std::string kSample =
    "[[bus]]\nname = \"sbus\"\nkind = \"can\"\n" +
    unit_of_address(1, "P870 = 9\nP871 = 1\nP872 = 5\nP873 = 6\nP874 = 1\nP875 = 0\n") +
    unit_of_address(2, "P870 = 1\nP871 = 9\n");

TEST(DecodedRows, ProcessDataByAssignment) {
  PROVES("M07-SCOM-09", "M07-MON-09", "M07-SW-06");
  const std::vector<std::string> lines =
      decoded({"00B#000613883A98", "00C#000713930000", "00B#0006F15A0000", "013#F15AF15A0000",
               "00C#000000000000", "00C#002000000000", "00C#000200000000", "00C#002200000000"},
              kSample);
  ASSERT_EQ(lines.size(), 8U);
  EXPECT_TRUE(
      contains(lines[0], "CTRL. WORD 1 0006h (enable), SPEED 1000.0 rpm, MAX. SPEED 3000.0 rpm -> unit1"))
      << lines[0];
  EXPECT_TRUE(contains(lines[1], "SPEED 1002.2 rpm, 0000h <- unit1")) << lines[1];
  EXPECT_TRUE(contains(lines[2], "SPEED -750.0 rpm")) << lines[2];
  // One word under two assignments: a speed, and bits by their names.
  EXPECT_TRUE(contains(lines[3], "SPEED -750.0 rpm, CTRL. WORD 1 F15Ah (stop, ")) << lines[3];
  EXPECT_TRUE(contains(lines[3], "reset")) << lines[3];
  EXPECT_TRUE(contains(lines[4], "0000h (not ready")) << lines[4];
  EXPECT_TRUE(contains(lines[5], "0020h (fault")) << lines[5];
  EXPECT_TRUE(contains(lines[6], "0002h (ready")) << lines[6];
  EXPECT_TRUE(contains(lines[7], "0022h (warning")) << lines[7];
}

TEST(DecodedRows, QuantitiesOfReadScale) {
  PROVES("PAR-24");
  std::vector<std::string> frames;
  for (size_t quantity = 0; quantity <= std::size(kPrintedQuantities); ++quantity)
    frames.push_back("20C#3700207E0000" + hex_id(static_cast<int>(quantity)).substr(1) + "00");
  frames.insert(frames.end(), {"20C#37002117000004FD", "20C#3700207E00000B42", "20C#3700207E0000FF00"});
  const std::vector<std::string> lines = decoded(frames, kSample);
  ASSERT_EQ(lines.size(), frames.size());
  for (size_t quantity = 0; quantity <= std::size(kPrintedQuantities); ++quantity)
    EXPECT_TRUE(
        contains(lines[quantity],
                 "quantity " + std::to_string(quantity) + " " +
                     (quantity < std::size(kPrintedQuantities) ? kPrintedQuantities[quantity] : "unknown") +
                     ", conversion 0"))
        << lines[quantity];
  const size_t last = std::size(kPrintedQuantities);
  EXPECT_TRUE(contains(lines[last + 1], "quantity 4 time, conversion -3 (ms)")) << lines[last + 1];
  EXPECT_TRUE(contains(lines[last + 2], "quantity 11 rotational velocity, conversion 66")) << lines[last + 2];
  EXPECT_TRUE(contains(lines[last + 3], "no quantity, conversion 0")) << lines[last + 3];
}

// 100 000 writes last 34.7 days at two a minute, and 3.8 years at one in 20 minutes.
TEST(DecodedRows, LifeOfTheMemory) {
  PROVES("M07-SCOM-11");
  for (const auto& [wait, time, life] :
       {std::tuple{"30000", "5min", "34.7 days"}, {"1200000", "41min", "3.8 years"}}) {
    const TemporaryFolder folder;
    folder.write("p.toml", "[[station]]\nname = \"u\"\nunit = \"mc07\"\nprogram = \"P.IPC\"\n");
    folder.write("P.IPC",
                 "#include <const.h>\nMOVLNK Ml; MLDATA Mld; long n;\nmain() { Ml.BusType = 5; Ml.Address = "
                 "253; Ml.Format = 6; Ml.Service = 2;"
                 " Ml.Index = 8602; Ml.DPointer = numof(Mld); while (1) { n = 1 - n; Mld.WritePar = 100 + 10 "
                 "* n; _MoviLink(Ml); _Wait(" +
                     std::string(wait) + "); } }\n");
    const CommandResult result = run_ipos({"run", "p.toml", "--for", time, "--why"}, folder.path());
    EXPECT_TRUE(contains(result.out + result.err, "at this rate the memory lasts " + std::string(life)))
        << result.out << result.err;
  }
}

}  // namespace
}  // namespace ipos::tests
