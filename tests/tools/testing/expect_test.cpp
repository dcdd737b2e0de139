// Every kind of expectation, met and not met. The plant: a counter that goes up by one every 10 ms from 10 ms
// on, a signal that is on every second count, and a cyclic frame of 100 ms.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "tests/harness/contains.hpp"
#include "tests/tools/command.hpp"
#include "tools/testing/check.hpp"

namespace ipos::tests {
namespace {

using runtime::kMillisecond;
using tools::testing::Check;
using tools::testing::Expect;
using tools::testing::Subject;
using tools::testing::Time;

const std::string kProgram = R"(#include <const.h>
SCTRCYCL Tr;
long lCount, lEven, lOther, lData;
main()
{
  Tr.ObjectNo = 1024;
  Tr.CycleTime = 100;
  Tr.Offset = 0;
  Tr.Format = 4;
  Tr.DPointer = numof(lData);
  lData = 0x01020304;
  _SBusCommDef(SCD_TRCYCL, Tr);
  _SBusCommOn();
  lEven = 1;
  while (1)
  {
    _Wait(10);
    lCount++;
    lEven = 1 - lEven;
  }
}
)";

const std::string kPlant = R"([[bus]]
name = "sbus"
kind = "can"

[[station]]
name = "unit1"
unit = "md60a"
program = "A.IPC"
sbus = "sbus"

[[station]]
name = "unit2"
unit = "md60a"
sbus = "sbus"
[station.parameters]
P813 = 1
P100 = "SBus"
P101 = "SBus"
[station.inputs]
DI00 = 1
DI01 = 1
DI03 = 1

)";

// The test file: the plant and `items`.
CommandResult run_items(const std::string& items, const std::vector<std::string>& flags = {}) {
  const TemporaryFolder folder;
  folder.write("A.IPC", kProgram);
  folder.write("a.test.toml", kPlant + items);
  std::vector<std::string> arguments = {"test", "a.test.toml", "--speed", "1000"};
  arguments.insert(arguments.end(), flags.begin(), flags.end());
  return run_ipos(arguments, folder.path());
}

void passes(const std::string& items) {
  const CommandResult result = run_items(items);
  EXPECT_EQ(result.exit_code, 0) << items << result.out << result.err;
}

void fails(const std::string& items, const std::string& because) {
  const CommandResult result = run_items(items);
  EXPECT_EQ(result.exit_code, 1) << items << result.out << result.err;
  EXPECT_TRUE(contains(result.out, because)) << items << result.out;
}

const std::string kCount = "[[expect]]\nstation = \"unit1\"\nvariable = \"lCount\"\n";
const std::string kEven = "[[expect]]\nstation = \"unit1\"\nvariable = \"lEven\"\n";
const std::string kFrame = "[[expect]]\nbus = \"sbus\"\nframe = \"400#*\"\n";
const std::string kToEnd = "[[step]]\nuntil = \"500ms\"\n";

TEST(Expectations, Equality) {
  passes(kCount + "at = \"95ms\"\nequals = 9\n");
  fails(kCount + "at = \"95ms\"\nequals = 10\n", "lCount of unit1 is 9 at 95 ms, expected 10");
  passes(kCount + "at = \"95ms\"\nequals = 10\ntolerance = 1\n");
  passes(kCount + "at = \"95ms\"\nnot = 8\n");
  fails(kCount + "at = \"95ms\"\nnot = 9\n", "expected not 9");
}

