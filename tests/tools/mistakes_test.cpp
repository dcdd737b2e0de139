// Mistakes in a plant: all in one round, each with its line and a caret.
#include <gtest/gtest.h>

#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

// Nine mistakes of every kind: keys and forms, names that lead nowhere, what the unit refuses, programs.
const std::string kPlant =
    "[[bus]]\n"                    //  1
    "name = \"sbus\"\n"            //  2
    "kind = \"can\"\n"             //  3
    "[[station]]\n"                //  4
    "name = \"saw\"\n"             //  5
    "unit = \"mdxb\"\n"            //  6
    "sbus = \"nowhere\"\n"         //  7: no such bus
    "program = \"SAW.IPC\"\n"      //  8
    "colour = \"red\"\n"           //  9: no such key
    "[station.parameters]\n"       // 10
    "P9999 = 1\n"                  // 11: no such parameter
    "P302 = 99999999\n"            // 12: beyond its range
    "P003 = 1\n"                   // 13: read only
    "P100 = \"nobody\"\n"          // 14: no such text
    "[[station]]\n"                // 15
    "name = \"fan\"\n"             // 16
    "unit = \"mdxb\"\n"            // 17
    "program = \"MISSING.IPC\"\n"  // 18: no such file
    "[[expect]]\n"                 // 19
    "station = \"saw\"\n"          // 20
    "at = \"1 fortnight\"\n"       // 21: no time
    "variable = \"a\"\n"           // 22
    "equals = 1\n"                 // 23
    "[[stimulus]]\n"               // 24
    "station = \"saw\"\n"          // 25
    "at = \"1s\"\n"                // 26
    "variable = \"nobody\"\n"      // 27: no such variable
    "set = 1\n";                   // 28

TEST(Mistakes, OfAPlantAreToldInOneRound) {
  const TemporaryFolder folder;
  folder.write("p.toml", kPlant);
  folder.write("SAW.IPC", "long a;\nmain() { a = 1; }\n");
  const CommandResult result = run_ipos({"run", "p.toml", "--for", "1s"}, folder.path());
  EXPECT_EQ(result.exit_code, 65);
  for (const char* part :
       {"p.toml:7:8: error: there is no bus 'nowhere'\n    7 | sbus = \"nowhere\"\n      |        ^\n",
        "p.toml:9:1: error: unknown key 'colour'", "p.toml:11:", "P9999", "p.toml:12:", "P302",
        "p.toml:13:", "P003", "p.toml:14:", "nobody", "p.toml:18:", "MISSING.IPC: ",
        "p.toml:21:6: error: '1 fortnight' is no time", "p.toml:24:", "has no variable 'nobody'"})
    EXPECT_NE(result.err.find(part), std::string::npos) << part << "\n" << result.err;
  size_t count = 0;
  for (size_t at = result.err.find(": error: "); at != std::string::npos;
       at = result.err.find(": error: ", at + 1))
    ++count;
  EXPECT_EQ(count, 9U) << result.err;
}

TEST(Mistakes, ProgramsAreCompiledAllTheSame) {
  const TemporaryFolder folder;
  folder.write("p.toml", kPlant);
  folder.write("SAW.IPC", "long a;\nmain() { a = b; }\n");
  const CommandResult result = run_ipos({"run", "p.toml", "--for", "1s"}, folder.path());
  EXPECT_EQ(result.exit_code, 65);
  for (const char* part : {"SAW.IPC:2:", "[E0201]", "p.toml:9:1: error: unknown key", "MISSING.IPC"})
    EXPECT_NE(result.err.find(part), std::string::npos) << part << "\n" << result.err;
  // Nobody knows the variables of a program that has mistakes.
  EXPECT_EQ(result.err.find("has no variable 'nobody'"), std::string::npos) << result.err;
}

TEST(Mistakes, ATextWithoutQuotes) {
  const TemporaryFolder folder;
  folder.write("p.toml", "[[bus]]\nname = sbus\n");
  const CommandResult result = run_ipos({"run", "p.toml", "--for", "1s"}, folder.path());
  EXPECT_NE(
      result.err.find("p.toml:2:8: error: a value is a number, true, false, a list, or a text in quotes\n"),
      std::string::npos)
      << result.err;
}

// The caret stands under the character, also behind letters of several bytes.
TEST(Mistakes, CaretCountsCharacters) {
  const TemporaryFolder folder;
  folder.write("p.toml", "bus = [ { name = \"\xC3\xA4\xC3\xB6\", colour = 1, kind = \"can\" } ]\n");
  const CommandResult result = run_ipos({"run", "p.toml", "--for", "1s"}, folder.path());
  EXPECT_NE(result.err.find("colour = 1, kind = \"can\" } ]\n      |                        ^\n"),
            std::string::npos)
      << result.err;
}

}  // namespace
}  // namespace ipos::tests
