// The command line contract: what goes where, exit codes, and a located message for each mistake a user can
// make.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/harness/contains.hpp"
#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

using ::testing::Test;

const std::string kProgram = "long a;\nmain()\n{\n  a = 5;\n}\n";

TEST(Usage, WrongCommandLinesAre64) {
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{},
                                                    {"frobnicate"},
                                                    {"run"},
                                                    {"run", "x.IPC", "--for", "soon"},
                                                    {"run", "x.IPC", "--speed", "0"},
                                                    {"build", "x.IPC", "--emit=pdf"},
                                                    {"run", "x.IPC", "--format", "xml"},
                                                    {"build", "notes.txt"}}) {
    const CommandResult result = run_ipos(arguments);
    EXPECT_EQ(result.exit_code, 64);
    EXPECT_EQ(result.out, "");
    EXPECT_FALSE(result.err.empty());
  }
}

TEST(Usage, HelpAndVersion) {
  EXPECT_EQ(run_ipos({"--help"}).exit_code, 0);
  EXPECT_TRUE(contains(run_ipos({"--version"}).out, "ipos "));
  for (const std::string verb :
       {"build", "run", "test", "disasm", "verify", "asm", "explain", "fmt", "lsp"}) {
    const CommandResult result = run_ipos({verb, "--help"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_TRUE(contains(result.out, "Example")) << verb;
  }
}

// The table is read here by itself: cmake/notices.cmake made the text.
TEST(Usage, LicencesOfAllThatItContains) {
  const CommandResult result = run_ipos({"--licences"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(run_ipos({"--licenses"}).out, result.out);
  EXPECT_TRUE(contains(result.out, read_text(project("LICENSE").string())));
  std::istringstream table(read_text(project("packaging/third_parties.tsv").string()));
  size_t count = 0;
  for (std::string line; std::getline(table, line);) {
    std::istringstream row(line);
    std::vector<std::string> cells;
    for (std::string cell; std::getline(row, cell, '\t');) cells.push_back(cell);
    if (line.starts_with("#")) continue;
    ASSERT_EQ(cells.size(), 7U) << line;
    const std::string in = " " + cells[5] + " ";
    const bool is_here = contains(in, " linux ") || contains(in, " page ") || contains(in, " plot ");
    EXPECT_EQ(contains(result.out, "\n----\n" + cells[0] + " " + cells[1] + ", " + cells[2] + "\n"), is_here) << line;
    const std::string text = read_text(project("packaging/licences/" + cells[3] + ".txt").string());
    EXPECT_FALSE(text.empty()) << line;
    EXPECT_TRUE(!is_here || contains(result.out, text)) << line;
    count += is_here;
  }
  EXPECT_GT(count, 30U);
}

TEST(Input, MissingFilesAre66) {
  for (const std::string verb : {"build", "run"}) {
    const CommandResult result = run_ipos({verb, "/nowhere/X.IPC"});
    EXPECT_EQ(result.exit_code, 66) << verb;
    EXPECT_TRUE(contains(result.err, "/nowhere/X.IPC")) << result.err;
  }
  EXPECT_EQ(run_ipos({"verify", "/nowhere/X.ipx"}).exit_code, 66);
  EXPECT_EQ(run_ipos({"run", "/nowhere/plant.toml"}).exit_code, 66);
}

TEST(Input, UnwritableOutputIs74) {
  const TemporaryFolder folder;
  const std::string file = folder.write("A.IPC", kProgram);
  EXPECT_EQ(run_ipos({"build", file, "-o", "/nowhere/a.ipx"}).exit_code, 74);
  EXPECT_EQ(run_ipos({"run", file, "--for", "1ms", "--log", "/nowhere/a.log"}).exit_code, 74);
}

TEST(Input, ThatDoesNotExistIs66InEveryVerb) {
  EXPECT_EQ(run_ipos({"test", "/nowhere"}).exit_code, 66);
  EXPECT_EQ(run_ipos({"fmt", "/nowhere.IPC"}).exit_code, 66);
  EXPECT_EQ(run_ipos({"bus", "decode", "/nowhere.log"}).exit_code, 66);
}

TEST(Output, AnInputIsNotOverwritten) {
  const TemporaryFolder folder;
  folder.write("A.IPC", kProgram);
  EXPECT_EQ(run_ipos({"build", "A.IPC", "-o", "A.IPC"}, folder.path()).exit_code, 64);
  EXPECT_EQ(run_ipos({"run", "A.IPC", "--for", "1ms", "--log", "A.IPC"}, folder.path()).exit_code, 64);
  EXPECT_EQ(read_text(folder.path() / "A.IPC"), kProgram);
}

TEST(Run, ALogOnStandardOutputStandsThereAlone) {
  const std::string plant = project("examples/scom/scom.toml").string();
  const TemporaryFolder folder;
  const CommandResult in_file = run_ipos({"run", plant, "--for", "1s", "--log", "can.log"}, folder.path());
  ASSERT_EQ(in_file.exit_code, 0) << in_file.err;
  const CommandResult out = run_ipos({"run", plant, "--for", "1s", "--log", "-"}, folder.path());
  EXPECT_EQ(out.exit_code, 0) << out.err;
  EXPECT_EQ(out.out, read_text(folder.path() / "can.log"));
  EXPECT_TRUE(contains(out.err, in_file.out)) << "the report gives way";
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "-"));
  EXPECT_EQ(run_ipos({"run", plant, "--for", "1ms", "--log", "-", "--plot", "-"}).exit_code, 64);
}

TEST(Run, SaysWhyItEndsWithOne) {
  const TemporaryFolder folder;
  folder.write("A.IPC", "long a;\nmain()\n{\n    a = 1 / a;\n}\n");
  const std::string station = "[[station]]\nname = \"u\"\nunit = \"md60a\"\nprogram = \"A.IPC\"\n";
  const auto run = [&](const std::string& expect) {
    folder.write("p.toml", station + expect);
    return run_ipos({"run", "p.toml", "--for", "20ms"}, folder.path());
  };
  const std::string why = "ipos: exit code 1: u has fault F10, which no [[expect]] looks for\n";
  CommandResult result = run("");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(contains(result.err, why)) << result.err;
  const std::string expect = "[[expect]]\nstation = \"u\"\nat = \"10ms\"\n";
  for (const std::string state : {"fault", "program_fault"}) {
    result = run(expect + "state = \"" + state + "\"\nequals = 10\n");
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_FALSE(contains(result.err, why)) << result.err;
  }
  // Another fault, none, or a state that tells no fault foresee nothing.
  EXPECT_EQ(run(expect + "state = \"fault\"\nequals = 8\n").exit_code, 1);
  EXPECT_EQ(run(expect + "state = \"powered\"\nequals = 1\n").exit_code, 1);
  result = run(expect + "state = \"falut\"\nequals = 1\n");
  EXPECT_EQ(result.exit_code, 65);
  EXPECT_TRUE(contains(result.err, "p.toml:8:9: error: 'falut' is no state; known are fault, status"))
      << result.err;
}

TEST(Run, NamesOfOneStationGiveNoSectionOfAnother) {
  const TemporaryFolder folder;
  folder.write("A.IPC", "long lOne;\nmain()\n{\n    lOne = 1;\n}\n");
  folder.write("B.IPC", "long lTwo;\nmain()\n{\n    lTwo = 1;\n}\n");
  folder.write("p.toml",
               "[[station]]\nname = \"a\"\nunit = \"md60a\"\nprogram = \"A.IPC\"\n"
               "[[station]]\nname = \"b\"\nunit = \"md60a\"\nprogram = \"B.IPC\"\n");
  const CommandResult result = run_ipos({"run", "p.toml", "--for", "1ms", "--watch=lTwo"}, folder.path());
  EXPECT_EQ(result.out.substr(0, 3), "b (") << result.out;
}

// The notation of the option parser is not that of people.
TEST(Usage, HelpIsReadable) {
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"run"}, {"disasm"}, {"debug"}, {"bus", "monitor"}, {"watch"}}) {
    std::vector<std::string> arguments = words;
    arguments.emplace_back("--help");
    const std::string help = run_ipos(arguments).out;
    for (const char* part : {"{*}", "{false}", "TEXT:", "UINT:", "ENUM", "18446744073709551615", "{,"})
      EXPECT_FALSE(contains(help, part)) << words[0] << " shows " << part << "\n" << help;
  }
}

