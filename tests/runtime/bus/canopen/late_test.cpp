// What CANopen nodes send on change, in the run that leaves milliseconds out and in the plain one: random plants of two
// nodes and a master, with words that change by counting, by decisions and by programs, and everything that happens to a
// node. Each frame comes in the same moment with the same data, and the journal tells the same.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <random>
#include <string>
#include <vector>

#include "runtime/station/can_bus.hpp"
#include "tests/runtime/plant/loop_body.hpp"
#include "tests/runtime/plant/plant_rig.hpp"

namespace ipos::tests {
namespace {

using runtime::Plant;
using runtime::Time;

struct Frames final : runtime::CanObserver {
  void on_frame(const runtime::CanLine&, const runtime::FrameRecord& record) override {
    std::string text = fmt::format("{} {:X}#", record.end, record.frame.id);
    for (size_t n = 0; n < record.frame.length; ++n) text += fmt::format("{:02X}", record.frame.data[n]);
    lines.push_back(std::move(text));
  }
  void on_line_event(const runtime::CanLine&, const runtime::LineEvent&) override {}
  std::vector<std::string> lines;
};

// Programs that let a unit be idle, run ahead, write PI words, wait, fault, start a timer, and follow SYNC by ISYNC.
const char* const kPrograms[] = {
    "main() { while (1) { } }",
    "long a; main() { while (1) { a = a * 5 + 1; } }",
    "#include <const.h>\nSSPIDATA3 pi; long n; main() { while (1) { _Wait(37); n++; pi.PI3 = n; _SetSys(SS_PIDATA, pi); } }",
    "#include <constb.h>\nlong n; main() { while (1) { _Wait(7); n = n + 3; } }",
    "#include <constb.h>\nlong n, z; main() { _Wait(400); n = n / z; }",
    "#include <constb.h>\nlong n; main() { H488 = 300; while (1) { if (H488 == 0) { H488 = 300; n++; } } }",
    "#include <constb.h>\nlong m; main() { SyncSource = numof(m); SyncControl = 1; while (1) { _Wait(9); m = m + 50; } }",
};

struct Draw {
  std::mt19937 random;
  uint32_t below(uint32_t limit) { return static_cast<uint32_t>(random()) % limit; }
  template <typename... Words>
  const char* one_of(Words... words) {
    const char* all[] = {words...};
    return all[below(sizeof...(words))];
  }
};

std::string node_text(Draw& draw, int number) {
  std::string text = fmt::format(
      "[[station]]\nname = 'n{0}'\nunit = 'mdxb'\nprogram = 'P{0}.IPC'\nsbus = 'can'\n{2}[station.parameters]\nP880 = 1\n"
      "P886 = {0}\nP100 = 10\nP101 = 3\nP130 = {1}\n",
      number, 100 + 100 * draw.below(20), draw.below(4) == 0 ? "noise = '0.3 %'\n" : "");
  if (draw.below(3) == 0) text += fmt::format("P700 = 13\nP077 = {}\n", draw.one_of("0", "2"));
  if (draw.below(2) == 0) text += "P883 = '200 ms'\n";  // timeout of the SBus
  for (int pi = 873; pi <= 875; ++pi)
    text += fmt::format("P{} = {}\n", pi, draw.one_of("0", "1", "2", "3", "4", "5", "6", "7", "9"));
  text += "[station.inputs]\nDI00 = 1\nDI01 = 1\nDI03 = 1\n";
  return text;
}

std::string target_text(Draw& draw, int number) {
  std::string text =
      fmt::format("[[control.target]]\naddress = {}\npo = [{}, {}]\n", number, draw.one_of("6", "6", "0"), draw.below(16000));
  text += draw.one_of("", "heartbeat = '50ms'\n", "guard = '100ms'\n");
  if (draw.below(3) == 0)
    text += fmt::format("[[control.target.pdo]]\nnumber = 1\ntransmit = true\ntype = {}\nmap = ['{}', '{}', '{}']\n",
                        draw.one_of("0", "1", "3", "252", "253", "255"), draw.one_of("PI1", "PI3", "PI4"),
                        draw.one_of("PI2", "PI1"), draw.one_of("PI3", "PI10", "PI2"));
  if (draw.below(3) == 0)
    text += fmt::format("[[control.target.pdo]]\nnumber = 1\ntype = {}\nmap = ['{}', 'PO2', '{}']\n", draw.one_of("0", "1", "254", "255"),
                        draw.one_of("PO1", "PO4"), draw.one_of("PO3", "PO1", "PO10"));
  for (int pdo = 2; pdo <= 3; ++pdo) {
    text += fmt::format("[[control.target.pdo]]\nnumber = {}\ntransmit = true\ntype = {}\n", pdo,
                        draw.one_of("255", "254", "255", "0", "1"));
    if (draw.below(2) == 0) text += fmt::format("inhibit = '{}ms'\n", 1 + draw.below(40));
    if (draw.below(3) == 0) text += fmt::format("event = '{}ms'\n", 5 + draw.below(60));
    text += fmt::format("map = ['{}', '{}']\n", draw.one_of("PI1", "PI2", "PI3"), draw.one_of("PI2", "PI3", "PI1"));
  }
  return text;
}

std::string plant_text(Draw& draw) {
  std::string text = fmt::format("[[bus]]\nname = 'can'\nkind = 'can'\nbaud = {}\n", draw.one_of("500000", "1000000", "125000"));
  text += fmt::format("[[control]]\nname = 'plc'\nkind = 'canopen'\nsbus = 'can'\ncycle = '{}ms'\n", 5 + draw.below(60));
  for (const int number : {5, 6}) text += target_text(draw, number);
  for (const int number : {5, 6}) text += node_text(draw, number);
  return text;
}

// Something that a hand does to a station between two stretches.
void do_something(Plant& plant, uint32_t what, uint32_t value) {
  runtime::Station& station = *plant.stations()[value % 2];
  const auto input = static_cast<size_t>(value / 2 % 4);
  switch (what) {
    case 0: station.inputs().line(input).set = station.inputs().line(input).set == 0 ? 1 : 0; break;
    case 1:
      if (station.powered()) station.drive().state().raise_fault(8);
      break;
    case 2: station.powered() ? station.power_off() : station.power_on(); break;
    case 3:
      if (station.powered()) (void)station.drive().set_parameter("P873", static_cast<int32_t>(value / 8 % 8));
      break;
    case 4:
      if (station.powered()) station.drive().state().reset_fault();
      break;
    case 5:
      if (station.powered()) (void)station.drive().set_parameter("P077", static_cast<int32_t>(value / 8 % 2 * 2));
      break;
    default: station.look();
  }
}

class CanopenLate : public ::testing::TestWithParam<uint32_t> {};

TEST_P(CanopenLate, SendsWhatThePlainRunSends) {
  Draw draw{std::mt19937(GetParam())};
  const std::string text = plant_text(draw);
  SCOPED_TRACE(text);
  std::map<std::string, std::string> programs;
  for (const char* name : {"P5.IPC", "P6.IPC"}) programs[name] = kPrograms[draw.below(std::size(kPrograms))];
  const auto plain = make_plant(text, programs, std::nullopt, in_turn());
  const auto late = make_plant(text, programs);
  ASSERT_TRUE(plain && late);
  Frames plain_frames, late_frames;
  plain->add_observer(plain_frames);
  late->add_observer(late_frames);
  bool left_out = false;
  for (Time at = 0; at < 3 * runtime::kSecond;) {
    at += static_cast<Time>(1 + draw.below(500'000)) * runtime::kMicrosecond;
    const uint32_t what = draw.below(8), value = draw.below(1000);
    for (Plant* plant : {plain.get(), late.get()}) {
      plant->run_until(at);
      left_out |= plant == late.get() && (late->stations()[0]->behind() || late->stations()[1]->behind());
      do_something(*plant, what, value);
    }
    ASSERT_EQ(plain_frames.lines.size(), late_frames.lines.size()) << at;
  }
  EXPECT_EQ(plain_frames.lines, late_frames.lines);
  ASSERT_EQ(plain->journal().entries().size(), late->journal().entries().size());
  for (size_t n = 0; n < plain->journal().entries().size(); ++n) {
    EXPECT_EQ(plain->journal().entries()[n].time, late->journal().entries()[n].time);
    EXPECT_EQ(plain->journal().entries()[n].text, late->journal().entries()[n].text);
  }
  RecordProperty("left_out", left_out ? 1 : 0);
}

INSTANTIATE_TEST_SUITE_P(Seeds, CanopenLate, ::testing::Range(static_cast<uint32_t>(first_plant()), static_cast<uint32_t>(plant_count(150)) + 1));

// A node that turns and tells its process data at SYNC only: nobody can notice its milliseconds one by one, whether its
// program works or waits, and no SYNC and no repeated process data end that.
class CanopenLateNode : public ::testing::TestWithParam<const char*> {};

TEST_P(CanopenLateNode, ThatTellsNothingOnChangeIsLate) {
  const auto plant = make_plant(R"(
[[bus]]
name = 'can'
kind = 'can'
baud = 500000
[[control]]
name = 'plc'
kind = 'canopen'
sbus = 'can'
cycle = '20ms'
[[control.target]]
address = 5
po = [6, 5000]
[[station]]
name = 'n5'
unit = 'mdxb'
program = 'P.IPC'
sbus = 'can'
[station.parameters]
P880 = 1
P886 = 5
P100 = 10
P101 = 3
[station.inputs]
DI00 = 1
DI01 = 1
DI03 = 1
)",
                                {{"P.IPC", GetParam()}});
  int late = 0;
  for (Time at = 8 * runtime::kSecond; at < 8 * runtime::kSecond + ms(1000); at += ms(1)) {
    plant->run_until(at);
    late += plant->stations()[0]->behind() ? 1 : 0;
  }
  EXPECT_GT(late, 950);
}
INSTANTIATE_TEST_SUITE_P(Programs, CanopenLateNode,
                         ::testing::Values(kPrograms[0], kPrograms[1], "#include <constb.h>\nlong n; main() { while (1) { _Wait(500); n++; } }"));

}  // namespace
}  // namespace ipos::tests
