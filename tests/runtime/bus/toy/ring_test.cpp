// A kind of bus is a class and a row: the ring works in a plant, and a visitor without a case for it does not compile.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "runtime/signals/find.hpp"
#include "tests/runtime/bus/toy/ring_bus.hpp"
#include "tests/runtime/plant/plain_plant.hpp"

namespace ipos::tests {
namespace {

using namespace runtime;  // NOLINT

constexpr uint32_t kSent = 10, kReceived = 20;  // variables

// A station at the ring: every 5 ms its H10 goes to an address, and what comes to its own goes into H20.
class RingPort final : private RingNode, private EventTarget {
 public:
  RingPort(Plant& plant, RingBus& ring, Station& station, uint8_t to)
      : plant_(plant), ring_(ring), station_(station), to_(to), source_(plant.next_source()) {
    node_ = ring.attach(station.config().name, *this);
    plant.queue().schedule(5 * kMillisecond, source_, *this, 0);
  }
  RingPort(const RingPort&) = delete;
  RingPort& operator=(const RingPort&) = delete;

 private:
  void on_event(Time now, uint32_t, uint64_t) override {
    ring_.send(node_, to_, static_cast<uint8_t>(station_.variable(kSent)));
    plant_.queue().schedule(now + 5 * kMillisecond, source_, *this, 0);
  }
  void on_telegram(Time, const RingTelegram& telegram) override { write(station_, kReceived, telegram.value); }