TEST(Build, SyntaxErrorIsLocated) {
  const TemporaryFolder folder;
  folder.write("A.IPC", "long a;\nmain()\n{\n  a = ;\n}\n");
  const CommandResult result = run_ipos({"build", "A.IPC"}, folder.path());
  EXPECT_EQ(result.exit_code, 65);
  EXPECT_TRUE(result.err.starts_with("A.IPC:4:7: error: ")) << result.err;
  EXPECT_TRUE(contains(result.err, "  a = ;\n")) << result.err;
  EXPECT_TRUE(contains(result.err, "^")) << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "A.ipx"));
}

TEST(Build, UnknownNameIsLocated) {
  const TemporaryFolder folder;
  folder.write("A.IPC", "long speed;\nmain()\n{\n  spede = 1;\n}\n");
  const CommandResult result = run_ipos({"build", "A.IPC"}, folder.path());
  EXPECT_EQ(result.exit_code, 65);
  EXPECT_TRUE(result.err.starts_with("A.IPC:4:3: error: ")) << result.err;
  EXPECT_TRUE(contains(result.err, "speed")) << "a suggestion is expected: " << result.err;
}

TEST(Build, MissingIncludeIsLocated) {
  const TemporaryFolder folder;
  folder.write("A.IPC", "#include <missing.h>\nmain() { }\n");
  const CommandResult result = run_ipos({"build", "A.IPC"}, folder.path());
  EXPECT_EQ(result.exit_code, 65);
  EXPECT_TRUE(result.err.starts_with("A.IPC:1:")) << result.err;
  EXPECT_TRUE(contains(result.err, "missing.h")) << result.err;
}

