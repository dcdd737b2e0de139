// Texts of strangers, in every field that has one, through every verb: no byte of them acts on a terminal, makes a line
// of its own, or spoils a report. And inputs as large as they may be, and larger: an answer, not a crash.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/harness/contains.hpp"
#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

namespace fs = std::filesystem;

// What a text of a stranger may have in it; in a file name as it is, in TOML by its escapes.
constexpr const char* kBytes[] = {"\x1b]0;pwn\x07\x1b[2J", "\nipos: error: faked", "\r::error::faked", "\x07\x08\x7f", ("\x9b" "31m")};
constexpr const char* kEscapes[] = {"\\u001b]0;pwn\\u0007\\u001b[2J", "\\nipos: error: faked", "\\r::error::faked",
                                    "\\u0007\\b\\u007f", "\\u009b31m"};

void expect_clean(const std::string& text, const std::string& what) {
  for (size_t n = 0; n < text.size(); ++n) {
    const auto byte = static_cast<unsigned char>(text[n]);
    const bool control = (byte < 0x20 && byte != '\n' && byte != '\t') || byte == 0x7F ||
                         (byte == 0xC2 && n + 1 < text.size() && static_cast<unsigned char>(text[n + 1]) < 0xA0);
    const bool lone = byte >= 0x80 && byte < 0xC0 && (n == 0 || static_cast<unsigned char>(text[n - 1]) < 0x80);
    ASSERT_FALSE(control || lone) << what << ": byte " << int{byte} << " in " << nlohmann::json(text).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  }
  ASSERT_FALSE(text.starts_with("ipos: error: faked") || contains(text, "\nipos: error: faked") || contains(text, "\n::error::faked"))
      << what << ": " << text;
}

const std::string kProgram = "long lCount;\nmain()\n{\n  while (1) { lCount = lCount + 1; _Wait(10); }\n}\n";

// A plant with every kind of table; the text under test takes the place of one value.
const std::string kPlant = R"([[bus]]
name = "sbus"
kind = "can"
baud = 500000
[[bus]]
name = "xt"
kind = "rs485"
[[station]]
name = "saw"
unit = "mdxb"
program = "A.IPC"
sbus = "sbus"
rs485_xt = "xt"
firmware = "823 947 6.16"
nvram = "saw.nv"
hex = ["lCount"]
[station.parameters]
P130 = "2.5 s"
[station.inputs]
DI10 = 1
[station.analog]
AI1 = "5 V"
[[stimulus]]
station = "saw"
at = "10ms"
input = "DI10"
set = 1
[[wire]]
from = "saw.DO01"
to = "saw.DI11"
[[fault]]
bus = "sbus"
at = "5ms"
kind = "silence"
[[expect]]
station = "saw"
at = "50ms"
variable = "lCount"
equals = 4
)";

class Strangers : public ::testing::Test {
 protected:
  void SetUp() override { folder_.write("A.IPC", kProgram); }

  void run_verb(const std::vector<std::string>& words, const std::string& what) {
    const CommandResult result = run_ipos(words, folder_.path());
    std::string line = what;
    for (const std::string& word : words) line += " " + word;
    EXPECT_NE(result.exit_code, 70) << line << result.err;
    EXPECT_GE(result.exit_code, 0) << line;
    expect_clean(result.out, line);
    expect_clean(result.err, line);
  }
  TemporaryFolder folder_;
};

TEST_F(Strangers, TextsOfPlants) {
  // Each text in quotes, values and names of keys, one after the other.
  size_t fields = 0;
  for (size_t at = kPlant.find('"'); at != std::string::npos; ++fields) {
    const size_t end = kPlant.find('"', at + 1);
    for (const char* escape : kEscapes) {
      folder_.write("p.toml", kPlant.substr(0, end) + escape + kPlant.substr(end));
      const std::string what = kPlant.substr(at, end - at);
      run_verb({"run", "p.toml", "--for", "20ms"}, what);
      if (escape != kEscapes[0]) continue;
      for (const std::vector<std::string>& words :
           {std::vector<std::string>{"run", "p.toml", "--for", "5ms", "--format", "json", "--watch"},
            {"bus", "plan", "p.toml"}, {"bus", "dbc", "p.toml"}, {"param", "list", "p.toml"}, {"test", "p.toml", "--format", "github"}})
        run_verb(words, what);
    }
    at = kPlant.find('"', end + 1);
  }
  EXPECT_EQ(fields, static_cast<size_t>(std::count(kPlant.begin(), kPlant.end(), '"')) / 2);
}

