// Logs and traces of a run that ends by force: what had happened a second before is in the files, whole.
#include <gtest/gtest.h>

#include <csignal>

#include <chrono>
#include <sstream>
#include <thread>

#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

using Clock = std::chrono::steady_clock;

std::vector<std::string> whole_lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text.substr(0, text.rfind('\n') + 1));
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

TEST(Kill, LeavesAllButTheLastSecondOfLogAndTrace) {
  const TemporaryFolder folder;
  folder.write(
      "A.IPC",
      "#include <constb.h>\nlong v;\nSCTRCYCL Tr;\nmain()\n{\n  Tr.ObjectNo = 1034;\n  Tr.CycleTime = 5;\n"
      "  Tr.Format = 4;\n  Tr.DPointer = numof(v);\n  _SBusCommDef(SCD_TRCYCL, Tr);\n  _SBusCommOn();\n"
      "  while (1) v = v + 1;\n}\n");
  folder.write(
      "line.toml",
      "[[bus]]\nname = \"sbus\"\nkind = \"can\"\nbaud = 500000\n"
      "[[station]]\nname = \"a\"\nunit = \"mdxb\"\nprogram = \"A.IPC\"\nsbus = \"sbus\"\n"
      "[[station]]\nname = \"b\"\nunit = \"mdxb\"\nsbus = \"sbus\"\n[station.parameters]\nP881 = 2\n");
  const auto begin = Clock::now();
  RunningIpos run(
      {"run", "line.toml", "--realtime", "--for", "1000s", "--log", "can.log", "--trace", "run.csv"},
      folder.path());
  const auto lived = [begin] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
  // Until both have something of more than a second, however late a loaded machine begins.
  const auto grown = [&] {
    const auto rows = whole_lines(read_text(folder.path() / "run.csv"));
    return rows.size() > 1500 && whole_lines(read_text(folder.path() / "can.log")).size() > 200;
  };
  while (!grown() && lived() < 60) std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_TRUE(grown()) << "no second of log and trace after " << lived() << " s";
  run.signal(SIGKILL);
  EXPECT_EQ(run.wait().exit_code, 128 + SIGKILL);

  const auto frames = whole_lines(read_text(folder.path() / "can.log"));
  ASSERT_FALSE(frames.empty());
  // The first cycle of candump's clock: a log never starts at second 0.
  const auto seconds = [](const std::string& line) { return std::stod(line.substr(1, line.find(')') - 1)); };
  const double logged = seconds(frames.back()) - seconds(frames.front());
  // A machine with other work may start late and keep pace late; what it did until a second before is there.
  const auto rows = whole_lines(read_text(folder.path() / "run.csv"));
  ASSERT_GT(rows.size(), 2U);
  const double traced = std::stod(rows.back()) / 1000;
  EXPECT_NEAR(logged, traced, 1.0) << "log and trace of one run";
  EXPECT_GT(traced, 0.5) << "after " << lived() << " s";
  // Whole: each millisecond has its row, and each 5 ms a frame of the cyclic telegram.
  for (size_t n = 1; n < rows.size(); ++n) EXPECT_EQ(std::stoul(rows[n]), n);
  EXPECT_GE(frames.size(), static_cast<size_t>(logged * 1000 / 5));
}

}  // namespace
}  // namespace ipos::tests
