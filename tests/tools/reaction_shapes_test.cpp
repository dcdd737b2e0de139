// ipos bus plan --reaction on programs that need several turns of their loops: flags that are set in one turn and acted upon in the
// next one, tasks that hand over, state machines, loops that go back before they have decided. Where it has a figure, no output of a
// run changes later than the figure after the last change of an input, at random moments; where it has none, it names the line.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

constexpr const char* kHead = "#include <constb.h>\n#include <iob.h>\n";

// Its parts as text; a newline stands in front of what is to have a line of its own.
struct Program {
  std::string variables, functions, start, turn;
};

std::string leader(const Program& with) {
  return kHead + std::string("SCTRCYCL Tr; long lData") + with.variables + ";\n" + with.functions +
         "main()\n{\n  Tr.ObjectNo = 1100; Tr.CycleTime = 10; Tr.Format = 4; Tr.DPointer = numof(lData);\n  _SBusCommDef(SCD_TRCYCL, Tr);\n"
         "  _SBusCommOn();\n  " +
         with.start + "\n  while (1)\n  {\n" + with.turn + "\n  }\n}\n";
}
std::string follower(const Program& with) {
  return kHead + std::string("SCREC Re; long lData") + with.variables + ";\n" + with.functions +
         "main()\n{\n  Re.ObjectNo = 1100; Re.Format = 4; Re.DPointer = numof(lData);\n  _SBusCommDef(SCD_REC, Re);\n  _SBusCommOn();\n  " +
         with.start + "\n  while (1)\n  {\n" + with.turn + "\n  }\n}\n";
}

std::string plant() {
  return "[[bus]]\nname = \"sbus\"\nkind = \"can\"\nbaud = 500000\n"
         "[[station]]\nname = \"leader\"\nunit = \"mdxb\"\nprogram = \"A.IPC\"\nsbus = \"sbus\"\n[station.parameters]\nP881 = 1\nP884 = 2\nP601 = 16\nP602 = 16\n"
         "[[station]]\nname = \"follower\"\nunit = \"mdxb\"\nprogram = \"B.IPC\"\nsbus = \"sbus\"\n[station.parameters]\nP881 = 2\nP884 = 2\nP602 = 16\nP620 = 21\n";
}

class Planned {
 public:
  Planned(const std::string& a, const std::string& b) {
    folder.write("A.IPC", a);
    folder.write("B.IPC", b);
    folder.write("p.toml", plant());
    const CommandResult planned = run_ipos({"bus", "plan", "p.toml", "--reaction", "--format", "json"}, folder.path());
    EXPECT_EQ(planned.exit_code, 0) << planned.err << a << b;
    reaction = nlohmann::json::parse(planned.out)["reactions"].at(0);
  }
  bool has_figure() const { return !reaction["from_input_ns"].is_null(); }
  double worst() const { return reaction["from_input_ns"].get<double>() / 1e6; }
  std::string because() const { return reaction["because"]; }
  // "1:4 2:2": of task 1 four turns, of task 2 two.
  std::string turns(const std::string& whose) const {
    std::string text;
    for (const auto& one : reaction[whose]) text += (text.empty() ? "" : " ") + std::to_string(one["task"].get<int>()) + ":" + std::to_string(one["turns"].get<int>());
    return text;
  }
  TemporaryFolder folder;
  nlohmann::json reaction;
};

const Program kFollow{"", "", "", "    if (lData) SET_DO01; else CLEAR_DO01;"};

std::string leader_turns(const Program& program) {
  const Planned planned(leader(program), follower(kFollow));
  return planned.has_figure() ? planned.turns("sender_turns") : planned.because();
}

// The turn that has just looked ends, the next one looks; each variable that is read before it is written takes one more.
TEST(ReactionShapes, TurnsOfAChainOfVariables) {
  EXPECT_EQ(leader_turns({"", "", "", "    if (DI02) lData = 1; else lData = 0;"}), "1:2");
  EXPECT_EQ(leader_turns({", a", "", "", "    if (DI02) a = 1; else a = 0;\n    lData = a;"}), "1:2");
  EXPECT_EQ(leader_turns({", a", "", "", "    lData = a;\n    if (DI02) a = 1; else a = 0;"}), "1:3");
  EXPECT_EQ(leader_turns({", a, b", "", "", "    lData = b;\n    b = a;\n    if (DI02) a = 1; else a = 0;"}), "1:4");
  EXPECT_EQ(leader_turns({", a, b", "", "", "    lData = b;\n    if (DI02) a = 1; else a = 0;\n    b = a;"}), "1:3");
  // An array in a loop within the turn is of the same turn.
  EXPECT_EQ(leader_turns({", a[4], i, s", "", "", "    s = 0;\n    for (i = 0; i < 4; i++) s = s + DI02;\n    lData = s;"}), "1:2");
  // In functions.
  EXPECT_EQ(leader_turns({", a", "Ask() { if (DI02) a = 1; else a = 0; }\nTell() { lData = a; }\n", "", "    Tell();\n    Ask();"}), "1:3");
  EXPECT_EQ(leader_turns({", a", "Ask() { if (DI02) a = 1; else a = 0; }\nTell() { lData = a; }\n", "", "    Ask();\n    Tell();"}), "1:2");
}