TEST(Build, WritesAnImageThatIsTheSameEachTime) {
  const TemporaryFolder folder;
  const std::string source = project("examples/scom/SCOM1.IPC").string();
  EXPECT_EQ(run_ipos({"build", source, "-o", "a.ipx"}, folder.path()).exit_code, 0);
  EXPECT_EQ(run_ipos({"build", source, "-o", "b.ipx"}, folder.path()).exit_code, 0);
  const std::string image = read_text(folder.path() / "a.ipx");
  EXPECT_FALSE(image.empty());
  EXPECT_EQ(image, read_text(folder.path() / "b.ipx"));
  EXPECT_EQ(run_ipos({"verify", "a.ipx"}, folder.path()).exit_code, 0);
}

TEST(Build, EveryStageCanBePrinted) {
  const std::string source = project("examples/scom/SCOM1.IPC").string();
  const auto stage = [&](const std::string& name) {
    const CommandResult result = run_ipos({"build", source, "--emit=" + name});
    EXPECT_EQ(result.exit_code, 0) << name << result.err;
    return result.out;
  };
  EXPECT_TRUE(contains(stage("tokens"), "TrCycl"));
  EXPECT_TRUE(contains(stage("ast"), "main"));
  EXPECT_TRUE(contains(stage("asm"), "SCOM TRANSMIT CYCLIC, H420"));
  EXPECT_TRUE(contains(stage("image"), "TrCycl.ObjectNo"));
  EXPECT_TRUE(contains(stage("map"), "lTrDataLow"));
  EXPECT_TRUE(contains(stage("listing"), "SCOMON"));
  EXPECT_TRUE(contains(stage("c"), "static const uint32_t SCOM1_image[] = {\n    0x31585049,"));
}

TEST(Images, DisassembledTextAssemblesToTheSameBytes) {
  const TemporaryFolder folder;
  for (const std::string name : {"scom/SCOM1", "scom-intel/SCOM2_Intel", "movilink/Movilink"}) {
    ASSERT_EQ(run_ipos({"build", project("examples/" + name + ".IPC").string(), "-o", "a.ipx"}, folder.path())
                  .exit_code,
              0);
    const CommandResult text = run_ipos({"disasm", "a.ipx"}, folder.path());
    ASSERT_EQ(text.exit_code, 0);
    folder.write("a.ipa", text.out);
    const CommandResult back = run_ipos({"asm", "a.ipa", "-o", "b.ipx"}, folder.path());
    ASSERT_EQ(back.exit_code, 0) << back.err;
    EXPECT_EQ(read_text(folder.path() / "a.ipx"), read_text(folder.path() / "b.ipx")) << name;
  }
}