 public:
  static void write(Station& station, uint32_t variable, int32_t value) {
    const auto index = static_cast<uint16_t>(11'000 + variable);
    EXPECT_TRUE(station.drive().parameters().execute(stdlib::Service::WriteVolatile, index, value));
  }

 private:
  Plant& plant_;
  RingBus& ring_;
  Station& station_;
  uint8_t to_;
  uint32_t source_;
  NodeId node_ = kNoNode;
};

std::string ring_text(const std::string& keys = "") {
  std::string text = "[[bus]]\nname = 'loop'\nkind = 'ring'\n" + keys;
  for (const char* name : {"a", "b", "c"})
    text += std::string("[[station]]\nname = '") + name + "'\nunit = 'mdxb'\n";
  return text;
}

// Stations a, b and c have the addresses 0, 1 and 2; a sends to c, c to a, and b to itself all the way round.
struct RingPlant {
  RingPlant()
      : plain(ring_text()),
        ring(*plain->all<RingBus>().at(0)),
        a(*plain, ring, plain.station(0), 2),
        b(*plain, ring, plain.station(1), 7),
        c(*plain, ring, plain.station(2), 0) {}
  PlainPlant plain;
  RingBus& ring;
  RingPort a, b, c;
};

struct Heard final : BusObserver, BusTracer {
  explicit Heard(Bus& bus) {
    bus.add_observer(*this);
    bus.add_tracer(*this);
  }
  void on_message(const Bus& bus, const BusMessage& message) override {
    messages.push_back(bus.name() + " " + message.text + " | " + message.meaning);
    times.push_back(message.end);
  }
  void on_trace(const Bus&, std::span<const uint64_t> more) override {
    facts.insert(facts.end(), more.begin(), more.end());
  }
  std::vector<std::string> messages;
  std::vector<Time> times;
  std::vector<uint64_t> facts;
};

TEST(ToyBus, CarriesTelegramsFromStationToStation) {
  RingPlant rig;
  Heard heard(rig.ring);
  RingPort::write(rig.plain.station(0), kSent, 30);
  RingPort::write(rig.plain.station(2), kSent, 99);
  const Time hop = rig.ring.hop();
  EXPECT_EQ(hop, 3'125 * kMicrosecond);  // 30 bits at 9600 baud
  rig.plain->run_until(5 * kMillisecond + 2 * hop - 1);
  EXPECT_EQ(rig.plain.station(2).variable(kReceived), 0);
  rig.plain->run_until(5 * kMillisecond + 2 * hop);
  EXPECT_EQ(rig.plain.station(2).variable(kReceived), 30);
  // Then that of b goes round for nobody, and that of c comes to a.
  rig.plain->run_until(5 * kMillisecond + 6 * hop);
  EXPECT_EQ(rig.plain.station(0).variable(kReceived), 99);
  EXPECT_EQ(heard.messages, (std::vector<std::string>{"loop 00 02 1E | a to c: 30", "loop 01 07 00 | back again",
                                                      "loop 02 00 63 | c to a: 99"}));
  EXPECT_EQ(heard.times.at(1), 5 * kMillisecond + 5 * hop);
  EXPECT_EQ(heard.facts.size(), 12U);
  EXPECT_EQ(rig.plain.told("", "loop: nobody has address 7").size(), 1U);
}

TEST(ToyBus, IsAKindOfThePlantFile) {
  const PlainPlant plant(ring_text("baud = 19200\nlength = 120\n"));
  const RingBus& ring = *plant->all<RingBus>().at(0);
  EXPECT_EQ(ring.baud(), 19'200U);
  EXPECT_EQ(plant.told("", "loop: a ring has at most 100 m").size(), 1U);
  EXPECT_TRUE(plant->all<CanBus>().empty());
  const PlantFileResult wrong = read_plant_file(ring_text("baud = 500000\n"));
  ASSERT_EQ(wrong.errors.size(), 1U);
  EXPECT_EQ(wrong.errors[0].text, "the ring has 9600 or 19200 baud, not 500000");
}

TEST(ToyBus, HasSignalsAndAHand) {
  RingPlant rig;
  EXPECT_EQ(refuse_message(BusKind::Ring, "02"), "'02' is no address and value; write for example \"02 1E\"");
  EXPECT_EQ(refuse_message(BusKind::Ring, "02 1E"), std::nullopt);
  rig.ring.attach_hand();
  EXPECT_EQ(rig.ring.node_names(), (std::vector<std::string>{"a", "b", "c", "test"}));
  const auto value = signals::find_signals(*rig.plain, "loop.1.value");
  ASSERT_TRUE(value) << value.error();
  EXPECT_EQ(rig.ring.send("01 2A"), std::nullopt);
  rig.plain->run_until(kSecond);
  EXPECT_EQ(value->at(0).read(), 0x2A);
  EXPECT_EQ(signals::find_signals(*rig.plain, "loop.1.count")->at(0).read(), 1);
  EXPECT_EQ(signals::find_signals(*rig.plain, "loop.load")->at(0).read(), 100);
}

TEST(ToyBus, HasFaultsOfAHand) {
  RingPlant rig;
  RingPort::write(rig.plain.station(0), kSent, 30);
  ASSERT_EQ(rig.ring.fault_rules().size(), 1U);
  FaultConfig fault = rig.ring.make_fault({rig.ring.fault_rules()[0].word, 0});
  fault.bus = "loop";
  fault.station = "d";
  EXPECT_FALSE(rig.plain->plant_fault(fault));
  fault.station = "b";
  fault.fault.until = kSecond;
  EXPECT_TRUE(rig.plain->plant_fault(fault));
  rig.plain->run_until(kSecond - 1);
  EXPECT_EQ(rig.ring.arrived(2).count, 0U);
  rig.plain->run_until(2 * kSecond);
  EXPECT_GT(rig.ring.arrived(2).count, 0U);
}

// --- who has to be touched

std::string output_of(const std::string& command) {
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return "cannot be started";
  std::string text;
  std::array<char, 512> buffer;
  while (const size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe)) text.append(buffer.data(), n);
  pclose(pipe);
  return text;
}

// Sources of the product that visit lines themselves; the macros of the table have the rest.
std::vector<std::string> visitors() {
  std::vector<std::string> found;
  for (const char* folder : {"runtime", "tools"})
    for (const auto& entry : std::filesystem::recursive_directory_iterator(std::string(IPOS_SOURCE_DIR) + "/" + folder)) {
      if (entry.path().extension() != ".cpp") continue;
      std::ostringstream text;
      text << std::ifstream(entry.path()).rdbuf();
      if (text.str().find("ProfibusBus& ") != std::string::npos && text.str().find("visit(") != std::string::npos)
        found.push_back(entry.path().lexically_relative(IPOS_SOURCE_DIR));
    }
  std::sort(found.begin(), found.end());
  return found;
}

TEST(ToyBus, WhoHasNoCaseForItDoesNotCompile) {
  const std::vector<std::string> sources = visitors();
  EXPECT_EQ(sources, (std::vector<std::string>{"runtime/library/instance.cpp", "runtime/plant_port/join.cpp",
                                               "tools/logs/log_writer.cpp", "tools/run/verb_run.cpp",
                                               "tools/serve/host/bus_tab.cpp"}));
  EXPECT_LE(sources.size() + 1, 8U) << "files outside of the kind's own, with the row";
  for (const std::string& source : sources) {
    const std::string messages = output_of(std::string("'") + IPOS_COMPILER + "' -std=c++20 -fsyntax-only '@" +
                                           IPOS_FLAGS + "' '" + IPOS_SOURCE_DIR + "/" + source + "' 2>&1");
    EXPECT_NE(messages.find("RingBus"), std::string::npos) << source << ": " << messages;
    EXPECT_NE(messages.find("error: "), std::string::npos) << source;
    EXPECT_EQ(messages.find("No such file"), std::string::npos) << messages;
  }
}

}  // namespace
}  // namespace ipos::tests