TEST(ReactionShapes, TurnsOfTasksThatHandOver) {
  EXPECT_EQ(leader_turns({", a", "Side() { while (1) { if (DI02) a = 1; else a = 0; } }\n", "_SetTask2(T2_START, Side);", "    lData = a;"}),
            "1:2 2:2");
  // There and back: task 1 looks, task 2 answers, task 1 tells.
  EXPECT_EQ(leader_turns({", a, b", "Side() { while (1) b = a; }\n", "_SetTask2(T2_START, Side);",
                          "    lData = b;\n    if (DI02) a = 1; else a = 0;"}),
            "1:4 2:2");
  EXPECT_EQ(leader_turns({", a", "Side() { while (1) if (DI02) a = 1; }\n", "_SetTask2(T2_START, Side);", "    if (a) { lData = 1; a = 0; }"}),
            "leader: tasks 1 and 2 write a");
}

// States 0 to 3 go round with one input: from any of them at most three steps until it stays, in 2 or in 0. Then the turn that has
// just looked, the one that sees the input, and the one in which the last state has acted.
TEST(ReactionShapes, TurnsOfAStateMachine) {
  const std::string states =
      "    switch (st)\n    {\n      case 0: if (DI02) st = 1; break;\n      case 1: lData = 1; st = 2; break;\n"
      "      case 2: if (!DI02) st = 3; break;\n      case 3: lData = 0; st = 0; break;\n    }";
  EXPECT_EQ(leader_turns({", st", "", "", states}), "1:6");
  // Two states, one step.
  EXPECT_EQ(leader_turns({", st", "", "", "    if (st == 0) { if (DI02) { lData = 1; st = 1; } }\n    else if (!DI02) { lData = 0; st = 0; }"}), "1:4");
  // A counter with an end: three steps, and where it is not counted the value of the turn before is taken.
  EXPECT_EQ(leader_turns({", c", "", "c = 0;", "    if (DI02) { if (c < 3) c++; } else c = 0;\n    if (c >= 3) lData = 1; else lData = 0;"}), "1:6");
}

TEST(ReactionShapes, NamesTheLineThatNothingBounds) {
  EXPECT_EQ(leader_turns({"", "", "", "    if (!DI03) continue;\n    if (DI02) lData = 1; else lData = 0;"}),
            "leader: line 13 acts only when line 12 lets it, whatever has come");
  EXPECT_EQ(leader_turns({"", "", "", "    while (!DI03) { }\n    if (DI02) lData = 1; else lData = 0;"}),
            "leader: line 13 acts only when line 12 lets it, whatever has come");
  // Both sides write: what else is asked for is a part of the decision.
  EXPECT_EQ(leader_turns({"", "", "", "    if (DI02 && DI03) lData = 1; else lData = 0;"}), "1:2");
  EXPECT_EQ(leader_turns({", st", "", "",
                          "    switch (st)\n    {\n      case 0: if (DI02) st = 1; break;\n      case 1: if (DI03) { lData = 1; st = 2; } break;\n"
                          "      case 2: if (!DI02) { lData = 0; st = 0; } break;\n    }"}),
            "leader: line 15 acts only when line 12 lets it, whatever has come");
  EXPECT_EQ(leader_turns({", c", "", "", "    c++;\n    if (c == 100 && DI02) lData = 1;\n    if (c == 100 && !DI02) lData = 0;"}),
            "leader: line 13 acts only when something else lets it, whatever has come");
  EXPECT_EQ(leader_turns({", c", "", "", "    if (DI02) c++;\n    lData = c;"}),
            "leader: c at line 12 comes of what it was turns before, and nothing tells of how many");
  EXPECT_EQ(leader_turns({"", "", "", "    lData = 0;\n    if (DI02) lData = 1;"}),
            "leader: lData is written at line 12 and at line 13, and may be seen in between");
  EXPECT_EQ(leader_turns({"", "", "", "    lData = DI02;"}), "leader: line 12 writes lData in several commands, and it may be seen in between");
  EXPECT_EQ(leader_turns({"", "", "", "    if (DI02) H488 = 100;\n    if (H488 > 0) lData = 1; else lData = 0;"}),
            "leader: H488, which line 12 writes, goes on by itself");
  EXPECT_EQ(leader_turns({", c", "", "", "    c++;\n    lData = c;"}), "what leader sends comes of nothing from outside");
}

