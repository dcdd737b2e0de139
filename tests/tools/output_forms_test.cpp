// A file whose name says a form that an option cannot write is refused before anything runs, and nothing is written.
#include <gtest/gtest.h>

#include "tests/tools/command.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/output_forms.hpp"

namespace ipos::tests {
namespace {

TEST(OutputForms, EveryRowKnowsItsEndingsAndRefusesOthers) {
  for (const tools::OutputForms& row : tools::output_forms()) {
    for (const std::string_view ending : row.endings) {
      EXPECT_EQ(tools::output_ending(row.option, "dir.x/a" + std::string(ending)), ending) << row.option;
      std::string capitals(ending);
      for (char& c : capitals) c = static_cast<char>(std::toupper(c));
      EXPECT_EQ(tools::output_ending(row.option, "a" + capitals), ending) << row.option;
    }
    for (const char* none : {"", "-"}) EXPECT_EQ(tools::output_ending(row.option, none), "") << row.option;
    for (const char* wrong : {"a.png", "a.pdf", "a.blf", "a.docx", "a.svg.png", "a."}) try {
        tools::output_ending(row.option, wrong);
        ADD_FAILURE() << row.option << " takes " << wrong;
      } catch (const tools::Failure& failure) {
        EXPECT_EQ(failure.exit_code(), 64);
        for (const std::string_view ending : row.endings)
          EXPECT_NE(std::string(failure.what()).find(ending), std::string::npos) << failure.what();
      }
  }
}

TEST(OutputForms, TheVerbsAskForTheirForms) {
  const TemporaryFolder folder;
  folder.write("p.toml",
               "[[bus]]\nname = \"sbus\"\nkind = \"can\"\n[[station]]\nname = \"saw\"\nunit = \"md60a\"\nsbus = \"sbus\"\n");
  folder.write("can.log", "(1.000000) sbus 100#00\n");
  const auto refused = [&](std::vector<std::string> arguments, const std::string& file) {
    arguments.push_back(file);
    const CommandResult result = run_ipos(arguments, folder.path());
    EXPECT_EQ(result.exit_code, 64) << arguments[0] << " " << arguments[arguments.size() - 2] << result.err;
    EXPECT_NE(result.err.find("the name must end in ."), std::string::npos) << result.err;
    EXPECT_FALSE(std::filesystem::exists(folder.path() / file)) << file;
  };
  for (const char* option : {"--plot", "--trace", "--log", "--serial-log", "--coverage"})
    refused({"run", "p.toml", "--for", "1ms", option}, "a.png");
  refused({"run", "p.toml", "--for", "1ms", "--serial-log"}, "x.pcapng");
  refused({"run", "p.toml", "--for", "1ms", "--log"}, "x.blf");
  for (const char* option : {"--junit", "--tap", "--json", "--html", "--coverage"})
    refused({"test", "p.toml", option}, "a.png");
  refused({"scope", "p.toml", "saw", "-o"}, "a.png");
  refused({"bus", "replay", "can.log", "p.toml", "--log"}, "a.png");
  EXPECT_EQ(run_ipos({"run", "p.toml", "--for", "1ms", "--plot", "a.SVG"}, folder.path()).exit_code, 0);
}

}  // namespace
}  // namespace ipos::tests