TEST_F(Strangers, TextsOfTests) {
  folder_.write("p.toml", "[[station]]\nname = \"saw\"\nunit = \"mdxb\"\nprogram = \"A.IPC\"\n");
  const std::string test =
      "plant = \"p.toml\"\n[[case]]\nname = \"one\"\nvalue = \"text\"\n[[step]]\nat = \"5ms\"\nstation = \"saw\"\ninput = \"DI10\"\npulse = 1\nfor = "
      "\"5ms\"\n[[expect]]\nnote = \"why\"\nat = \"20ms\"\nstation = \"saw\"\nvariable = \"lCount\"\nequals = 99\n";
  for (size_t at = test.find('"'); at != std::string::npos;) {
    const size_t end = test.find('"', at + 1);
    for (const char* escape : kEscapes) {
      folder_.write("a.test.toml", test.substr(0, end) + escape + test.substr(end));
      const std::string what = test.substr(at, end - at);
      run_verb({"test", "a.test.toml", "--format", "github", "--junit", "r.xml", "--tap", "r.tap", "--html", "r.html"}, what);
      for (const char* report : {"r.xml", "r.tap", "r.html"})
        if (fs::exists(folder_.path() / report)) expect_clean(read_text(folder_.path() / report), what + report);
      run_verb({"test", "a.test.toml", "--list"}, what);
    }
    at = test.find('"', end + 1);
  }
}

TEST_F(Strangers, NamesOfFiles) {
  for (const char* bytes : kBytes) {
    const std::string name = std::string("f") + bytes;
    if (name.find('/') != std::string::npos) continue;
    for (const auto& [ending, text] : {std::pair<std::string, std::string>{".IPC", "long 5;\n"}, {".IPC", kProgram}, {".ipx", "IPX1"}, {".ipa", "SET"},
                                       {".toml", "x = 1\n"}, {".test.toml", "x = 1\n"}, {".log", "(1.0) can0 1#2\nx\n"}}) {
      const std::string file = name + ending;
      folder_.write(file, text);
      for (const std::vector<std::string>& words :
           {std::vector<std::string>{"build", file}, {"run", file, "--for", "1ms"}, {"run", file, "--for", "1ms", "--format", "json"},
            {"test", file}, {"test", "."}, {"test", ".", "--list"}, {"verify", file}, {"disasm", file}, {"asm", file},
            {"fmt", file, "--check"}, {"fmt", ".", "--check"}, {"fmt", file, "--diff"}, {"bus", "decode", file}, {"bus", "load", "--baud", "500000", file},
            {"param", "list", file}, {"debug", file}, {"bus", "plan", file}, {"build", file, "--emit=listing"}})
        run_verb(words, "file");
      fs::remove(folder_.path() / file);
    }
    folder_.write("h.IPC", "#include \"" + name + ".h\"\nmain() { }\n");
    run_verb({"build", "h.IPC"}, "include");
  }
  // Latin-1, as files out of old archives have it: no reason to refuse one, and JSON stays JSON.
  folder_.write("Gr\xf6sse.IPC", kProgram);
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"run", "Gr\xf6sse.IPC", "--for", "1ms", "--format", "json", "--watch"},
        {"run", "Gr\xf6sse.IPC", "--signals", "list", "--format", "json"}}) {
    const CommandResult json = run_ipos(words, folder_.path());
    EXPECT_EQ(json.exit_code, 0) << json.err;
    EXPECT_FALSE(nlohmann::json::parse(json.out, nullptr, false).is_discarded()) << json.out;
  }
}