// --- random programs

class Shapes {
 public:
  explicit Shapes(unsigned seed) : random_(seed) {}

  // `source`: what it decides by. `on`, `off`: what it does.
  Program program(const std::string& source, const std::string& on, const std::string& off) {
    const std::string decide = "if (" + source + ") " + on + " else " + off;
    const std::string ask = "if (" + source + ") a = 1; else a = 0;", act = "if (a) " + on + " else " + off;
    const std::string other = any({"DI03", "!DI03"}), pause = any({"", "", "_Wait(2);", "_Wait(7);"});
    Program made;
    switch (number(17)) {
      case 0: made.turn = decide; break;
      case 1: {  // flags from turn to turn, in any order
        const int count = number(5) + 1;
        std::vector<std::string> lines;
        for (int n = 0; n < count; ++n) made.variables += ", f" + std::to_string(n);
        for (int n = 1; n < count; ++n) lines.push_back("f" + std::to_string(n) + " = f" + std::to_string(n - 1) + ";");
        lines.push_back("if (" + source + ") f0 = 1; else f0 = 0;");
        lines.push_back("if (f" + std::to_string(count - 1) + ") " + on + " else " + off);
        std::shuffle(lines.begin(), lines.end(), random_);
        for (const std::string& line : lines) made.turn += line + "\n";
        break;
      }
      case 2: made.turn = "if (" + other + ") continue;\n" + decide; break;
      case 3: made.turn = "if (" + other + ") { " + off + " continue; }\n" + decide; break;
      case 4:
      case 5: {  // a machine of four to six states
        made.variables = ", st";
        const int more = number(3);
        made.turn = "switch (st) { case 0: if (" + source + ") st = 1; break; case 1: " + on + " st = 2; break; case 2: if (!(" + source + ")) st = 3; break;";
        for (int n = 3; n < 3 + more; ++n) made.turn += " case " + std::to_string(n) + ": st = " + std::to_string(n + 1) + "; break;";
        made.turn += " case " + std::to_string(3 + more) + ": " + off + " st = 0; break; }";
        break;
      }
      case 6:
        made.variables = ", st";
        made.turn = "if (st == 0) { if (" + source + ") { " + on + " st = 1; } } else { if (!(" + source + ")) { " + off + " st = 0; } }";
        break;
      case 7:
        made.variables = ", a";
        made.functions = "Side() { while (1) { " + ask + any({"", " _Wait(3);", " _Wait(11);"}) + " } }\n";
        made.start = "_SetTask2(T2_START, Side);";
        made.turn = act;
        break;
      case 8:
        made.variables = ", a, b";
        made.functions = "Side() { while (1) { if (b) a = 1; else a = 0; " + pause + " } }\n";
        made.start = any({"_SetTask2(T2_START, Side);", "_SetTask(1, Side);"});
        made.turn = act + "\nif (" + source + ") b = 1; else b = 0;";
        break;
      case 9: made.turn = "if (" + source + ") " + on + "\nif (!(" + source + ")) " + off; break;
      case 10:
        made.variables = ", now, before";
        made.turn = "if (" + source + ") now = 1; else now = 0;\nif (now && !before) " + on + "\nelse if (!now && before) " + off + "\nbefore = now;";
        break;
      case 11: made.turn = "while (" + other + ") { }\n" + decide; break;
      case 12: made.turn = "if ((" + source + ") && " + other + ") " + on + " else " + off; break;
      case 13:
        made.variables = ", a";
        made.functions = "Ask() { " + ask + " }\nAct() { " + act + " }\n";
        made.turn = any({"Ask(); Act();", "Act(); Ask();", "Act(); if (" + other + ") Ask();", "Act(); Ask(); Act();"});
        break;
      case 14:
        made.variables = ", c";
        made.start = "c = 0;";
        made.turn = "if (" + source + ") { if (c < " + std::to_string(number(5) + 1) + ") c++; } else c = 0;\nif (c > 0) " + on + " else " + off;
        break;
      case 15:
        made.variables = ", a, st";
        made.turn = "switch (st) { case 0: a = 0; if (" + source + ") st = 1; break; case 1: a = 1; if (!(" + source + ")) st = 0; break; }\n" + act;
        break;
      default:
        made.variables = ", k";
        made.turn = "k = 0;\ndo { k++; } while (k < " + std::to_string(number(9) + 1) + ");\nif ((" + source + ") && k > 0) " + on + " else " + off;
    }
    made.turn = any({"", "H100 = H100 + 1;\n"}) + any({pause + "\n" + made.turn, made.turn + "\n" + pause});
    return made;
  }