// 5.254 V at the analog input: it is compared to as many decimals as the expectation has.
TEST(Expectations, DecimalsOfSignals) {
  const std::string input = "[[step]]\nat = \"10ms\"\nstation = \"unit2\"\nanalog = \"AI1\"\nset = \"5.254 V\"\n"
                            "[[expect]]\nstation = \"unit2\"\nsignal = \"AI1\"\nat = \"95ms\"\n";
  for (const char* right : {"equals = 5", "equals = 5.3", "equals = 5.25", "equals = 5.254", "equals = 5.254000",
                            "equals = 5\ntolerance = 0.3", "equals = 5.26\ntolerance = 0.01", "not = 5.26", "min = 5.25\nmax = 5.3",
                            "max = 6", "one_of = [5, 5.25]", "sequence = [5.25]"})
    passes(input + right + (std::string(right).starts_with("seq") ? "\nwithin = \"1s\"\n" : "\n"));
  fails(input + "equals = 5.26\n", "AI1 of unit2 is 5.25 at 95 ms, expected 5.26");
  fails(input + "equals = 5.255\n", "AI1 of unit2 is 5.254 at 95 ms, expected 5.255");
  fails(input + "equals = 5\ntolerance = 0.2\n", "is 5.3 at 95 ms, expected 4.8 to 5.2");
  fails(input + "min = 5.5\n", "is 5.3 at 95 ms, expected at least 5.5");
  fails(input + "equals = -0.05\n", "is 5.25 at 95 ms, expected -0.05");
  fails(input + "equals = 5.26\n", "unit2.AI1 = 5.25 since 10 ms, 0.00 from");
}

TEST(Expectations, DecimalsThatCannotBe) {
  const auto refuses = [](const std::string& items, const std::string& because) {
    const CommandResult result = run_items(items);
    EXPECT_NE(result.exit_code, 0) << items;
    EXPECT_TRUE(contains(result.out + result.err, because)) << items << result.out << result.err;
  };
  const std::string signal = "[[expect]]\nstation = \"unit2\"\nsignal = \"AI1\"\nat = \"95ms\"\n";
  refuses(signal + "equals = 5.1234567\n", "equals has more than 6 decimals, or is too large");
  refuses(signal + "equals = nan\n", "equals has more than 6 decimals, or is too large");
  refuses(signal + "equals = 1e300\n", "equals has more than 6 decimals, or is too large");
  refuses(signal + "min = 0.5\nmax = \"6\"\n", "max must be a number");
  refuses(signal + "min = 0.5\nmax = 0.4\n", "max is below min");
  refuses(kCount + "at = \"95ms\"\nequals = 9.5\n", "equals must be a whole number; decimals are for signal = \"...\"");
}

TEST(Expectations, RangeAndChoice) {
  passes(kCount + "at = \"95ms\"\nmin = 9\nmax = 9\n");
  passes(kCount + "at = \"95ms\"\nmin = 9\n");
  fails(kCount + "at = \"95ms\"\nmin = 10\n", "is 9 at 95 ms, expected at least 10");
  fails(kCount + "at = \"95ms\"\nmax = 8\n", "expected at most 8");
  fails(kCount + "at = \"95ms\"\nmin = 1\nmax = 3\n", "expected 1 to 3");
  passes(kCount + "at = \"95ms\"\none_of = [1, 9]\n");
  fails(kCount + "at = \"95ms\"\none_of = [1, 8]\n", "expected one of 1, 8");
}

// The script goes on when it is met: 5 comes at 50 or 51 ms, 7 is met 20 ms later.
TEST(Expectations, WithinATime) {
  passes(kCount + "equals = 5\nwithin = \"60ms\"\n" + kCount + "equals = 7\nafter = \"23ms\"\n");
  fails(kCount + "equals = 5\nwithin = \"40ms\"\n",
        "lCount of unit1 did not become 5 from 0 ms to 40 ms, is ");
}

TEST(Expectations, Always) {
  passes(kCount + "max = 50\nalways = true\n" + kToEnd);
  fails(kCount + "max = 20\nalways = true\n" + kToEnd, "expected always at most 20");
  passes(kCount + "max = 20\nalways = true\nduring = \"150ms\"\n" + kToEnd);
}

TEST(Expectations, Never) {
  passes(kCount + "equals = 70\nnever = true\n" + kToEnd);
  fails(kCount + "equals = 20\nnever = true\n" + kToEnd, "lCount of unit1 is 20 at 20");
}

TEST(Expectations, NumberOfTimes) {
  // Even counts from 95 to 195 ms: 10, 12, 14, 16, 18.
  const std::string window = "equals = 1\nat = \"95ms\"\nduring = \"100ms\"\n";
  passes(kEven + window + "times = 5\n");
  fails(kEven + window + "times = 6\n", "expected 6");
  passes(kEven + window + "at_most = 5\n");
  fails(kEven + window + "at_most = 4\n", "for the 5. time");
  passes(kEven + window + "at_least = 5\n");
  fails(kEven + window + "at_least = 6\n", "5 times from 95 ms to 195 ms, expected 6 at least");
  passes(kEven + "equals = 1\nat_least = 3\nwithin = \"70ms\"\n");
}

