// A gateway in the library: a number behind the stations, power, signals to read, and nothing of a drive.
#include <gtest/gtest.h>

#include <string>

#include "tests/runtime/library/functions.hpp"

namespace ipos::tests {
namespace {

constexpr const char* kPlant = R"(
[[bus]]
name = "dp"
kind = "profibus"
baud = 500000
[[bus]]
name = "sbus"
kind = "can"
[[station]]
name = "gw"
unit = "gateway"
profibus = "dp"
profibus_address = 10
sbus = "sbus"
[[station]]
name = "pump"
unit = "mc07"
sbus = "sbus"
[station.parameters]
P813 = 2
[[control]]
name = "plc"
profibus = "dp"
[[control.slave]]
address = 10
cfg = "F3 F2"
po = [6, 1500, 0]
)";

TEST(LibraryGateway, HasPowerAndSignals) {
  ipos_plant_source source = {};
  source.text = kPlant;
  ipos_plant* plant = nullptr;
  ASSERT_EQ(ipos_plant_open(&source, &plant), IPOS_PLANT_OK);
  uint32_t gateway = 0;
  ASSERT_EQ(ipos_plant_station(plant, "gw", &gateway), IPOS_PLANT_OK);
  EXPECT_EQ(gateway, 1U) << "behind the pump";
  ipos_plant_station_info info = {};
  ASSERT_EQ(ipos_plant_station_at(plant, gateway, &info), IPOS_PLANT_OK);
  EXPECT_STREQ(info.unit, "gateway");
  EXPECT_EQ(ipos_plant_station_at(plant, 2, &info), IPOS_PLANT_NO_STATION);
  bool ideal = true;
  EXPECT_EQ(ipos_plant_ideal_motor(plant, gateway, &ideal), IPOS_PLANT_OK);
  EXPECT_FALSE(ideal) << "it has no motor";

  uint32_t word = 0, powered = 0, exchange = 0;
  ASSERT_EQ(ipos_plant_find(plant, gateway, IPOS_PLANT_ANY, "drive2.PO2", &word), IPOS_PLANT_OK);
  ASSERT_EQ(ipos_plant_find(plant, gateway, IPOS_PLANT_STATE, "powered", &powered), IPOS_PLANT_OK);
  ASSERT_EQ(ipos_plant_find(plant, gateway, IPOS_PLANT_SIGNAL, "exchange", &exchange), IPOS_PLANT_OK);
  EXPECT_EQ(ipos_plant_find(plant, gateway, IPOS_PLANT_ANY, "speed", &word), IPOS_PLANT_NO_SIGNAL);
  EXPECT_NE(std::string(ipos_plant_message(plant)).find("gateway 'gw' has no signal 'speed'; it has powered"),
            std::string::npos);
  const auto value = [&](uint32_t signal) {
    int64_t read = -1;
    EXPECT_EQ(ipos_plant_read(plant, signal, &read), IPOS_PLANT_OK);
    return read;
  };
  ASSERT_EQ(ipos_plant_run(plant, 3'000'000'000), IPOS_PLANT_OK);
  EXPECT_EQ(value(exchange), 1);
  EXPECT_EQ(value(word), 1500);
  EXPECT_EQ(ipos_plant_write(plant, word, 1), IPOS_PLANT_READ_ONLY);
  EXPECT_EQ(ipos_plant_drive_fault(plant, gateway, 26), IPOS_PLANT_REFUSED);

  ASSERT_EQ(ipos_plant_power(plant, gateway, false), IPOS_PLANT_OK);
  ASSERT_EQ(ipos_plant_run(plant, 4'000'000'000), IPOS_PLANT_OK);
  EXPECT_EQ(value(powered), 0);
  EXPECT_EQ(value(exchange), 0);
  const char* why = nullptr;
  ASSERT_EQ(ipos_plant_why(plant, gateway, &why), IPOS_PLANT_OK);
  EXPECT_STREQ(why, "the power is off");
  // The record brings it back to where it was.
  size_t size = 0;
  EXPECT_EQ(ipos_plant_save(plant, nullptr, &size), IPOS_PLANT_TOO_SMALL);
  std::string saved(size, '\0');
  ASSERT_EQ(ipos_plant_save(plant, saved.data(), &size), IPOS_PLANT_OK);
  ASSERT_EQ(ipos_plant_power(plant, gateway, true), IPOS_PLANT_OK);
  ASSERT_EQ(ipos_plant_run(plant, 8'000'000'000), IPOS_PLANT_OK);
  EXPECT_EQ(value(exchange), 1);
  ASSERT_EQ(ipos_plant_restore(plant, saved.data(), size), IPOS_PLANT_OK);
  EXPECT_EQ(value(powered), 0);
  EXPECT_EQ(value(word), 0);
  EXPECT_EQ(ipos_plant_close(plant), IPOS_PLANT_OK);
}

}  // namespace
}  // namespace ipos::tests
