// Each status comes where the header says, with its words.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <set>
#include <string>
#include <vector>

#include "stdlib/unit_types.hpp"
#include "tests/runtime/library/functions.hpp"

namespace {

constexpr const char* kPlant = R"([[bus]]
name = "sbus"
kind = "can"
[[bus]]
name = "rs"
kind = "rs485"
baud = 9600
[[station]]
name = "a"
unit = "mdxb"
sbus = "sbus"
rs485 = "rs"
)";

class LibraryStatus : public ::testing::Test {
 protected:
  void SetUp() override {
    source_.text = kPlant;
    ASSERT_EQ(ipos_plant_open(&source_, &plant_), IPOS_PLANT_OK);
  }
  void TearDown() override { EXPECT_EQ(ipos_plant_close(plant_), IPOS_PLANT_OK); }
  uint32_t find(ipos_plant_kind kind, const char* name) {
    uint32_t signal = UINT32_MAX;
    EXPECT_EQ(ipos_plant_find(plant_, 0, kind, name, &signal), IPOS_PLANT_OK) << ipos_plant_message(plant_);
    return signal;
  }
  std::string message() const { return ipos_plant_message(plant_); }

  ipos_plant_source source_{};
  ipos_plant* plant_ = nullptr;
};

TEST(LibraryTable, EveryStatusHasItsTextAndNoOtherHasOne) {
  std::set<std::string> texts;
#define ROW(name, number, text)                     \
  EXPECT_EQ(name, number);                          \
  EXPECT_STREQ(ipos_plant_status_text(name), text); \
  EXPECT_EQ(std::string_view(text).find("ipos_plant_"), std::string_view::npos) << "Python shows it, too"; \
  texts.insert(text);
  IPOS_PLANT_STATUSES(ROW)
#undef ROW
  EXPECT_EQ(texts.size(), 21U);
  EXPECT_STREQ(ipos_plant_status_text(-1), "");
  EXPECT_STREQ(ipos_plant_status_text(21), "");
  EXPECT_EQ(ipos_plant_version(), uint32_t{IPOS_PLANT_VERSION});
}

TEST(LibraryOpening, MistakesHavePlaces) {
  ipos_plant_source source{};
  source.text = "[[station]]\nname = \"a\"\nunit = \"mdxx\"\n";
  ipos_plant* plant = nullptr;
  ASSERT_EQ(ipos_plant_open(&source, &plant), IPOS_PLANT_BAD_PLANT);
  ASSERT_EQ(ipos_plant_mistakes(plant), 1U);
  ipos_plant_mistake mistake{};
  ASSERT_EQ(ipos_plant_mistake_at(plant, 0, &mistake), IPOS_PLANT_OK);
  EXPECT_EQ(mistake.line, 3U);
  EXPECT_EQ(mistake.column, 8U);
  EXPECT_EQ(ipos_plant_mistake_at(plant, 1, &mistake), IPOS_PLANT_NOTHING);
  EXPECT_EQ(ipos_plant_run(plant, 1), IPOS_PLANT_NOT_OPEN);
  EXPECT_EQ(ipos_plant_close(plant), IPOS_PLANT_OK);
  EXPECT_EQ(ipos_plant_open(nullptr, &plant), IPOS_PLANT_INVALID_ARGUMENT);
  source.text = nullptr;
  EXPECT_EQ(ipos_plant_open(&source, &plant), IPOS_PLANT_INVALID_ARGUMENT);
  EXPECT_EQ(plant, nullptr);
  EXPECT_EQ(ipos_plant_close(nullptr), IPOS_PLANT_OK);
}