TEST(Expectations, Period) {
  passes(kEven + "equals = 1\nat = \"95ms\"\nduring = \"100ms\"\nevery = \"20ms\"\ntolerance = \"1ms\"\n");
  fails(kEven + "equals = 1\nat = \"95ms\"\nduring = \"100ms\"\nevery = \"25ms\"\ntolerance = \"1ms\"\n",
        "after the one before, expected every 25 ms");
  fails(kCount + "equals = 5\nduring = \"100ms\"\nevery = \"20ms\"\n", "1 times from 0 ms to 100 ms");
}

TEST(Expectations, Sequence) {
  passes(kCount + "sequence = [0, 1, 2, 3]\nduring = \"45ms\"\n");
  passes(kCount + "sequence = [1, 2, 3]\nwithin = \"45ms\"\n");
  fails(kCount + "sequence = [0, 1, 3]\nduring = \"45ms\"\n", "became 2 at 2");
  fails(kCount + "sequence = [0, 1, 2, 3, 4, 5, 6]\nduring = \"45ms\"\n", "of the sequence, ");
  passes(kEven + "sequence = [0, 1]\nrepeat = true\nat = \"5ms\"\nduring = \"300ms\"\n");
}

TEST(Expectations, Frames) {
  passes(kFrame + "within = \"150ms\"\n");
  fails(kFrame + "at = \"120ms\"\nwithin = \"50ms\"\n",
        "frame 400#* on sbus did not come from 120 ms to 170 ms");
  passes(kFrame + "every = \"100ms\"\ntolerance = \"1ms\"\nduring = \"1s\"\n");
  fails(kFrame + "every = \"90ms\"\ntolerance = \"1ms\"\nduring = \"1s\"\n", "expected every 90 ms");
  fails(kFrame + "never = true\n" + kToEnd, "400#01020304 came on sbus at ");
  passes("[[expect]]\nbus = \"sbus\"\nframe = \"401#*\"\nnever = true\n" + kToEnd);
  passes(kFrame + "always = true\n" + kToEnd);
  fails("[[expect]]\nbus = \"sbus\"\nframe = \"401#*\"\nalways = true\n" + kToEnd, "expected only 401#*");
  passes("[[expect]]\nbus = \"sbus\"\nsequence = [\"400#01020304\"]\nrepeat = true\nduring = \"450ms\"\n");
  fails("[[expect]]\nbus = \"sbus\"\nsequence = [\"400#*\", \"401#*\"]\nduring = \"450ms\"\n",
        "expected 401#*, element 2");
  fails(kFrame + "at_most = 2\n" + kToEnd, "for the 3. time");
}

// Where a kind of expectation ends, by the check itself: a thousandth of a millisecond before and behind.
class Checked {
 public:
  explicit Checked(Expect expect, Time start = 10 * kMillisecond) : expect_(std::move(expect)), check_(expect_, start) {}
  // A frame of the pattern, or one of "b*".
  bool comes(Time at, const char* text = "a1") {
    check_.event(at, text, "");
    return check_.verdict() == Check::Verdict::Open;
  }
  Check::Verdict until(Time end) {
    check_.finish(end);
    return check_.verdict();
  }
  Check::Verdict verdict() const { return check_.verdict(); }

 private:
  Expect expect_;
  Check check_;
};

Expect frames(Expect::Kind kind) {
  Expect expect;
  expect.kind = kind;
  expect.subject.kind = Subject::Kind::Message;
  expect.subject.message = "frame";
  expect.subject.bus = "sbus";
  expect.subject.pattern = "*";
  return expect;
}

