// Every verb where its surroundings are bad: standard output on a full disk, each input replaced by something
// that is no file, a folder that cannot be written to. No verb hangs, none changes a file of the user, and the
// exit codes are those of the table in docs/reference/command-line.md. The verbs come from --help: a new one needs a sample here.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <functional>
#include <map>
#include <set>
#include <sstream>
#include <thread>

#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

// A command that works, in a folder with the files of prepare().
struct Sample {
  Words words;
  Words inputs;        // files it reads; a word "@port" is a path from the root, "@case" the first case of the campaign
  Words outputs = {};  // files it may make or change
  std::string typed = {};
  bool finds_others =
      false;  // looks in a folder, or tells trouble in its protocol: may end well without an input
};

std::string framed(const std::string& body) {
  return "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
}

const std::map<std::string, std::vector<Sample>>& samples() {
  static const std::map<std::string, std::vector<Sample>> all = {
      {"build",
       {{{"build", "A.IPC", "-o", "out.ipx"}, {"A.IPC", "own.h"}, {"out.ipx"}},
        {{"build", "A.IPC", "--emit=listing"}, {"A.IPC", "own.h"}},
        {{"build", "A.IPC", "--emit=tokens"}, {"A.IPC", "own.h"}}}},
      {"asm", {{{"asm", "A.ipa", "-o", "out.ipx"}, {"A.ipa"}, {"out.ipx"}}}},
      {"disasm", {{{"disasm", "A.ipx"}, {"A.ipx"}}, {{"disasm", "A.ipx", "--listing"}, {"A.ipx"}}}},
      {"verify", {{{"verify", "A.ipx"}, {"A.ipx"}}}},
      {"run",
       {{{"run", "plant.toml", "--for", "10ms", "--watch", "--log", "out.log", "--serial-log", "out.slog",
          "--plot", "out.svg", "--trace", "out.csv", "--coverage", "out.info"},
         {"plant.toml", "A.IPC", "own.h", "u.nv"},
         {"out.log", "out.slog", "out.svg", "out.csv", "out.info", "u.nv"}},
        {{"run", "A.ipx", "--for", "10ms", "--watch", "--format", "json"}, {"A.ipx"}},
        {{"run", "plant.toml", "--for", "10ms", "--log", "-"}, {"plant.toml"}, {"u.nv"}}}},
      {"test",
       {{{"test", "x.test.toml", "--junit", "out.xml", "--tap", "out.tap", "--json", "out.json", "--coverage",
          "out.info"},
         {"x.test.toml", "plant.toml", "A.IPC", "own.h"},
         {"out.xml", "out.tap", "out.json", "out.info"}},
        {{"test", "."}, {}},
        {{"test", "x.test.toml", "--list"}, {"x.test.toml"}}}},
      {"campaign plan", {{{"campaign", "plan", "c.campaign.toml"}, {"c.campaign.toml", "plant.toml", "A.IPC", "own.h"}}}},
      {"campaign run",
       {{{"campaign", "run", "c.campaign.toml", "--out", "out.cases", "--jobs", "1"},
         {"c.campaign.toml", "plant.toml", "A.IPC", "own.h"},
         {"out.cases"}}}},
      {"campaign merge",
       {{{"campaign", "merge", "done", "--csv", "out.csv", "--junit", "out.xml", "--html", "out.html"},
         {"done/shard-1-of-1.jsonl"},
         {"out.csv", "out.xml", "out.html"}},
        {{"campaign", "merge", "done", "--csv", "-"}, {"done/shard-1-of-1.jsonl"}}}},
      {"campaign show", {{{"campaign", "show", "c.campaign.toml", "@case"}, {"c.campaign.toml", "plant.toml", "A.IPC", "own.h"}}}},
      {"trace export", {{{"trace", "export", "u.ipos-trace", "-o", "out.csv"}, {"u.ipos-trace"}, {"out.csv"}},
                        {{"trace", "export", "u.ipos-trace"}, {"u.ipos-trace"}}}},
      {"fmu", {{{"fmu", "plant.toml", "-o", "out.fmu"}, {"plant.toml", "A.IPC", "own.h"}, {"out.fmu"}}}},
      {"bus plan", {{{"bus", "plan", "plant.toml"}, {"plant.toml", "A.IPC", "own.h", "u.nv"}}}},
      {"bus decode",
       {{{"bus", "decode", "can.log", "--names", "plant.toml"}, {"can.log", "plant.toml", "A.IPC", "u.nv"}}}},
      {"bus monitor",
       {{{"bus", "monitor", "can.log", "--plant", "plant.toml"},
         {"can.log", "plant.toml", "A.IPC", "u.nv"}}}},
      {"bus load", {{{"bus", "load", "can.log", "--baud", "500000"}, {"can.log"}}}},
      {"bus replay",
       {{{"bus", "replay", "can.log", "plant.toml", "--watch", "--log", "out.log"},
         {"can.log", "plant.toml", "A.IPC", "u.nv"},
         {"out.log"}}}},
      {"bus dbc",
       {{{"bus", "dbc", "plant.toml"}, {"plant.toml", "A.IPC", "u.nv"}},
        {{"bus", "dbc", "A.ipx", "-o", "out.dbc"}, {"A.ipx"}, {"out.dbc"}}}},
      {"bus dissector",
       {{{"bus", "dissector", "plant.toml", "-o", "out.lua"}, {"plant.toml", "A.IPC", "u.nv"}, {"out.lua"}},
        {{"bus", "dissector"}, {}}}},
      {"param list", {{{"param", "list", "plant.toml"}, {"plant.toml", "u.nv"}}}},
      {"param get", {{{"param", "get", "plant.toml", "P130"}, {"plant.toml", "u.nv"}}}},
      {"param set", {{{"param", "set", "plant.toml", "P130=2.5s"}, {"plant.toml", "u.nv"}, {"u.nv"}}}},
      {"param save",
       {{{"param", "save", "plant.toml", "out.settings"}, {"plant.toml", "u.nv"}, {"out.settings"}},
        {{"param", "save", "plant.toml", "-"}, {"plant.toml", "u.nv"}}}},
      {"param load",
       {{{"param", "load", "plant.toml", "u.settings"}, {"plant.toml", "u.settings", "u.nv"}, {"u.nv"}}}},
      {"param diff",
       {{{"param", "diff", "u.settings", "plant.toml:u"}, {"u.settings", "plant.toml", "u.nv"}}}},
      {"watch",
       {{{"watch", "plant.toml", "u", "P000", "--count", "1", "--every", "10ms"},
         {"plant.toml", "A.IPC", "u.nv"}}}},
      {"canopen eds", {{{"canopen", "eds", "--unit", "mdxb", "-o", "out.eds"}, {}, {"out.eds"}}}},
      {"profibus gsd",
       {{{"profibus", "gsd", "ffp31", "-o", "-"}, {}},
        {{"profibus", "gsd", "size0", "-o", "out.gsd"}, {}, {"out.gsd"}},
        {{"profibus", "gsd", "dfp", "--unit", "md60a", "-o", "-"}, {}}}},
      {"fms", {{{"fms", "dp.toml", "inv", "read", "1025", "--at", "10ms"}, {"dp.toml"}}}},
      {"diag", {{{"diag", "plant.toml"}, {"plant.toml", "A.IPC", "u.nv"}}}},
      {"scope", {{{"scope", "b.toml", "--samples", "2"}, {"b.toml"}}}},
      {"scan", {{{"scan", "@port", "--to", "0"}, {"port"}}}},
      {"completion", {{{"completion", "bash"}, {}}, {{"completion", "fish"}, {}}}},
      {"man", {{{"man"}, {}}}},
      {"new", {{{"new", "out.project"}, {}, {"out.project"}}}},
      {"explain", {{{"explain", "E0201"}, {}}, {{"explain", "P130"}, {}}}},
      {"fmt",
       {{{"fmt", "A.IPC", "own.h"}, {"A.IPC", "own.h"}, {"A.IPC", "own.h"}, "", true},
        {{"fmt", "."}, {"A.IPC", "own.h"}, {"A.IPC", "own.h"}, "", true},
        {{"fmt", "--diff", "A.IPC"}, {"A.IPC"}, {}, "", true},
        {{"fmt"}, {}, {}, "main(){H0=1;}"}}},
      {"lsp",
       {{{"lsp"},
         {},
         {},
         framed(R"({"jsonrpc":"2.0","id":1,"method":"initialize","params":{"capabilities":{}}})") +
             framed(R"({"jsonrpc":"2.0","id":2,"method":"shutdown"})") +
             framed(R"({"jsonrpc":"2.0","method":"exit"})")}}},
      {"debug",
       {{{"debug", "plant.toml", "--for", "10ms"},
         {"plant.toml", "A.IPC", "own.h", "u.nv"},
         {},
         "continue\ninfo tasks\n"}}},
      {"dap",
       {{{"dap"},
         {"plant.toml", "A.IPC", "u.nv"},
         {},
         framed(R"({"seq":1,"type":"request","command":"initialize","arguments":{}})") +
             framed(R"({"seq":2,"type":"request","command":"launch","arguments":{"program":"plant.toml"}})"),
         true}}},
  };
  return all;
}