TEST_F(Strangers, TextsOfSourcesAndImages) {
  for (const char* bytes : kBytes) {
    folder_.write("s.IPC", "long a; // " + std::string(bytes) + "\n#error " + bytes + "\nmain() { a = b" + bytes + "; }\n");
    folder_.write("t.IPC", "long a; // " + std::string(bytes) + "\nmain() { a = 1; /* " + bytes + " */ while (1) a = a + 1; }\n");
    for (const char* file : {"s.IPC", "t.IPC"})
      for (const std::vector<std::string>& words :
           {std::vector<std::string>{"build", file, "-o", "s.ipx"}, {"build", file, "--diagnostics", "json"}, {"build", file, "--diagnostics", "sarif"},
            {"build", file, "--emit=listing"}, {"build", file, "--emit=tokens"}, {"build", file, "--emit=ast"}, {"build", file, "--emit=map"},
            {"test", file}, {"run", file, "--for", "1ms", "--watch"}})
        run_verb(words, "source");
  }
  // Names in images: what controls anything is refused, Latin-1 is shown.
  folder_.write("n.ipa", ".unit md60a\n.symbol H420 \"a\\xE4b\"\n.function \"f\\xF6\" M01\nM01 : SET H420 = 1\nEND\n");
  ASSERT_EQ(run_ipos({"asm", "n.ipa"}, folder_.path()).exit_code, 0);
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"run", "n.ipx", "--for", "1ms", "--watch"}, {"run", "n.ipx", "--for", "1ms", "--watch", "--format", "json"},
        {"disasm", "n.ipx"}, {"verify", "n.ipx"}, {"run", "n.ipx", "--signals", "list"}, {"run", "n.ipx", "--signals", "list", "--format", "json"}})
    run_verb(words, "image");
  const CommandResult json = run_ipos({"run", "n.ipx", "--for", "1ms", "--watch", "--format", "json"}, folder_.path());
  EXPECT_EQ(nlohmann::json::parse(json.out)["stations"][0]["variables"][0]["name"], "a\xc3\xa4" "b");
  folder_.write("c.ipa", ".unit md60a\n.symbol H420 \"a\\x1Bb\"\nM01 : SET H420 = 1\nEND\n");
  EXPECT_EQ(run_ipos({"asm", "c.ipa"}, folder_.path()).exit_code, 65);
  folder_.write("b.ipa", ".unit md60a\n.symbol H500 x 3000\nM01 : ADD H0 + 1\nWAIT 1\nJMP M01\n");
  const CommandResult beyond = run_ipos({"asm", "b.ipa"}, folder_.path());
  EXPECT_EQ(beyond.exit_code, 65);
  EXPECT_TRUE(contains(beyond.err, "E0303") && contains(beyond.err, "up to H511")) << beyond.err;
}

// Lines that end with CR LF are quoted without it.
TEST_F(Strangers, QuotedLinesOfCrLfFiles) {
  const auto crlf = [](std::string text) {
    for (size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) text.insert(at, "\r");
    return text;
  };
  folder_.write("A.IPC", crlf("long x;\nlong y;\nmain()\n{\n  x = 2;\n  while (1) _Wait(10);\n}\n"));
  folder_.write("B.IPC", crlf("long x;\nmain()\n{\n  x = zz;\n}\n// expect x = 3\n"));
  folder_.write("a.test.toml", crlf("[[station]]\nname = \"d\"\nunit = \"mdxb\"\nprogram = \"A.IPC\"\n[[expect]]\nat = \"15ms\"\nvariable = \"x\"\nequals = 1\n"));
  folder_.write("p.toml", crlf("[[station]]\nname = \"d\"\nunit = \"mdxc\"\n"));
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"test", "a.test.toml", "--junit", "r.xml", "--tap", "r.tap", "--html", "r.html", "--json", "r.json"}, {"test", "B.IPC"},
        {"run", "p.toml", "--for", "1ms"}, {"build", "B.IPC"}, {"build", "B.IPC", "--diagnostics", "json"}, {"build", "A.IPC", "--emit=listing"},
        {"build", "A.IPC", "--emit=asm"}, {"fmt", "A.IPC", "--check"}}) {
    const CommandResult result = run_ipos(words, folder_.path());
    std::string all = result.out + result.err;
    for (const char* report : {"r.xml", "r.tap", "r.html", "r.json"})
      if (fs::exists(folder_.path() / report)) all += read_text(folder_.path() / report);
    for (const char* end : {"?\n", "\r", "?\"", "?<", "\\r"}) EXPECT_FALSE(contains(all, end)) << words[0] << words[1] << all;
  }
}