TEST(Checks, AFrameOfTheTimeItselfWasBefore) {
  Checked never(frames(Expect::Kind::Never));
  EXPECT_TRUE(never.comes(10 * kMillisecond));
  EXPECT_FALSE(never.comes(10 * kMillisecond + 1));
  Expect within = frames(Expect::Kind::Within);
  within.within = 5 * kMillisecond;
  Checked last(within), late(within);
  EXPECT_FALSE(last.comes(15 * kMillisecond));
  EXPECT_EQ(last.verdict(), Check::Verdict::Met);
  EXPECT_TRUE(late.comes(15 * kMillisecond + 1));
  EXPECT_EQ(late.until(16 * kMillisecond), Check::Verdict::Failed);
}

TEST(Checks, AtLeastIsMetByTheLastThatIsMissing) {
  Expect expect = frames(Expect::Kind::Count);
  expect.least = 2;
  expect.within = 50 * kMillisecond;
  Checked check(expect);
  EXPECT_TRUE(check.comes(11 * kMillisecond));
  EXPECT_FALSE(check.comes(12 * kMillisecond));
  EXPECT_EQ(check.verdict(), Check::Verdict::Met);
}

TEST(Checks, WhatIsToComeAgainAndAgainMayNotStop) {
  Expect expect = frames(Expect::Kind::Every);
  expect.period = 10 * kMillisecond;
  expect.tolerance = kMillisecond;
  for (const auto& [end, is] : {std::pair(41 * kMillisecond, Check::Verdict::Met),
                                {41 * kMillisecond + 1, Check::Verdict::Failed}}) {
    Checked check(expect);
    for (const Time at : {20, 30}) EXPECT_TRUE(check.comes(at * kMillisecond));
    EXPECT_EQ(check.until(end), is) << end;
  }
  Checked late(expect);
  EXPECT_TRUE(late.comes(20 * kMillisecond));
  EXPECT_TRUE(late.comes(31 * kMillisecond)) << "the tolerance";
  EXPECT_FALSE(late.comes(42 * kMillisecond + 1));
}

TEST(Checks, ASequenceThatRepeatsIsLookedAtToItsEnd) {
  Expect expect = frames(Expect::Kind::Sequence);
  expect.patterns = {"a*", "b*"};
  for (const bool repeat : {false, true}) {
    expect.repeat = repeat;
    Checked check(expect);
    EXPECT_TRUE(check.comes(11 * kMillisecond, "a1"));
    check.comes(12 * kMillisecond, "b1");
    check.comes(13 * kMillisecond, "b1");
    EXPECT_EQ(check.until(20 * kMillisecond), repeat ? Check::Verdict::Failed : Check::Verdict::Met);
  }
}

TEST(Expectations, AReportHasTheLastFourValues) {
  const CommandResult result = run_items(kCount + "at = \"105ms\"\nequals = 0\n");
  EXPECT_TRUE(contains(result.out, "unit1.lCount = 10 since 101 ms, 9 from 91 ms, 8 from 81 ms, 7 from 71 ms\n") ||
              contains(result.out, "unit1.lCount = 10 since 100 ms, 9 from 90 ms, 8 from 80 ms, 7 from 70 ms\n"))
      << result.out;
}

TEST(Expectations, StatesParametersAndProcessData) {
  passes("[[expect]]\nstation = \"unit1\"\nstate = \"running\"\nequals = 1\nat = \"50ms\"\n");
  fails("[[expect]]\nstation = \"unit1\"\nstate = \"fault\"\nequals = 8\nat = \"50ms\"\n",
        "fault of unit1 is 0");
  passes("[[expect]]\nstation = \"unit2\"\nparameter = \"P813\"\nequals = 1\nat = \"1ms\"\n");
  passes("[[expect]]\nstation = \"unit2\"\nparameter = \"P101\"\nequals = \"SBus\"\nat = \"1ms\"\n");
  fails("[[expect]]\nstation = \"unit2\"\nparameter = \"P101\"\nequals = \"RS-485\"\nat = \"1ms\"\n",
        "P101 of unit2 is 3");
  passes("[[expect]]\nstation = \"unit2\"\nprocess_data = \"PI2\"\nequals = 0\nat = \"10ms\"\n");
}

