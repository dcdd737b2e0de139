// CANopen of MOVIDRIVE B (MDX60B/61B chapter 5.4): frames of the library to a node of a plant.
#include "tests/harness/proves.hpp"
#include "tests/runtime/manuals/talk.hpp"

namespace ipos::tests {
namespace {

constexpr const char* kNode5 = "P880 = 1\nP886 = 5\n";

// An SDO upload; the answer of the node behind its identifier.
std::string upload(Talk& talk, int index, int subindex) {
  const std::string place =
      word_text(index).substr(3) + " " + word_text(index).substr(0, 2) + " " + word_text(subindex).substr(3);
  for (const std::string& answer : talk.ask(std::to_string(0x605) + " # 40 " + place + " 00 00 00 00"))
    if (answer.starts_with(std::to_string(0x585) + " # ")) return answer.substr(answer.find('#') + 2);
  return "none";
}

TEST(CanopenRows, IdentifiersOfNode5) {
  PROVES("MDB-TOC-05");
  Talk talk(can_bus() + on_sbus("u", "mdxb", kNode5));
  EXPECT_EQ(ipos_plant_join(talk.plant(), talk.bus("sbus")), IPOS_PLANT_OK);
  const Texts boot = talk.answers(50 * kMs);
  ASSERT_FALSE(boot.empty());
  EXPECT_EQ(boot[0], std::to_string(0x705) + " # 00") << "boot-up, on the identifier of guarding";
  // What the node itself has as identifiers of its telegrams, low octet first.
  const auto identifier = [&](int index, int subindex) {
    const Bytes bytes = bytes_of(upload(talk, index, subindex));
    return bytes.size() == 8 && bytes[0] == 0x43 ? (bytes[5] & 7) << 8 | bytes[4] : -1;
  };
  for (int pdo = 0; pdo < 4; ++pdo) {
    EXPECT_EQ(identifier(0x1400 + pdo, 1), 0x205 + 0x100 * pdo);
    EXPECT_EQ(identifier(0x1800 + pdo, 1), 0x185 + 0x100 * pdo);
  }
  EXPECT_EQ(identifier(0x1005, 0), 0x080);
  EXPECT_EQ(identifier(0x1014, 0), 0x085);
  // NMT on 0: started, the node takes PDO 1 on 205h, and answers the SYNC on 080h with 185h.
  talk.ask("0 # 01 05");
  talk.ask(std::to_string(0x205) + " # 06 00 E8 03 00 00");
  bool input = false;
  for (const std::string& frame : talk.ask(std::to_string(0x080) + " #"))
    input |= frame.starts_with(std::to_string(0x185) + " #");
  EXPECT_TRUE(input);
  EXPECT_EQ(talk.value("u", "PO2"), 1000);
  EXPECT_EQ(ipos_plant_drive_fault(talk.plant(), 0, 1), IPOS_PLANT_OK);
  bool emergency = false;
  for (const std::string& frame : talk.answers(50 * kMs))
    emergency |= frame.starts_with(std::to_string(0x085) + " #");
  EXPECT_TRUE(emergency);
}

TEST(CanopenRows, ParametersAreObjects) {
  PROVES("MDB-TOC-17");
  Talk talk(can_bus() + on_sbus("u", "mdxb", kNode5, "[station.load]\ndriven = true\n"));
  uint32_t shaft = UINT32_MAX;
  ASSERT_EQ(ipos_plant_find(talk.plant(), 0, IPOS_PLANT_SHAFT, "shaft_speed", &shaft), IPOS_PLANT_OK);
  ASSERT_EQ(ipos_plant_write_text(talk.plant(), shaft, "1000 rpm"), IPOS_PLANT_OK) << talk.opened().message();
  talk.ask("0 # 80 05");
  talk.pass(200 * kMs);
  // 8318, low octet first.
  EXPECT_EQ(upload(talk, 0x207E, 0), "43 7E 20 00 40 42 0F 00");
  EXPECT_EQ(upload(talk, 0x207E, 1), "80 7E 20 01 11 00 09 06") << "no such subindex";
  EXPECT_EQ(upload(talk, 9999, 0).substr(12), "00 00 02 06") << "no such object";
  // P130 := 2500.
  talk.ask(std::to_string(0x605) + " # 23 16 21 00 C4 09 00 00");
  EXPECT_EQ(talk.value("u", "P130"), 2500);
}

}  // namespace
}  // namespace ipos::tests