TEST(Images, OneFlippedByteIsRefused) {
  const TemporaryFolder folder;
  const std::string source = folder.write("A.IPC", kProgram);
  ASSERT_EQ(run_ipos({"build", source}, folder.path()).exit_code, 0);
  std::string image = read_text(folder.path() / "A.ipx");
  image[image.size() / 2] = static_cast<char>(image[image.size() / 2] ^ 0x10);
  folder.write("bad.ipx", image);
  for (const std::string verb : {"verify", "disasm", "run"}) {
    const CommandResult result = run_ipos({verb, "bad.ipx"}, folder.path());
    EXPECT_EQ(result.exit_code, 1) << verb;
    EXPECT_TRUE(contains(result.err, "bad.ipx")) << result.err;
    EXPECT_TRUE(contains(result.err, "checksum")) << result.err;
    EXPECT_EQ(result.out, "");
  }
}

TEST(Run, FaultNamesTheSourceLine) {
  const TemporaryFolder folder;
  folder.write("A.IPC", "long a, b;\nmain()\n{\n  a = 1;\n  a = a / b;\n}\n");
  const CommandResult result =
      run_ipos({"run", "A.IPC", "--for", "100ms", "--format", "json"}, folder.path());
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(contains(result.err, "F10")) << result.err;
  EXPECT_TRUE(contains(result.err, "A.IPC:5:")) << result.err;
  EXPECT_EQ(nlohmann::json::parse(result.out)["stations"][0]["fault"], 10);
}

TEST(Run, RecursionIsF32) {
  const TemporaryFolder folder;
  folder.write("A.IPC", "main()\n{\n  Again();\n}\nAgain()\n{\n  Again();\n}\n");
  const CommandResult result = run_ipos({"run", "A.IPC", "--for", "1s", "--format", "json"}, folder.path());
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(contains(result.err, "F32")) << result.err;
  EXPECT_TRUE(contains(result.err, "A.IPC:7:")) << result.err;
  EXPECT_EQ(nlohmann::json::parse(result.out)["stations"][0]["fault"], 32);
}

