// Lines in the library: what is heard of them with its flags and tags, errors as SocketCAN has them, loads, and faults
// planted while the plant runs.
#include "tests/runtime/library/opened_plant.hpp"

namespace ipos::tests {
namespace {

constexpr const char* kThreeLines = R"([[bus]]
name = "can"
kind = "can"
[[bus]]
name = "alone"
kind = "can"
[[bus]]
name = "rs"
kind = "rs485"
[[station]]
name = "a"
unit = "mdxb"
sbus = "can"
rs485 = "rs"
)";

ipos_plant_frame frame_with(uint32_t id, uint32_t flags = 0, uint8_t length = 0) {
  ipos_plant_frame frame{};
  frame.id = id;
  frame.flags = flags;
  frame.length = length;
  for (uint8_t n = 0; n < 8; ++n) frame.data[n] = static_cast<uint8_t>(n + 1);
  return frame;
}

TEST(LibraryLines, FramesAreHeardWithFlagsAndTag) {
  const OpenedPlant plant(kThreeLines);
  const struct {
    uint32_t id, flags;
    uint8_t length;
  } rows[] = {{0x7FF, 0, 8}, {0x1FFFFFFF, IPOS_PLANT_EXTENDED, 3}, {0x123, IPOS_PLANT_REMOTE, 5}, {0, 0, 0}};
  uint32_t last = 0;
  for (const auto& row : rows) {
    const ipos_plant_frame sent = frame_with(row.id, row.flags, row.length);
    uint32_t tag = 0;
    EXPECT_EQ(ipos_plant_send(plant.plant, 0, &sent, &tag), IPOS_PLANT_OK) << plant.message();
    EXPECT_NE(tag, last);
    last = tag;
    int64_t now = 0;
    ipos_plant_time(plant.plant, &now);
    EXPECT_EQ(ipos_plant_run_to_frame(plant.plant, 0, now + 5'000'000), IPOS_PLANT_OK);
    const auto heard = plant.frames();
    ASSERT_EQ(heard.size(), 1U);
    EXPECT_EQ(std::tuple(heard[0].id, heard[0].flags, heard[0].tag, heard[0].length),
              std::tuple(row.id, row.flags | IPOS_PLANT_OWN, tag, row.length));
    ipos_plant_time(plant.plant, &now);
    EXPECT_EQ(heard[0].time, now) << "the run ends with the frame";
    for (uint8_t n = 0; n < row.length && row.flags != IPOS_PLANT_REMOTE; ++n)
      EXPECT_EQ(heard[0].data[n], n + 1);
    EXPECT_TRUE(plant.frames().empty()) << "each is given once";
  }
  for (const auto& [id, flags, length] :
       {std::tuple(0x800U, 0U, uint8_t{0}),
        std::tuple(0x20000000U, uint32_t{IPOS_PLANT_EXTENDED}, uint8_t{0}), std::tuple(0U, 0U, uint8_t{9}),
        std::tuple(0U, uint32_t{IPOS_PLANT_ERROR}, uint8_t{0}),
        std::tuple(0U, uint32_t{IPOS_PLANT_OWN}, uint8_t{0})}) {
    const ipos_plant_frame wrong = frame_with(id, flags, length);
    EXPECT_EQ(ipos_plant_send(plant.plant, 0, &wrong, nullptr), IPOS_PLANT_BAD_VALUE);
  }
}

TEST(LibraryLines, TagsGoWithTheirFrames) {
  const OpenedPlant plant(kThreeLines);
  std::vector<uint32_t> tags;
  for (const uint32_t id : {0x700U, 0x100U, 0x400U, 0x100U}) {
    const ipos_plant_frame sent = frame_with(id);
    EXPECT_EQ(ipos_plant_send(plant.plant, 0, &sent, &tags.emplace_back()), IPOS_PLANT_OK);
  }
  plant.run(5);
  std::vector<std::pair<uint32_t, uint32_t>> heard;
  for (const ipos_plant_frame& frame : plant.frames()) heard.emplace_back(frame.id, frame.tag);
  EXPECT_EQ(heard, (std::vector<std::pair<uint32_t, uint32_t>>{
                       {0x100, tags[1]}, {0x100, tags[3]}, {0x400, tags[2]}, {0x700, tags[0]}}));
}

TEST(LibraryLines, ReceiveTakesAsManyAsFit) {
  const OpenedPlant plant(kThreeLines);
  const ipos_plant_frame sent = frame_with(0x100);
  for (int n = 0; n < 5; ++n) EXPECT_EQ(ipos_plant_send(plant.plant, 0, &sent, nullptr), IPOS_PLANT_OK);
  plant.run(5);
  ipos_plant_frame frames[3];
  size_t count = 9;
  EXPECT_EQ(ipos_plant_receive(plant.plant, 0, nullptr, 0, &count), IPOS_PLANT_OK);
  EXPECT_EQ(count, 0U);
  EXPECT_EQ(ipos_plant_receive(plant.plant, 0, nullptr, 1, &count), IPOS_PLANT_INVALID_ARGUMENT);
  EXPECT_EQ(ipos_plant_receive(plant.plant, 0, frames, 3, nullptr), IPOS_PLANT_INVALID_ARGUMENT);
  for (const size_t expected : {3U, 2U, 0U}) {
    EXPECT_EQ(ipos_plant_receive(plant.plant, 0, frames, 3, &count), IPOS_PLANT_OK);
    EXPECT_EQ(count, expected);
  }
}

// CAN_ERR_... of linux/can/error.h: ACK 20h, CRTL 4 with RX 10h and TX 20h passive in data[1], BUSOFF 40h, RESTARTED 100h.
TEST(LibraryLines, ErrorsAreThoseOfSocketCan) {
  const OpenedPlant plant(kThreeLines);
  const ipos_plant_frame sent = frame_with(0x100);
  EXPECT_EQ(ipos_plant_send(plant.plant, 1, &sent, nullptr), IPOS_PLANT_OK);
  plant.run(50);
  bool acknowledge = false, passive = false;
  for (const ipos_plant_frame& frame : plant.frames(1)) {
    EXPECT_EQ(frame.flags, uint32_t{IPOS_PLANT_ERROR | IPOS_PLANT_OWN});
    EXPECT_EQ(frame.length, 8);
    acknowledge |= frame.id == 0x20 && frame.data[1] == 0;
    passive |= frame.id == 4 && frame.data[1] == 0x30;
    EXPECT_TRUE(frame.id == 0x20 || frame.id == 4) << frame.id;
  }
  EXPECT_TRUE(acknowledge && passive);
  EXPECT_EQ(
      ipos_plant_line_fault(plant.plant, "[[fault]]\nbus = \"can\"\nkind = \"short\"\nuntil = \"50ms\"\n"),
      IPOS_PLANT_OK);
  EXPECT_EQ(ipos_plant_send(plant.plant, 0, &sent, nullptr), IPOS_PLANT_OK);
  plant.run(200);
  bool off = false, back = false;
  for (const ipos_plant_frame& frame : plant.frames()) {
    off |= frame.id == 0x40 && (frame.flags & IPOS_PLANT_ERROR) != 0;
    back |= frame.id == 0x100 && (frame.flags & IPOS_PLANT_ERROR) != 0;
  }
  EXPECT_TRUE(off && back);
}

TEST(LibraryLines, LoadIsThePartOfTheTime) {
  const OpenedPlant plant(kThreeLines);
  ipos_plant_load load{};
  ASSERT_EQ(ipos_plant_bus_load(plant.plant, 0, &load), IPOS_PLANT_OK);
  EXPECT_EQ(load.percent, 0.0) << "at the time 0";
  const ipos_plant_frame sent = frame_with(0x555, 0, 0);
  ASSERT_EQ(ipos_plant_send(plant.plant, 0, &sent, nullptr), IPOS_PLANT_OK);
  plant.run(1);
  ASSERT_EQ(ipos_plant_bus_load(plant.plant, 0, &load), IPOS_PLANT_OK);
  // 44 bits of a frame without data and 3 of intermission, and few stuff bits, of 500.
  EXPECT_NEAR(load.percent, 100.0 * 47 / 500, 0.8);
  EXPECT_EQ(std::pair(load.frames, load.lost), std::pair(uint64_t{1}, uint64_t{0}));
  EXPECT_EQ(ipos_plant_bus_load(plant.plant, 3, &load), IPOS_PLANT_NO_BUS);
  EXPECT_EQ(ipos_plant_bus_load(plant.plant, 0, nullptr), IPOS_PLANT_INVALID_ARGUMENT);
}

TEST(LibraryLines, RunToFrameEndsAtItsLimit) {
  const OpenedPlant plant(kThreeLines);
  const auto run = [&](int64_t until) { return ipos_plant_run_to_frame(plant.plant, 0, until); };
  int64_t now = 0;
  EXPECT_EQ(run(3'000'001), IPOS_PLANT_OK);
  EXPECT_EQ(ipos_plant_time(plant.plant, &now), IPOS_PLANT_OK);
  EXPECT_EQ(now, 3'000'001);
  EXPECT_EQ(run(3'000'000), IPOS_PLANT_INVALID_ARGUMENT);
  EXPECT_EQ(plant.message(), "it is 3000001 ns: time does not run back");
  EXPECT_EQ(run(3'000'001), IPOS_PLANT_OK);
  EXPECT_EQ(run(INT64_MAX), IPOS_PLANT_INVALID_ARGUMENT);
  EXPECT_EQ(ipos_plant_run_to_frame(plant.plant, 2, 4'000'000), IPOS_PLANT_NO_BUS);
  EXPECT_EQ(plant.message(), "no CAN line has number 2");
}

TEST(LibraryLines, BytesOfSerialLines) {
  const OpenedPlant plant(kThreeLines);
  const std::vector<uint8_t> bytes(1'001, 0x55);
  EXPECT_EQ(ipos_plant_serial_send(plant.plant, 2, bytes.data(), 1'001), IPOS_PLANT_BAD_VALUE);
  EXPECT_EQ(plant.message(), "1 to 1000 bytes can be sent at a time");
  EXPECT_EQ(ipos_plant_serial_send(plant.plant, 2, nullptr, 1), IPOS_PLANT_INVALID_ARGUMENT);
  EXPECT_EQ(ipos_plant_serial_send(plant.plant, 0, bytes.data(), 1), IPOS_PLANT_NO_BUS);
  EXPECT_EQ(plant.message(), "no serial line has number 0");
  // Of nobody here: address 9, and the block check that is right.
  const std::vector<uint8_t> telegram = {0x02, 0x09, 0x85, 0, 0x06,
                                         0x13, 0x88, 0,    0, 0x02 ^ 0x09 ^ 0x85 ^ 0x06 ^ 0x13 ^ 0x88};
  plant.run(10);
  EXPECT_EQ(ipos_plant_serial_send(plant.plant, 2, telegram.data(), telegram.size()), IPOS_PLANT_OK);
  plant.run(100);
  ipos_plant_telegram heard{};
  ASSERT_EQ(ipos_plant_serial_receive(plant.plant, 2, &heard), IPOS_PLANT_OK);
  EXPECT_EQ(std::vector(heard.bytes, heard.bytes + heard.length), telegram);
  EXPECT_TRUE(heard.valid);
  EXPECT_STRNE(heard.text, "");
  // Ten characters of 11 bits at 9600 baud.
  EXPECT_NEAR(static_cast<double>(heard.end - heard.start), 10 * 11 / 9600.0 * 1e9, 1e6);
  EXPECT_EQ(ipos_plant_serial_receive(plant.plant, 2, &heard), IPOS_PLANT_NOTHING);
  EXPECT_EQ(ipos_plant_serial_receive(plant.plant, 2, nullptr), IPOS_PLANT_INVALID_ARGUMENT);
}

TEST(LibraryLines, FaultsAreReadLikeThoseOfThePlant) {
  const OpenedPlant plant(kThreeLines);
  EXPECT_EQ(ipos_plant_line_fault(plant.plant, nullptr), IPOS_PLANT_INVALID_ARGUMENT);
  EXPECT_EQ(ipos_plant_line_fault(plant.plant, "\n"), IPOS_PLANT_BAD_VALUE);
  EXPECT_EQ(plant.message(), "the text has no [[fault]]");
  EXPECT_EQ(ipos_plant_line_fault(plant.plant, "[[fault]]\nbus = \"x\"\nkind = \"drop\"\n"),
            IPOS_PLANT_BAD_VALUE);
  EXPECT_EQ(plant.message(), "line 2, column 7: there is no bus 'x'");
  EXPECT_EQ(
      ipos_plant_line_fault(plant.plant, "[[fault]]\nbus = \"alone\"\nkind = \"drop\"\nstation = \"a\"\n"),
      IPOS_PLANT_REFUSED);
  EXPECT_EQ(plant.message(), "station 'a' is not on bus 'alone'");
}

// A line has signals by name: its load, and what its telegrams carried last, also after a state was restored.
TEST(LibraryLines, TelegramsAreSignals) {
  const OpenedPlant plant(kThreeLines);
  const auto find = [&](uint32_t line, const char* name) {
    uint32_t signal = UINT32_MAX;
    EXPECT_EQ(ipos_plant_find(plant.plant, IPOS_PLANT_LINE + line, IPOS_PLANT_ANY, name, &signal), IPOS_PLANT_OK) << plant.message();
    return signal;
  };
  const uint32_t byte = find(0, "123.B1"), other = find(1, "123.B1"), count = find(0, "count");
  const ipos_plant_frame sent = frame_with(0x123, 0, 3);  // 1, 2, 3
  uint32_t tag = 0;
  ASSERT_EQ(ipos_plant_send(plant.plant, 0, &sent, &tag), IPOS_PLANT_OK);
  plant.run(5);
  EXPECT_EQ(plant.value(byte), 2);
  EXPECT_EQ(plant.value(other), 0);
  EXPECT_EQ(plant.value(count), static_cast<int64_t>(plant.frames().size()));
  size_t size = 0;
  ASSERT_EQ(ipos_plant_save(plant.plant, nullptr, &size), IPOS_PLANT_TOO_SMALL);
  std::string saved(size, '\0');
  ASSERT_EQ(ipos_plant_save(plant.plant, saved.data(), &size), IPOS_PLANT_OK);
  ASSERT_EQ(ipos_plant_restore(plant.plant, saved.data(), size), IPOS_PLANT_OK) << plant.message();
  EXPECT_EQ(plant.value(byte), 2);

  EXPECT_EQ(plant.info(byte).kind, IPOS_PLANT_SIGNAL);
  EXPECT_EQ(plant.info(byte).flags, 0U);
  for (const auto change : {ipos_plant_write, ipos_plant_force}) EXPECT_EQ(change(plant.plant, byte, 1), IPOS_PLANT_READ_ONLY);
  uint32_t signal = 0;
  EXPECT_EQ(ipos_plant_find(plant.plant, IPOS_PLANT_LINE, IPOS_PLANT_ANY, "speed", &signal), IPOS_PLANT_NO_SIGNAL);
  EXPECT_NE(plant.message().find("line 'can' has no signal 'speed'; it has load, count"), std::string::npos) << plant.message();
  EXPECT_EQ(ipos_plant_find(plant.plant, IPOS_PLANT_LINE, IPOS_PLANT_STATE, "load", &signal), IPOS_PLANT_NO_SIGNAL);
  EXPECT_EQ(ipos_plant_find(plant.plant, IPOS_PLANT_LINE + 3, IPOS_PLANT_ANY, "load", &signal), IPOS_PLANT_NO_STATION);
  const char* name = nullptr;
  EXPECT_EQ(ipos_plant_name_at(plant.plant, IPOS_PLANT_LINE + 2, IPOS_PLANT_SIGNAL, nullptr, 0, &name), IPOS_PLANT_OK);
  EXPECT_STREQ(name, "load");
  EXPECT_EQ(ipos_plant_name_at(plant.plant, IPOS_PLANT_LINE + 2, IPOS_PLANT_STATE, nullptr, 0, &name), IPOS_PLANT_NOTHING);
  EXPECT_EQ(ipos_plant_power(plant.plant, IPOS_PLANT_LINE, false), IPOS_PLANT_NO_STATION);
}

}  // namespace
}  // namespace ipos::tests
