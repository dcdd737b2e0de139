// [[fault]] and [[control]] in the plant file: what is read, what is refused where, and that a seed decides a
// run.
#include <gtest/gtest.h>

#include "tests/runtime/bus_plan/plant_rig.hpp"

namespace ipos::tests {
namespace {

std::vector<std::string> errors(const std::string& more) {
  return PlantRig(bus_text() + station_text("a", "") + station_text("b", "P813 = 1\n") + more).errors;
}

// The first error of a [[fault]] that begins in line 16.
std::string refused(const std::string& kind, const std::string& keys) {
  const std::vector<std::string> found = errors(fault_text(kind, keys));
  return found.empty() ? "" : found[0];
}

TEST(FaultFile, EveryKindIsRead) {
  EXPECT_TRUE(errors(fault_text("drop", "frame = 3\nid = 523\n")).empty());
  EXPECT_TRUE(
      errors(fault_text("corrupt", "rate = 10\nseed = 7\nstation = \"b\"\nfrom = \"10ms\"\nuntil = \"1s\"\n"))
          .empty());
  EXPECT_TRUE(errors(fault_text("delay", "delay = \"5ms\"\nrate = 1\n")).empty());
  EXPECT_TRUE(errors(fault_text("duplicate", "")).empty());
  EXPECT_TRUE(errors(fault_text("terminator", "rate = 100\n")).empty());
  EXPECT_TRUE(errors(fault_text("cut", "behind = \"a\"\n")).empty());
  EXPECT_TRUE(errors(fault_text("cut", "station = \"a\"\n")).empty());
  EXPECT_TRUE(errors(fault_text("swap", "station = \"a\"\n")).empty());
  EXPECT_TRUE(errors(fault_text("short", "from = \"1ms\"\nuntil = \"2ms\"\n")).empty());
  EXPECT_TRUE(errors(fault_text("stuck", "")).empty());
}

TEST(FaultFile, MistakesAreLocated) {
  EXPECT_EQ(refused("explode", ""),
            "18: 'explode' is no fault; known are drop, corrupt, delay, duplicate, terminator, cut, swap, "
            "short, stuck, length, baud");
  EXPECT_EQ(refused("drop", "frame = 0\n"), "19: frames are counted from 1");
  EXPECT_EQ(refused("drop", "frame = 1\nrate = 5\n"),
            "20: a fault strikes the n-th frame, or a rate of them: not both");
  EXPECT_EQ(refused("drop", "rate = 1001\n"), "19: rate is 0 to 1000");
  EXPECT_EQ(refused("delay", ""), "16: delay = ... belongs to kind = \"delay\", and there it must be");
  EXPECT_EQ(refused("drop", "delay = \"1ms\"\n"),
            "16: delay = ... belongs to kind = \"delay\", and there it must be");
  EXPECT_EQ(refused("baud", "station = \"a\"\n"), "16: baud = ... belongs to kind = \"baud\", and there it must be");
  EXPECT_EQ(refused("drop", "baud = 250000\n"), "16: baud = ... belongs to kind = \"baud\", and there it must be");
  EXPECT_EQ(refused("baud", "station = \"a\"\nbaud = 9600\n"),
            "20: a CAN station has 125000, 250000, 500000, 1000000 baud, not 9600");
  EXPECT_EQ(refused("cut", ""), "16: a fault 'cut' needs station = \"...\" or behind = \"...\"");
  EXPECT_EQ(refused("swap", ""), "16: a fault 'swap' needs station = \"...\"");
  EXPECT_EQ(refused("swap", "behind = \"a\"\n"), "19: behind belongs to kind = \"cut\"");
  EXPECT_EQ(refused("short", "station = \"a\"\n"), "16: a fault 'short' concerns the whole line");
  EXPECT_EQ(refused("short", "frame = 3\n"), "19: frame does not belong to a fault 'short'");
  EXPECT_EQ(refused("drop", "station = \"c\"\n"), "19: there is no station 'c'");
  EXPECT_EQ(refused("drop", "from = \"2ms\"\nuntil = \"1ms\"\n"), "16: until must be after from");
  EXPECT_EQ(refused("drop", "from = \"soon\"\n"), "19: 'soon' is no time; write for example 500ms or 1.5s");
  EXPECT_EQ(refused("drop", "when = 3\n").substr(0, 31), "19: unknown key 'when' in [[fau");
  EXPECT_EQ(errors("[[fault]]\nkind = \"drop\"\n")[0], "16: a [[fault]] needs bus = \"...\"");
  EXPECT_EQ(errors("[[fault]]\nbus = \"can\"\nkind = \"drop\"\n")[0], "17: there is no bus 'can'");
}

TEST(FaultFile, ControlsAreChecked) {
  const std::string control = "[[control]]\nname = \"plc\"\nsbus = \"sbus\"\n";
  EXPECT_TRUE(errors(control).empty());
  EXPECT_EQ(errors("[[control]]\nname = \"a\"\nsbus = \"sbus\"\n")[0], "16: there are two of station 'a'");
  EXPECT_EQ(errors(control + "sync = 2048\n")[0], "19: sync is 0 to 2047");
  EXPECT_EQ(errors(control + "cycle = \"1ms\"\n")[0], "19: a sync cycle has at least 5ms");
  EXPECT_EQ(errors(control + "[[control.target]]\naddress = 1\n")[0],
            "16: a target without every = ... is synchronous and needs sync = ... in its [[control]]");
  EXPECT_EQ(errors(control + "[[control.target]]\nevery = \"1ms\"\n")[0],
            "19: a [[control.target]] needs address = ... or group = ...");
  EXPECT_EQ(errors(control + "sync = 0\n[[control.target]]\ngroup = 1\n")[0],
            "20: group process data need every = ...: they cannot be synchronous");
  EXPECT_EQ(errors(control + "sync = 0\n[[control.target]]\naddress = 1\npo = [1, 2, 3, 4]\n")[0],
            "22: there are three process data words");
  EXPECT_EQ(errors(control + "sync = 0\n[[control.target]]\naddress = 1\npo = [65536]\n")[0],
            "22: a process data word has 16 bits");
}

std::vector<std::pair<Time, uint32_t>> run(const std::string& seed) {
  PlantRig rig(
      bus_text() + station_text("a", "P813 = 1\n") + station_text("b", "P813 = 2\n") +
      "[[control]]\nname = \"plc\"\nsbus = \"sbus\"\n[[control.target]]\naddress = 1\nevery = \"2ms\"\n"
      "[[control.target]]\naddress = 2\nevery = \"3ms\"\n" +
      fault_text("corrupt", "rate = 100\nseed = " + seed + "\n") +
      fault_text("drop", "rate = 50\nseed = 9\nstation = \"b\"\n"));
  rig.run_until(kSecond);
  std::vector<std::pair<Time, uint32_t>> frames;
  for (const FrameRecord& record : rig.frames) frames.emplace_back(record.end, record.frame.id);
  return frames;
}

TEST(FaultFile, TheSeedDecidesTheRun) {
  const auto first = run("4");
  EXPECT_EQ(first, run("4"));
  EXPECT_NE(first, run("5"));
}

}  // namespace
}  // namespace ipos::tests