TEST(Run, UntilEndStopsWithTheProgram) {
  const TemporaryFolder folder;
  folder.write("A.IPC", "long a;\nmain()\n{\n  _Wait(50);\n  a = 5;\n}\n");
  const CommandResult result =
      run_ipos({"run", "A.IPC", "--until", "end", "--format", "json"}, folder.path());
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const auto report = nlohmann::json::parse(result.out);
  EXPECT_GE(report["time_us"], 50'000);
  EXPECT_LE(report["time_us"], 60'000);
  EXPECT_EQ(report["stations"][0]["name"], "A");
  EXPECT_EQ(report["stations"][0]["unit"], "md60a");
  EXPECT_EQ(report["stations"][0]["variables"][0],
            (nlohmann::json{{"name", "a"}, {"index", 420}, {"value", 5}}));
  EXPECT_TRUE(
      contains(run_ipos({"run", "A.IPC", "--until", "end", "--watch"}, folder.path()).out, "H420 a  5\n"));
}

// Names that are printed are names that are taken.
TEST(Run, WatchTakesTheNamesItPrints) {
  const TemporaryFolder folder;
  folder.write("A.IPC",
               "typedef struct { long a; long b[2]; } T;\nT y[2];\nmain()\n{\n  y[0].b[1] = 9;\n}\n");
  folder.write("B.IPC", "long other;\nmain()\n{\n  other = 1;\n}\n");
  folder.write("two.toml",
               "[[station]]\nname = \"a\"\nunit = \"mdxb\"\nprogram = \"A.IPC\"\n"
               "[[station]]\nname = \"b\"\nunit = \"mdxb\"\nprogram = \"B.IPC\"\n"
               "[[expect]]\nstation = \"a\"\nat = \"10ms\"\nvariable = \"y[0].b[1]\"\nequals = 9\n"
               "[[expect]]\nstation = \"a\"\nat = \"10ms\"\nvariable = \"RefOffset\"\nequals = 0\n");
  const auto watched = [&](const std::string& names) {
    const CommandResult result =
        run_ipos({"run", "two.toml", "--for", "20ms", "--watch=" + names}, folder.path());
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.out;
  };
  EXPECT_TRUE(contains(watched("y[0].b[1]"), "H422 y[0].b[1]  9\n"));
  EXPECT_TRUE(contains(watched("y[0].b"), "H421 y[0].b[0]  0\nH422 y[0].b[1]  9\n"));
  EXPECT_TRUE(contains(watched("y"), "H423 y[1].a     0\n"));
  EXPECT_TRUE(contains(watched("RefOffset"), "H498 RefOffset  0\n"));
  // Signals have no number, and a pattern takes several.
  EXPECT_TRUE(contains(watched("speed,DI0*"), "     speed  0.000 rpm\n     DI00   0\n"))
      << watched("speed,DI0*");
  EXPECT_FALSE(contains(watched("y"), "B.IPC")) << "a station without the name has no section";
  // Of one station of several that have it.
  EXPECT_TRUE(contains(watched("RefOffset"), "B.IPC"));
  for (const char* name : {"a.RefOffset", "a.H498", "a.H200"}) {
    const std::string out = watched(name);
    EXPECT_TRUE(contains(out, "A.IPC") && !contains(out, "B.IPC")) << name << out;
    EXPECT_TRUE(contains(out, name[2] == 'H' ? name + 2 : "H498 RefOffset  0\n")) << name << out;
  }
  EXPECT_TRUE(contains(watched("a.y[0].b[1]"), "H422 y[0].b[1]  9\n"));
  const CommandResult traced = run_ipos({"run", "two.toml", "--for", "20ms", "--trace", "t.csv", "--signals",
                                         "a.y[0].b[1],a.RefOffset,a.DI03,a.DO01"},
                                        folder.path());
  EXPECT_EQ(traced.exit_code, 0) << traced.err;
  EXPECT_TRUE(
      read_text(folder.path() / "t.csv").starts_with("time_ms,a.y[0].b[1],a.RefOffset,a.DI03,a.DO01\n"));
}

TEST(Run, SpeedSetsTheCommandsOfAMillisecond) {
  const TemporaryFolder folder;
  folder.write("A.IPC", "long a;\nmain()\n{\n  while (1) a++;\n}\n");  // two commands a round
  const auto count = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"run", "A.IPC", "--for", "99ms", "--format", "json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return nlohmann::json::parse(
        run_ipos(arguments, folder.path()).out)["stations"][0]["variables"][0]["value"];
  };
  EXPECT_EQ(count({}), 50);  // ticks at 0, 1, .. 99 ms
  EXPECT_EQ(count({"--speed", "20"}), 1000);
}

class Recordings : public Test {
 protected:
  Recordings() {
    folder_.write("A.IPC", "long a;\nmain()\n{\n  while (1) a++;\n}\n");
    folder_.write("two.toml",
                  "[[station]]\nname = \"u1\"\nunit = \"md60a\"\nprogram = \"A.IPC\"\n"
                  "[[station]]\nname = \"u2\"\nunit = \"mc07\"\n[station.inputs]\nDI00 = 1\n");
  }
  CommandResult run(std::vector<std::string> more) {
    more.insert(more.begin(), {"run", "--for", "5ms"});
    return run_ipos(more, folder_.path());
  }
  TemporaryFolder folder_;
};

TEST_F(Recordings, TraceAndPlot) {
  EXPECT_EQ(run({"two.toml", "--trace", "t.csv", "--plot", "p.svg", "--signals", "u1.a,u2.P302"}).exit_code,
            0);
  EXPECT_EQ(read_text(folder_.path() / "t.csv"),
            "time_ms,u1.a,u2.P302 [rpm]\n1,1,1500.000\n2,2,1500.000\n3,2,1500.000\n4,3,1500.000\n"
            "5,3,1500.000\n");
  const std::string plot = read_text(folder_.path() / "p.svg");
  EXPECT_TRUE(contains(plot, "<svg") && contains(plot, ">two.toml<") && contains(plot, ">u1.a<")) << plot;
}

