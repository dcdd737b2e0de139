// Bus load of a log, replay of a log, and the DBC file, whose signals are decoded here by the rules of the
// format.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <regex>
#include <sstream>

#include "runtime/bus/can/frame_bits.hpp"
#include "runtime/bus/can/line.hpp"
#include "runtime/bus/dbc/dbc.hpp"
#include "runtime/bus/log/bus_load.hpp"
#include "runtime/bus/log/replay.hpp"
#include "runtime/bus/movilink/parameter_telegram.hpp"
#include "runtime/bus/movilink/process_data.hpp"
#include "tests/runtime/bus/wire_model.hpp"

namespace ipos::tests {
namespace {

using namespace ipos::runtime;  // NOLINT

Frame any_frame(std::mt19937& random) {
  Frame frame;
  frame.id = static_cast<uint32_t>(random() % kStandardIdLimit);
  frame.length = static_cast<uint8_t>(random() % 9);
  for (size_t n = 0; n < frame.length; ++n) frame.data[n] = static_cast<uint8_t>(random());
  return frame;
}

TEST(BusLoad, WindowsIdentifiersAndTotalsAgreeWithTheWireModel) {
  std::mt19937 random(3);
  BusLoad load;
  Time at = 5 * kSecond + 300 * kMillisecond;
  const Time begin = at;
  uint64_t all = 0;
  std::map<Time, uint64_t> windows;
  for (int n = 0; n < 5000; ++n) {
    const Frame frame = any_frame(random);
    const uint64_t bits = wire(frame).size() + 3;
    all += bits;
    windows[(at - begin) / kSecond] += bits;
    load.add(at, frame);
    at += static_cast<Time>(random() % 2000) * kMicrosecond;
  }
  EXPECT_EQ(load.total().exact_bits, all);
  EXPECT_EQ(load.total().frames, 5000U);
  for (size_t n = 0; n < load.windows().size(); ++n) {
    EXPECT_EQ(load.windows()[n].start, begin + static_cast<Time>(n) * kSecond);
    EXPECT_EQ(load.windows()[n].count.exact_bits, windows[static_cast<Time>(n)]);
  }
  uint64_t by_identifier = 0;
  for (const auto& [id, count] : load.identifiers()) by_identifier += count.exact_bits;
  EXPECT_EQ(by_identifier, all);
}

TEST(BusLoad, PercentAndEmptyWindows) {
  BusLoad load;
  EXPECT_EQ(load.span(), 0);
  Frame frame;
  frame.id = 0x555;
  frame.length = 8;
  for (int n = 0; n < 1000; ++n) load.add(n * kMillisecond, frame);
  load.add(3 * kSecond, frame);
  ASSERT_EQ(load.windows().size(), 4U);
  EXPECT_EQ(load.windows()[1].count.frames, 0U);
  EXPECT_EQ(load.windows()[0].count.worst_bits, 135'000U);
  EXPECT_EQ(LoadCount::percent_hundredths(135'000, 500'000, kSecond), 2700U);
  EXPECT_EQ(LoadCount::percent_hundredths(1, 500'000, 0), 0U);
  load.add(1'000'000 * kSecond, frame);  // a jump of the clock does not make a million windows
  EXPECT_EQ(load.windows().size(), 5U);
}

// Shares are rounded to hundredths of a per cent, halves up.
TEST(BusLoad, PercentIsRounded) {
  const auto share = [](uint64_t bits) { return LoadCount::percent_hundredths(bits, 500'000, kSecond); };
  EXPECT_EQ(share(24), 0U);
  EXPECT_EQ(share(25), 1U);
  EXPECT_EQ(share(74), 1U);
  EXPECT_EQ(share(75), 2U);
  EXPECT_EQ(share(500'000), 10'000U);
  EXPECT_EQ(LoadCount::percent_hundredths(1, 500'000, kMicrosecond), 0U) << "no bit fits into it";
  EXPECT_EQ(LoadCount::percent_hundredths(1, 500'000, 2 * kMicrosecond), 10'000U);
  EXPECT_EQ(LoadCount::percent_hundredths(1, 500'000, -kSecond), 0U);
}

// Up to an hour of silence is shown second by second; behind a longer one the seconds count anew (ours).
TEST(BusLoad, AnHourOfSilence) {
  for (const Time more : {Time{0}, Time{1}}) {
    BusLoad load;
    load.add(7 * kSecond, {});
    load.add(7 * kSecond + 3600 * kSecond + more, {});
    ASSERT_EQ(load.windows().size(), more == 0 ? 3601U : 2U);
    EXPECT_EQ(load.windows().back().start, 3607 * kSecond + more);
    EXPECT_EQ(load.windows().back().count.frames, 1U);
    EXPECT_EQ(load.span(), 3600 * kSecond + more);
  }
  BusLoad load;
  load.add(0, {});
  load.add(kSecond - 1, {});
  EXPECT_EQ(load.windows().size(), 1U);
  load.add(kSecond, {});
  EXPECT_EQ(load.windows().size(), 2U);
}

class Quiet final : public CanNode {
 public:
  void on_frame(Time now, const Frame& frame) override {
    frames.push_back(frame);
    times.push_back(now);
  }
  void on_sent(Time, const Frame&, uint64_t) override {}
  void on_not_sent(Time, const Frame&, uint64_t, NotSent) override {}
  std::vector<Frame> frames;
  std::vector<Time> times;
};

TEST(Replay, FramesComeAtTheirTimes) {
  std::mt19937 random(5);
  std::vector<LogEntry> entries;
  Time at = 77 * kSecond;
  for (int n = 0; n < 500; ++n) {
    entries.push_back({at, "can0", any_frame(random)});
    at += 400 * kMicrosecond + static_cast<Time>(random() % 1000) * kMicrosecond;
  }
  EventQueue queue;
  CanLine line(queue, 0, "sbus", 500'000);
  Quiet listener;
  line.attach("listener", 500'000, listener);
  Replay replay(queue, 7, entries, 50 * kMillisecond);
  LinePort port(line, line.attach("replay", 500'000, replay));
  replay.start(port, line.bit_time());
  queue.run_until(replay.end() + kSecond);
  ASSERT_EQ(listener.frames.size(), entries.size());
  EXPECT_EQ(replay.sent(), entries.size());
  EXPECT_EQ(replay.refused(), 0U);
  for (size_t n = 0; n < entries.size(); ++n) {
    EXPECT_EQ(listener.frames[n], entries[n].frame);
    const Time wanted = entries[n].time - 77 * kSecond + 50 * kMillisecond;
    EXPECT_LE(std::llabs(listener.times[n] - wanted), 2 * line.bit_time()) << n;
  }
}

// --- DBC

struct Signal {
  std::string name;
  unsigned start, bits;
  bool intel, is_signed;
  double factor;
  std::string receivers;
};
struct Message {
  std::string name;
  unsigned bytes = 0;
  std::string sender;
  std::vector<Signal> signals;
};

std::map<unsigned, Message> parse_dbc(const std::string& text) {
  static const std::regex message(R"(BO_ (\d+) (\w+): (\d+) (\w+))");
  static const std::regex signal(
      R"re( SG_ (\w+)(?: M| m\d+)? : (\d+)\|(\d+)@([01])([+-]) \(([^,]+),0\) \[[^|]+\|[^\]]+\] "[^"]*" (.+))re");
  std::map<unsigned, Message> messages;
  Message* current = nullptr;
  std::istringstream in(text);
  std::smatch m;
  for (std::string line; std::getline(in, line);) {
    if (std::regex_match(line, m, message)) {
      current = &messages[static_cast<unsigned>(std::stoul(m[1]))];
      *current = {m[2], static_cast<unsigned>(std::stoul(m[3])), m[4], {}};
    } else if (std::regex_match(line, m, signal)) {
      EXPECT_NE(current, nullptr);
      current->signals.push_back({m[1], static_cast<unsigned>(std::stoul(m[2])),
                                  static_cast<unsigned>(std::stoul(m[3])), m[4] == "1", m[5] == "-",
                                  std::stod(m[6]), m[7]});
    } else {
      EXPECT_FALSE(line.starts_with("BO_ ") || line.starts_with(" SG_")) << line;
    }
  }
  return messages;
}

// Walks from bit to bit: Intel upwards, Motorola to the left within a byte and on to the next one.
int64_t decode(const Signal& signal, const Frame& frame) {
  uint64_t value = 0;
  unsigned at = signal.start;
  for (unsigned n = 0; n < signal.bits; ++n) {
    const uint64_t bit = frame.data[at / 8] >> (at % 8) & 1U;
    if (signal.intel) {
      value |= bit << n;
      ++at;
    } else {
      value = value << 1 | bit;
      at = at % 8 == 0 ? at + 15 : at - 1;
    }
  }
  if (signal.is_signed && (value >> (signal.bits - 1) & 1U) != 0)
    return static_cast<int64_t>(value) - (int64_t{1} << signal.bits);
  return static_cast<int64_t>(value);
}

TEST(Dbc, SignalsDecodeToTheVariablesInEveryLengthAndLayout) {
  std::mt19937 random(11);
  for (const VariableLayout layout : {VariableLayout::Motorola, VariableLayout::Intel})
    for (uint8_t length = 0; length <= 8; ++length) {
      TelegramNames names;
      ObjectNames object;
      object.id = 1024;
      object.station = "unit 1";
      object.sent = true;
      object.format = {length, layout};
      object.variables = {"Data.Low", "Data.High[1]"};
      object.cycle = 100;
      names.objects.push_back(object);
      UnitNames unit;
      unit.name = "unit 1";
      unit.unit = stdlib::find_unit("md60a");
      unit.settings = {1, 2, 0};
      names.units.push_back(unit);
      const std::string text = dbc_text({names, {}});
      const auto messages = parse_dbc(text);
      ASSERT_TRUE(messages.contains(1024));
      const Message& message = messages.at(1024);
      EXPECT_EQ(message.bytes, length);
      EXPECT_EQ(message.sender, "unit_1");
      EXPECT_NE(text.find("BA_ \"GenMsgCycleTime\" BO_ 1024 100;"), std::string::npos);
      ASSERT_EQ(message.signals.size(), object.format.variables());
      for (int n = 0; n < 50; ++n) {
        const VariablePair pair{static_cast<int32_t>(random()), static_cast<int32_t>(random())};
        const Frame frame = variable_frame(1024, object.format, pair);
        const auto received = frame_variables(frame, object.format);
        for (const Signal& signal : message.signals)
          EXPECT_EQ(decode(signal, frame), signal.name == "Data_Low" ? received->low : received->high)
              << signal.name << ' ' << static_cast<int>(length);
      }
    }
}

TEST(Dbc, ProcessDataWithScaleAndNodes) {
  TelegramNames names;
  UnitNames unit;
  unit.name = "unit1";
  unit.unit = stdlib::find_unit("md60a");
  unit.settings = {1, 2, 0};
  unit.output = {9, 1, 8};
  unit.input = {6, 1, 2};
  names.units.push_back(unit);
  unit.name = "unit2";
  unit.settings.address = 2;
  names.units.push_back(unit);
  const auto messages = parse_dbc(dbc_text({names, {}}));
  const Frame frame = process_frame(12, {0x0202, static_cast<uint16_t>(-5000), 100});
  const Message& input = messages.at(12);
  EXPECT_EQ(input.sender, "unit1");
  const auto shown = [&](const std::string& name) {
    for (const Signal& signal : input.signals)
      if (signal.name == name) return static_cast<double>(decode(signal, frame)) * signal.factor;
    ADD_FAILURE() << name;
    return 0.0;
  };
  EXPECT_DOUBLE_EQ(shown("PI2_SPEED"), -1000);
  EXPECT_DOUBLE_EQ(shown("PI3_OUTP_CURRENT"), 10);
  // 0202h: bit 1, ready, and the state 2, no enable.
  EXPECT_EQ(shown("PI1_ready"), 1);
  EXPECT_EQ(shown("PI1_output_stage_on"), 0);
  EXPECT_EQ(shown("PI1_state"), 2);
  EXPECT_EQ(messages.at(22).signals[0].receivers, "unit1,unit2");  // one message of the group
  EXPECT_TRUE(messages.contains(13));
  EXPECT_EQ(messages.at(11).signals.back().name, "PO3_RAMP");
}

TEST(Dbc, ControlWordBitsAndTheParameterChannel) {
  TelegramNames names;
  UnitNames unit;
  unit.name = "unit1";
  unit.unit = stdlib::find_unit("md60a");
  unit.settings = {1, 2, 0};
  unit.output = {9, 1, 8};
  names.units.push_back(unit);
  const std::string text = dbc_text({names, {}});
  const auto messages = parse_dbc(text);
  // 0806h in bytes 0 and 1: enable (bits 1 and 2), bit 11 a fixed setpoint.
  const Frame po = process_frame(11, {0x0806, 0, 0});
  std::string on;
  for (const Signal& signal : messages.at(11).signals)
    if (signal.bits == 1 && decode(signal, po) != 0) on += signal.name + " ";
  EXPECT_EQ(on, "PO1_no_rapid_stop PO1_no_stop PO1_fixed_setpoint_bit_0 ");
  // A request to address 1: 523; write index 8470, P130, 2500.
  ASSERT_TRUE(messages.contains(523));
  const Frame request{523, 8, encode(parameter_request(Service::Write, 8470, 0, 2500))};
  const auto value = [&](const std::string& begin) {
    for (const Signal& signal : messages.at(523).signals)
      if (signal.name.starts_with(begin)) return static_cast<double>(decode(signal, request)) * signal.factor;
    ADD_FAILURE() << begin;
    return 0.0;
  };
  EXPECT_EQ(value("Service"), 2);
  EXPECT_EQ(value("Index"), 8470);
  EXPECT_DOUBLE_EQ(value("P130_"), 2.5);
  EXPECT_NE(text.find("VAL_ 523 Service 0 \"no service\" 1 \"read\""), std::string::npos);
  EXPECT_NE(text.find(" SG_ Index M : 23|16@0+"), std::string::npos);
}

}  // namespace
}  // namespace ipos::tests
