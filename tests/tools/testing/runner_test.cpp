// The runner around the tests: finding, choosing, repeating, cases, comments, mistakes and exit codes.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <set>
#include <stdexcept>

#include "tests/harness/contains.hpp"
#include "tests/tools/command.hpp"
#include "tools/test_file/read_tests.hpp"
#include "tools/testing/suite.hpp"

namespace ipos::tests {
namespace {

size_t lines(const std::string& text) {
  return static_cast<size_t>(std::count(text.begin(), text.end(), '\n'));
}

const std::string kProgram = "long a, b;\nmain()\n{\n  a = 5;  // expect a == 5\n  while (b < 3) b++;\n}\n";
const std::string kStation = "[[station]]\nname = \"u\"\nunit = \"md60a\"\nprogram = \"A.IPC\"\n";
const std::string kGood = kStation + "[[expect]]\nvariable = \"a\"\nequals = 5\nat = \"100ms\"\n";
const std::string kBad = kStation + "[[expect]]\nvariable = \"a\"\nequals = 6\nat = \"100ms\"\n";

class Runner : public ::testing::Test {
 protected:
  void SetUp() override { folder_.write("A.IPC", kProgram); }
  CommandResult run(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "test");
    return run_ipos(arguments, folder_.path());
  }
  // The message about a malformed file.
  std::string mistake(const std::string& text) const {
    folder_.write("bad.test.toml", text);
    const CommandResult result = run({"bad.test.toml"});
    EXPECT_EQ(result.exit_code, 65) << text << result.out << result.err;
    return result.out;
  }
  TemporaryFolder folder_;
};

TEST_F(Runner, FoldersAreSearched) {
  std::filesystem::create_directory(folder_.path() / "sub");
  folder_.write("sub/one.test.toml", "plant = \"../p.toml\"\nplant_expects = true\n");
  folder_.write("two.test.toml", kGood);
  folder_.write("p.toml", kGood.substr(0, kStation.size()) +
                              "[[expect]]\nstation = \"u\"\nvariable = \"a\"\nequals = 5\nat = \"1s\"\n");
  folder_.write("QUIET.IPC", "main() { }\n");
  const CommandResult list = run({".", "--list"});
  EXPECT_EQ(list.exit_code, 0);
  EXPECT_EQ(list.out, "A.IPC  A.IPC:1\nsub/one  sub/one.test.toml:1\ntwo  two.test.toml:1\n");
  const CommandResult all = run({"."});
  EXPECT_EQ(all.exit_code, 0) << all.out << all.err;
  EXPECT_TRUE(contains(all.out, "3 tests, 3 passed\n")) << all.out;
}

TEST_F(Runner, NamesAreChosenByPatterns) {
  folder_.write("one.test.toml", kGood);
  folder_.write("two.test.toml", kGood);
  EXPECT_EQ(lines(run({".", "--list", "--filter", "t*"}).out), 1U);
  EXPECT_EQ(lines(run({".", "--list", "--filter", "one,two"}).out), 2U);
  const CommandResult none = run({".", "--filter", "x*"});
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_TRUE(contains(none.err, "there is no test of that name")) << none.err;
}

TEST_F(Runner, ExitCodes) {
  folder_.write("good.test.toml", kGood);
  folder_.write("bad.test.toml", kBad);
  folder_.write("broken.test.toml", "x = 1\n");
  EXPECT_EQ(run({"good.test.toml"}).exit_code, 0);
  EXPECT_EQ(run({"bad.test.toml"}).exit_code, 1);
  EXPECT_EQ(run({"bad.test.toml", "broken.test.toml"}).exit_code, 65);
  EXPECT_EQ(run({"nowhere.test.toml"}).exit_code, 66);
  EXPECT_EQ(run({"good.test.toml", "--junit", "/nowhere/a.xml"}).exit_code, 74);
  EXPECT_EQ(run({}).exit_code, run({"."}).exit_code) << "no path is the folder we are in";
  EXPECT_EQ(run({"notes.txt"}).exit_code, 66);
  folder_.write("notes.txt", "no test");
  EXPECT_EQ(run({"notes.txt"}).exit_code, 64);
  EXPECT_EQ(run({"good.test.toml", "--jobs", "0"}).exit_code, 64);
  EXPECT_EQ(run({"good.test.toml", "--diagnostics", "json"}).exit_code, 64);
  EXPECT_EQ(run({"good.test.toml", "--unit", "robot"}).exit_code, 64);
}

TEST_F(Runner, ATestThatLooksAtNothingFails) {
  folder_.write("empty.test.toml", kStation + "[[step]]\nwait = \"100ms\"\n");
  const CommandResult result = run({"empty.test.toml"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(contains(result.out, "the test expects nothing")) << result.out;
  folder_.write("p.toml", kStation);
  EXPECT_EQ(run({"p.toml"}).exit_code, 1);
  std::filesystem::create_directory(folder_.path() / "none");
  EXPECT_EQ(run({"none"}).exit_code, 1);
}

TEST_F(Runner, FailFastBeginsNoOther) {
  folder_.write("a.test.toml", kBad);
  folder_.write("b.test.toml", kGood);
  const CommandResult result = run({"a.test.toml", "b.test.toml", "--fail-fast", "--jobs", "1"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(contains(result.out, "not run b\n")) << result.out;
  EXPECT_TRUE(contains(result.out, "2 tests, 0 passed, 1 failed, 1 not run\n")) << result.out;
}

TEST_F(Runner, JobsDoNotChangeTheReport) {
  for (int n = 0; n < 12; ++n) folder_.write(fmt::format("t{:02}.test.toml", n), n % 3 == 0 ? kBad : kGood);
  const CommandResult one = run({".", "--jobs", "1"});
  const CommandResult four = run({".", "--jobs", "4"});
  EXPECT_EQ(one.out, four.out);
  EXPECT_TRUE(contains(one.out, "13 tests, 9 passed, 4 failed\n")) << one.out;
}

// Half of the frames are lost by chance: another seed loses others, the same seed the same ones.
TEST_F(Runner, SeedsMoveChance) {
  folder_.write(
      "S.IPC",
      "#include <const.h>\nSCTRCYCL Tr;\nlong d;\nmain()\n{\n  Tr.ObjectNo = 1024;\n  Tr.CycleTime = 10;\n"
      "  Tr.Format = 4;\n  Tr.DPointer = numof(d);\n  _SBusCommDef(SCD_TRCYCL, Tr);\n  _SBusCommOn();\n"
      "  while (1) d++;\n}\n");
  folder_.write(
      "R.IPC",
      "#include <const.h>\nSCREC Rec;\nlong d;\nmain()\n{\n  Rec.ObjectNo = 1024;\n  Rec.Format = 4;\n"
      "  Rec.DPointer = numof(d);\n  _SBusCommDef(SCD_REC, Rec);\n  _SBusCommOn();\n  while (1) ;\n}\n");
  folder_.write("seed.test.toml",
                "[[bus]]\nname = \"sbus\"\nkind = \"can\"\n"
                "[[station]]\nname = \"s\"\nunit = \"md60a\"\nprogram = \"S.IPC\"\nsbus = \"sbus\"\n"
                "[[station]]\nname = \"r\"\nunit = \"md60a\"\nprogram = \"R.IPC\"\nsbus = \"sbus\"\n"
                "[station.parameters]\nP813 = 1\n"
                "[[fault]]\nbus = \"sbus\"\nkind = \"drop\"\nrate = 500\nseed = 7\n"
                "[[expect]]\nstation = \"r\"\nvariable = \"d\"\nequals = -1\nat = \"505ms\"\n");
  const auto report = [&](const char* seed) { return run({"seed.test.toml", "--seed", seed}).out; };
  const auto seeds_move_it = [&] {
    EXPECT_EQ(report("1"), report("1"));
    std::set<std::string> reports;
    for (const char* seed : {"1", "2", "3", "4"}) {
      const std::string text = report(seed);
      reports.insert(text.substr(text.find("d of r is")));
    }
    EXPECT_GE(reports.size(), 2U);
  };
  seeds_move_it();
  const CommandResult again = run({"seed.test.toml", "--repeat", "3", "--seed", "10", "--artifacts", "left"});
  for (const char* part : {"seed#1", "seed#2", "seed#3", "seed 10\n", "seed 11\n", "seed 12\n", "3 tests, "})
    EXPECT_TRUE(contains(again.out, part)) << part << again.out;
  // Each run has left what it reports: the last column but one is r.d.
  for (const char* turn : {"seed_1", "seed_2", "seed_3"}) {
    const std::string told = read_text(folder_.path() / "left" / turn / "report.txt");
    const std::string trace = read_text(folder_.path() / "left" / turn / "trace.csv");
    const size_t is = told.find("d of r is ") + 10, row = trace.find("\n505,");
    ASSERT_NE(row, std::string::npos) << trace;
    const std::string number = told.substr(is, told.find(' ', is) - is);
    EXPECT_TRUE(contains(trace.substr(row, trace.find('\n', row + 1) - row), "," + number + ",")) << turn << told;
  }
  // The same fault as a step.
  std::string step = read_text(folder_.path() / "seed.test.toml");
  const size_t begin = step.find("[[fault]]");
  step.replace(begin, step.find("[[expect]]") - begin,
               "[[step]]\nat = \"1ms\"\nfault = { bus = \"sbus\", kind = \"drop\", rate = 500, seed = 7 }\n");
  folder_.write("seed.test.toml", step);
  seeds_move_it();
}

TEST_F(Runner, CasesRunTheSameTestOverManyValues) {
  folder_.write("case.test.toml",
                kStation +
                    "[[case]]\nname = \"at once\"\nwhen = \"100ms\"\nvalue = 5\n"
                    "[[case]]\nname = \"later\"\nwhen = \"2s\"\nvalue = 0x5\n"
                    "[[case]]\nwhen = \"1s\"\nvalue = 6\n"
                    "[[expect]]\nnote = \"${when}: ${value}\"\nvariable = \"a\"\nequals = \"$value\"\n"
                    "at = \"$when\"\n");
  const CommandResult result = run({"case.test.toml"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(contains(result.out, "ok      case/at once  1 check in 0.100 s\n")) << result.out;
  EXPECT_TRUE(contains(result.out, "ok      case/later  1 check in 2.000 s\n")) << result.out;
  EXPECT_TRUE(contains(result.out, "FAILED  case/3  1 check in 1.000 s\n")) << result.out;
  EXPECT_TRUE(contains(result.out, "(1s: 6)\n")) << result.out;
  EXPECT_TRUE(contains(
      mistake(kStation + "[[case]]\nx = 1\n[[expect]]\nvariable = \"a\"\nequals = \"$y\"\nat = \"1s\"\n"),
      "bad.test.toml:9:10: error: case '1' has no value 'y'\n"));
  EXPECT_TRUE(contains(mistake(kStation + "[[expect]]\nvariable = \"a\"\nequals = \"$y\"\n"),
                       "bad.test.toml:7:10: error: '$y' is a value of a [[case]], and there is none\n"));
}

TEST_F(Runner, MistakesHaveTheirPlace) {
  struct Row {
    std::string items;
    std::string message;
  };
  for (const Row& row : std::vector<Row>{
           {"[[expect]]\nvariable = \"a\"\nequal = 5\n",
            "bad.test.toml:7:1: error: unknown key 'equal' in [[expect]]"},
           {"[[expect]]\nvariable = \"a\"\n", "bad.test.toml:5:1: error: an [[expect]] needs equals"},
           {"[[expect]]\nvariable = \"c\"\nequals = 5\n",
            "bad.test.toml:5:1: error: station 'u' has no variable 'c'"},
           {"[[expect]]\nequals = 5\n", "bad.test.toml:5:1: error: an [[expect]] needs one of variable"},
           {"[[expect]]\nvariable = \"a\"\nequals = \"x\"\n",
            "bad.test.toml:7:10: error: equals must be a whole number"},
           {"[[expect]]\nvariable = \"a\"\nequals = 5\nat = \"soon\"\n",
            "bad.test.toml:8:6: error: 'soon' is no time"},
           {"[[expect]]\nvariable = \"a\"\nequals = 5\nmin = 3\n",
            "bad.test.toml:5:1: error: an [[expect]] has one of"},
           {"[[expect]]\nvariable = \"a\"\nequals = 5\nalways = true\nnever = true\n",
            "bad.test.toml:9:9: error: an [[expect]] has either always or never"},
           {"[[expect]]\nstate = \"tired\"\nequals = 5\n", "bad.test.toml:6:9: error: 'tired' is no state"},
           {"[[expect]]\nbus = \"x\"\nframe = \"4*\"\nnever = true\n",
            "bad.test.toml:6:7: error: there is no bus 'x'"},
           {"[[step]]\nwait = \"1s\"\npower = \"on\"\n",
            "bad.test.toml:7:9: error: a [[step]] does one thing: wait or power"},
           {"[[step]]\nfoo = 1\n", "bad.test.toml:5:1: error: a [[step]] needs one of wait"},
           {"[[step]]\npower = \"high\"\n", "bad.test.toml:6:9: error: power is one of off, on"},
           {"[[step]]\nvariable = \"a\"\n",
            "bad.test.toml:5:1: error: a [[step]] needs set, force, pulse or release"},
           {"[[step]]\nstation = \"w\"\nvariable = \"a\"\nset = 1\n",
            "bad.test.toml:6:11: error: there is no station 'w'"},
       }) {
    const std::string out = mistake(kStation + row.items);
    EXPECT_TRUE(contains(out, row.message)) << row.items << out;
  }
  EXPECT_TRUE(contains(mistake("plant = \"none.toml\"\n"),
                       "bad.test.toml:1:9: error: plant none.toml: No such file"));
  EXPECT_TRUE(contains(mistake("a = \n"), "bad.test.toml:1:"));
  EXPECT_TRUE(contains(mistake("[[bus]]\nname = \"b\"\nkind = \"can\"\nport = \"vcan0\"\n" + kStation +
                               "[[expect]]\nvariable = \"a\"\nequals = 5\n"),
                       "bad.test.toml:4:8: error: bus 'b' is joined to port 'vcan0'"));
}

// In the signal's unit, as an expectation of it counts.
TEST_F(Runner, AStepSetsAnySignalThatCanBeWritten) {
  folder_.write("load.test.toml",
                kStation + "[[step]]\nsignal = \"load_torque\"\nset = \"3 Nm\"\n[[expect]]\nsignal = \"load_torque\"\nequals = 3\n"
                "[[step]]\nsignal = \"load_torque\"\nforce = -4\n[[expect]]\nsignal = \"load_torque\"\nequals = -4\nafter = \"10ms\"\n"
                "[[step]]\nsignal = \"load_torque\"\npulse = 7\nfor = \"20ms\"\n[[expect]]\nsignal = \"load_torque\"\nequals = 7\nafter = \"10ms\"\n");
  const CommandResult good = run({"load.test.toml"});
  EXPECT_EQ(good.exit_code, 0) << good.out << good.err;
  EXPECT_TRUE(contains(mistake(kStation + "[[step]]\nsignal = \"torque\"\nset = 3\n"), "bad.test.toml:5:1: error: torque of u can only be read"));
  EXPECT_TRUE(contains(mistake(kStation + "[[step]]\nsignal = \"load_torque\"\nset = \"3 kg\"\n"), "bad.test.toml:5:1: error: '3 kg' is no number"));
}

TEST_F(Runner, ATimeThatIsOverEndsTheTest) {
  folder_.write(
      "late.test.toml",
      kStation + "[[step]]\nwait = \"1s\"\n[[expect]]\nvariable = \"a\"\nequals = 5\nat = \"500ms\"\n");
  const CommandResult result = run({"late.test.toml"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(contains(result.out, "late.test.toml:7:1: its time, 500 ms, is over")) << result.out;
}

TEST_F(Runner, ProgramsThatDoNotCompileAreErrors) {
  folder_.write("A.IPC", "main()\n{\n  a = 5;\n}\n");
  folder_.write("a.test.toml", kGood);
  const CommandResult result = run({"a.test.toml"});
  EXPECT_EQ(result.exit_code, 65);
  EXPECT_TRUE(contains(result.out, "A.IPC:3:3: error: ")) << result.out;
}

TEST_F(Runner, AFaultThatNothingExpectsFailsTheTest) {
  folder_.write("F.IPC", "long a, p;\nmain()\n{\n  a = 5;\n  p = 100000;\n  *p = 1;\n}\n");
  const std::string station = "[[station]]\nname = \"u\"\nunit = \"md60a\"\nprogram = \"F.IPC\"\n";
  const std::string expect = "[[expect]]\nvariable = \"a\"\nequals = 5\nat = \"100ms\"\n";
  folder_.write("f.test.toml", station + expect);
  const CommandResult result = run({"f.test.toml"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(contains(result.out, "u has a fault at ")) << result.out;
  EXPECT_TRUE(contains(result.out, "F.IPC:6:")) << result.out;
  folder_.write("g.test.toml", station + expect + "[[expect]]\nstate = \"program_fault\"\nnot = 0\n");
  EXPECT_EQ(run({"g.test.toml"}).exit_code, 0) << run({"g.test.toml"}).out;
}

// The plant's own expectations are of its own test, unless another one asks for them; they are found in the plant's file.
TEST_F(Runner, ExpectationsOfThePlantAreLookedAtWhereTheTestSaysSo) {
  folder_.write("p.toml", kStation + "[[expect]]\nstation = \"u\"\nvariable = \"a\"\nequals = 6\nat = \"100ms\"\n");
  const std::string own = "[[expect]]\nvariable = \"a\"\nequals = 5\nat = \"100ms\"\n";
  folder_.write("a.test.toml", "plant = \"p.toml\"\n" + own);
  EXPECT_EQ(run({"a.test.toml"}).exit_code, 0) << run({"a.test.toml"}).out;
  folder_.write("b.test.toml", "plant = \"p.toml\"\nplant_expects = true\n" + own);
  const CommandResult result = run({"b.test.toml"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(contains(result.out, "  p.toml:5:1: a of u is 5")) << result.out;
}

// A test begins with an empty memory and leaves none behind.
TEST_F(Runner, ATestHasNoMemoryOfUnits) {
  folder_.write("p.toml", kStation + "nvram = \"u.nv\"\n");
  folder_.write("a.test.toml", "plant = \"p.toml\"\n[[expect]]\nvariable = \"a\"\nequals = 5\nat = \"100ms\"\n");
  folder_.write("b.test.toml", kStation + "nvram = \"u.nv\"\n[[expect]]\nvariable = \"a\"\nequals = 5\nat = \"100ms\"\n");
  for (const char* test : {"a.test.toml", "b.test.toml"}) EXPECT_EQ(run({test}).exit_code, 0) << run({test}).out;
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "u.nv"));
}

// The numbers on both sides of what is expected.
TEST_F(Runner, ComparisonsOfCommentsEndWhereTheySay) {
  const auto holds = [&](const std::string& comparison) {
    folder_.write("X.IPC", "long a;\nmain()\n{\n  a = 5;  // expect a " + comparison + "\n}\n");
    return run({"X.IPC"}).exit_code == 0;
  };
  for (const char* good : {"< 6", "<= 5", "> 4", ">= 5", "== 5", "!= 4"}) EXPECT_TRUE(holds(good)) << good;
  for (const char* bad : {"< 5", "<= 4", "> 5", ">= 6", "== 4", "!= 5"}) EXPECT_FALSE(holds(bad)) << bad;
}

TEST_F(Runner, CommentsOfAProgram) {
  EXPECT_EQ(run({"A.IPC"}).exit_code, 0) << run({"A.IPC"}).out;
  folder_.write("B.IPC",
                "long a, b[4], n;\nmain()\n{\n  b[3] = 9;  // expect b[3] == 9 // expect H5 == 0 at 100ms\n"
                "  while (1)\n  {\n    _Wait(50);\n    a++;  // expect a >= 3 within 300ms // expect a != 7 "
                "at 90ms\n  }\n}\n");
  CommandResult result = run({"B.IPC"});
  EXPECT_EQ(result.exit_code, 1) << "it does not end";
  EXPECT_TRUE(contains(result.out, "the program does not end within 60000 ms")) << result.out;
  folder_.write("C.IPC", "long a;\nmain()\n{\n  a = 7;  // expect a == 8 at 100ms\n  while (1) ;\n}\n");
  result = run({"C.IPC"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(contains(result.out, "C.IPC:4:11: a of C is 7 at 100 ms, expected 8\n")) << result.out;
  EXPECT_TRUE(contains(result.out, "> 4 |   a = 7;  // expect a == 8 at 100ms\n")) << result.out;
  folder_.write("D.IPC", "long a;\nmain()\n{\n  a = 7;  // expect a = 8\n}\n");
  result = run({"D.IPC"});
  EXPECT_EQ(result.exit_code, 65);
  EXPECT_TRUE(contains(result.out, "D.IPC:4:11: error: not understood")) << result.out;
}

// Each worker asks whether there was a signal, whichever thread it came to.
TEST_F(Runner, ASignalEndsAllWorkers) {
  folder_.write("a.test.toml", kGood);
  for (const char* name : {"b.test.toml", "c.test.toml", "d.test.toml", "e.test.toml"})
    folder_.write(name, kStation + "[[expect]]\nvariable = \"a\"\nequals = 5\nat = \"1000000s\"\n");
  RunningIpos tests({"test", ".", "--jobs", "4"}, folder_.path());
  ASSERT_TRUE(tests.prints("ok      a"));
  tests.signal(SIGINT);
  const CommandResult result = tests.wait();
  EXPECT_EQ(result.exit_code, 130) << result.err;
  EXPECT_TRUE(contains(result.out, "interrupted")) << result.out;
}

// Where collectors attach themselves: once a test, before anything happens, and gone before the plant is.
TEST(Prepare, SeesEachPlantBeforeItsFirstEvent) {
  const TemporaryFolder folder;
  folder.write("A.IPC", kProgram);
  const auto tests = tools::testing::read_test_file((folder.path() / "a.test.toml").string(), kGood);
  tools::testing::SuiteOptions options;
  options.repeat = 3;
  options.jobs = 2;
  std::atomic<int> begun = 0, ended = 0;
  options.run.prepare = [&](runtime::Plant& plant) -> std::shared_ptr<void> {
    EXPECT_EQ(plant.now(), 0);
    EXPECT_NE(plant.stations()[0]->machine(), nullptr);
    ++begun;
    return {nullptr, [&](void*) { ++ended; }};
  };
  for (const auto& result : tools::testing::run_suite(tests, options))
    EXPECT_EQ(result.outcome, tools::testing::Outcome::Passed);
  EXPECT_EQ(begun, 3);
  EXPECT_EQ(ended, 3);
}

// As on a full disk: the program tells it and ends in good order, whichever thread it happens in.
TEST(Listener, PassesItsExceptionOnFromEveryThread) {
  const TemporaryFolder folder;
  folder.write("A.IPC", kProgram);
  const auto tests = tools::testing::read_test_file((folder.path() / "a.test.toml").string(), kGood);
  tools::testing::SuiteOptions options;
  options.repeat = 50;
  for (options.jobs = 1; options.jobs <= 4; ++options.jobs) {
    const auto listen = [](const auto&, size_t done, size_t) {
      if (done >= 5) throw std::runtime_error("no space");
    };
    EXPECT_THROW(tools::testing::run_suite(tests, options, listen), std::runtime_error) << options.jobs;
  }
}

// The programs of the compiler's own suite say in the same words what must come out.
TEST(Comments, OfTheLanguageProgramsHold) {
  const CommandResult result = run_ipos({"test", project("tests/language").string(), "--speed", "1000"});
  EXPECT_EQ(result.exit_code, 0) << result.out;
}

}  // namespace
}  // namespace ipos::tests