TEST(Expectations, ManyMayFailAndAllAreTold) {
  const CommandResult result =
      run_items(kCount + "at = \"95ms\"\nequals = 1\n" + kCount + "at = \"195ms\"\nequals = 2\n");
  EXPECT_TRUE(contains(result.out, "is 9 at 95 ms, expected 1"));
  EXPECT_TRUE(contains(result.out, "is 19 at 195 ms, expected 2"));
}

TEST(Steps, SetForceAndRelease) {
  const std::string step = "[[step]]\nat = \"100ms\"\nstation = \"unit1\"\nvariable = \"lCount\"\n";
  passes(step + "set = 1000\n" + kCount + "at = \"155ms\"\nmin = 1004\nmax = 1006\n");
  passes(step + "force = 1000\n" + kCount + "at = \"155ms\"\nmin = 1000\nmax = 1001\n" +
         "[[step]]\nat = \"200ms\"\nstation = \"unit1\"\nvariable = \"lCount\"\nrelease = true\n" + kCount +
         "at = \"255ms\"\nmin = 1004\nmax = 1006\n");
  passes(
      "[[step]]\nat = \"10ms\"\nstation = \"unit2\"\nparameter = \"P130\"\nset = \"2.5 s\"\n"
      "[[expect]]\nstation = \"unit2\"\nparameter = \"P130\"\nequals = 2500\n");
  passes(
      "[[step]]\nstation = \"unit2\"\ninput = \"DI02\"\nset = 1\n"
      "[[expect]]\nstation = \"unit2\"\ninput = \"DI02\"\nequals = true\n");
  fails("[[step]]\nstation = \"unit2\"\nparameter = \"P813\"\nset = 64\n" + kToEnd, "too large");
}

TEST(Steps, ProcessData) {
  passes(
      "[[step]]\nat = \"10ms\"\nstation = \"unit2\"\nprocess_data = \"PO2\"\nset = 5000\n"
      "[[step]]\nat = \"10ms\"\nstation = \"unit2\"\nprocess_data = \"PO1\"\nforce = 6\n"
      "[[expect]]\nstation = \"unit2\"\nprocess_data = \"PO2\"\nequals = 5000\n"
      "[[expect]]\nstation = \"unit2\"\nstate = \"setpoint\"\nmin = 1\nwithin = \"1s\"\n");
}

TEST(Steps, SettingAWordEndsItsForce) {
  const std::string word = "[[step]]\nstation = \"unit2\"\nprocess_data = \"PO1\"\n";
  passes(word + "at = \"10ms\"\nforce = 6\n" + word + "at = \"20ms\"\nset = 2\n" +
         "[[expect]]\nstation = \"unit2\"\nprocess_data = \"PO1\"\nequals = 2\nat = \"30ms\"\n");
}

// Control word, setpoint 1000 rpm, as a master sends them: the slave answers with its status.
TEST(Steps, SendAndAwaitFrames) {
  const std::string send = "[[step]]\nat = \"10ms\"\nbus = \"sbus\"\nsend = \"00B#000613880000\"\n";
  passes(send + "[[step]]\nbus = \"sbus\"\nawait = \"00C#*\"\nwithin = \"5ms\"\n" + kCount + "max = 2\n");
  fails(send + "[[step]]\nbus = \"sbus\"\nawait = \"00D#*\"\nwithin = \"5ms\"\n" + kCount + "equals = 99\n",
        "frame 00D#* on sbus did not come from 10 ms to 15 ms");
}