// U+FFFE and U+FFFF are no characters of XML, ESC is none of a line for GitHub.
TEST_F(Strangers, ReportsAreReadByTheirReaders) {
  folder_.write("A.IPC", kProgram);
  const std::string expect = "[[expect]]\nat = \"5ms\"\nvariable = \"lCount\"\nequals = 77\n";
  folder_.write("odd\xEF\xBF\xBE.test.toml", "[[station]]\nname = \"d\"\nunit = \"mdxb\"\nprogram = \"A.IPC\"\n" + expect + "note = \"\\uFFFE\\uFFFF \\\" : # |\"\n");
  folder_.write("two.test.toml", "[[station]]\nname = \"d\xEF\xBF\xBF\"\nunit = \"mdxb\"\nprogram = \"A.IPC\"\n" + expect);
  folder_.write("broken.test.toml", "x = 1\n\n");
  folder_.write("good.test.toml", "[[station]]\nname = \"d\"\nunit = \"mdxb\"\nprogram = \"A.IPC\"\n[[expect]]\nat = \"5ms\"\nvariable = \"lCount\"\nequals = 1\n");
  run_ipos({"test", ".", "--junit", "r.xml", "--tap", "r.tap", "--json", "r.json", "--html", "r.html"}, folder_.path());
  const std::string folder = folder_.path().string();
  EXPECT_EQ(std::system(("cd '" + folder + "' && python3 -c \"import xml.dom.minidom as m; m.parse('r.xml')\"").c_str()), 0);
  EXPECT_FALSE(nlohmann::json::parse(read_text(folder_.path() / "r.json"), nullptr, false).is_discarded());
  if (std::system("command -v prove > /dev/null") == 0) {
    EXPECT_NE(std::system(("cd '" + folder + "' && prove -v --exec cat r.tap > prove.txt 2>&1").c_str()), -1);
    const std::string told = read_text(folder_.path() / "prove.txt");
    EXPECT_TRUE(contains(told, "Failed 3/4 subtests")) << told;
    EXPECT_FALSE(contains(told, "Parse errors")) << told;
  }
}

// ---- Size

// Runs with so much memory that a multiple of the input fits, and no more.
CommandResult bounded(const std::vector<std::string>& words, const fs::path& folder, uint64_t megabytes) {
  rlimit before{};
  getrlimit(RLIMIT_AS, &before);
  const rlimit small{megabytes << 20U, before.rlim_max};
  setrlimit(RLIMIT_AS, &small);
  CommandResult result = run_ipos(words, folder);
  setrlimit(RLIMIT_AS, &before);
  return result;
}

std::string times(const std::string& text, size_t n) {
  std::string all;
  all.reserve(text.size() * n);
  for (size_t k = 0; k < n; ++k) all += text;
  return all;
}

struct Large {
  const char* file;
  std::string text;
  int exit_code;
  std::vector<std::string> words;
};

class Sizes : public Strangers {};