TEST_F(LibraryStatus, OfStationsAndSignals) {
  uint32_t number = 0;
  EXPECT_EQ(ipos_plant_station(plant_, "b", &number), IPOS_PLANT_NO_STATION);
  EXPECT_EQ(message(), "there is no station 'b'; the plant has a");
  EXPECT_EQ(ipos_plant_find(plant_, 0, IPOS_PLANT_INPUT, "DI08", &number), IPOS_PLANT_NO_SIGNAL);
  EXPECT_EQ(ipos_plant_find(plant_, 9, IPOS_PLANT_INPUT, "DI00", &number), IPOS_PLANT_NO_STATION);
  EXPECT_EQ(ipos_plant_find(plant_, 0, 99, "DI00", &number), IPOS_PLANT_INVALID_ARGUMENT);
  int64_t value = 0;
  EXPECT_EQ(ipos_plant_read(plant_, 77, &value), IPOS_PLANT_NO_SIGNAL);
  const uint32_t output = find(IPOS_PLANT_OUTPUT, "DO01");
  EXPECT_EQ(ipos_plant_write(plant_, output, 1), IPOS_PLANT_READ_ONLY);
  const uint32_t input = find(IPOS_PLANT_INPUT, "DI03");
  EXPECT_EQ(ipos_plant_write(plant_, input, 2), IPOS_PLANT_BAD_VALUE);
  EXPECT_EQ(ipos_plant_write_text(plant_, input, "1"), IPOS_PLANT_OK);
  EXPECT_EQ(ipos_plant_read(plant_, input, &value), IPOS_PLANT_OK);
  EXPECT_EQ(value, 1);
  const uint32_t ramp = find(IPOS_PLANT_PARAMETER, "P130");
  EXPECT_EQ(ipos_plant_write(plant_, ramp, -1), IPOS_PLANT_REFUSED);
  EXPECT_NE(message().find("P130"), std::string::npos);
  ipos_plant_signal_info info{};
  ASSERT_EQ(ipos_plant_signal_info_of(plant_, ramp, &info), IPOS_PLANT_OK);
  EXPECT_STREQ(info.unit, "s");
  EXPECT_DOUBLE_EQ(info.factor, 0.001);
  EXPECT_EQ(info.number, 8470U);
  EXPECT_EQ(info.flags, uint32_t{IPOS_PLANT_WRITABLE});
}

TEST_F(LibraryStatus, OfTime) {
  EXPECT_EQ(ipos_plant_run(plant_, 5'000'000), IPOS_PLANT_OK);
  EXPECT_EQ(ipos_plant_run(plant_, 4'999'999), IPOS_PLANT_INVALID_ARGUMENT);
  const auto never = [](void*, ipos_plant*) { return false; };
  EXPECT_EQ(ipos_plant_run_until(plant_, 7'000'000, never, nullptr), IPOS_PLANT_NOT_REACHED);
  const auto inside = [](void* user, ipos_plant* plant) {
    *static_cast<ipos_plant_status*>(user) = ipos_plant_run(plant, 99'000'000);
    return true;
  };
  ipos_plant_status status = IPOS_PLANT_OK;
  EXPECT_EQ(ipos_plant_run_until(plant_, 9'000'000, inside, &status), IPOS_PLANT_OK);
  EXPECT_EQ(status, IPOS_PLANT_BUSY);
  int64_t now = 0;
  EXPECT_EQ(ipos_plant_time(plant_, &now), IPOS_PLANT_OK);
  EXPECT_EQ(now, 7'000'000);
  EXPECT_EQ(ipos_plant_duration("1.5ms", &now), IPOS_PLANT_OK);
  EXPECT_EQ(now, 1'500'000);
  EXPECT_EQ(ipos_plant_duration("soon", &now), IPOS_PLANT_BAD_VALUE);
}

TEST_F(LibraryStatus, OfBuses) {
  uint32_t bus = 9;
  EXPECT_EQ(ipos_plant_bus(plant_, "can0", &bus), IPOS_PLANT_NO_BUS);
  EXPECT_EQ(message(), "there is no bus 'can0'; the plant has sbus, rs");
  ipos_plant_frame frame{};
  frame.id = 0x800;
  EXPECT_EQ(ipos_plant_send(plant_, 0, &frame, nullptr), IPOS_PLANT_BAD_VALUE);
  frame.id = 0x7FF;
  for (int n = 0; n < 64; ++n) EXPECT_EQ(ipos_plant_send(plant_, 0, &frame, nullptr), IPOS_PLANT_OK);
  EXPECT_EQ(ipos_plant_send(plant_, 0, &frame, nullptr), IPOS_PLANT_FULL);
  EXPECT_EQ(ipos_plant_run(plant_, 8'000'000), IPOS_PLANT_OK);  // one of them has gone
  EXPECT_EQ(ipos_plant_send(plant_, 0, &frame, nullptr), IPOS_PLANT_OK);
  EXPECT_EQ(ipos_plant_send(plant_, 1, &frame, nullptr), IPOS_PLANT_NO_BUS);
  const std::array<uint8_t, 4> bytes = {2, 1, 5, 6};
  EXPECT_EQ(ipos_plant_serial_send(plant_, 1, bytes.data(), 0), IPOS_PLANT_BAD_VALUE);
  EXPECT_EQ(ipos_plant_serial_send(plant_, 1, bytes.data(), bytes.size()), IPOS_PLANT_OK);
  EXPECT_EQ(ipos_plant_serial_send(plant_, 1, bytes.data(), bytes.size()), IPOS_PLANT_REFUSED);
  EXPECT_EQ(ipos_plant_serial_send(plant_, 0, bytes.data(), bytes.size()), IPOS_PLANT_NO_BUS);
  ipos_plant_telegram telegram{};
  EXPECT_EQ(ipos_plant_serial_receive(plant_, 1, &telegram), IPOS_PLANT_NOTHING);
  EXPECT_EQ(ipos_plant_line_fault(plant_, "[[fault]]\nbus = \"sbus\"\n"), IPOS_PLANT_BAD_VALUE);
  EXPECT_EQ(ipos_plant_line_fault(plant_, ""), IPOS_PLANT_BAD_VALUE);
}

