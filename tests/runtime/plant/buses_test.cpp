// Lines of every kind from outside: what a test sends on them, what is told of it, their load, and faults planted on
// them.
#include "tests/runtime/plant/plain_plant.hpp"

namespace ipos::runtime {
namespace {

using tests::PlainPlant;

// One line of each kind, with a station on it that hears what is sent.
const std::string kEveryLine = R"(
[[bus]]
name = 'can'
kind = 'can'
[[bus]]
name = 'rs'
kind = 'rs485'
[[bus]]
name = 'dp'
kind = 'profibus'
[[station]]
name = 'u'
unit = 'mdxb'
sbus = 'can'
rs485 = 'rs'
option = 'dfp'
profibus = 'dp'
profibus_address = 8
)";

class LineListener final : public BusObserver, public BusTracer {
 public:
  void on_message(const Bus& bus, const BusMessage& message) override {
    buses.push_back(bus.name());
    messages.push_back(message);
  }
  void on_trace(const Bus&, std::span<const uint64_t> all) override {
    facts.emplace_back(all.begin(), all.end());
  }

  std::vector<std::string> buses;
  std::vector<BusMessage> messages;
  std::vector<std::vector<uint64_t>> facts;
};

TEST(Buses, RefuseWhatIsNoMessage) {
  for (const auto& [kind, text] :
       {std::pair(BusKind::Can, "20B#3100207E00000000"), std::pair(BusKind::Can, "000#"),
        std::pair(BusKind::Can, "1FFFFFFF#00"), std::pair(BusKind::Rs485, "02 01 85 bcc"),
        std::pair(BusKind::Rs232, "02"), std::pair(BusKind::Profibus, "10 08 02 49 fcs 16")})
    EXPECT_EQ(refuse_message(kind, text), std::nullopt) << text;
  EXPECT_TRUE(refuse_message(BusKind::Can, "20B").value().starts_with("'20B' is no frame: "));
  EXPECT_TRUE(refuse_message(BusKind::Can, "02 01")
                  .value()
                  .ends_with("; write for example \"20B#3100207E00000000\""));
  for (const BusKind kind : {BusKind::Rs485, BusKind::Rs232})
    for (const std::string wrong : {"20B#00", "02 1", "02 bcc 00", ""})
      EXPECT_EQ(refuse_message(kind, wrong),
                "'" + wrong + "' are no bytes; write for example \"02 01 85 00 06 13 88 00 00 bcc\"");
  for (const std::string wrong : {"20B#00", "10 08 02 49 fcs", "10 fcs 16 16", ""})
    EXPECT_EQ(refuse_message(BusKind::Profibus, wrong),
              "'" + wrong + "' are no octets; write for example \"10 08 02 49 fcs 16\"");
}

TEST(Buses, FramesOfCan) {
  const PlainPlant plant(kEveryLine);
  Bus& bus = *plant->find_bus("can");
  LineListener heard;
  bus.add_observer(heard);
  bus.add_tracer(heard);
  bus.attach_hand();
  bus.attach_hand();  // the same one
  EXPECT_EQ(bus.send("7FF#0102"), std::nullopt);
  EXPECT_EQ(bus.send("1ABCDEF0#"), std::nullopt);
  EXPECT_EQ(bus.send("123#R"), std::nullopt);
  plant->run_until(10 * kMillisecond);
  ASSERT_EQ(heard.messages.size(), 3U);
  // The lower identifier first: 123h, 1ABCDEF0h (its first eleven bits are 6AFh), 7FFh.
  const auto is = [&](size_t n, const char* text, const std::vector<uint8_t>& bytes) {
    EXPECT_EQ(heard.messages[n].text, text);
    EXPECT_EQ(heard.messages[n].bytes, bytes);
    EXPECT_EQ(heard.messages[n].meaning, "");
    EXPECT_EQ(heard.buses[n], "can");
    ASSERT_TRUE(heard.messages[n].frame);
    EXPECT_EQ(heard.messages[n].frame->remote, n == 0);
  };
  is(0, "123#R", {});
  is(1, "1ABCDEF0#", {});
  is(2, "7FF#0102", {1, 2});
  EXPECT_EQ(bus.load(plant->now()).frames, 3U);
  ASSERT_EQ(heard.facts.size(), 3U);
  EXPECT_EQ(heard.facts[2].size(), 8U) << "sender, begin, end, bits, identifier, length, data";
  EXPECT_EQ(heard.facts[2][2], static_cast<uint64_t>(heard.messages[2].end));
  EXPECT_EQ(std::vector(heard.facts[2].begin() + 4, heard.facts[2].end()),
            (std::vector<uint64_t>{0x7FF, 2, 1, 2}));
  EXPECT_EQ(heard.facts[1].size(), 6U);
}

TEST(Buses, ManyFramesWait) {
  const PlainPlant plant(kEveryLine);
  Bus& bus = *plant->find_bus("can");
  bus.attach_hand();
  std::optional<std::string> refused;
  int sent = 0;
  for (; sent < 10'000 && !refused; ++sent) refused = bus.send("7FF#");
  EXPECT_EQ(refused, "too many frames wait to be sent");
  plant->run_until(kSecond);
  EXPECT_EQ(bus.load(plant->now()).frames, static_cast<uint64_t>(sent - 1));
  EXPECT_EQ(bus.send("7FF#"), std::nullopt);
}

// Block check: exclusive or of all bytes (1053 1610 p. 21).
TEST(Buses, TelegramsOfRs485) {
  const PlainPlant plant(kEveryLine);
  Bus& bus = *plant->find_bus("rs");
  LineListener heard;
  bus.add_observer(heard);
  bus.add_tracer(heard);
  bus.attach_hand();
  bus.attach_hand();
  EXPECT_EQ(bus.send("02 09 85 00 06 13 88 00 00 bcc"), std::nullopt);
  EXPECT_EQ(bus.send("02"), "the telegram before is still being sent");
  plant->run_until(100 * kMillisecond);
  ASSERT_EQ(heard.messages.size(), 1U) << "nobody has address 9";
  const uint8_t check = 0x02 ^ 0x09 ^ 0x85 ^ 0x06 ^ 0x13 ^ 0x88;
  EXPECT_EQ(heard.messages[0].bytes, (std::vector<uint8_t>{2, 9, 0x85, 0, 6, 0x13, 0x88, 0, 0, check}));
  EXPECT_EQ(heard.messages[0].text, "02 09 85 00 06 13 88 00 00 13");
  EXPECT_FALSE(heard.messages[0].meaning.empty());
  EXPECT_EQ(heard.facts.size(), 10U) << "one for each character";
  EXPECT_EQ(heard.facts[9][3], check);
  EXPECT_EQ(bus.load(plant->now()).frames, 1U);
  EXPECT_EQ(bus.send("02 09 85"), std::nullopt);
  plant->run_until(103 * kMillisecond);
  EXPECT_EQ(heard.messages.size(), 1U);
  bus.finish();
  ASSERT_EQ(heard.messages.size(), 2U) << "what was not completed is told at the end";
  EXPECT_TRUE(heard.messages[1].text.starts_with("02 09"));
  bus.finish();
  EXPECT_EQ(heard.messages.size(), 2U);
}

// Frame check sequence: sum of the octets from DA on (EN 50170 volume 2).
TEST(Buses, FramesOfProfibus) {
  const PlainPlant plant(kEveryLine);
  Bus& bus = *plant->find_bus("dp");
  LineListener heard;
  bus.add_observer(heard);
  bus.add_tracer(heard);
  bus.attach_hand();
  bus.attach_hand();
  EXPECT_EQ(bus.send("10 09 02 49 fcs 16"), std::nullopt);
  EXPECT_EQ(bus.send("10 09 02 49 fcs 16"), "the frame before is still being sent");
  plant->run_until(10 * kMillisecond);
  EXPECT_EQ(bus.send("68 05 05 68 89 82 49 3E 3C fcs 16"), std::nullopt);
  plant->run_until(20 * kMillisecond);
  EXPECT_EQ(bus.send("10 09 02 49 00 16"), std::nullopt);
  plant->run_until(30 * kMillisecond);
  ASSERT_EQ(heard.messages.size(), 3U);
  EXPECT_EQ(heard.messages[0].text, "10 09 02 49 54 16");
  EXPECT_EQ(heard.messages[0].bytes, (std::vector<uint8_t>{0x10, 9, 2, 0x49, 0x54, 0x16}));
  EXPECT_FALSE(heard.messages[0].meaning.empty() || heard.messages[0].meaning.starts_with("void"));
  EXPECT_EQ(heard.messages[1].text, "68 05 05 68 89 82 49 3E 3C CE 16");
  EXPECT_TRUE(heard.messages[2].meaning.starts_with("void: ")) << heard.messages[2].meaning;
  ASSERT_EQ(heard.facts.size(), 3U);
  EXPECT_EQ(heard.facts[0].size(), 4U + 6U);
  EXPECT_EQ(heard.facts[0][3], 0U) << "a good frame";
  EXPECT_NE(heard.facts[2][3], 0U);
  EXPECT_EQ(heard.facts[0][2], static_cast<uint64_t>(heard.messages[0].end));
  EXPECT_EQ(bus.load(plant->now()).frames, 2U) << "the void one was not delivered";
}

TEST(Buses, FaultsNeedTheirStation) {
  const PlainPlant plant(kEveryLine);
  FaultConfig fault;
  fault.bus = "can";
  fault.fault.kind = FaultKind::Drop;
  fault.station = "v";
  EXPECT_FALSE(plant->plant_fault(fault));
  EXPECT_FALSE(plant->repair_fault(fault));
  for (const char* station : {"u", ""}) {
    fault.station = station;
    EXPECT_FALSE(plant->repair_fault(fault)) << "there is none yet";
    EXPECT_TRUE(plant->plant_fault(fault));
    plant->run_until(plant->now() + kMillisecond);
    EXPECT_TRUE(plant->repair_fault(fault));
  }
  fault.octets.emplace().kind = OctetFaultKind::Lost;
  for (const char* bus : {"dp", "rs"}) {
    fault.bus = bus;
    fault.station = "v";
    EXPECT_FALSE(plant->plant_fault(fault));
    for (const char* station : {"u", ""}) {
      fault.station = station;
      EXPECT_FALSE(plant->repair_fault(fault));
      EXPECT_TRUE(plant->plant_fault(fault));
      plant->run_until(plant->now() + kMillisecond);
      EXPECT_TRUE(plant->repair_fault(fault));
    }
  }
}

// While the fault lasts nobody hears the frame; behind its end everybody does.
TEST(Buses, APlantedFaultStrikesAndEnds) {
  const PlainPlant plant(kEveryLine +
                         "[[fault]]\nbus = 'can'\nkind = 'short'\nfrom = '10ms'\nuntil = '20ms'\n"
                         "[[fault]]\nbus = 'dp'\nkind = 'lost'\nfrom = '10ms'\nuntil = '20ms'\n"
                         "[[fault]]\nbus = 'can'\nkind = 'drop'\nstation = 'w'\n"
                         "[[station]]\nname = 'w'\nunit = 'mdxb'\n");
  EXPECT_EQ(plant.told("w", "the fault planted on bus 'can' has no effect: the station is not on it").size(),
            1U);
  Bus& can = *plant->find_bus("can");
  Bus& dp = *plant->find_bus("dp");
  can.attach_hand();
  dp.attach_hand();
  for (const auto& [at, frames] : {std::pair(5, 1U), std::pair(15, 1U), std::pair(35, 2U)}) {
    plant->run_until(at * kMillisecond);
    can.send("7FF#");
    dp.send("10 09 02 49 fcs 16");
    plant->run_until((at + 4) * kMillisecond);
    if (at != 15) {
      EXPECT_GE(can.load(plant->now()).frames, frames) << at;
    }
  }
  EXPECT_FALSE(plant.told("", "can").empty()) << "what happens on the line is told";
  EXPECT_FALSE(plant.told("", "dp").empty());
}

}  // namespace
}  // namespace ipos::runtime
