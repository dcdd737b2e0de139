// Logs of other tools in the verbs: each tells what it left out, lets a bus be chosen, and goes on with what it understood.
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/harness/contains.hpp"
#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

const std::string kSbusPlant =
    "[[bus]]\nname = \"sbus\"\nkind = \"can\"\n[[station]]\nname = \"d\"\nunit = \"mdxb\"\nsbus = \"sbus\"\n";

// Every verb that reads logs.
std::vector<std::vector<std::string>> verbs(const std::string& log, std::vector<std::string> more = {}) {
  std::vector<std::vector<std::string>> all{{"bus", "decode", log},
                                            {"bus", "decode", log, "--format", "json"},
                                            {"bus", "monitor", log},
                                            {"bus", "monitor", log, "--table"},
                                            {"bus", "load", log, "--baud", "500000"},
                                            {"bus", "replay", log, "p.toml"}};
  for (auto& words : all) words.insert(words.end(), more.begin(), more.end());
  return all;
}

size_t count_of(const std::string& text, const std::string& part) {
  size_t count = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(BusLogs, WhatIsLeftOutIsToldOnceInEveryVerb) {
  const TemporaryFolder folder;
  folder.write("p.toml", kSbusPlant);
  const std::string good = "(1711000000.000000) can0 203#3100207E00000000\n";
  folder.write(
      "a.log",
      good +
          "(1711000000.001000) can0 20000008#0000020000000000\n(1711000000.002000) can0 203##1AABBCC\n"
          "(1711000000.002000) can0 203##1AABBCC\n# by hand\n");
  folder.write("b.log", good + "nonsense\n(1711000000.001000) can0 20000008#0000020000000000\n" + good);
  for (const auto& words : verbs("a.log")) {
    const CommandResult result = run_ipos(words, folder.path());
    EXPECT_EQ(result.exit_code, 0) << words[1] << result.err;
    EXPECT_EQ(count_of(result.err, "a.log: note: 1 error frame, 2 FD frames left out\n"), 1U)
        << words[1] << result.err;
  }
  for (const auto& words : verbs("b.log")) {
    const CommandResult result = run_ipos(words, folder.path());
    EXPECT_EQ(result.exit_code, 65) << words[1];
    EXPECT_TRUE(contains(result.err, "b.log:2:1: error: '(' expected\n")) << words[1] << result.err;
    EXPECT_EQ(count_of(result.err, "b.log: note: 1 error frame, 1 line not understood left out\n"), 1U)
        << words[1] << result.err;
    EXPECT_NE(result.out, "") << words[1] << ": the rest is used";
  }
}

TEST(BusLogs, EqualMistakesArePrintedTwentyTimes) {
  const TemporaryFolder folder;
  folder.write("p.toml", kSbusPlant);
  std::string log = "(1711000000.000000) can0 203#3100207E00000000\n";
  for (int n = 0; n < 1'000; ++n) log += "nonsense\n";
  folder.write("a.log", log + "(1.000000) can0 203#0\n");
  for (const auto& words : verbs("a.log")) {
    const CommandResult result = run_ipos(words, folder.path());
    EXPECT_EQ(count_of(result.err, "'(' expected"), 20U) << words[1];
    EXPECT_EQ(count_of(result.err, "more mistakes of this kind are only counted"), 1U) << words[1];
    EXPECT_EQ(count_of(result.err, "second hexadecimal digit"), 1U) << "another kind is printed";
    EXPECT_TRUE(contains(result.err, "1001 lines not understood left out\n")) << words[1];
  }
}

TEST(BusLogs, AFileThatIsNoLogGetsOneMessage) {
  const TemporaryFolder folder;
  folder.write("p.toml", kSbusPlant);
  folder.write("text", "Dear reader,\nthis is a letter\nof three lines\n");
  folder.write("line", "nonsense\n");
  folder.write("wide", std::string("\xFF\xFE(\0", 4));
  folder.write("mf4", "MDF     4.10    ");
  folder.write("table", "timestamp,arbitration_id,extended,remote\n0.0,0x203,0,0\n");
  folder.write("gz", "\x1F\x8B\x08 is no gzip");
  for (const auto& [file, part] : {std::pair("text", "none of 3 lines is understood: this is no log"),
                                   {"line", "line:1:1: error: '(' expected"},
                                   {"wide", "UTF-16"},
                                   {"mf4", "MF4"},
                                   {"table", "csv"},
                                   {"gz", "packed with gzip, and damaged"}})
    for (const auto& words : verbs(file)) {
      if (words[1] == "monitor") continue;  // it prints its totals, too
      const CommandResult result = run_ipos(words, folder.path());
      EXPECT_EQ(result.exit_code, 65) << file << words[1];
      EXPECT_EQ(count_of(result.err, "error: "), 1U) << file << words[1] << result.err;
      EXPECT_TRUE(contains(result.err, part)) << file << words[1] << result.err;
    }
  for (const char* file : {"text", "wide", "mf4", "gz"})
    EXPECT_EQ(count_of(run_ipos({"bus", "monitor", file}, folder.path()).err, "error: "), 1U) << file;
}

TEST(BusLogs, ABusIsChosen) {
  const TemporaryFolder folder;
  folder.write("p.toml", kSbusPlant);
  // 4 frames in 1 ms on each: the load of each is that of 2 requests, by canbusload's formula 123 bits each, 49.20 %.
  std::string log;
  for (const char* time : {"000000", "001000"})
    for (const char* bus : {"can0", "can1"})
      log += std::string("(1711000000.") + time + ") " + bus + " 204#3100207E000003E8\n";
  folder.write("two.log", log);
  const auto run = [&](std::vector<std::string> words) { return run_ipos(words, folder.path()); };
  const CommandResult load = run({"bus", "load", "two.log", "--baud", "500000"});
  EXPECT_EQ(load.exit_code, 0);
  EXPECT_EQ(count_of(load.out, "   49.20    54.00\n"), 4U) << load.out;
  EXPECT_TRUE(contains(load.out, "bus can0\n") && contains(load.out, "\nbus can1\n")) << load.out;
  EXPECT_TRUE(contains(load.err, "2 buses, each for itself: can0, can1; --channel chooses")) << load.err;
  const auto json =
      nlohmann::json::parse(run({"bus", "load", "two.log", "--baud", "500000", "--format", "json"}).out);
  ASSERT_EQ(json["buses"].size(), 2U);
  EXPECT_EQ(json["buses"][1]["bus"], "can1");
  EXPECT_EQ(json["buses"][1]["all"]["frames"], 2);
  for (const char* channel : {"can1", "1"}) {
    const CommandResult one = run({"bus", "load", "two.log", "--baud", "500000", "--channel", channel});
    EXPECT_EQ(one.err, "");
    EXPECT_TRUE(one.out.starts_with("window from")) << one.out;
    EXPECT_TRUE(contains(one.out, "all                 2 ")) << one.out;
  }
  const CommandResult both = run({"bus", "replay", "two.log", "p.toml"});
  EXPECT_EQ(both.exit_code, 64);
  EXPECT_EQ(both.out, "");
  EXPECT_TRUE(contains(
      both.err,
      "two.log: 2 buses are in the log, and a replay is for one line: choose with --channel from can0, can1"))
      << both.err;
  EXPECT_TRUE(contains(run({"bus", "replay", "two.log", "p.toml", "--channel", "can0"}).out,
                       "2 of 2 frames replayed"));
  EXPECT_TRUE(contains(run({"bus", "replay", "two.log", "p.toml", "--channel", "can0,can1"}).out,
                       "4 of 4 frames replayed"));
  for (const auto& words : verbs("two.log", {"--channel", "can1"})) {
    const CommandResult one = run(words);
    EXPECT_EQ(one.exit_code, 0) << words[1] << one.err;
    EXPECT_FALSE(contains(one.out, "can0")) << words[1];
  }
  for (const auto& words : verbs("two.log", {"--channel", "can7"})) {
    const CommandResult none = run(words);
    EXPECT_EQ(none.exit_code, 64) << words[1];
    EXPECT_TRUE(contains(none.err, "two.log: there is no bus 'can7' in the log, only can0, can1"))
        << words[1] << none.err;
  }
  EXPECT_EQ(run({"bus", "monitor", "can0", "--channel", "can0"}).exit_code, 64);
}

TEST(BusLogs, TelegramsOfAnotherKindOfBusAreLeftOut) {
  const TemporaryFolder folder;
  folder.write("p.toml", kSbusPlant);
  folder.write("a.log",
               "(1.000000) can0 203#\n0.000455 0.014913 line1 02 01 05 00 06 3A 98 01 F4 57 | a\nDC 02 01\n");
  folder.write("serial.log", "0.000455 0.014913 line1 02 01 05 00 06 3A 98 01 F4 57 | a\n");
  for (const auto& words : {std::vector<std::string>{"bus", "load", "a.log", "--baud", "500000"},
                            {"bus", "replay", "a.log", "p.toml"}}) {
    const CommandResult result = run_ipos(words, folder.path());
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(contains(result.err, "2 telegrams of other kinds of bus left out")) << result.err;
  }
  for (const auto& [words, message] :
       {std::pair{std::vector<std::string>{"bus", "load", "serial.log", "--baud", "500000"},
                  "no frame of CAN or PROFIBUS is in it"},
        {{"bus", "replay", "serial.log", "p.toml"}, "no CAN frame is in it"}}) {
    const CommandResult result = run_ipos(words, folder.path());
    EXPECT_EQ(result.exit_code, 65);
    EXPECT_TRUE(contains(result.err, message)) << result.err;
  }
}

// Frames at 1, 3, 2 s: the span is 2 s, so 3 frames of 47 bits at least load it.
TEST(BusLogs, TimesThatGoBack) {
  const TemporaryFolder folder;
  folder.write("p.toml", kSbusPlant);
  folder.write(
      "a.log",
      "(1711000001.000000) can0 203#\n(1711000003.000000) can0 203#\n(1711000002.000000) can0 203#\n");
  folder.write(
      "b.log",
      "(1711000001.000000) can0 203#\n(1711000002.000000) can0 203#\n(1711000003.000000) can0 203#\n");
  const auto load = [&](const char* log) {
    return run_ipos({"bus", "load", log, "--baud", "10000"}, folder.path());
  };
  EXPECT_EQ(load("a.log").out, load("b.log").out);
  EXPECT_TRUE(contains(load("a.log").err, "its times go back"));
  EXPECT_EQ(load("b.log").err, "");
  const CommandResult replay =
      run_ipos({"bus", "replay", "a.log", "p.toml", "--log", "out.log"}, folder.path());
  EXPECT_TRUE(contains(replay.err, "its times go back; the frames are played in the order of time"))
      << replay.err;
  EXPECT_TRUE(contains(replay.out, "sbus: 3 frames in 2.100 s")) << replay.out;
}

// A clock that was set from 1970 to 2024: canplayer -s leaves such a gap out.
TEST(BusLogs, AJumpOfTheClockIsNotPlayed) {
  const TemporaryFolder folder;
  folder.write("p.toml", kSbusPlant);
  folder.write(
      "a.log",
      "(0000000001.000000) can0 203#\n(0000000001.500000) can0 203#\n(1711000000.000000) can0 203#\n");
  const CommandResult hour = run_ipos({"bus", "replay", "a.log", "p.toml"}, folder.path());
  EXPECT_EQ(hour.exit_code, 0);
  EXPECT_TRUE(
      contains(hour.err, "1 gap longer than 1h is played as 1h, 1710996398 s are left out (--longest-gap)"))
      << hour.err;
  EXPECT_TRUE(contains(hour.out, "sbus: 3 frames in 3600.600 s")) << hour.out;
  const CommandResult short_one =
      run_ipos({"bus", "replay", "a.log", "p.toml", "--longest-gap", "100ms"}, folder.path());
  EXPECT_TRUE(contains(short_one.err, "2 gaps longer than 100ms are played as 100ms")) << short_one.err;
  EXPECT_TRUE(contains(short_one.out, "sbus: 3 frames in 0.300 s")) << short_one.out;
  EXPECT_EQ(run_ipos({"bus", "replay", "a.log", "p.toml", "--longest-gap", "soon"}, folder.path()).exit_code,
            64);
}

TEST(BusLogs, PackedLogsAreRead) {
  const TemporaryFolder folder;
  folder.write("p.toml", kSbusPlant);
  folder.write("plain.log", "(1711000000.000000) can0 203#3100207E00000000\n");
  const std::string path = (folder.path() / "log.gz").string();
  gzFile file = gzopen(path.c_str(), "wb");
  const std::string text = read_text(folder.path() / "plain.log");
  ASSERT_EQ(gzwrite(file, text.data(), static_cast<unsigned>(text.size())), static_cast<int>(text.size()));
  gzclose(file);
  const auto plain = verbs("plain.log"), packed = verbs("log.gz");
  for (size_t n = 0; n < plain.size(); ++n) {
    const CommandResult result = run_ipos(packed[n], folder.path());
    EXPECT_EQ(result.out, run_ipos(plain[n], folder.path()).out) << plain[n][1];
    EXPECT_EQ(result.exit_code, 0);
  }
  // Cut off, as any log may be: what is there is shown, and the rest is missed.
  const std::string bytes = read_text(path);
  folder.write("log.gz", bytes.substr(0, bytes.size() - 5));
  for (size_t n = 0; n < plain.size(); ++n) {
    const CommandResult result = run_ipos(packed[n], folder.path());
    EXPECT_EQ(result.exit_code, 65) << plain[n][1];
    EXPECT_TRUE(contains(result.err, "packed with gzip, and cut off: the rest of the log is missing")) << result.err;
    if (plain[n][1] == "decode") {
      EXPECT_EQ(result.out, run_ipos(plain[n], folder.path()).out);
    }
  }
}

// Names of buses and files come from strangers.
TEST(BusLogs, NoByteOfAStrangerReachesTheTerminal) {
  const TemporaryFolder folder;
  folder.write("p.toml", kSbusPlant);
  const std::string name = "a\x1B[2J.log";
  folder.write(
      name,
      "(1711000000.000000) b\x1B]0;x\x07 203#3100207E00000000\nnonsense\n(1711000000.000000) c\xC2\x9B"
      "1m 2##\n"
      "(1711000000.000000) c\xC2\x9B"
      "1m 203#\n(1711000000.000000) c\xC2\x9B"
      "1m 20000004#\n");
  folder.write("mixed.log", "(1.000000) can0 203#\n");
  auto all = verbs(name);
  all.push_back({"bus", "load", name, "--baud", "500000", "--format", "json"});
  all.push_back({"bus", "decode", name, "--channel", "z\x1B[1m"});
  for (const auto& words : all) {
    const CommandResult result = run_ipos(words, folder.path());
    for (const std::string& text : {result.out, result.err}) {
      EXPECT_EQ(text.find('\x1B'), std::string::npos) << words[1] << text;
      EXPECT_EQ(text.find('\x07'), std::string::npos) << words[1];
      EXPECT_EQ(text.find("\xC2\x9B"), std::string::npos) << words[1];
    }
  }
}

}  // namespace
}  // namespace ipos::tests