TEST_F(Sizes, WhatIsLargeIsAnsweredAndWhatIsLargerIsRefused) {
  constexpr size_t kLimit = size_t{64} << 20U;  // tools/cli/files.hpp
  const std::string plant = "[[station]]\nname = \"d\"\nunit = \"mdxb\"\n";
  const auto filled = [&](const std::string& text, size_t size) { return text + std::string(size - text.size(), '#'); };
  const Large all[] = {
      {"p.toml", filled(plant, kLimit), 0, {"run", "p.toml", "--for", "1ms"}},
      {"p.toml", filled(plant, kLimit + 1), 66, {"run", "p.toml", "--for", "1ms"}},
      {"p.toml", times("a.", 100'000) + "a=1", 65, {"run", "p.toml"}},
      {"p.toml", times("a.", 1'000'000) + "a=1", 65, {"run", "p.toml"}},
      {"p.toml", "[" + times("a.", 1'000'000) + "a]", 65, {"run", "p.toml"}},
      {"p.toml", times("[", 10'000'000), 65, {"run", "p.toml"}},
      {"a.test.toml", times("a.", 1'000'000) + "a=1", 65, {"test", "a.test.toml"}},
      {"a.test.toml", filled("x = 1\n", kLimit), 65, {"test", "a.test.toml"}},
      {"a.test.toml", filled("x = 1\n", kLimit + 1), 66, {"test", "a.test.toml"}},
      {"s.IPC", kProgram + std::string(kLimit - kProgram.size(), ' '), 0, {"build", "s.IPC"}},
      {"s.IPC", kProgram + std::string(kLimit + 1 - kProgram.size(), ' '), 66, {"build", "s.IPC"}},
      {"s.IPC", "main() { " + times("(", 1'000'000) + "}", 65, {"build", "s.IPC"}},
      {"s.IPC", "main() {\n" + times("x9 = 1;\n", 100'000) + "}", 65, {"build", "s.IPC"}},
      {"x.ipx", "IPX1" + std::string(kLimit - 4, '\0'), 1, {"verify", "x.ipx"}},
      {"x.ipx", "IPX1" + std::string(kLimit - 3, '\0'), 66, {"verify", "x.ipx"}},
      {"x.ipa", ".unit mdxb\n" + times("SET H0 = 1\n", 1'000'000), 0, {"asm", "x.ipa"}},
      {"set.toml", times("a.", 1'000'000) + "a=1", 65, {"param", "load", "p2.toml", "set.toml"}},
      {"saw.nv", std::string(kLimit, 'x'), 65, {"run", "nv.toml", "--for", "1ms"}},
  };
  folder_.write("p2.toml", plant);
  folder_.write("nv.toml", plant + "nvram = \"saw.nv\"\n");
  for (const Large& one : all) {
    folder_.write(one.file, one.text);
    const CommandResult result = bounded(one.words, folder_.path(), 1500);
    EXPECT_EQ(result.exit_code, one.exit_code) << one.file << " " << one.text.size() << " " << one.text.substr(0, 20) << result.err.substr(0, 500);
    EXPECT_LT(result.err.size(), 200'000U);
    fs::remove(folder_.path() / one.file);
  }
}

// Too little memory is about the input, not a defect.
TEST_F(Sizes, WithoutMemoryTheInputIsTold) {
  folder_.write("s.IPC", kProgram + std::string(60U << 20U, ' '));
  const CommandResult result = bounded({"build", "s.IPC"}, folder_.path(), 100);
  EXPECT_EQ(result.exit_code, 65) << result.err;
  EXPECT_TRUE(contains(result.err, "more memory than there is")) << result.err;
}

// Messages of editors: one larger than a message may be ends the session with a reason.
TEST_F(Sizes, MessagesOfEditors) {
  for (const char* verb : {"lsp", "dap"}) {
    folder_.write("deep", "Content-Length: 2000000\r\n\r\n" + times("[", 2'000'000));
    folder_.write("large", "Content-Length: 268435457\r\n\r\n{");
    folder_.write("header", times("X: y\r\n", 20'000));
    for (const auto& [file, code] : {std::pair{"deep", verb[0] == 'l' ? 1 : 0}, {"large", 65}, {"header", 65}}) {
      const std::string line = "cd '" + folder_.path().string() + "' && ulimit -v 1500000 && '" + ipos_program() + "' " + verb + " < " + file + " > /dev/null 2> err";
      const int status = std::system(line.c_str());
      EXPECT_EQ(WEXITSTATUS(status), code) << verb << file << read_text(folder_.path() / "err");
    }
  }
}

// A test that does not come to its end on the clock has failed.
TEST_F(Sizes, ATestHasATimeOnTheClock) {
  folder_.write("busy.test.toml", "[[station]]\nname = \"d\"\nunit = \"mdxb\"\nprogram = \"A.IPC\"\n[[expect]]\nvariable = \"lCount\"\nalways = true\nmin = 0\nduring = \"4166563s\"\n");
  const CommandResult result = run_ipos({"test", "busy.test.toml", "--time-limit", "1"}, folder_.path());
  EXPECT_EQ(result.exit_code, 1) << result.out << result.err;
  EXPECT_TRUE(contains(result.out, "time: the test takes more than 1 s on the clock")) << result.out;
}

// A downloaded plant may name any file for a memory; it is told.
TEST_F(Strangers, AMemoryOutsideOfThePlantsFolderIsTold) {
  fs::create_directory(folder_.path() / "sub");
  const std::string station = "[[station]]\nname = \"d\"\nunit = \"mdxb\"\nnvram = ";
  folder_.write("sub/far.toml", station + "\"../d.nv\"\n");
  folder_.write("sub/near.toml", station + "\"x/../d.nv\"\n");
  fs::create_directory(folder_.path() / "sub/x");
  const CommandResult far = run_ipos({"run", "sub/far.toml", "--for", "1ms"}, folder_.path());
  EXPECT_EQ(far.exit_code, 0) << far.err;
  EXPECT_TRUE(contains(far.err, "sub/far.toml:4:") && contains(far.err, "is outside of the folder")) << far.err;
  EXPECT_EQ(far.err.find("outside"), far.err.rfind("outside"));
  const CommandResult near = run_ipos({"run", "sub/near.toml", "--for", "1ms"}, folder_.path());
  EXPECT_FALSE(contains(near.err, "outside")) << near.err;
}

}  // namespace
}  // namespace ipos::tests