TEST_F(LibraryStatus, OfNodesOfALine) {
  ipos_plant_bus_info info{};
  ASSERT_EQ(ipos_plant_bus_at(plant_, 1, &info), IPOS_PLANT_OK);
  EXPECT_STREQ(info.name, "rs");
  EXPECT_EQ(info.kind, IPOS_PLANT_SERIAL);
  EXPECT_EQ(info.baud, 9600U);
  EXPECT_EQ(ipos_plant_bus_at(plant_, 2, &info), IPOS_PLANT_NO_BUS);
  EXPECT_EQ(ipos_plant_join(plant_, 0), IPOS_PLANT_OK);
  EXPECT_EQ(ipos_plant_join(plant_, 0), IPOS_PLANT_OK);  // once is enough
  EXPECT_EQ(ipos_plant_join(plant_, 1), IPOS_PLANT_NO_BUS);
  ipos_plant_frame sent{};
  sent.id = 0x123;
  ASSERT_EQ(ipos_plant_send(plant_, 0, &sent, nullptr), IPOS_PLANT_OK);
  ASSERT_EQ(ipos_plant_run(plant_, 5'000'000), IPOS_PLANT_OK);
  std::array<ipos_plant_frame, 8> frames{};
  size_t count = 0;
  ASSERT_EQ(ipos_plant_receive(plant_, 0, frames.data(), frames.size(), &count), IPOS_PLANT_OK);
  ASSERT_EQ(count, 1U);
  EXPECT_EQ(frames[0].flags, uint32_t{IPOS_PLANT_OWN});
  const char* name = nullptr;
  ASSERT_EQ(ipos_plant_node_name(plant_, 0, 0, &name), IPOS_PLANT_OK);
  EXPECT_STREQ(name, "a");
  EXPECT_EQ(ipos_plant_node_name(plant_, 0, frames[0].sender, &name), IPOS_PLANT_OK);
  EXPECT_STRNE(name, "a");
  EXPECT_EQ(ipos_plant_node_name(plant_, 0, 99, &name), IPOS_PLANT_NO_STATION);
}

// Against the table itself: a front end that asks the library names and recognises the units that it knows.
TEST(LibraryParameters, UnitsAndTheirSignsAreThoseOfTheTable) {
  size_t units = 0;
  for (const ipos::stdlib::UnitType& unit : ipos::stdlib::unit_types()) EXPECT_EQ(ipos_plant_unit_name(units++), unit.name);
  EXPECT_EQ(ipos_plant_unit_name(units), nullptr);
  const char* unit = nullptr;
  uint16_t indices[8];
  size_t rows = 0;
  for (const ipos::stdlib::UnitSigns& signs : ipos::stdlib::unit_signs()) {
    size_t count = 0;
    EXPECT_EQ(ipos_plant_unit_signs(rows, &unit, indices, &count), IPOS_PLANT_TOO_SMALL);
    EXPECT_EQ(count, signs.indices.size());
    ASSERT_EQ(ipos_plant_unit_signs(rows++, &unit, indices, &count), IPOS_PLANT_OK);
    EXPECT_EQ(unit, signs.unit);
    EXPECT_TRUE(std::equal(signs.indices.begin(), signs.indices.end(), indices, indices + count));
  }
  size_t count = std::size(indices);
  EXPECT_EQ(ipos_plant_unit_signs(rows, &unit, indices, &count), IPOS_PLANT_NOTHING);
  EXPECT_EQ(ipos_plant_unit_signs(0, nullptr, indices, &count), IPOS_PLANT_INVALID_ARGUMENT);
  EXPECT_EQ(ipos_plant_unit_signs(0, &unit, nullptr, &count), IPOS_PLANT_INVALID_ARGUMENT);
  EXPECT_EQ(ipos_plant_unit_signs(0, &unit, indices, nullptr), IPOS_PLANT_INVALID_ARGUMENT);
}