  int number(int below) { return std::uniform_int_distribution<>(0, below - 1)(random_); }
  double between(double least, double most) { return std::uniform_real_distribution<>(least, most)(random_); }
  std::string any(const std::vector<std::string>& all) { return all[static_cast<size_t>(number(static_cast<int>(all.size())))]; }

 private:
  std::mt19937 random_;
};

struct Moment {
  double at;  // ms
  std::string text;
};

// Inputs of both stations change: sometimes before all has followed, mostly later.
std::vector<Moment> moments(Shapes& shapes, double worst, int count) {
  std::vector<Moment> all;
  bool level[3] = {};
  double at = 500;
  for (int n = 0; n < count; ++n) {
    at += shapes.number(3) == 0 ? shapes.between(0, worst / 3) : worst + 5 + shapes.between(0, shapes.number(2) == 0 ? 40 : 200);
    at = std::round(at * 1000) / 1000;
    const int which = std::max(0, shapes.number(4) - 1);
    level[which] = !level[which];
    all.push_back({at, std::string("[[stimulus]]\nstation = \"") + (which == 2 ? "follower" : "leader") + "\"\nat = \"" +
                           std::to_string(static_cast<int64_t>(std::llround(at * 1000))) + "us\"\ninput = \"" + (which == 0 ? "DI02" : "DI03") +
                           "\"\nset = " + (level[which] ? "1" : "0") + "\n"});
  }
  return all;
}

// How long after the last change of an input an output changed, at most.
double longest(const std::string& csv, const std::vector<Moment>& inputs, size_t& changes) {
  std::istringstream lines(csv);
  std::string line, last;
  double most = 0;
  while (std::getline(lines, line)) {
    const size_t comma = line.find(',');
    if (comma == std::string::npos || line[0] < '0' || line[0] > '9') continue;
    const std::string value = line.substr(comma + 1);
    const double at = std::stod(line.substr(0, comma));
    if (!last.empty() && value != last && at >= inputs.front().at) {
      ++changes;
      const auto next = std::upper_bound(inputs.begin(), inputs.end(), at, [](double now, const Moment& one) { return now < one.at; });
      most = std::max(most, at - std::prev(next)->at);
    }
    last = value;
  }
  return most;
}

TEST(ReactionShapes, NoRunIsSlowerThanTheFigure) {
  constexpr unsigned kPrograms = 300;
  unsigned figures = 0;
  double closest = 0;
  for (unsigned seed = 0; seed < kPrograms; ++seed) {
    Shapes shapes(seed);
    const std::string a = leader(shapes.program("DI02", "lData = 1;", "lData = 0;"));
    const std::string b = follower(shapes.program(shapes.any({"lData", "lData == 1", "lData & 1"}), "SET_DO01;", "CLEAR_DO01;"));
    Planned planned(a, b);
    if (!planned.has_figure()) {
      EXPECT_NE(planned.because(), "") << a << b;
      continue;
    }
    ++figures;
    const double worst = planned.worst();
    const std::vector<Moment> inputs = moments(shapes, worst, 100);
    std::string text = plant();
    for (const Moment& one : inputs) text += one.text;
    planned.folder.write("p.toml", text);
    const CommandResult run = run_ipos({"run", "p.toml", "--for", std::to_string(static_cast<int64_t>(inputs.back().at + 3 * worst + 300)) + "ms",
                                        "--trace", "-", "--signals", "follower.DO01"},
                                       planned.folder.path());
    ASSERT_EQ(run.exit_code, 0) << run.err;
    size_t changes = 0;
    const double seen = longest(run.out, inputs, changes);
    EXPECT_GT(changes, 0U) << "seed " << seed << "\n" << a << b;
    EXPECT_LE(seen, worst) << "seed " << seed << "\n" << a << b;
    closest = std::max(closest, seen / worst);
  }
  // Rather more have a figure than not, as far as one of the two programs does not wait for something else.
  EXPECT_GE(figures, kPrograms / 4);
  EXPECT_GE(closest, 0.6) << "figures of no use";
  RecordProperty("figures", static_cast<int>(figures));
}

}  // namespace
}  // namespace ipos::tests