struct End {
  int code = -1;  // -1: it hung
  std::string out, err;
};

// Everything about the files of a folder that a user could miss.
std::map<std::string, std::string> state_of(const fs::path& folder, const Words& but = {}) {
  std::map<std::string, std::string> state;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().lexically_relative(folder).string();
    if (std::find(but.begin(), but.end(), name.substr(0, name.find('/'))) != but.end()) continue;
    struct stat info {};
    lstat(entry.path().c_str(), &info);
    std::string& text = state[name];
    text = std::to_string(info.st_mode) + " " + std::to_string(info.st_size) + " " +
           std::to_string(info.st_mtim.tv_sec) + "." + std::to_string(info.st_mtim.tv_nsec);
    if (S_ISLNK(info.st_mode)) text += fs::read_symlink(entry.path()).string();
    if (S_ISREG(info.st_mode) && info.st_size < 1'000'000) text += read_text(entry.path());
  }
  return state;
}

class Sweep : public ::testing::Test {
 protected:
  static constexpr auto kPatience =
      std::chrono::seconds(60);  // far beyond any good end, also on a busy machine

  Sweep() { prepare(); }
  ~Sweep() override { RecordProperty("cases", cases_); }

  void prepare() {
    const TemporaryFolder& f = good_;
    f.write("own.h", "#define STEP 1\nlong lCount;\n");
    f.write("A.IPC", "#include \"own.h\"\nmain()\n{\n  while(1) lCount=lCount+STEP;\n}\n");
    f.write("A.ipa", "END\n");
    f.write("can.log", "(1.000000) sbus 400#5566778800000000\n");
    f.write("dp.toml",
            "[[bus]]\nname = \"dp\"\nkind = \"profibus\"\n[[station]]\nname = \"inv\"\nunit = \"mc31\"\noption = \"ffp31\"\n"
            "profibus = \"dp\"\nprofibus_address = 8\n");
    f.write("b.toml", "[[station]]\nname = \"b\"\nunit = \"mdxb\"\n");
    f.write("plant.toml",
            "[[bus]]\nname = \"sbus\"\nkind = \"can\"\n[[station]]\nname = \"u\"\nunit = \"md60a\"\nprogram "
            "= \"A.IPC\"\n"
            "sbus = \"sbus\"\nnvram = \"u.nv\"\n");
    f.write("x.test.toml",
            "plant = \"plant.toml\"\n[[expect]]\nstation = \"u\"\nstate = \"fault\"\nequals = 0\n"
            "[[step]]\nwait = \"1ms\"\n");
    f.write("port", "no port\n");
    f.write("c.campaign.toml",
            "plant = \"plant.toml\"\nfor = \"10ms\"\n[[vary]]\nstation = \"u\"\nvariable = \"H10\"\nvalues = [1, 2]\n");
    ASSERT_EQ(run_ipos({"build", "A.IPC"}, f.path()).exit_code, 0);
    ASSERT_EQ(run_ipos({"param", "save", "plant.toml", "u.settings"}, f.path()).exit_code, 0);
    ASSERT_EQ(run_ipos({"param", "set", "plant.toml", "P130=1.5s"}, f.path()).exit_code, 0);
    ASSERT_EQ(run_ipos({"run", "plant.toml", "--for", "10ms", "--trace", "u.ipos-trace"}, f.path()).exit_code, 0);
    ASSERT_EQ(run_ipos({"campaign", "run", "c.campaign.toml", "--out", "done", "--jobs", "1"}, f.path()).exit_code, 0);
    const std::string rows = read_text(f.path() / "done/shard-1-of-1.jsonl"), begin = "{\"case\":\"";
    ASSERT_TRUE(rows.starts_with(begin));
    case_ = rows.substr(begin.size(), 16);
    const std::string text = run_ipos({"disasm", "A.ipx"}, f.path()).out;
    f.write("A.ipa", text);
  }