TEST_F(Recordings, DefaultSignals) {
  EXPECT_EQ(run({"two.toml", "--trace", "t.csv"}).exit_code, 0);
  EXPECT_TRUE(read_text(folder_.path() / "t.csv")
                  .starts_with("time_ms,u1.speed [rpm],u1.setpoint [rpm],u1.status,"
                               "u2.speed [rpm],u2.setpoint [rpm],u2.status\n"));
}

TEST_F(Recordings, OneStationNeedsNoName) {
  EXPECT_EQ(run({"--trace", "t.csv", "--signals", "a,H3,speed", "A.IPC"}).exit_code, 0);
  EXPECT_TRUE(read_text(folder_.path() / "t.csv").starts_with("time_ms,A.a,A.H3,A.speed [rpm]\n"));
}

TEST_F(Recordings, MistakesAreTold) {
  const auto refuses = [&](const std::vector<std::string>& arguments, const std::string& words,
                           int exit_code) {
    const CommandResult result = run(arguments);
    EXPECT_EQ(result.exit_code, exit_code) << words;
    EXPECT_EQ(result.out, "");
    EXPECT_TRUE(contains(result.err, words)) << result.err;
  };
  refuses({"two.toml", "--signals", "u1.speed"}, "--signals needs --plot or --trace", 64);
  refuses({"two.toml", "--trace", "t.csv", "--signals", "speed"}, "signals begin with u1., u2.", 64);
  refuses({"two.toml", "--trace", "t.csv", "--signals", "u3.speed"}, "signals begin with u1., u2.", 64);
  refuses({"two.toml", "--trace", "t.csv", "--signals", "u1.sped"},
          "station 'u1' has no signal 'sped'; it has speed, frequency, position, ", 64);
  refuses({"two.toml", "--trace", "t.csv", "--signals", "u1.b"}, "variables H0 to H511, a", 64);
  refuses({"two.toml", "--trace", "t.csv", "--signals", "u1.P99999"}, "parameters as P000", 64);
  refuses({"two.toml", "--trace", "t.csv", "--signals", "u1.H512"}, "variables H0 to H511", 64);
  refuses({"two.toml", "--trace", "t.csv", "--signals", "u2.H512"}, "it has speed, frequency, current, ", 64);
  refuses({"two.toml", "--trace", "/nowhere/t.csv"}, "/nowhere/t.csv: No such file or directory", 74);
  refuses({"two.toml", "--plot", "/nowhere/p.svg"}, "/nowhere/p.svg: No such file or directory", 74);
}

class PlantErrors : public Test {
 protected:
  CommandResult run(const std::string& plant) {
    folder_.write("A.IPC", kProgram);
    folder_.write("plant.toml", plant);
    return run_ipos({"run", "plant.toml", "--for", "10ms"}, folder_.path());
  }
  void refuses(const std::string& plant, const std::string& place, const std::string& words,
               int exit_code = 65) {
    const CommandResult result = run(plant);
    EXPECT_EQ(result.exit_code, exit_code) << plant;
    EXPECT_TRUE(contains(result.err, "plant.toml:" + place + ": error: ")) << result.err;
    EXPECT_TRUE(contains(result.err, words)) << result.err;
    EXPECT_EQ(result.out, "");
  }
  TemporaryFolder folder_;
};

const std::string kStation = "[[station]]\nname = \"u\"\nunit = \"md60a\"\nprogram = \"A.IPC\"\n";
const std::string kBus = "[[bus]]\nname = \"b\"\nkind = \"can\"\n";

