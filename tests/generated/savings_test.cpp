// Programs of the forms that take fewer commands (switch, bits, copies, indexes) do what the same source does with -O0, command by
// command as it is written; also where tasks and an interrupt run beside them, and one of them changes what a switch looks at.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cstdio>
#include <map>
#include <memory>

#include "compiler/compile.hpp"
#include "compiler/diag/render.hpp"
#include "tests/generated/forms.hpp"
#include "tests/generated/pcg.hpp"
#include "tests/generated/program_generator.hpp"
#include "tests/generated/source_text.hpp"
#include "vm/exec/machine.hpp"
#include "vm/sched/scheduler.hpp"
#include "vm/verify/verify.hpp"

namespace ipos::tests {
namespace {

struct End {
  std::vector<int32_t> variables;  // but for the temporaries
  uint16_t fault = 0;
  uint64_t commands = 0;
};

constexpr uint64_t kMostCommands = 300'000;

const stdlib::UnitType& mdxb() { return *stdlib::find_unit(std::string_view("mdxb")); }

End run(const std::string& text, bool as_written) {
  End out;
  compiler::CompileOptions options;
  options.unit = &mdxb();
  options.as_written = as_written;
  const compiler::Compilation made = compiler::compile("T.IPC", "", text, options);
  EXPECT_TRUE(made.image) << compiler::render_text(made.diagnostics.all(), *made.sources, false) << text;
  if (!made.image) return out;
  const auto image = vm::verify(made.image->code, {mdxb().variables, mdxb().program_words, mdxb().tasks, mdxb().call_depth}, {}).image;
  vm::Machine machine(*image, {});
  machine.start();
  out.commands = machine.run(1, kMostCommands).commands;
  out.fault = machine.fault().number;
  out.variables.assign(machine.variables().begin(), machine.variables().end());
  std::fill(out.variables.begin() + 900, out.variables.begin() + 1000, 0);
  return out;
}

TEST(Savings, DoWhatIsWritten) {
  uint64_t saved = 0, written = 0;
  int compared = 0;
  for (uint64_t seed = 1; seed <= 3000 && !::testing::Test::HasFailure(); ++seed) {
    const std::string text = forms_program(seed);
    const End fewer = run(text, false), all = run(text, true);
    // A loop whose counter is written through an element beyond its array may go on for ever.
    if (fewer.commands == kMostCommands || all.commands == kMostCommands) continue;
    ++compared;
    EXPECT_EQ(fewer.fault, all.fault) << "seed " << seed << "\n" << text;
    EXPECT_EQ(fewer.variables, all.variables) << "seed " << seed << "\n" << text;
    saved += all.commands - fewer.commands;
    written += all.commands;
  }
  std::printf("%.1f %% of the commands saved\n", 100.0 * static_cast<double>(saved) / static_cast<double>(written));
  EXPECT_GT(saved, written / 10);
  EXPECT_GT(compared, 2900);
}

// The programs of the other tests, which have no such forms on purpose.
TEST(Savings, GeneratedProgramsDoWhatIsWritten) {
  for (uint64_t seed = 2'000'001; seed <= 2'002'000 && !::testing::Test::HasFailure(); ++seed) {
    Program program = generate_program(seed, false);
    const std::string source = source_text(program);
    std::vector<std::vector<int32_t>> results;
    for (const bool as_written : {false, true}) {
      compiler::CompileOptions options;
      options.unit = stdlib::find_unit(std::string_view(program.unit));
      options.as_written = as_written;
      const compiler::Compilation made = compiler::compile("T.IPC", "", source, options);
      ASSERT_TRUE(made.image) << seed;
      const auto image = vm::verify(made.image->code,
                                    {options.unit->variables, options.unit->program_words, options.unit->tasks, options.unit->call_depth}, {});
      ASSERT_TRUE(image.image) << seed;
      vm::Machine machine(*image.image, {});
      machine.start();
      machine.run(1, 20'000'000);
      std::vector<int32_t>& variables = results.emplace_back(machine.variables().begin(), machine.variables().end());
      for (const auto& row : made.map)
        if (row.range == "temporaries") std::fill_n(variables.begin() + row.number, row.count, 0);
    }
    // A temporary more or less moves none of the program's variables; what either uses is left aside.
    EXPECT_EQ(results[0], results[1]) << "seed " << seed << "\n" << source;
  }
}

// Main, task 2, task 3 and a variable interrupt each compute with variables of their own, a thousand times over; what each has at the
// end does not depend on the others. Task 3 changes a variable of main's switch, from one of its cases to another, so that the
// sum of the counters is that of the turns and the default is never reached.
TEST(Savings, BesideTasksAndAnInterrupt) {
  int interrupted = 0, compared = 0;
  for (uint64_t seed = 1; seed <= 300 && !::testing::Test::HasFailure(); ++seed) {
    Pcg random(seed + 77);
    std::string types, declarations, body;
    std::vector<std::string> parts;
    for (const char* root : {"m", "u", "v", "w"}) {
      Forms forms(random, root);
      types += forms.type();
      declarations += forms.declarations();
      parts.push_back(forms.statements(random.between(3, 8)));
    }
    std::string cases, states;
    const int count = random.between(2, 14);
    for (int n = 0; n < count; ++n) cases += fmt::format("case {}: counted{}++; break;\n", n * 3, n % 3);
    const std::string text =
        "#include <constb.h>\n#pragma var H900 H999\n#pragma globals 200 399\n" + types + declarations +
        "VARINT request;\nlong shared, lost, counted0, counted1, counted2, turns, uTurns, vTurns, wTurns, next;\n"
        "second()\n{\nwhile (uTurns < 20)\n{\n" + parts[1] + "uTurns++;\n}\n}\n"
        "third()\n{\nwhile (1)\n{\nif (vTurns < 20)\n{\n" + parts[2] + "vTurns++;\n}\nnext = next + 7;\nshared = next % " + std::to_string(count) +
        " * 3;\n}\n}\n"
        "changed()\n{\nif (wTurns < 20)\n{\n" + parts[3] + "wTurns++;\n}\n}\n"
        "main()\n{\n_SetTask2(T2_START, second);\n_SetTask(T2_START, third);\nrequest.Control = 2;\nrequest.SrcVar = numof(next);\nrequest.CompareVar = 8;\nrequest.Mode = VI_CHANGED;\nrequest.Priority = 1;\n"
        "_SetVarInterrupt(request, changed);\n"
        "while (turns < 20)\n{\n" + parts[0] + "switch (shared)\n{\n" + cases + "default: lost++;\n}\nturns++;\n}\nwhile (1) ;\n}\n";
    std::vector<std::map<std::string, int32_t>> ends;
    for (const bool as_written : {false, true}) {
      compiler::CompileOptions options;
      options.unit = &mdxb();
      options.atomic = true;  // `shared` gets its value at once
      options.as_written = as_written;
      const compiler::Compilation made = compiler::compile("T.IPC", "", text, options);
      ASSERT_TRUE(made.image) << compiler::render_text(made.diagnostics.all(), *made.sources, false) << text;
      const auto image = vm::verify(made.image->code, {mdxb().variables, mdxb().program_words, mdxb().tasks, mdxb().call_depth}, {}).image;
      const vm::Host host{nullptr, [](void*, vm::Machine&, int, const vm::Instruction&) noexcept { return vm::HostReply{}; }};
      auto machine = std::make_unique<vm::Machine>(*image, host);
      machine->start();
      const auto rate = static_cast<uint32_t>(3 + seed % 9);
      for (int ms = 0; ms < 8000; ++ms) vm::run_tick(*machine, vm::Rates{{rate, rate + 1, 20}});
      std::map<std::string, int32_t>& end = ends.emplace_back();
      for (const vm::Symbol& symbol : made.image->symbols)
        for (uint32_t n = 0; n < symbol.count; ++n) end[fmt::format("{}[{}]", symbol.name, n)] = machine->variables()[symbol.variable + n];
      EXPECT_EQ(end["lost[0]"], 0) << "seed " << seed << "\n" << text;
      EXPECT_EQ(end["counted0[0]"] + end["counted1[0]"] + end["counted2[0]"], end["turns[0]"]) << "seed " << seed;
      for (const char* name : {"shared[0]", "next[0]", "counted0[0]", "counted1[0]", "counted2[0]", "request.IntEvent[0]"}) end.erase(name);
    }
    const auto is_done = [](std::map<std::string, int32_t>& end) {
      return end["turns[0]"] == 20 && end["uTurns[0]"] == 20 && end["vTurns[0]"] == 20 && end["wTurns[0]"] == 20;
    };
    if (!is_done(ends[0]) || !is_done(ends[1])) continue;
    EXPECT_EQ(ends[0], ends[1]) << "seed " << seed << "\n" << text;
    interrupted += ends[0]["wTurns[0]"] != 0;
    ++compared;
  }
  EXPECT_GT(compared, 200);
  EXPECT_GT(interrupted, 200);
}

}  // namespace
}  // namespace ipos::tests