  // A folder of its own for a case.
  std::unique_ptr<TemporaryFolder> copy() const {
    auto folder = std::make_unique<TemporaryFolder>();
    fs::copy(good_.path(), folder->path(), fs::copy_options::recursive);
    return folder;
  }

  // Runs the command in a folder; `before` is done in the child.
  End run(const Sample& sample, const fs::path& folder, const char* output = nullptr,
          const std::function<bool()>& before = {}) {
    ++cases_;
    const TemporaryFolder aside;
    const std::string typed = aside.write("typed", sample.typed);
    const std::string out = (aside.path() / "out").string(), err = (aside.path() / "err").string();
    const pid_t child = fork();
    if (child == 0) {
      dup2(open(typed.c_str(), O_RDONLY), 0);
      dup2(open(output == nullptr ? out.c_str() : output, O_WRONLY | O_CREAT, 0600), 1);
      dup2(open(err.c_str(), O_WRONLY | O_CREAT, 0600), 2);
      if (before && !before()) _exit(125);
      if (chdir(folder.c_str()) != 0) _exit(126);
      Words words = sample.words;
      for (std::string& word : words)
        if (word == "@case")
          word = case_;
        else if (word.starts_with("@"))
          word = (folder / word.substr(1)).string();
      std::vector<char*> argv{const_cast<char*>("ipos")};
      for (std::string& word : words) argv.push_back(word.data());
      argv.push_back(nullptr);
      execv(ipos_program(), argv.data());
      _exit(127);
    }
    int status = 0;
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    while (waitpid(child, &status, WNOHANG) == 0) {
      if (std::chrono::steady_clock::now() > deadline) {
        kill(child, SIGKILL);
        waitpid(child, &status, 0);
        return {-1, read_text(out), read_text(err)};
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return {code, output == nullptr ? read_text(out) : "", read_text(err)};
  }

  void for_each(const std::function<void(const Sample&, const std::string& name)>& action) {
    for (const auto& [verb, list] : samples())
      for (const Sample& sample : list) {
        std::string name = "ipos";
        for (const std::string& word : sample.words) name += " " + word;
        action(sample, name);
      }
    std::printf("%d cases\n", cases_);
  }

  TemporaryFolder good_;
  std::string case_;
  int cases_ = 0;
};

// The verbs below the words, as --help lists them.
Words verbs_of(Words words) {
  words.emplace_back("--help");
  std::istringstream help(run_ipos(words).out);
  Words verbs;
  bool listed = false;
  for (std::string line; std::getline(help, line);) {
    if (!line.empty() && line.front() != ' ' && line.back() == ':') {  // a heading; most are groups of verbs
      listed = line != "Options:" && line != "Positionals:" && !line.starts_with("Example");
    } else if (listed && line.starts_with("  ") && line.size() > 2 && line[2] != ' ') {
      verbs.push_back(line.substr(2, line.find(' ', 2) - 2));
    } else if (line.empty()) {
      listed = false;
    }
  }
  return verbs;
}

TEST(Samples, AreThereForEveryVerb) {
  std::set<std::string> verbs;
  for (const std::string& verb : verbs_of({})) {
    const Words inner = verbs_of({verb});
    for (const std::string& one : inner) verbs.insert(verb + " " + one);
    if (inner.empty()) verbs.insert(verb);
  }
  EXPECT_EQ(verbs.erase("serve"), 1U);  // which does not end by itself (tests/serve has what it reads)
  std::set<std::string> sampled;
  for (const auto& [verb, list] : samples()) sampled.insert(verb);
  EXPECT_EQ(sampled, verbs);
  EXPECT_GT(verbs.size(), 20U);
}

TEST_F(Sweep, LostStandardOutputIs74) {
  for_each([&](const Sample& sample, const std::string& name) {
    const auto folder = copy();
    const End good = run(sample, folder->path());
    EXPECT_EQ(good.code, sample.words[0] == "scan"               ? 74
                         : sample.words.back() == "plant.toml:u" ? 1
                                                                 : 0)
        << name << good.err;
    const auto again = copy();
    const auto before = state_of(again->path(), sample.outputs);
    const End lost = run(sample, again->path(), "/dev/full");
    EXPECT_EQ(lost.code, good.out.empty() ? good.code : 74) << name << "\n" << lost.err;
    EXPECT_EQ(state_of(again->path(), sample.outputs), before) << name;
    const End help = run({{sample.words[0], "--help"}, {}}, again->path(), "/dev/full");
    EXPECT_EQ(help.code, 74) << name;
  });
}

TEST_F(Sweep, InputsThatAreNoFiles) {
  const std::map<std::string, std::function<void(const fs::path&)>> replacements = {
      {"a folder", [](const fs::path& path) { fs::create_directory(path); }},
      {"a device", [](const fs::path& path) { fs::create_symlink("/dev/zero", path); }},
      {"a pipe", [](const fs::path& path) { ASSERT_EQ(mkfifo(path.c_str(), 0600), 0); }},
      {"a loop of links", [](const fs::path& path) { fs::create_symlink(path.filename(), path); }},
      {"3 GB",
       [](const fs::path& path) {
         const int file = open(path.c_str(), O_WRONLY | O_CREAT, 0600);
         ASSERT_EQ(ftruncate(file, off_t{3} << 30), 0);
         close(file);
       }},
  };
  for_each([&](const Sample& sample, const std::string& name) {
    for (const std::string& input : sample.inputs)
      for (const auto& [what, replace] : replacements) {
        const auto folder = copy();
        fs::remove(folder->path() / input);
        replace(folder->path() / input);
        const std::string about = name + ", " + input + " is " + what;
        // An input that is refused is not written either.
        Words outputs = sample.outputs;
        std::erase(outputs, input);
        const auto before = state_of(folder->path(), outputs);
        const End end = run(sample, folder->path());
        const std::set<int> refused{1, 64, 65, 66, 74};
        EXPECT_TRUE(refused.contains(end.code) || (sample.finds_others && end.code == 0))
            << about << ": " << end.code << "\n"
            << end.err;
        EXPECT_EQ(state_of(folder->path(), outputs), before) << about;
      }
  });
}

TEST_F(Sweep, FoldersThatCannotBeWritten) {
  if (std::system("unshare -m true 2>/dev/null") != 0)
    GTEST_SKIP() << "mounting a folder for reading only is not allowed here";
  for_each([&](const Sample& sample, const std::string& name) {
    const auto folder = copy();
    const End good = run(sample, folder->path());
    const auto locked = copy();
    const auto before = state_of(locked->path());
    const std::string path = locked->path().string();
    const End end = run(sample, locked->path(), nullptr, [&path] {
      if (unshare(CLONE_NEWNS) != 0 || mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0)
        return false;
      return mount(path.c_str(), path.c_str(), nullptr, MS_BIND, nullptr) == 0 &&
             mount(nullptr, path.c_str(), nullptr, MS_BIND | MS_REMOUNT | MS_RDONLY, nullptr) == 0;
    });
    const std::set<int> refused{65, 74};
    EXPECT_TRUE(sample.outputs.empty() ? end.code == good.code : refused.contains(end.code))
        << name << ": " << end.code << "\n"
        << end.err;
    EXPECT_EQ(state_of(locked->path()), before) << name;
  });
}

}  // namespace
}  // namespace ipos::tests