TEST(LibraryParameters, OfRealUnitsHaveTextsBothWays) {
  uint16_t index = 0;
  ASSERT_EQ(ipos_plant_parameter_index("mdxb", "P130", &index), IPOS_PLANT_OK);
  EXPECT_EQ(index, 8470);
  EXPECT_EQ(ipos_plant_parameter_index("mdxb", "P9999", &index), IPOS_PLANT_NO_SIGNAL);
  EXPECT_EQ(ipos_plant_parameter_index("mdxx", "P130", &index), IPOS_PLANT_NO_STATION);
  EXPECT_EQ(ipos_plant_parameter_index(nullptr, "P130", &index), IPOS_PLANT_INVALID_ARGUMENT);
  char text[200];
  ASSERT_EQ(ipos_plant_parameter_text("mdxb", 8470, 2500, text, sizeof text), IPOS_PLANT_OK);
  EXPECT_STREQ(text, "2.500 s");
  EXPECT_EQ(ipos_plant_parameter_text("mdxb", 8470, 2500, text, 4), IPOS_PLANT_TOO_SMALL);
  EXPECT_STREQ(text, "2.5");
  EXPECT_EQ(ipos_plant_parameter_text("mdxb", 8470, 2500, text, 0), IPOS_PLANT_TOO_SMALL);
  EXPECT_EQ(ipos_plant_parameter_text("mdxb", 1, 0, text, sizeof text), IPOS_PLANT_NO_SIGNAL);
  int32_t value = 0;
  ASSERT_EQ(ipos_plant_parameter_value("mdxb", 8470, "2.5 s", &value, text, sizeof text), IPOS_PLANT_OK);
  EXPECT_EQ(value, 2500);
  EXPECT_EQ(ipos_plant_parameter_value("mdxb", 8470, "2.5 rpm", &value, text, sizeof text),
            IPOS_PLANT_BAD_VALUE);
  EXPECT_STRNE(text, "");
  // Of the manual's list: error class 8, code 0, additional code 15h.
  EXPECT_STREQ(ipos_plant_return_code(0x08000015), "parameter value too large");
  EXPECT_STREQ(ipos_plant_return_code(0x99999999), "");
}

TEST_F(LibraryStatus, OfStates) {
  size_t size = 0;
  EXPECT_EQ(ipos_plant_save(plant_, nullptr, &size), IPOS_PLANT_TOO_SMALL);
  std::string state(size, '\0');
  EXPECT_EQ(ipos_plant_save(plant_, state.data(), &size), IPOS_PLANT_OK);
  EXPECT_EQ(ipos_plant_restore(plant_, state.data(), size), IPOS_PLANT_OK);
  EXPECT_EQ(ipos_plant_restore(plant_, state.data(), size - 1), IPOS_PLANT_BAD_STATE);
  ipos_plant_source other = source_;
  other.seed = 1;
  ipos_plant* plant = nullptr;
  ASSERT_EQ(ipos_plant_open(&other, &plant), IPOS_PLANT_OK);
  EXPECT_EQ(ipos_plant_restore(plant, state.data(), size), IPOS_PLANT_OTHER_PLANT);
  EXPECT_EQ(ipos_plant_close(plant), IPOS_PLANT_OK);
  other.flags = IPOS_PLANT_NO_RECORD;
  ASSERT_EQ(ipos_plant_open(&other, &plant), IPOS_PLANT_OK);
  uint64_t hash = 0;
  size = 0;
  EXPECT_EQ(ipos_plant_save(plant, nullptr, &size), IPOS_PLANT_NOT_RECORDED);
  EXPECT_EQ(ipos_plant_trace_hash(plant, &hash), IPOS_PLANT_NOT_RECORDED);
  EXPECT_EQ(ipos_plant_close(plant), IPOS_PLANT_OK);
}

