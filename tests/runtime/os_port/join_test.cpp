// Lines of a plant at real ports: each kind has its bridge, the port has the rate of the line, and a port that cannot be
// had says why.
#include "runtime/plant_port/join.hpp"

#include <gtest/gtest.h>

#include "runtime/os_port/can_port.hpp"
#include "runtime/os_port/serial_port.hpp"
#include "runtime/os_port/system_clock.hpp"
#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

using namespace ipos::runtime;  // NOLINT: everything here is about the runtime

class JoinedLines : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_pty()) GTEST_SKIP() << kNoPty;
    PlantFileResult file = read_plant_file(
        "[[bus]]\nname = 'can'\nkind = 'can'\nbaud = 250000\n[[bus]]\nname = 'rs'\nkind = 'rs485'\n"
        "[[bus]]\nname = 'slow'\nkind = 'rs232'\n[[bus]]\nname = 'dp'\nkind = 'profibus'\n"
        "[[station]]\nname = 'u'\nunit = 'mdxb'\nsbus = 'can'\nrs485 = 'rs'\noption = 'dfp'\nprofibus = "
        "'dp'\n"
        "profibus_address = 8\n[station.parameters]\nP884 = 1\n");
    ASSERT_TRUE(file.errors.empty()) << file.errors[0].text;
    std::vector<PlantError> errors;
    plant_ = std::make_unique<Plant>(std::move(file.plant), std::vector<std::optional<vm::Image>>(1),
                                     std::nullopt, errors);
    ASSERT_TRUE(errors.empty());
  }
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  tl::expected<JoinedPort, PortError> join(const std::string& bus, const std::string& port,
                                           PortLoss loss = PortLoss::Ends) {
    return join_port(*plant_, *plant_->find_bus(bus), port, clock_, loss);
  }

  TemporaryFolder folder_;
  SystemClock clock_;
  std::unique_ptr<Plant> plant_;
};

TEST_F(JoinedLines, EachKindHasItsBridge) {
  for (const PortLoss loss : {PortLoss::Ends, PortLoss::GoesOn})
    for (const auto& [bus, port, goods] : {std::tuple("can", "slcan:pty:" + path("can"), "frames"),
                                           std::tuple("rs", "pty:" + path("rs"), "bytes"),
                                           std::tuple("slow", "pty:" + path("slow"), "bytes")}) {
      const auto joined = join(bus, port, loss);
      ASSERT_TRUE(joined) << joined.error().text;
      EXPECT_NE(joined->port->name().find(path(bus)), std::string::npos);
      EXPECT_EQ(joined->bridge->goods(), goods) << bus;
      EXPECT_EQ(&joined->bridge->port(), joined->port.get());
      EXPECT_EQ(joined->port->absence().empty(), false) << "no program is at the other end";
    }
  const auto profibus = join("dp", "pty:" + path("dp"));
  ASSERT_TRUE(profibus) << profibus.error().text << ": PROFIBUS has other rates than MOVILINK";
}

// MOVILINK and PROFIBUS have even parity, which a pseudo-terminal cannot have.
TEST_F(JoinedLines, SerialLinesHaveEvenParity) {
  for (const char* bus : {"rs", "slow", "dp"}) {
    const auto joined = join(bus, "pty:" + path(bus));
    ASSERT_TRUE(joined) << joined.error().text;
    std::string told;
    for (const std::string& note : joined->bridge->take_notes()) told += note;
    EXPECT_NE(told.find("a pseudo-terminal has no parity"), std::string::npos) << bus;
  }
}