// The block check is worked out by the step: the exclusive-or of all bytes, 57h by hand. The slave answers.
TEST(Steps, SendAndAwaitTelegrams) {
  const TemporaryFolder folder;
  const std::string plant =
      "[[bus]]\nname = \"line1\"\nkind = \"rs485\"\n"
      "[[station]]\nname = \"unit1\"\nunit = \"md60a\"\nrs485 = \"line1\"\n[station.parameters]\nP810 = 1\n";
  const std::string expect =
      "[[expect]]\nbus = \"line1\"\nsequence = [\"02 01 05 00 06 3A 98 01 F4 57\", \"1D 01 05 *\"]\nduring = "
      "\"100ms\"\n";
  const std::string send =
      "[[step]]\nat = \"10ms\"\nbus = \"line1\"\nsend = \"02 01 05 00 06 3A 98 01 F4 bcc\"\n";
  const std::string await = "[[step]]\nbus = \"line1\"\nawait = \"response of 1, 3PD*\"\nwithin = \"70ms\"\n";
  folder.write("a.test.toml", plant + expect + send + await);
  CommandResult result = run_ipos({"test", "a.test.toml"}, folder.path());
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
  folder.write(
      "a.test.toml",
      plant + send + "[[expect]]\nbus = \"line1\"\ntelegram = \"1D *\"\nnever = true\nduring = \"100ms\"\n");
  result = run_ipos({"test", "a.test.toml"}, folder.path());
  EXPECT_EQ(result.exit_code, 1) << result.out << result.err;
  EXPECT_TRUE(contains(result.out, "(response of 1, 3PD")) << result.out;
}

TEST(Steps, FaultsOfLinesAndDrives) {
  const std::string cut =
      "[[step]]\nat = \"150ms\"\nfault = { bus = \"sbus\", kind = \"cut\", station = \"unit1\", until = "
      "\"200ms\" }\n";
  passes(cut + kFrame + "at = \"160ms\"\nnever = true\nduring = \"180ms\"\n" + kFrame +
         "at = \"360ms\"\nwithin = \"150ms\"\n");
  passes(
      "[[step]]\nat = \"10ms\"\nstation = \"unit2\"\ndrive_fault = 8\n"
      "[[expect]]\nstation = \"unit2\"\nstate = \"fault\"\nequals = 8\n"
      "[[step]]\nstation = \"unit2\"\nparameter = \"P840\"\nset = 1\nafter = \"10ms\"\n"
      "[[expect]]\nstation = \"unit2\"\nstate = \"fault\"\nequals = 0\nafter = \"10ms\"\n");
}

// A fault that a step brings is what its author had in mind; one beside it is not.
TEST(Steps, AFaultThatAStepBringsIsExpected) {
  const std::string fault = "[[step]]\nat = \"10ms\"\nstation = \"unit2\"\ndrive_fault = 8\n";
  passes(fault + kCount + "at = \"50ms\"\nmin = 1\n");
}

TEST(Steps, ProgramsStopAndBeginAnew) {
  const std::string stop = "[[step]]\nat = \"100ms\"\nstation = \"unit1\"\nprogram = \"stop\"\n";
  passes(stop + kCount + "at = \"300ms\"\nmax = 10\n" +
         "[[step]]\nstation = \"unit1\"\nprogram = \"start\"\n"
         "[[expect]]\nstation = \"unit1\"\nstate = \"running\"\nequals = 1\n" +
         kCount + "min = 12\nwithin = \"100ms\"\n");
  fails("[[step]]\nat = \"100ms\"\nstation = \"unit1\"\nprogram = \"start\"\n" + kToEnd,
        "the program runs already");
}

TEST(Steps, PowerOffAndOn) {
  passes(
      "[[step]]\nat = \"100ms\"\nstation = \"unit1\"\npower = \"off\"\n"
      "[[expect]]\nstation = \"unit1\"\nstate = \"powered\"\nequals = 0\n" +
      kFrame +
      "after = \"1ms\"\nnever = true\nduring = \"200ms\"\n"
      "[[step]]\nat = \"350ms\"\nstation = \"unit1\"\npower = \"on\"\n" +
      kCount + "note = \"variables begin at 0\"\nafter = \"55ms\"\nmin = 4\nmax = 6\n" + kFrame +
      "within = \"150ms\"\n");
}

TEST(Steps, AStepActsInItsMillisecondAndAnExpectationLooksAfterIt) {
  passes(
      "[[step]]\nat = \"100ms\"\nstation = \"unit1\"\nvariable = \"lOther\"\nset = 7\n"
      "[[expect]]\nstation = \"unit1\"\nvariable = \"lOther\"\nequals = 0\nat = \"99ms\"\n"
      "[[expect]]\nstation = \"unit1\"\nvariable = \"lOther\"\nequals = 7\nat = \"100ms\"\n");
}

}  // namespace
}  // namespace ipos::tests
