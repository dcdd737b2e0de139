// Our end of slcan at an adapter that the test plays byte by byte, over a pseudo-terminal: opening, refusals, time
// stamps, what is no frame, and an adapter that does not read.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cstdlib>

#include "runtime/os_port/descriptor.hpp"
#include "runtime/os_port/slcan_text.hpp"
#include "tests/runtime/os_port/port_rig.hpp"
#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

class SlcanClientTalk : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_pty()) GTEST_SKIP() << kNoPty;
    master_ = Descriptor(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK));
    ASSERT_TRUE(master_.is_open() && grantpt(master_.get()) == 0 && unlockpt(master_.get()) == 0);
  }
  void open(const std::string& serial_baud = "", uint32_t baud = 500'000) {
    client_.reset();
    CanPortResult opened =
        open_can_port(std::string("slcan:") + ptsname(master_.get()) + serial_baud, baud, clock_);
    ASSERT_TRUE(opened) << opened.error().text;
    client_ = std::move(*opened);
    client_->take_notes();  // of the driver
  }
  // What the client writes.
  std::string written() const {
    std::string all;
    std::array<char, 4'096> bytes{};
    for (int quiet = 0; quiet < 3;) {
      const ssize_t size = ::read(master_.get(), bytes.data(), bytes.size());
      if (size > 0) {
        all.append(bytes.data(), static_cast<size_t>(size));
      } else {
        usleep(200);
        ++quiet;
      }
    }
    return all;
  }
  // The adapter says it, and a frame at the end, until which the client reads.
  std::vector<CanArrival> say(const std::string& text) {
    const std::string all = text + "t7FE0\r";
    EXPECT_EQ(::write(master_.get(), all.data(), all.size()), static_cast<ssize_t>(all.size()));
    std::vector<CanArrival> arrivals;
    for (int tries = 0; tries < 50'000; ++tries) {
      const auto got = client_->receive();
      EXPECT_TRUE(got);
      if (!got) break;
      if (!*got) {
        usleep(200);
        continue;
      }
      if ((*got)->frame.id == 0x7FE) return arrivals;
      arrivals.push_back(**got);
    }
    ADD_FAILURE() << "the last frame has not come within ten seconds";
    return arrivals;
  }

  ManualClock clock_;
  Descriptor master_;
  std::unique_ptr<CanPort> client_;
};
using ClientNotes = std::vector<std::string>;

