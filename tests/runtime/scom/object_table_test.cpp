// The plain table of variable telegrams: what it reads, judges, sends and takes, and which saved states it accepts.
// Expected values follow from the rules of 1053 1610 p. 51 to 61, IPOSplus p. 232 and docs/reference/protocols/sbus.md.
#include "runtime/scom/object_table.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "runtime/clock/random.hpp"
#include "tests/harness/proves.hpp"

namespace ipos::runtime {
namespace {

constexpr ObjectKind kKinds[] = {ObjectKind::TransmitCyclic, ObjectKind::TransmitAcyclic,
                                 ObjectKind::Receive};
constexpr uint32_t kSbus1Flags = 522, kSbus2Flags = 523;

const stdlib::UnitType& unit_named(std::string_view name) { return *stdlib::find_unit(name); }

// A unit's table with its variables; objects have their data at H100 and their result at H50.
struct Table {
  explicit Table(std::string_view name = "md60a", int sbus = 1, uint32_t baud = 500'000)
      : unit(unit_named(name)), table(unit, baud, sbus), h(unit.variables, 0) {}

  static ObjectRequest request(ObjectKind kind, int32_t object, int32_t format = 8, int32_t data = 100) {
    return {kind, object, kind == ObjectKind::TransmitCyclic ? 100 : 0, 0, format, data, 50};
  }
  ObjectVerdict define(const ObjectRequest& request) { return table.define(request, h); }
  ObjectVerdict define(ObjectKind kind, int32_t object, int32_t format = 8, int32_t data = 100) {
    return define(request(kind, object, format, data));
  }
  ObjectVerdict cyclic(int32_t object, int32_t cycle, int32_t offset = 0, int32_t format = 0) {
    return define({ObjectKind::TransmitCyclic, object, cycle, offset, format, 100, 50});
  }
  ObjectVerdict receive(int32_t object, int32_t format = 8, int32_t data = 100) {
    return define(ObjectKind::Receive, object, format, data);
  }
  int32_t result() const { return h[50]; }

  const stdlib::UnitType& unit;
  ObjectTable table;
  std::vector<int32_t> h;
};

// As p. 51 has it: four bytes to a variable.
uint32_t variables_of(int32_t length) { return static_cast<uint32_t>((length + 3) / 4); }

// A telegram of eight bytes with H = 11223344h and H+1 = 55667788h, MOTOROLA (p. 59).
Frame example_frame(uint32_t id, uint8_t length = 8) {
  return {id, length, {0x55, 0x66, 0x77, 0x88, 0x11, 0x22, 0x33, 0x44}};
}

// The three structures of p. 54 to 56. Every variable of them holds its own number.
TEST(ObjectTable, ElementsStandAsTheManualPrintsThem) {
  PROVES("SCOM-04", "SCOM-05");
  Table unit;
  std::iota(unit.h.begin(), unit.h.end(), 0);
  const ObjectRequest sent = unit.table.request(ObjectKind::TransmitCyclic, 420, unit.h);
  EXPECT_EQ(sent.kind, ObjectKind::TransmitCyclic);
  EXPECT_EQ(sent.object, 420);
  EXPECT_EQ(sent.cycle, 421);
  EXPECT_EQ(sent.offset, 422);
  EXPECT_EQ(sent.format, 423);
  EXPECT_EQ(sent.data, 424);
  EXPECT_EQ(sent.result, 425U);
  for (const ObjectKind kind : {ObjectKind::TransmitAcyclic, ObjectKind::Receive}) {
    const ObjectRequest other = unit.table.request(kind, 10, unit.h);
    EXPECT_EQ(other.kind, kind);
    EXPECT_EQ(other.object, 10);
    EXPECT_EQ(other.cycle, 0);
    EXPECT_EQ(other.offset, 0);
    EXPECT_EQ(other.format, 11);
    EXPECT_EQ(other.data, 12);
    if (kind == ObjectKind::TransmitAcyclic) {
      EXPECT_EQ(other.result, 13U);
    }
  }
}

// Bit 24 only says which bus is meant (IPOSplus p. 232). Elsewhere it belongs to a number that is no identifier.
TEST(ObjectTable, Bit24SelectsSbus2) {
  struct Case {
    std::string_view unit;
    int sbus;
    int32_t written, read;
    ObjectVerdict verdict;
  };
  const Case cases[] = {
      {"mdxb", 1, 1024, 1024, ObjectVerdict::Accepted},
      {"mdxb", 1, 0x100'0400, 0x100'0400, ObjectVerdict::OnSbus2},
      {"mdxb", 1, 0x100'0000, 0x100'0000, ObjectVerdict::OnSbus2},
      {"mdxb", 1, 0xFF'FFFF, 0xFF'FFFF, ObjectVerdict::NoIdentifier},
      {"mdxb", 1, 0x200'0400, 0x200'0400, ObjectVerdict::NoIdentifier},
      {"mdxb", 1, -1, -1, ObjectVerdict::NoIdentifier},
      {"mdxb", 2, 1024, 1024, ObjectVerdict::Accepted},
      {"mdxb", 2, 0x100'0400, 1024, ObjectVerdict::Accepted},
      {"mdxb", 2, 0x100'0000, 0, ObjectVerdict::Accepted},
      {"mdxb", 2, 0x100'07FF, 2047, ObjectVerdict::Accepted},
      {"mdxb", 2, 0x100'0800, 2048, ObjectVerdict::NoIdentifier},
      {"mdxb", 2, 0x300'0400, 0x200'0400, ObjectVerdict::NoIdentifier},
      {"mdxb", 2, -1, -1, ObjectVerdict::NoIdentifier},
      {"md60a", 1, 0x100'0400, 0x100'0400, ObjectVerdict::NoIdentifier},
      {"mc07", 1, 0x100'0400, 0x100'0400, ObjectVerdict::NoIdentifier},
  };
  for (const Case& c : cases) {
    Table unit(c.unit, c.sbus);
    unit.h[20] = c.written;
    unit.h[21] = 8;
    unit.h[22] = 100;
    const ObjectRequest read = unit.table.request(ObjectKind::Receive, 20, unit.h);
    EXPECT_EQ(read.object, c.read) << c.unit << ' ' << c.sbus << ' ' << c.written;
    EXPECT_EQ(unit.define(read), c.verdict) << c.unit << ' ' << c.sbus << ' ' << c.written;
  }
}

// F10 for each length, layout and kind: the last variable the telegram touches has to be one of the unit's.
TEST(ObjectTable, DataLieWithinTheVariables) {
  for (const std::string_view name : {"md60a", "mdxb"})
    for (const ObjectKind kind : kKinds)
      for (const int32_t layout : {0, 0x100})
        for (int32_t length = 1; length <= 8; ++length) {
          const auto all = static_cast<int32_t>(unit_named(name).variables);
          for (const int32_t data :
               {INT32_MIN, -2, -1, 0, all - 2, all - 1, all, all + 1, 0xFFFF, 0x1'0000, INT32_MAX}) {
            Table unit(name);
            const bool inside =
                data >= 0 && int64_t{data} + variables_of(length) <= static_cast<int64_t>(unit.h.size());
            const ObjectVerdict verdict = unit.define(kind, 1024, layout + length, data);
            EXPECT_EQ(verdict, inside ? ObjectVerdict::Accepted : ObjectVerdict::NoVariables)
                << name << ' ' << length << " bytes at " << data;
          }
        }
}

TEST(ObjectTable, EveryLengthOfBothLayoutsAndNoOther) {
  PROVES("VAR-07");
  for (const ObjectKind kind : kKinds)
    for (int32_t format = -3; format <= 0x20A; ++format) {
      const bool allowed = (format & ~0x100) >= 0 && (format & ~0x100) <= 8;
      EXPECT_EQ(Table().define(kind, 1024, format),
                allowed ? ObjectVerdict::Accepted : ObjectVerdict::NoFormat)
          << format;
    }
}

// What is refused has its kind's result: -1 (ours), 3 for one-shot ones, and none for receive objects.
TEST(ObjectTable, ARefusedObjectHasTheResultOfItsKind) {
  struct Case {
    int32_t object, format;
    ObjectVerdict verdict;
  };
  for (const Case& c : {Case{1024, 9, ObjectVerdict::NoFormat}, Case{2048, 8, ObjectVerdict::NoIdentifier},
                        Case{-1, 8, ObjectVerdict::NoIdentifier}, Case{3, 8, ObjectVerdict::ClosedIdentifier},
                        Case{0x100'0400, 8, ObjectVerdict::OnSbus2}})
    for (const ObjectKind kind : kKinds) {
      Table unit("mdxb");
      unit.h[50] = 777;
      EXPECT_EQ(unit.define(kind, c.object, c.format), c.verdict);
      EXPECT_EQ(unit.result(), kind == ObjectKind::TransmitCyclic    ? -1
                               : kind == ObjectKind::TransmitAcyclic ? 3
                                                                     : 777);
      EXPECT_EQ(unit.table.state().cyclic_count, 0);
      EXPECT_EQ(unit.table.state().receive_count, 0);
    }
}

// An accepted one-shot telegram has its status from who sends it, so the table leaves its result alone.
TEST(ObjectTable, AnAcceptedOneShotTelegramLeavesItsResultAlone) {
  Table unit;
  unit.h[50] = 777;
  EXPECT_EQ(unit.define(ObjectKind::TransmitAcyclic, 1024), ObjectVerdict::Accepted);
  EXPECT_EQ(unit.result(), 777);
  EXPECT_EQ(unit.receive(1025), ObjectVerdict::Accepted);
  EXPECT_EQ(unit.result(), 777);
}

TEST(ObjectTable, CycleTimesOfEachFamily) {
  PROVES("SCOM-07");
  for (const std::string_view name : {"md60a", "compact", "mc07", "mdxb"})
    for (const auto& [from, to] : {std::pair{-21, 41}, {65'500, 65'560}, {131'060, 131'081}})
      for (int32_t cycle = from; cycle < to; ++cycle) {
        const bool fast = cycle >= 1 && cycle <= 9 && name != "mc07";
        const bool slow = cycle >= 10 && cycle <= 65'530 && cycle % 10 == 0;
        Table unit(name);
        EXPECT_EQ(unit.cyclic(1024, cycle),
                  fast || slow ? ObjectVerdict::Accepted : ObjectVerdict::WrongCycleTime)
            << name << ' ' << cycle;
        EXPECT_EQ(unit.result() < 0, !fast && !slow) << name << ' ' << cycle;
      }
}

// A: 0 to 65534 ms in steps of 1 below 10 ms, 0 to 65530 ms in steps of 10 from there (p. 54). MOVITRAC 07 only has the
// latter. B: smaller than the cycle, with the same steps (IPOSplus p. 232).
TEST(ObjectTable, OffsetsOfEachFamily) {
  PROVES("SCOM-08");
  for (const std::string_view name : {"md60a", "mc07", "mdxb"})
    for (const int32_t cycle : {1, 2, 5, 9, 10, 20, 100, 65'530}) {
      if (name == "mc07" && cycle < 10) continue;
      for (const auto& [from, to] : {std::pair{-11, 121}, {65'509, 65'551}})
        for (int32_t offset = from; offset < to; ++offset) {
          bool allowed =
              offset >= 0 && (cycle < 10 ? offset <= 65'534 : offset <= 65'530 && offset % 10 == 0);
          if (name == "mdxb") allowed = allowed && offset < cycle;
          Table unit(name);
          EXPECT_EQ(unit.cyclic(1024, cycle, offset),
                    allowed ? ObjectVerdict::Accepted : ObjectVerdict::WrongOffset)
              << name << ' ' << cycle << ' ' << offset;
          EXPECT_EQ(unit.result() < 0, !allowed);
        }
    }
}

// MOVITRAC B: 1 to 255 ms, offset and cycle together at most 255, 16 objects (IPOSplus p. 232).
TEST(ObjectTable, MovitracBHasOneClassOfItsOwn) {
  for (int32_t cycle = -2; cycle <= 600; ++cycle)
    for (const int32_t offset : {-1, 0, 1, 7, 155, 254, 255, 256}) {
      Table unit("mc07b");
      const bool has_cycle = cycle >= 1 && cycle <= 255;
      const bool allowed = has_cycle && offset >= 0 && offset + cycle <= 255;
      EXPECT_EQ(unit.cyclic(1024, cycle, offset), allowed     ? ObjectVerdict::Accepted
                                                  : has_cycle ? ObjectVerdict::WrongOffset
                                                              : ObjectVerdict::WrongCycleTime)
          << cycle << ' ' << offset;
    }
  Table unit("mc07b", 1, 1'000'000);
  for (int32_t n = 0; n < 16; ++n) EXPECT_EQ(unit.cyclic(1024 + n, n < 8 ? 9 : 255), ObjectVerdict::Accepted) << n;
  EXPECT_EQ(unit.cyclic(1100, 9), ObjectVerdict::TooManyTransmit);
  EXPECT_EQ(unit.result(), -2);
  EXPECT_EQ(unit.cyclic(1100, 255), ObjectVerdict::TooManyTransmit);
}

// The limits are those of each class by itself, whichever class comes first.
TEST(ObjectTable, TransmitObjectsOfEachUnit) {
  PROVES("SCOM-09");
  struct Case {
    std::string_view unit;
    int32_t fast, slow;
  };
  for (const Case& c :
       {Case{"md60a", 5, 10}, Case{"compact", 5, 10}, Case{"mc07", 0, 10}, Case{"mdxb", 15, 15}})
    for (const bool fast_first : {true, false}) {
      Table unit(c.unit, 1, 1'000'000);
      int32_t id = 1024;
      for (const bool fast : {fast_first, !fast_first}) {
        if (fast && c.fast == 0) continue;
        for (int32_t n = 0; n < (fast ? c.fast : c.slow); ++n) {
          // The shortest slow cycle and the longest fast one are neighbours.
          EXPECT_EQ(unit.cyclic(id++, fast ? 9 : 10), ObjectVerdict::Accepted) << c.unit << ' ' << n;
          EXPECT_GE(unit.result(), 0);
        }
        EXPECT_EQ(unit.cyclic(id++, fast ? 9 : 10), ObjectVerdict::TooManyTransmit) << c.unit;
        EXPECT_EQ(unit.result(), -2);
      }
      EXPECT_EQ(unit.table.state().cyclic_count, c.fast + c.slow);
    }
}

// A frame of n bytes has 55 + 10 n bits at worst; cycles that divide a second make whole loads, so the percent follows
// without any rounding but the last.
TEST(ObjectTable, ResultIsTheWholePercentStillFree) {
  PROVES("SCOM-10", "SCOM-11");
  constexpr int32_t kCycles[] = {1, 2, 4, 5, 8, 10, 20, 40, 50, 100, 200, 500, 1000};
  Random random(79);
  int refused = 0, full = 0;
  for (int round = 0; round < 200; ++round) {
    const uint32_t baud = 125'000U << (round % 4);
    Table unit("mdxb", 1, baud);
    const int64_t budget = int64_t{baud} * 7 / 10;
    int64_t used = 0;
    for (int32_t id = 1024; id < 1030; ++id) {
      const int32_t cycle = kCycles[random.below(std::size(kCycles))];
      const auto length = static_cast<int32_t>(random.below(9));
      const int64_t load = (55 + 10 * length) * 1000 / cycle;
      const ObjectVerdict verdict = unit.cyclic(id, cycle, 0, length);
      if (used + load > budget) {
        EXPECT_EQ(verdict, ObjectVerdict::Overload);
        EXPECT_EQ(unit.result(), -3);
        ++refused;
        continue;
      }
      used += load;
      EXPECT_EQ(verdict, ObjectVerdict::Accepted);
      EXPECT_EQ(unit.result(), (budget - used) * 100 / budget) << used << " of " << budget;
      full += unit.result() < 10;
    }
  }
  EXPECT_GT(refused, 20);
  EXPECT_GT(full, 5);
}

// One identifier, one use; another one is free. A one-shot telegram is no use that the table keeps.
TEST(ObjectTable, AnIdentifierHasOneUse) {
  PROVES("VAR-04");
  struct Case {
    ObjectKind first, second;
    ObjectVerdict verdict;
  };
  for (const Case& c :
       {Case{ObjectKind::TransmitCyclic, ObjectKind::TransmitCyclic, ObjectVerdict::SentTwice},
        Case{ObjectKind::TransmitCyclic, ObjectKind::Receive, ObjectVerdict::SentAndReceived},
        Case{ObjectKind::Receive, ObjectKind::TransmitCyclic, ObjectVerdict::SentAndReceived},
        Case{ObjectKind::Receive, ObjectKind::Receive, ObjectVerdict::ReceivedTwice},
        Case{ObjectKind::TransmitAcyclic, ObjectKind::TransmitCyclic, ObjectVerdict::Accepted},
        Case{ObjectKind::TransmitAcyclic, ObjectKind::TransmitAcyclic, ObjectVerdict::Accepted},
        Case{ObjectKind::TransmitAcyclic, ObjectKind::Receive, ObjectVerdict::Accepted},
        Case{ObjectKind::TransmitCyclic, ObjectKind::TransmitAcyclic, ObjectVerdict::Accepted},
        Case{ObjectKind::Receive, ObjectKind::TransmitAcyclic, ObjectVerdict::Accepted}})
    // The use before it may be the first or the last of three.
    for (const int32_t used : {1024, 1026}) {
      Table unit;
      for (int32_t id = 1024; id <= 1026; ++id) EXPECT_EQ(unit.define(c.first, id), ObjectVerdict::Accepted);
      EXPECT_EQ(unit.define(c.second, used), c.verdict);
      if (c.second == ObjectKind::TransmitCyclic && c.verdict != ObjectVerdict::Accepted) {
        EXPECT_EQ(unit.result(), -1);
      }
      EXPECT_EQ(unit.define(c.second, 1027), ObjectVerdict::Accepted);
    }
}

TEST(ObjectTable, ReceiveObjectsOfAUnit) {
  PROVES("SCOM-15");
  Table unit;
  for (int32_t n = 0; n < 32; ++n) EXPECT_EQ(unit.receive(1024 + n), ObjectVerdict::Accepted);
  EXPECT_EQ(unit.receive(1100), ObjectVerdict::TooManyReceive);
  EXPECT_EQ(unit.table.state().receive_count, 32);
  unit.table.stop();
  EXPECT_EQ(unit.receive(1100), ObjectVerdict::Accepted) << "a stopped program leaves no objects";
}

// IPOSplus p. 319; only a stop of the program, which also takes the objects, opens the table again.
TEST(ObjectTable, ReceiveObjectsComeBeforeTheStart) {
  Table unit;
  EXPECT_EQ(unit.receive(1024), ObjectVerdict::Accepted);
  unit.table.start(5);
  EXPECT_EQ(unit.receive(1025), ObjectVerdict::TooLate);
  unit.table.pause();
  EXPECT_EQ(unit.receive(1025), ObjectVerdict::TooLate);
  EXPECT_EQ(unit.cyclic(1026, 10), ObjectVerdict::Accepted);
  EXPECT_EQ(unit.table.state().receive_count, 1);
  unit.table.stop();
  EXPECT_FALSE(unit.table.started());
  EXPECT_EQ(unit.receive(1025), ObjectVerdict::Accepted);
}

// The status stands in the fourth variable of the structure (p. 56).
TEST(ObjectTable, TheStatusOfAOneShotTelegramStandsInItsStructure) {
  constexpr int32_t kBefore = 777;
  std::array<int32_t, 12> memory{};
  const auto written = [&](uint32_t tag, size_t variables) -> int {
    memory.fill(kBefore);
    ObjectTable::note_acyclic(tag, AcyclicStatus::Sent, std::span(memory).first(variables));
    int place = -1;
    for (size_t n = 0; n < memory.size(); ++n)
      if (memory[n] != kBefore) {
        EXPECT_EQ(memory[n], 2);
        EXPECT_EQ(place, -1);
        place = static_cast<int>(n);
      }
    return place;
  };
  EXPECT_EQ(written(ObjectTable::kAcyclicTags, 10), 3);
  EXPECT_EQ(written(ObjectTable::kAcyclicTags + 4, 10), 7);
  EXPECT_EQ(written(ObjectTable::kAcyclicTags + 6, 10), 9);
  EXPECT_EQ(written(ObjectTable::kAcyclicTags + 7, 10), -1) << "behind the variables";
  EXPECT_EQ(written(ObjectTable::kAcyclicTags - 1, 10), -1) << "the tag of a cyclic object";
  EXPECT_EQ(written(0, 10), -1);
}

TEST(ObjectTable, AOneShotTelegramHasThePresentValues) {
  PROVES("VAR-09", "VAR-10");
  Table unit;
  unit.h[20] = 0x11223344;
  unit.h[21] = 0x55667788;
  EXPECT_EQ(ObjectTable::acyclic_frame(Table::request(ObjectKind::TransmitAcyclic, 1024, 8, 20), unit.h),
            Frame(1024, 8, {0x55, 0x66, 0x77, 0x88, 0x11, 0x22, 0x33, 0x44}));
  EXPECT_EQ(ObjectTable::acyclic_frame(Table::request(ObjectKind::TransmitAcyclic, 1024, 0x108, 20), unit.h),
            Frame(1024, 8, {0x44, 0x33, 0x22, 0x11, 0x88, 0x77, 0x66, 0x55}));
  EXPECT_EQ(ObjectTable::acyclic_frame(Table::request(ObjectKind::TransmitAcyclic, 2047, 0x103, 20), unit.h),
            Frame(2047, 3, {0x44, 0x33, 0x22}));
}

// An object is due O, O + T, O + 2T, ... after the start (docs/inside/cycle.md).
TEST(ObjectTable, AnObjectIsDueAfterItsOffsetAndThenInEachCycle) {
  PROVES("SCOM-13");
  struct Case {
    int64_t start;
    int32_t cycle, offset;
  };
  for (const Case& c : {Case{0, 1, 0}, Case{0, 10, 0}, Case{7, 3, 0}, Case{7, 3, 20}, Case{100, 50, 120}}) {
    Table unit;
    EXPECT_EQ(unit.cyclic(1100, 100), ObjectVerdict::Accepted);
    EXPECT_EQ(unit.cyclic(1024, c.cycle, c.offset), ObjectVerdict::Accepted);
    EXPECT_EQ(unit.table.sending(), 0U);
    unit.table.start(c.start);
    unit.table.start(c.start + 1);  // it runs already
    EXPECT_EQ(unit.table.sending(), 2U);
    const int64_t first = c.start + c.offset;
    for (int64_t tick = first - 30; tick < first + 60; ++tick) {
      int64_t next = first;
      while (next <= tick) next += c.cycle;
      EXPECT_EQ(unit.table.next_due(1, tick), next) << tick;
      bool sent = false;
      unit.table.due(tick, unit.h, [&](uint32_t tag, const Frame& frame) {
        if (tag == 1) sent = frame == Frame(1024, 0);
      });
      EXPECT_EQ(sent, tick >= first && (tick - first) % c.cycle == 0) << tick;
    }
  }
}

TEST(ObjectTable, AFrameIsForTheReceiveObjectOfItsIdentifier) {
  Table unit;
  for (int32_t n = 0; n < 3; ++n) unit.receive(1024 + n);
  unit.cyclic(1027, 10);
  EXPECT_EQ(unit.table.receiver({1024, 8}), std::nullopt) << "not started";
  unit.table.start(0);
  for (size_t n = 0; n < 3; ++n) {
    const auto id = static_cast<uint32_t>(1024 + n);
    EXPECT_EQ(unit.table.receiver({id, 8}), n);
    EXPECT_EQ(unit.table.receiver({id, 5}), n) << "of whatever length";
    EXPECT_EQ(unit.table.receiver(Frame(id, 8, {}, true, false)), std::nullopt) << "29 bits";
    EXPECT_EQ(unit.table.receiver(Frame(id, 8, {}, false, true)), std::nullopt) << "remote";
  }
  EXPECT_EQ(unit.table.receiver({1023, 8}), std::nullopt);
  EXPECT_EQ(unit.table.receiver({1027, 8}), std::nullopt) << "a transmit object";
  EXPECT_EQ(unit.table.receiver({0, 8}), std::nullopt) << "no object";
  unit.table.pause();
  EXPECT_EQ(unit.table.receiver({1024, 8}), std::nullopt);
}

// For every length: which variables a frame writes, and that has_taken() sees any other value in one of these only.
TEST(ObjectTable, AFrameWritesTheVariablesOfItsLength) {
  PROVES("VAR-08", "VAR-13");
  for (const std::string_view name : {"md60a", "mdxb"})
    for (int32_t length = 0; length <= 8; ++length) {
      // The data are the last variables, so what lies behind them is the end.
      Table unit(name);
      const uint32_t touched = variables_of(length);
      const auto data = static_cast<uint32_t>(unit.h.size()) - std::max(touched, 1U);
      EXPECT_EQ(unit.receive(1024, length, static_cast<int32_t>(data)), ObjectVerdict::Accepted);
      // The same object in the middle, with neighbours on both sides.
      EXPECT_EQ(unit.receive(1025, length, 200), ObjectVerdict::Accepted);
      unit.table.start(0);
      // The low-order bytes of 55667788 11223344, highest first.
      const uint64_t all = 0x5566'7788'1122'3344;
      const uint64_t value = length == 0 ? 0 : all << (64 - 8 * length) >> (64 - 8 * length);
      Frame frame(1024, static_cast<uint8_t>(length));
      for (int32_t n = 0; n < length; ++n)
        frame.data[static_cast<size_t>(n)] = static_cast<uint8_t>(value >> (8 * (length - 1 - n)));
      const int32_t expected[] = {static_cast<int32_t>(static_cast<uint32_t>(value)),
                                  static_cast<int32_t>(value >> 32)};
      for (size_t object = 0; object < 2; ++object) {
        const uint32_t at = object == 0 ? data : 200;
        Frame wrong = frame;
        wrong.length = static_cast<uint8_t>((length + 1) % 9);
        std::vector<int32_t> before(unit.h.size(), 777);
        if (name == "mdxb") before[kSbus1Flags] = 0;
        unit.h = before;
        EXPECT_FALSE(unit.table.take(object, wrong, unit.h));
        EXPECT_EQ(unit.h, before) << "of another length: nothing changes";

        std::vector<int32_t> after = before;
        std::copy_n(expected, touched, after.begin() + at);
        if (name == "mdxb") after[kSbus1Flags] = 1 << object;
        EXPECT_TRUE(unit.table.take(object, frame, unit.h));
        EXPECT_EQ(unit.h, after) << length;

        EXPECT_TRUE(unit.table.has_taken(object, frame, unit.h));
        EXPECT_FALSE(unit.table.has_taken(object, wrong, unit.h));
        for (uint32_t n = 0; n < 4; ++n) {
          if (at + n >= unit.h.size()) break;
          ++unit.h[at + n];
          EXPECT_EQ(unit.table.has_taken(object, frame, unit.h), n >= touched) << length << ' ' << n;
          --unit.h[at + n];
        }
      }
    }
}

// MOVIDRIVE B: bit n for the n-th object, in H522 for SBus 1 and in H523 for SBus 2. The program clears it, so a frame
// with the same values has not been taken until its bit is set again. Other units have no such flags.
TEST(ObjectTable, MovidriveBFlagsWhatItReceived) {
  for (const std::string_view name : {"md60a", "mdxb"})
    for (const int sbus : {1, 2}) {
      if (name != "mdxb" && sbus == 2) continue;
      Table unit(name, sbus);
      for (int32_t n = 0; n < 32; ++n) EXPECT_EQ(unit.receive(1024 + n, 8, 100), ObjectVerdict::Accepted);
      unit.table.start(0);
      const size_t of_bus = sbus == 1 ? kSbus1Flags : kSbus2Flags;
      for (size_t n = 0; n < 32; ++n) {
        const Frame frame = example_frame(static_cast<uint32_t>(1024 + n));
        const auto bit = static_cast<int32_t>(1U << n);
        EXPECT_TRUE(unit.table.take(n, frame, unit.h));
        EXPECT_TRUE(unit.table.has_taken(n, frame, unit.h));
        if (name != "mdxb") continue;
        // Every other flag stands and this one does not, and the other way round.
        unit.h[of_bus] = ~bit;
        EXPECT_FALSE(unit.table.has_taken(n, frame, unit.h)) << n;
        unit.h[of_bus] = bit;
        EXPECT_TRUE(unit.table.has_taken(n, frame, unit.h)) << n;

        for (const int32_t flags : {0, 0x55555555, ~bit, -1}) {
          std::vector<int32_t> expected(unit.h.size(), 9);
          unit.h = expected;
          unit.h[of_bus] = flags;
          EXPECT_TRUE(unit.table.take(n, frame, unit.h));
          expected[100] = 0x11223344;
          expected[101] = 0x55667788;
          expected[of_bus] = flags | bit;
          EXPECT_EQ(unit.h, expected) << n;
        }
      }
    }
}

// The states of a table are accepted again, up to full ones; they send and receive as before.
TEST(ObjectTable, ASavedStateGoesOn) {
  for (const std::string_view name : {"md60a", "compact", "mc07", "mdxb"}) {
    Table saved(name, 1, 1'000'000);
    EXPECT_TRUE(Table(name).table.restore(saved.table.state())) << "an empty one";
    const auto last = static_cast<int32_t>(saved.unit.variables) - 1;
    for (const stdlib::ObjectClass& objects : saved.unit.objects)
      for (int32_t n = objects.longest == 65'530 ? 1 : 0; n < objects.objects; ++n)
        EXPECT_EQ(saved.cyclic(1100 + objects.shortest * 10 + n, objects.longest == 9 ? 9 : 10), ObjectVerdict::Accepted);
    EXPECT_EQ(saved.define({ObjectKind::TransmitCyclic, 2047, 65'530, 0, 4, last, 50}),
              ObjectVerdict::Accepted);
    for (int32_t n = 0; n < 31; ++n) EXPECT_EQ(saved.receive(1300 + n), ObjectVerdict::Accepted);
    EXPECT_EQ(saved.receive(1331, 0x108, last - 1), ObjectVerdict::Accepted);
    saved.table.start(7);
    Table unit(name);
    ASSERT_TRUE(unit.table.restore(saved.table.state())) << name;
    EXPECT_TRUE(unit.table.started());
    EXPECT_EQ(unit.table.sending(), saved.table.sending());
    for (size_t n = 0; n < saved.table.sending(); ++n) {
      EXPECT_EQ(unit.table.next_due(n, 1000), saved.table.next_due(n, 1000));
      EXPECT_EQ(unit.table.frame(n, unit.h).id, saved.table.frame(n, saved.h).id);
    }
    EXPECT_EQ(unit.table.receiver({1331, 8}), 31U);
    EXPECT_EQ(unit.receive(1400), ObjectVerdict::TooLate);
  }
}

// A state with one thing wrong in its first or last object is refused, and what the table had stays.
TEST(ObjectTable, AStateThatCannotBeOneOfThisUnitIsRefused) {
  using State = ObjectTable::State;
  State sound;
  sound.cyclic_count = 3;
  sound.receive_count = 3;
  for (ObjectTable::Cyclic& object : sound.cyclic) object = {2047, 1, 0, 510, {8, VariableLayout::Intel}};
  for (ObjectTable::Receive& object : sound.receive) object = {2047, 511, {4, VariableLayout::Motorola}};
  struct Case {
    const char* what;
    bool accepted;
    void (*change)(State& state, size_t n);
  };
  const Case cases[] = {
      {"as it is", true, [](State&, size_t) {}},
      {"no cycle", false, [](State& s, size_t n) { s.cyclic[n].cycle = 0; }},
      {"a cycle of 2", true, [](State& s, size_t n) { s.cyclic[n].cycle = 2; }},
      {"sent identifier", false, [](State& s, size_t n) { s.cyclic[n].id = 2048; }},
      {"received identifier", false, [](State& s, size_t n) { s.receive[n].id = 2048; }},
      {"sent length", false, [](State& s, size_t n) { s.cyclic[n].format.length = 9; }},
      {"received length", false,
       [](State& s, size_t n) {
         s.receive[n] = {1024, 100, {9}};
       }},
      {"sent data of 8 bytes", false, [](State& s, size_t n) { s.cyclic[n].data = 511; }},
      {"sent data of 5 bytes", false,
       [](State& s, size_t n) { s.cyclic[n].data = 511, s.cyclic[n].format = {5}; }},
      {"sent data of 4 bytes", true,
       [](State& s, size_t n) { s.cyclic[n].data = 511, s.cyclic[n].format = {4}; }},
      {"received data of 4 bytes", false, [](State& s, size_t n) { s.receive[n].data = 512; }},
      {"received data of 8 bytes", true,
       [](State& s, size_t n) {
         s.receive[n] = {1024, 510, {8}};
       }},
      {"data far away", false, [](State& s, size_t n) { s.receive[n].data = 0xFFFF; }},
      {"layout sent", false,
       [](State& s, size_t n) { s.cyclic[n].format.layout = static_cast<VariableLayout>(2); }},
      {"layout received", false,
       [](State& s, size_t n) { s.receive[n].format.layout = static_cast<VariableLayout>(2); }},
      {"behind the objects", true, [](State& s, size_t) { s.cyclic[3].cycle = 0, s.receive[3].id = 2048; }},
      {"the most sent", true, [](State& s, size_t) { s.cyclic_count = 15; }},
      {"too many sent", false, [](State& s, size_t) { s.cyclic_count = 16; }},
      {"far too many sent", false, [](State& s, size_t) { s.cyclic_count = 255; }},
      {"the most received", true, [](State& s, size_t) { s.receive_count = 32; }},
      {"too many received", false, [](State& s, size_t) { s.receive_count = 33; }},
      {"far too many received", false, [](State& s, size_t) { s.receive_count = 255; }},
      {"only sent", true, [](State& s, size_t) { s.receive_count = 0; }},
      {"only received", true, [](State& s, size_t) { s.cyclic_count = 0; }},
  };
  for (const Case& c : cases)
    for (const size_t n : {size_t{0}, size_t{2}}) {
      State state = sound;
      c.change(state, n);
      Table unit;
      unit.cyclic(1024, 10);
      EXPECT_EQ(unit.table.restore(state), c.accepted) << c.what << " of object " << n;
      EXPECT_EQ(unit.table.state().cyclic_count, c.accepted ? state.cyclic_count : 1) << c.what;
      EXPECT_EQ(unit.table.state().cyclic[0].id == 1024, !c.accepted) << c.what;
    }
}

}  // namespace
}  // namespace ipos::runtime