// A station asks for the FDL status of the slave 8, which answers with 00, a slave (EN 50170 volume 2): 10 DA SA FC FCS 16.
TEST(LibraryProfibus, CarriesFramesBothWays) {
  ipos_plant_source source{};
  source.text = R"([[bus]]
name = "dp"
kind = "profibus"
baud = 1500000
[[station]]
name = "inv"
unit = "mc31"
option = "ffp31"
profibus = "dp"
profibus_address = 8
)";
  ipos_plant* plant = nullptr;
  ASSERT_EQ(ipos_plant_open(&source, &plant), IPOS_PLANT_OK);
  uint32_t bus = 7;
  ASSERT_EQ(ipos_plant_bus(plant, "dp", &bus), IPOS_PLANT_OK);
  EXPECT_EQ(bus, 0U);
  ipos_plant_bus_info info{};
  ASSERT_EQ(ipos_plant_bus_at(plant, bus, &info), IPOS_PLANT_OK);
  EXPECT_EQ(info.kind, IPOS_PLANT_PROFIBUS);
  EXPECT_EQ(info.baud, 1'500'000U);
  ASSERT_EQ(ipos_plant_run(plant, 1'000'000), IPOS_PLANT_OK);
  const std::array<uint8_t, 6> status{0x10, 0x08, 0x02, 0x49, 0x53, 0x16};
  EXPECT_EQ(ipos_plant_serial_send(plant, bus, status.data(), status.size()), IPOS_PLANT_OK);
  EXPECT_EQ(ipos_plant_serial_send(plant, bus, status.data(), status.size()), IPOS_PLANT_REFUSED);
  EXPECT_EQ(ipos_plant_serial_send(plant, bus, status.data(), 301), IPOS_PLANT_BAD_VALUE);
  EXPECT_EQ(ipos_plant_join(plant, bus), IPOS_PLANT_NO_BUS);
  // The first frame gives the slave its rate; the second one is answered.
  ASSERT_EQ(ipos_plant_run(plant, 2'000'000), IPOS_PLANT_OK);
  EXPECT_EQ(ipos_plant_serial_send(plant, bus, status.data(), status.size()), IPOS_PLANT_OK);
  ASSERT_EQ(ipos_plant_run(plant, 3'000'000), IPOS_PLANT_OK);
  std::vector<std::vector<uint8_t>> heard;
  ipos_plant_telegram telegram{};
  std::string text;
  while (ipos_plant_serial_receive(plant, bus, &telegram) == IPOS_PLANT_OK) {
    heard.emplace_back(telegram.bytes, telegram.bytes + telegram.length);
    EXPECT_TRUE(telegram.valid);
    text = telegram.text;
  }
  const std::vector<uint8_t> asked(status.begin(), status.end());
  EXPECT_EQ(heard, (std::vector<std::vector<uint8_t>>{asked, asked, {0x10, 0x02, 0x08, 0x00, 0x0A, 0x16}}));
  EXPECT_EQ(text.substr(0, 6), "8 -> 2") << text;
  ipos_plant_load load{};
  ASSERT_EQ(ipos_plant_bus_load(plant, bus, &load), IPOS_PLANT_OK);
  EXPECT_EQ(load.frames, 3U);
  // 3 x 66 bits of 4500, in percent.
  EXPECT_NEAR(load.percent, 100.0 * 198 / 4500, 0.1);
  // FMS: object 1025 is P120, 9.50 s as BCD.
  const std::array<uint8_t, 4> ramp{0x00, 0x00, 0x09, 0x50};
  ipos_plant_fms_answer answer{};
  EXPECT_EQ(ipos_plant_fms(plant, bus, 8, 7, "write", 1025, ramp.data(), ramp.size(), 2'000'000'000, &answer), IPOS_PLANT_OK);
  EXPECT_EQ(answer.end, IPOS_PLANT_FMS_DONE);
  ASSERT_EQ(ipos_plant_fms(plant, bus, 8, 7, "read", 1025, nullptr, 0, 4'000'000'000, &answer), IPOS_PLANT_OK);
  EXPECT_EQ(std::vector<uint8_t>(answer.data, answer.data + answer.length), std::vector<uint8_t>(ramp.begin(), ramp.end()));
  ASSERT_EQ(ipos_plant_fms(plant, bus, 8, 7, "read", 987, nullptr, 0, 4'000'000'000, &answer), IPOS_PLANT_OK);
  EXPECT_EQ(answer.end, IPOS_PLANT_FMS_ERROR);
  EXPECT_EQ(answer.code, 0x06070000U);
  EXPECT_EQ(ipos_plant_fms(plant, bus, 8, 7, "go", 0, nullptr, 0, 4'000'000'000, &answer), IPOS_PLANT_BAD_VALUE);
  EXPECT_EQ(ipos_plant_fms(plant, bus, 8, 9, "read", 0, nullptr, 0, 4'000'000'000, &answer), IPOS_PLANT_BAD_VALUE);
  EXPECT_EQ(ipos_plant_fms(plant, bus, 8, 7, "read", 0, nullptr, 0, 0, &answer), IPOS_PLANT_INVALID_ARGUMENT);
  EXPECT_EQ(ipos_plant_fms(plant, 5, 8, 7, "read", 0, nullptr, 0, 4'000'000'000, &answer), IPOS_PLANT_NO_BUS);
  EXPECT_EQ(ipos_plant_close(plant), IPOS_PLANT_OK);
}

}  // namespace