TEST_F(SlcanClientTalk, OpensTheChannelAndClosesIt) {
  for (const auto& [baud, digit] : {std::pair(125'000U, '4'), std::pair(1'000'000U, '8')}) {
    open("", baud);
    EXPECT_EQ(written(), std::string("C\rS") + digit + "\rZ1\rO\r");
    client_.reset();
    EXPECT_EQ(written(), "C\r");
  }
}

TEST_F(SlcanClientTalk, TheRateOfTheDeviceIsWhatItsNameSays) {
  for (const auto& [name, code] :
       {std::pair("", B115200), std::pair("@57600", B57600), std::pair("@9600", B9600)}) {
    open(name);
    termios settings{};
    ASSERT_EQ(tcgetattr(master_.get(), &settings), 0);
    EXPECT_EQ(cfgetospeed(&settings), static_cast<speed_t>(code)) << name;
    EXPECT_EQ(settings.c_iflag & (INPCK | PARMRK), 0U) << "without parity";
    EXPECT_EQ(client_->name(), std::string("slcan:") + ptsname(master_.get()));
  }
}

TEST_F(SlcanClientTalk, NamesOfDevicesAreExplained) {
  const auto error = [&](const std::string& name) {
    return open_can_port(name, 500'000, clock_).error().text;
  };
  for (const char* name : {"slcan:/dev/ttyUSB0@", "slcan:/dev/ttyUSB0@x", "slcan:/dev/ttyUSB0@115200x",
                           "slcan:/dev/ttyUSB0@99999999999"})
    EXPECT_EQ(error(name), std::string(name) + ": is no name of a port: write slcan:/dev/ttyUSB0@115200");
  for (const char* name : {"slcan:", "slcan:nothere", "slcan:nothere@9600"})
    EXPECT_EQ(error(name), std::string(name) +
                               ": is no name of a port: write slcan:/dev/ttyACM0, slcan:./ttyACM0 or "
                               "slcan:pty:/path");
}

TEST_F(SlcanClientTalk, FramesGoOutAsText) {
  open();
  written();
  client_->send(frame(0x123, 0xAB));
  client_->send({0x1FFFFFFF, 0, {}, true, true});
  EXPECT_EQ(written(), "t1231AB\rR1FFFFFFF0\r");
  EXPECT_EQ(client_->counts().sent, 2U);
  EXPECT_EQ(client_->waiting(), 0U);
}

// Four commands open the channel, and their answers come in that order: CR, or BEL for no. That the channel was closed
// already is no harm.
TEST_F(SlcanClientTalk, RefusalsOfTheOpeningAreTold) {
  const std::string rate = "the adapter refuses bit rate (S)", opening = "the adapter refuses open (O)",
                    stamps = "the adapter refuses time stamps (Z); times are those of arrival here";
  for (const auto& [answers, notes] :
       {std::pair("\r\r\r\r", ClientNotes{}), std::pair("\a\r\r\r", ClientNotes{}),
        std::pair("\r\a\r\r", ClientNotes{rate}), std::pair("\r\r\a\r", ClientNotes{stamps}),
        std::pair("\r\r\r\a", ClientNotes{opening}),
        std::pair("\a\a\a\a", ClientNotes{rate, stamps, opening})}) {
    open();
    EXPECT_TRUE(say(answers).empty());
    EXPECT_EQ(client_->take_notes(), notes);
    EXPECT_EQ(client_->counts().lost_out, 0U);
    // From now on it is frames that are refused.
    EXPECT_TRUE(say("\r\a\a").empty());
    EXPECT_EQ(client_->take_notes(),
              ClientNotes{"the adapter refuses frames (BEL): its queue is full or its channel is closed"});
    EXPECT_EQ(client_->counts().lost_out, 2U);
  }
}

TEST_F(SlcanClientTalk, OnlyFramesAreFrames) {
  open();
  const auto arrivals = say("\r\r\r\rz\rZ\rV0101\rNABCD\rF00\rt1002AABB\rT000001231CC\rr1003\rR000001230\r");
  ASSERT_EQ(arrivals.size(), 4U);
  EXPECT_EQ(arrivals[0].frame, (Frame{0x100, 2, {0xAA, 0xBB}}));
  EXPECT_EQ(arrivals[1].frame, (Frame{0x123, 1, {0xCC}, true}));
  EXPECT_EQ(arrivals[2].frame, (Frame{0x100, 3, {}, false, true}));
  EXPECT_EQ(arrivals[3].frame, (Frame{0x123, 0, {}, true, true}));
  for (const CanArrival& arrival : arrivals) {
    EXPECT_EQ(arrival.at, clock_.now());
    EXPECT_EQ(arrival.device_time, std::nullopt);
    EXPECT_FALSE(arrival.error);
  }
  EXPECT_EQ(client_->counts().received, 5U);
  EXPECT_EQ(client_->counts().lost_in, 0U);
  EXPECT_EQ(client_->take_notes(), ClientNotes{});
  // Broken ones, and a line that is too long for one.
  EXPECT_TRUE(say("t1009\rT1000\r" + std::string(100, 't') + "\rt80\r").empty());
  EXPECT_EQ(client_->counts().lost_in, 4U);
  EXPECT_EQ(client_->take_notes(), ClientNotes{"a broken line from the adapter: 't1009'"});
}

// Stamps are milliseconds and begin again every minute (LAWICEL: 0 to EA5Fh); the time goes on.
TEST_F(SlcanClientTalk, StampsGoOnOverTheMinute) {
  open();
  std::vector<Time> times;
  for (const CanArrival& arrival :
       say("t1000EA5F\rt1000EA5F\rt10000000\rt10000001\rt1000EA5E\rt10000000\r")) {
    ASSERT_TRUE(arrival.device_time);
    times.push_back(*arrival.device_time / kMillisecond);
    EXPECT_EQ(*arrival.device_time % kMillisecond, 0);
  }
  EXPECT_EQ(times, (std::vector<Time>{59'999, 59'999, 60'000, 60'001, 119'998, 120'000}));
}

TEST_F(SlcanClientTalk, AnAdapterThatDoesNotReadLosesWholeFrames) {
  open();
  const std::string line = slcan_text(frame(0x123, 0xAB));
  uint64_t tried = 0;
  for (; client_->counts().lost_out == 0 && tried < 100'000; ++tried) client_->send(frame(0x123, 0xAB));
  const PortCounts& counts = client_->counts();
  EXPECT_EQ(counts.lost_out, 1U);
  EXPECT_EQ(counts.sent, tried - 1);
  EXPECT_GT(counts.waited, 0U);
  EXPECT_GT(client_->waiting(), 0U);
  EXPECT_TRUE(client_->needs().output);
  EXPECT_EQ(client_->take_notes(),
            ClientNotes{"frames are lost: the adapter does not take them as fast as they come"});
  std::string all;
  for (std::string part; !(part = written()).empty();) {
    all += part;
    ASSERT_TRUE(client_->flush());
  }
  EXPECT_EQ(all.size(), std::string("C\rS6\rZ1\rO\r").size() + counts.sent * line.size());
  EXPECT_EQ(client_->waiting(), 0U);
  EXPECT_FALSE(client_->needs().output);
  const uint64_t waited = counts.waited;
  ASSERT_TRUE(client_->flush());
  EXPECT_EQ(counts.waited, waited);
}

TEST_F(SlcanClientTalk, AnAdapterThatHasGoneIsAnError) {
  open();
  const std::string name = client_->name();
  master_ = Descriptor();
  const auto got = client_->receive();
  ASSERT_FALSE(got);
  EXPECT_EQ(got.error().fault, PortFault::Gone);
  EXPECT_TRUE(got.error().text.starts_with(name)) << got.error().text;
  client_->send(frame(1));
  EXPECT_EQ(client_->flush().error().fault, PortFault::Gone);
}

}  // namespace
}  // namespace ipos::tests