TEST_F(JoinedLines, ARunEndsWithItsPortOrGoesOnWithoutIt) {
  for (const PortLoss loss : {PortLoss::Ends, PortLoss::GoesOn}) {
    auto other = open_serial_port("pty:" + path("line"), {9'600, true}, clock_);
    ASSERT_TRUE(other) << other.error().text;
    const auto joined = join("rs", path("line"), loss);
    ASSERT_TRUE(joined) << joined.error().text;
    EXPECT_TRUE(joined->bridge->collect(clock_.now()));
    EXPECT_EQ(joined->port->absence(), "");
    other->reset();
    bool there = true;
    for (int n = 0; n < 100 && there && joined->port->absence().empty(); ++n) {
      there = joined->bridge->collect(clock_.now());
      clock_.wait(clock_.now() + kMillisecond, {});
    }
    EXPECT_EQ(there, loss == PortLoss::GoesOn);
    EXPECT_EQ(joined->port->absence().empty(), loss == PortLoss::Ends);
  }
}

TEST_F(JoinedLines, APortThatCannotBeHadSaysWhy) {
  for (const PortLoss loss : {PortLoss::Ends, PortLoss::GoesOn}) {
    EXPECT_EQ(join("can", "nocan7", loss).error().fault, PortFault::NoSuchInterface);
    EXPECT_EQ(join("can", "slcan:/dev/null", loss).error().fault, PortFault::NotSerial);
    EXPECT_EQ(join("rs", "/dev/nothere", loss).error().fault, PortFault::NoSuchDevice);
    EXPECT_EQ(join("rs", "can0x", loss).error().fault, PortFault::BadName);
    EXPECT_EQ(join("dp", "/dev/null", loss).error().fault, PortFault::NotSerial);
  }
}

// A program that opens an adapter with another rate than that of the line is refused.
TEST_F(JoinedLines, ThePortHasTheRateOfTheLine) {
  const auto adapter = join("can", "slcan:pty:" + path("can"));
  ASSERT_TRUE(adapter) << adapter.error().text;
  for (const auto& [baud, refused] : {std::pair(500'000U, true), std::pair(250'000U, false)}) {
    auto program = open_can_port("slcan:" + path("can"), baud, clock_);
    ASSERT_TRUE(program) << program.error().text;
    std::string told;
    for (int n = 0; n < 40; ++n) {
      EXPECT_TRUE(adapter->bridge->collect(clock_.now() - plant_->now()));
      EXPECT_TRUE(adapter->bridge->flush());
      EXPECT_TRUE((*program)->receive());
      for (const std::string& note : adapter->bridge->take_notes()) told += note;
      clock_.wait(clock_.now() + kMillisecond, {});
    }
    EXPECT_EQ(told.find("refused to open: the program asks for 500000 bit/s, the bus has 250000") !=
                  std::string::npos,
              refused);
    program->reset();
    EXPECT_TRUE(adapter->bridge->collect(clock_.now() - plant_->now()));
  }
}

// What a station sends goes out by the bridge, and what comes in is on its line.
TEST_F(JoinedLines, FramesGoBothWays) {
  const auto adapter = join("can", "slcan:pty:" + path("can"), PortLoss::GoesOn);
  ASSERT_TRUE(adapter) << adapter.error().text;
  auto program = open_can_port("slcan:" + path("can"), 250'000, clock_);
  ASSERT_TRUE(program) << program.error().text;
  const Time epoch = clock_.now();
  Bus& bus = *plant_->find_bus("can");
  bus.attach_hand();
  std::vector<Frame> heard;
  for (int n = 0; n < 200 && heard.empty(); ++n) {
    EXPECT_TRUE(adapter->bridge->collect(epoch));
    if (n == 20) {
      EXPECT_EQ(bus.send("123#AB"), std::nullopt);
      Frame frame;
      frame.id = 0x7F0;
      (*program)->send(frame);
    }
    plant_->run_until(clock_.now() - epoch);
    EXPECT_TRUE(adapter->bridge->flush());
    const auto got = (*program)->receive();
    ASSERT_TRUE(got);
    if (*got) heard.push_back((*got)->frame);
    clock_.wait(clock_.now() + kMillisecond, {});
  }
  ASSERT_EQ(heard.size(), 1U);
  EXPECT_EQ(std::pair(heard[0].id, heard[0].data[0]), std::pair(0x123U, uint8_t{0xAB}));
  for (int n = 0; n < 20; ++n) {
    EXPECT_TRUE(adapter->bridge->collect(epoch));
    plant_->run_until(clock_.now() - epoch);
    clock_.wait(clock_.now() + kMillisecond, {});
  }
  EXPECT_EQ(bus.load(plant_->now()).frames, 2U);
}

}  // namespace
}  // namespace ipos::tests
