// ipos bus plan --reaction: its figure is never below what runs show whose input changes at random moments, and not far above it.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

struct Programs {
  int cycle = 10;       // ms, of the object
  int wait = 0;         // ms in each turn of the leader
  int work = 0;         // turns of a loop in each turn of the follower
  int baud = 125'000;
};

std::string plant(const Programs& with) {
  return "[[bus]]\nname = \"sbus\"\nkind = \"can\"\nbaud = " + std::to_string(with.baud) +
         "\n[[station]]\nname = \"leader\"\nunit = \"mdxb\"\nprogram = \"A.IPC\"\nsbus = \"sbus\"\n[station.parameters]\nP881 = 1\nP884 = " +
         (with.baud == 125'000 ? "0" : "2") +
         "\nP601 = 16\n[[station]]\nname = \"follower\"\nunit = \"mdxb\"\nprogram = \"B.IPC\"\nsbus = \"sbus\"\n[station.parameters]\nP881 = 2\nP884 = " +
         (with.baud == 125'000 ? "0" : "2") + "\nP620 = 21\n";
}

// The leader also sends an object of a lower number all the time, which comes first on the line.
std::string leader(const Programs& with) {
  return "#include <constb.h>\n#include <iob.h>\nSCTRCYCL Tr, Other; long lData, lMore, lOther, lOtherToo;\nmain()\n{\n"
         "  Other.ObjectNo = 1030; Other.CycleTime = 5; Other.Format = 8; Other.DPointer = numof(lOther);\n"
         "  _SBusCommDef(SCD_TRCYCL, Other);\n  Tr.ObjectNo = 1100; Tr.CycleTime = " +
         std::to_string(with.cycle) +
         "; Tr.Format = 4; Tr.DPointer = numof(lData);\n  _SBusCommDef(SCD_TRCYCL, Tr);\n  _SBusCommOn();\n  while (1)\n  {\n"
         "    if (DI02) lData = 1; else lData = 0;\n" +
         (with.wait == 0 ? "" : "    _Wait(" + std::to_string(with.wait) + ");\n") + "  }\n}\n";
}
std::string follower(const Programs& with) {
  return "#include <constb.h>\n#include <iob.h>\nSCREC Re, Other; long lData, lMore, lOther, lOtherToo, i;\nmain()\n{\n"
         "  Other.ObjectNo = 1030; Other.Format = 8; Other.DPointer = numof(lOther);\n  _SBusCommDef(SCD_REC, Other);\n"
         "  Re.ObjectNo = 1100; Re.Format = 4; Re.DPointer = numof(lData);\n  _SBusCommDef(SCD_REC, Re);\n  _SBusCommOn();\n"
         "  while (1)\n  {\n    if (lData) SET_DO01; else CLEAR_DO01;\n" +
         (with.work == 0 ? "" : "    for (i = 0; i < " + std::to_string(with.work) + "; i++) H100 = lOther;\n") + "  }\n}\n";
}

// Times of the changes of a signal in a trace of CSV, in ms.
std::vector<double> changes(const std::string& csv) {
  std::vector<double> times;
  std::istringstream lines(csv);
  std::string line, last;
  while (std::getline(lines, line)) {
    const size_t comma = line.find(',');
    if (comma == std::string::npos || line.empty() || line[0] < '0' || line[0] > '9') continue;
    const std::string value = line.substr(comma + 1);
    if (!last.empty() && value != last) times.push_back(std::stod(line.substr(0, comma)));
    last = value;
  }
  return times;
}

TEST(Reaction, IsNeverBelowWhatRunsShow) {
  std::mt19937 random(7);
  for (const Programs& with : {Programs{}, Programs{7, 3, 40, 125'000}, Programs{50, 0, 10, 500'000}, Programs{5, 20, 5, 500'000}}) {
    const TemporaryFolder folder;
    folder.write("A.IPC", leader(with));
    folder.write("B.IPC", follower(with));
    folder.write("p.toml", plant(with));
    const CommandResult planned = run_ipos({"bus", "plan", "p.toml", "--reaction", "--format", "json"}, folder.path());
    ASSERT_EQ(planned.exit_code, 0) << planned.err;
    const auto all = nlohmann::json::parse(planned.out)["reactions"];
    ASSERT_EQ(all.size(), 2U);
    const auto& reaction = all[1];
    ASSERT_EQ(reaction["object"], 1100);
    ASSERT_FALSE(reaction["from_input_ns"].is_null()) << reaction["because"];
    const double worst = reaction["from_input_ns"].get<double>() / 1e6;
    std::string stimuli;
    std::vector<double> moments;
    double at = 200;
    for (int n = 0; n < 1000; ++n) {
      at += worst + 5 + std::uniform_real_distribution<>(0, 100)(random);
      at = std::round(at * 1000) / 1000;
      moments.push_back(at);
      stimuli += "[[stimulus]]\nstation = \"leader\"\nat = \"" + std::to_string(static_cast<int64_t>(at * 1000)) + "us\"\ninput = \"DI02\"\nset = " +
                 (n % 2 == 0 ? "1" : "0") + "\n";
    }
    folder.write("p.toml", plant(with) + stimuli);
    const CommandResult run = run_ipos({"run", "p.toml", "--for", std::to_string(static_cast<int64_t>(at + worst + 10)) + "ms", "--trace", "-",
                                        "--signals", "follower.DO01"},
                                       folder.path());
    const std::vector<double> seen = changes(run.out);
    ASSERT_EQ(seen.size(), moments.size()) << run.err << run.out.substr(0, 200);
    double longest = 0;
    for (size_t n = 0; n < seen.size(); ++n) longest = std::max(longest, seen[n] - moments[n]);
    EXPECT_LE(longest, worst) << with.cycle << " " << with.wait << " " << with.work;
    EXPECT_GE(longest, worst / 3) << "a figure of no use: " << with.cycle << " " << with.wait << " " << with.work;
  }
}

// Three stations in a row: the middle one hands on what it gets, in its own loop, each with its own period. The worst of 500
// changes at random moments is below the figure, and the figure is not far above it.
TEST(Reaction, GoesOnFromStationToStation) {
  const auto station = [](const std::string& name, const std::string& program, int address, const std::string& more) {
    return "[[station]]\nname = \"" + name + "\"\nunit = \"mdxb\"\nprogram = \"" + program +
           "\"\nsbus = \"sbus\"\n[station.parameters]\nP881 = " + std::to_string(address) + "\nP884 = 0\n" + more;
  };
  const std::string text = "[[bus]]\nname = \"sbus\"\nkind = \"can\"\nbaud = 125000\n" + station("first", "A.IPC", 1, "P601 = 16\n") +
                           station("middle", "M.IPC", 2, "") + station("last", "B.IPC", 3, "P620 = 21\n");
  const std::string head = "#include <constb.h>\n#include <iob.h>\n";
  const TemporaryFolder folder;
  folder.write("A.IPC", head + "SCTRCYCL Tr; long lData;\nmain()\n{\n  Tr.ObjectNo = 1100; Tr.CycleTime = 10; Tr.Format = 4; Tr.DPointer = numof(lData);\n"
                               "  _SBusCommDef(SCD_TRCYCL, Tr);\n  _SBusCommOn();\n  while (1) { if (DI02) lData = 1; else lData = 0; }\n}\n");
  folder.write("M.IPC", head + "SCREC Re; SCTRCYCL Tr; long lIn, lOut;\nmain()\n{\n  Re.ObjectNo = 1100; Re.Format = 4; Re.DPointer = numof(lIn);\n"
                               "  _SBusCommDef(SCD_REC, Re);\n  Tr.ObjectNo = 1101; Tr.CycleTime = 20; Tr.Format = 4; Tr.DPointer = numof(lOut);\n"
                               "  _SBusCommDef(SCD_TRCYCL, Tr);\n  _SBusCommOn();\n  while (1) { lOut = lIn; _Wait(4); }\n}\n");
  folder.write("B.IPC", head + "SCREC Re; long lData;\nmain()\n{\n  Re.ObjectNo = 1101; Re.Format = 4; Re.DPointer = numof(lData);\n"
                               "  _SBusCommDef(SCD_REC, Re);\n  _SBusCommOn();\n  while (1) { if (lData) SET_DO01; else CLEAR_DO01; }\n}\n");
  folder.write("p.toml", text);
  const CommandResult planned = run_ipos({"bus", "plan", "p.toml", "--reaction", "--format", "json"}, folder.path());
  ASSERT_EQ(planned.exit_code, 0) << planned.err;
  const auto report = nlohmann::json::parse(planned.out);
  const auto& chains = report["reaction_chains"];
  ASSERT_EQ(chains.size(), 1U) << planned.out;
  EXPECT_EQ(chains[0]["stations"], (nlohmann::json{"first", "middle", "last"}));
  EXPECT_EQ(chains[0]["objects"], (nlohmann::json{1100, 1101}));
  EXPECT_EQ(chains[0]["round"], false);
  ASSERT_FALSE(chains[0]["from_input_ns"].is_null()) << chains[0]["because"];
  const double worst = chains[0]["from_input_ns"].get<double>() / 1e6;
  // The middle one puts out nothing of what it gets; the second object comes of its own inputs, too: that and the period of the first.
  EXPECT_EQ(report["reactions"][0]["because"], "what middle receives goes to no output of it");
  EXPECT_GT(worst, report["reactions"][1]["from_input_ns"].get<double>() / 1e6 + 10);
  std::mt19937 random(11);
  std::string stimuli;
  std::vector<double> moments;
  double at = 300;
  for (int n = 0; n < 500; ++n) {
    at = std::round((at + worst + 5 + std::uniform_real_distribution<>(0, 100)(random)) * 1000) / 1000;
    moments.push_back(at);
    stimuli += "[[stimulus]]\nstation = \"first\"\nat = \"" + std::to_string(static_cast<int64_t>(std::llround(at * 1000))) +
               "us\"\ninput = \"DI02\"\nset = " + (n % 2 == 0 ? "1" : "0") + "\n";
  }
  folder.write("p.toml", text + stimuli);
  const CommandResult run = run_ipos({"run", "p.toml", "--for", std::to_string(static_cast<int64_t>(at + worst + 10)) + "ms", "--trace", "-",
                                      "--signals", "last.DO01"},
                                     folder.path());
  const std::vector<double> seen = changes(run.out);
  ASSERT_EQ(seen.size(), moments.size()) << run.err << run.out.substr(0, 200);
  double longest = 0;
  for (size_t n = 0; n < seen.size(); ++n) longest = std::max(longest, seen[n] - moments[n]);
  EXPECT_LE(longest, worst);
  EXPECT_GE(longest, worst / 3) << "a figure of no use";
}

// Who sends back what it gets closes a round, and the search ends there.
TEST(Reaction, ARoundIsSaid) {
  const auto program = [](int sends, int takes) {
    return "#include <constb.h>\n#include <iob.h>\nSCREC Re; SCTRCYCL Tr; long lIn, lOut;\nmain()\n{\n  Re.ObjectNo = " + std::to_string(takes) +
           "; Re.Format = 4; Re.DPointer = numof(lIn);\n  _SBusCommDef(SCD_REC, Re);\n  Tr.ObjectNo = " + std::to_string(sends) +
           "; Tr.CycleTime = 10; Tr.Format = 4; Tr.DPointer = numof(lOut);\n  _SBusCommDef(SCD_TRCYCL, Tr);\n  _SBusCommOn();\n"
           "  while (1) lOut = lIn + DI02;\n}\n";
  };
  const TemporaryFolder folder;
  folder.write("A.IPC", program(1100, 1101));
  folder.write("B.IPC", program(1101, 1100));
  folder.write("p.toml", plant({}));
  const CommandResult planned = run_ipos({"bus", "plan", "p.toml", "--reaction", "--format", "json"}, folder.path());
  const auto chains = nlohmann::json::parse(planned.out)["reaction_chains"];
  ASSERT_EQ(chains.size(), 2U) << planned.out;
  for (const auto& chain : chains) {
    EXPECT_EQ(chain["round"], true);
    EXPECT_EQ(chain["stations"].front(), chain["stations"].back());
  }
  EXPECT_NE(run_ipos({"bus", "plan", "p.toml", "--reaction"}, folder.path()).out.find("it is a round"), std::string::npos);
}

std::string because(const std::string& a, const std::string& b) {
  const TemporaryFolder folder;
  folder.write("A.IPC", a);
  folder.write("B.IPC", b);
  folder.write("p.toml", plant({}));
  const CommandResult planned = run_ipos({"bus", "plan", "p.toml", "--reaction", "--format", "json"}, folder.path());
  const auto all = nlohmann::json::parse(planned.out)["reactions"];
  EXPECT_TRUE(all.back()["from_input_ns"].is_null()) << planned.out;
  return all.back()["because"];
}

std::string with(std::string text, const std::string& old, const std::string& now) {
  return text.replace(text.find(old), old.size(), now);
}

TEST(Reaction, SaysWhyNothingBoundsIt) {
  const std::string a = leader({}), b = follower({});
  EXPECT_EQ(because(a, with(b, "    if (lData)", "    _Wait(H5);\n    if (lData)")), "task 1 of follower: waits at line 13");
  EXPECT_EQ(because(with(a, "    if (DI02)", "    H102++;\n    while (!DI03) { }\n    if (DI02)"), b),
            "task 1 of leader: nothing tells how often the loop at line 14 goes round");
  EXPECT_EQ(because(a, with(b, "    if (lData) SET_DO01; else CLEAR_DO01;\n", "")), "nothing in follower reads what it receives");
  EXPECT_EQ(because(with(with(a, "  while (1)", "  _SetInterrupt(SI_TIMER0, Tick);\n  while (1)"), "main()", "Tick() { H101++; }\nmain()"), b),
            "the interrupt routine Tick of leader may come in between");
}

}  // namespace
}  // namespace ipos::tests
