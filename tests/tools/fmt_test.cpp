// ipos fmt on the command line: in place, through standard output, --check and --diff.
#include <gtest/gtest.h>

#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

const std::string kUgly = "main(){H0=1;\n  H1=2;\n  H2=3;\n  H3=4;\n  H4=5;\n}\n";
const std::string kNeat = "main()\n{\n    H0 = 1;\n    H1 = 2;\n    H2 = 3;\n    H3 = 4;\n    H4 = 5;\n}\n";

TEST(Fmt, InPlaceAndFolders) {
  const TemporaryFolder folder;
  const std::string file = folder.write("A.IPC", kUgly);
  folder.write("B.IPC", "#include \"a.h\"\nmain(){}");
  const std::string header = folder.write("a.h", "#include \"deep.h\"\nlong  a ;");
  const std::string deep = folder.write("deep.h", "long  b ;");
  const std::string other = folder.write("other.h", "long  c ;");
  const std::string notes = folder.write("notes.txt", kUgly);
  EXPECT_EQ(run_ipos({"fmt", "--check", folder.path().string()}).exit_code, 1);
  EXPECT_EQ(read_text(file), kUgly);
  const CommandResult result = run_ipos({"fmt", folder.path().string()});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.out + result.err, "");
  EXPECT_EQ(read_text(file), kNeat);
  EXPECT_EQ(read_text(header), "#include \"deep.h\"\nlong a;\n");
  EXPECT_EQ(read_text(deep), "long b;\n");
  EXPECT_EQ(read_text(other), "long  c ;") << "no source includes it";
  EXPECT_EQ(read_text(notes), kUgly);
  EXPECT_EQ(run_ipos({"fmt", "--check", folder.path().string()}).exit_code, 0);
}

TEST(Fmt, CheckNamesTheFiles) {
  const TemporaryFolder folder;
  folder.write("A.IPC", kUgly);
  folder.write("B.IPC", kNeat);
  const CommandResult result = run_ipos({"fmt", "--check", "A.IPC", "B.IPC"}, folder.path());
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.out, "A.IPC\n");
}

// patch(1) takes the difference: the other tool that knows the form.
TEST(Fmt, DiffIsWhatPatchReads) {
  const TemporaryFolder folder;
  const std::string file =
      folder.write("A.IPC", "// 1\n// 2\n// 3\n// 4\n" + kUgly + "// 5\n// 6\n// 7\n// 8\nf(){}");
  const CommandResult diff = run_ipos({"fmt", "--diff", "A.IPC"}, folder.path());
  EXPECT_EQ(diff.exit_code, 0);
  EXPECT_EQ(diff.out.substr(0, 22), "--- A.IPC\n+++ A.IPC\n@@");
  ASSERT_EQ(run_ipos({"fmt", "--diff", "A.IPC"}, folder.path()).out, diff.out) << "nothing was changed";
  const std::string patch = folder.write("changes", diff.out);
  if (std::system("command -v patch >/dev/null") != 0) GTEST_SKIP() << "there is no patch";
  const std::string command = "cd '" + folder.path().string() + "' && patch -s -o patched A.IPC < changes";
  ASSERT_EQ(std::system(command.c_str()), 0) << diff.out;
  EXPECT_EQ(run_ipos({"fmt", file}).exit_code, 0);
  EXPECT_EQ(read_text(folder.path() / "patched"), read_text(file));
}

TEST(Fmt, RefusesWithThePlace) {
  const TemporaryFolder folder;
  const std::string file = folder.write("A.IPC", "main()\n{ /* open\n");
  const CommandResult result = run_ipos({"fmt", file});
  EXPECT_EQ(result.exit_code, 65);
  EXPECT_EQ(result.err.substr(0, file.size() + 10), file + ":2: error:");
  EXPECT_EQ(read_text(file), "main()\n{ /* open\n");
  EXPECT_EQ(run_ipos({"fmt", "no-such.IPC"}).exit_code, 66);
}

// Files of other languages, by name and in a folder: none is touched.
TEST(Fmt, NothingButIposSources) {
  const TemporaryFolder folder;
  folder.write("A.IPC", kNeat);
  const std::vector<std::pair<std::string, std::string>> others = {
      {"line.toml", "[[station]]\nname  =  \"u\"\n"},
      {"t.py", "def f():\n    if a:\n        return 1\n"},
      {"Makefile", "all:\n\tcc a.c\n"},
      {"n.md", "*  a\n*  b\n"},
      {"namespaces.h", "#include <string>\nstd::string name();\n"},
      {"numbers.h", "const double a=1.5e-3;\n"},
      {"point.h", "const double a=.5;\n"},
      {"text.h", "extern const char*t;\n#define A \"b\"\nconst char*u=\"c\";\n"},
      {"rest.h", "int printf(const char*,...);\n"},
      {"member.h", "int f(){return (a.*b)(c->*d);}\n"},
      {"order.h", "auto a=b<=>c;\n"},
      {"letter.h", "char c='c';\n"},
      {"at.h", "@interface A\n"},
  };
  for (const auto& [name, text] : others) folder.write(name, text);
  EXPECT_EQ(run_ipos({"fmt", "."}, folder.path()).exit_code, 0);
  for (const auto& [name, text] : others) {
    const CommandResult result = run_ipos({"fmt", name}, folder.path());
    EXPECT_EQ(result.exit_code, 65) << name;
    EXPECT_TRUE(result.err.starts_with(name + ":")) << result.err;
    EXPECT_EQ(read_text(folder.path() / name), text) << name;
  }
  // What is named beside it is formatted all the same.
  folder.write("A.IPC", kUgly);
  EXPECT_EQ(run_ipos({"fmt", "t.py", "A.IPC"}, folder.path()).exit_code, 65);
  EXPECT_EQ(read_text(folder.path() / "A.IPC"), kNeat);
}

TEST(Fmt, ExamplesAreInTheOneLayout) {
  const CommandResult result = run_ipos({"fmt", "--check", "examples"}, project(""));
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
}

}  // namespace
}  // namespace ipos::tests