TEST_F(PlantErrors, EachIsLocated) {
  refuses(kStation + "colour = \"red\"\n", "5:1", "colour");
  refuses(kStation + "hex = 3\u00b9\n", "5:8", "text or a comment");
  refuses(kStation + "port = \"vcan0\"\n", "5:1", "unknown key 'port'");
  refuses(kStation + "rs485 = \"line1\"\n", "5:9", "'line1'");
  refuses(kStation + "[[bus\n", "5:6", "table header");
  refuses("[[station]]\nname = \"u\"\nunit = \"md90\"\n", "3:8", "md90");
  refuses("[[station]]\nunit = \"md60a\"\n", "1:1", "name");
  refuses(kStation + "sbus = \"b\"\n", "5:8", "'b'");
  refuses(kStation + kStation, "5:1", "two");
  refuses(kBus + "baud = 800000\n" + kStation, "4:8", "800000");
  refuses("[[bus]]\nname = \"b\"\nkind = \"token ring\"\n" + kStation, "3:8", "token ring");
  refuses(kStation + "program = 5\n", "5:11", "program");
  refuses(kStation + "[station.parameters]\nP99999 = 1\n", "6:1", "P99999");
  refuses(kStation + "[station.parameters]\nP813 = 64\n", "6:1", "P813");
  refuses(kStation + "[station.parameters]\nP813 = \"x\"\n", "6:8", "P813");
  refuses(kStation + "[station.inputs]\nDI99 = 1\n", "6:1", "DI99");
  refuses(kStation + "[station.inputs]\nDI00 = 2\n", "6:8", "DI00");
  refuses(kStation + "[station.load]\nmass = 3\n", "6:1", "mass");
  refuses(kStation + "[station.load]\ninertia = -1\n", "6:11", "0 to 100000 %");
  refuses(kStation + "[station.load]\nfriction = \"much\"\n", "6:12", "in %");
  refuses(kStation + "[station.load]\ntorque = nan\n", "6:10", "-1000 to 1000 %");
  refuses(kStation + "[station.load]\nbrake = 1\n", "6:9", "true or false");
  refuses(kStation + "load = 5\n", "5:8", "[station.load]");
  refuses(kStation + "[[expect]]\nstation = \"v\"\nat = \"1ms\"\nvariable = \"a\"\nequals = 5\n", "6:11",
          "'v'");
  refuses(kStation + "[[expect]]\nstation = \"u\"\nat = \"later\"\nvariable = \"a\"\nequals = 5\n", "7:6",
          "later");
  refuses(kStation + "[[expect]]\nstation = \"u\"\nat = \"1ms\"\nvariable = \"zz\"\nequals = 5\n", "5:1",
          "zz");
  refuses(kStation + "[[expect]]\nstation = \"u\"\nat = \"1ms\"\nvariable = \"a\"\nequals = 5000000000\n",
          "9:10", "32 bits");
  refuses("", "1:1", "[[station]]");
  refuses("[[station]]\nname = \"u\"\nunit = \"md60a\"\nprogram = \"B.IPC\"\n", "4:11", "B.IPC", 66);
}

TEST_F(PlantErrors, AllAreReportedAtOnce) {
  const CommandResult result = run(kStation + "colour = 1\nshape = 2\n[station.inputs]\nDI99 = 1\n");
  EXPECT_EQ(result.exit_code, 65);
  EXPECT_TRUE(contains(result.err, "plant.toml:5:1"));
  EXPECT_TRUE(contains(result.err, "plant.toml:6:1"));
  EXPECT_TRUE(contains(result.err, "plant.toml:8:1"));
}

TEST_F(PlantErrors, UnmetExpectationIsAFinding) {
  const std::string expect = "[[expect]]\nstation = \"u\"\nat = \"5ms\"\nvariable = \"a\"\nequals = ";
  EXPECT_EQ(run(kStation + expect + "5\n").exit_code, 0);
  const CommandResult unmet = run(kStation + expect + "6\n");
  EXPECT_EQ(unmet.exit_code, 1);
  EXPECT_TRUE(
      contains(unmet.err, "plant.toml:5:1: expectation not met: a of u at 5.000 ms: is 5 (0x5), expected 6"))
      << unmet.err;
  const CommandResult late =
      run(kStation + "[[expect]]\nstation = \"u\"\nat = \"1h\"\nvariable = \"a\"\nequals = 5\n");
  EXPECT_EQ(late.exit_code, 1);
  EXPECT_TRUE(contains(late.err, "the run ended before")) << late.err;
}

TEST_F(PlantErrors, WrongBaudRateIsTold) {
  const CommandResult result = run(kBus + "baud = 125000\n" + kStation + "sbus = \"b\"\n");
  EXPECT_TRUE(contains(result.err, "baud rate")) << result.err;
  EXPECT_TRUE(contains(result.err, "u")) << result.err;
}

}  // namespace
}  // namespace ipos::tests
