// The packed form of a recording: the bytes of its table, its texts again, and what is left of it when the run was killed or the
// file is damaged.
#include "tools/recording/trace_file.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <chrono>
#include <random>
#include <sstream>
#include <thread>

#include "tests/tools/command.hpp"
#include "tests/tools/hand_made.hpp"
#include "tools/recording/trace_forms.hpp"
#include "vm/image/view.hpp"

namespace ipos::tools {
namespace {

using namespace std::string_literals;

std::string packed(const Recording& recording) {
  std::ostringstream out;
  write_trace(packed_trace, out, recording);
  return out.str();
}

struct Again {
  std::string text;  // in the form
  size_t rows = 0;
  std::optional<size_t> ends_early;
  std::optional<TraceMistake> mistake;
};

Again again(std::string_view bytes, TraceForm form) {
  Again result;
  TraceReader reader(bytes);
  result.mistake = reader.begin();
  if (result.mistake) return result;
  std::ostringstream out;
  const auto writer = form(out, reader.signals(), reader.tracks());
  RecordedPart part;
  for (;;) {
    const auto more = reader.next(part);
    if (!more) result.mistake = more.error();
    if (!more || !*more) break;
    writer->take(part);
    result.rows += part.times.size();
  }
  writer->finish();
  result.text = out.str();
  result.ends_early = reader.ends_early();
  return result;
}

std::string direct(const Recording& recording, TraceForm form) {
  std::ostringstream out;
  write_trace(form, out, recording);
  return out.str();
}

const TraceForm kTexts[] = {csv_trace, vcd_trace, jsonl_trace};

TEST(TraceFile, TextsOfItAreThoseOfTheRecording) {
  const Recording recording = hand_made();
  for (const TraceForm form : kTexts) {
    const Again read = again(packed(recording), form);
    EXPECT_FALSE(read.mistake) << read.mistake->text;
    EXPECT_FALSE(read.ends_early);
    EXPECT_EQ(read.text, direct(recording, form));
  }
  EXPECT_EQ(again(packed({}), jsonl_trace).text, "");
}

// Every kind of course: at rest, even, with noise, at the ends of 64 bits, seldom; some thousand rows, of which some are left
// out, in parts that come and are brought to the file as they like.
TEST(TraceFile, AnyCourseComesBack) {
  std::mt19937 random(1);
  Recording recording;
  for (int n = 0; n < 6; ++n) {
    recording.signals.push_back({"u.H" + std::to_string(n), "", 1, 0, false, "u"});
    recording.samples.emplace_back();
  }
  runtime::Time time = 0;
  for (int64_t row = 0; row < 5000; ++row) {
    time += runtime::kMillisecond * (random() % 300 == 0 ? 7 : 1);
    recording.times.push_back(time);
    const int64_t values[] = {5,
                              row * 1234 - 99,
                              static_cast<int64_t>(random() % 7),
                              random() % 2 == 0 ? INT64_MIN : INT64_MAX,
                              row / 777,
                              row % 100 < 50 ? row * row : 0};
    for (size_t n = 0; n < 6; ++n) recording.samples[n].push_back(values[n]);
  }
  const RecordedPart all = part_of(recording);
  std::ostringstream out;
  const auto writer = packed_trace(out, recording.signals, recording.tracks);
  for (size_t begin = 0; begin < all.times.size();) {
    const size_t end = std::min(all.times.size(), begin + random() % 400);
    RecordedPart part;
    part.times.assign(all.times.begin() + static_cast<std::ptrdiff_t>(begin), all.times.begin() + static_cast<std::ptrdiff_t>(end));
    for (const Change& change : all.changes)
      if (change.row >= begin && change.row < end) part.changes.push_back({change.row - begin, change.signal, change.sample});
    writer->take(part);
    if (random() % 4 == 0) writer->flush();
    begin = end;
  }
  writer->finish();
  for (const TraceForm form : kTexts) EXPECT_TRUE(again(out.str(), form).text == direct(recording, form));
}

std::string u32(uint32_t value) {
  std::string bytes;
  for (int n = 0; n < 4; ++n) bytes += static_cast<char>(value >> 8 * n);
  return bytes;
}
std::string block(char kind, char packing, const std::string& body, size_t size) {
  const std::string bytes = kind + ""s + packing + "\0\0"s + u32(static_cast<uint32_t>(body.size())) + u32(static_cast<uint32_t>(size)) + body;
  return bytes + u32(vm::crc32({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()}));
}
std::string stored(char kind, const std::string& content) { return block(kind, 0, content, content.size()); }

const std::string kBegin = "\x89IPOStrc\r\n\x1a\n\x01\0\0\0"s;
const std::string kHead =
    R"({"program":"x","signals":[{"name":"u.a","unit":"rpm","decimals":3,"bits":0,"factor":0.001,"station":"u"}],)"
    R"("tracks":[{"bus":"sbus","can":true},{"bus":"line","can":false}]})";

// The bytes by the table of docs/reference/trace-file.md, made by hand.
const std::string kRows =
    "\x01\xC0\x84\x3D\xC0\x84\x3D\x04"s +  // one run of rows: 1 ms, 1 ms apart, 4
    "\x09\x00\x02\x00\x01\x01\x02\x0A\x03\x02"s +  // a column of 9 bytes: base 0, a run of 1 row, and after 1 row of 2; +5, -2, and a step larger by 1
    "\x01\x80\x89\x7A\x01\x06u: F28"s +        // one event at 2 ms, a fault
    "\x02\xC0\xC4\x07\x00\x00\x8A\x08\x02\x80\x06"s +   // a CAN frame at 0.123456 ms: 40Ah, 2 bytes
    "\x80\xC0\x35\x01\x04\x00\x01\x05\x02hi"s;  // 0.876544 ms later a telegram with a text

TEST(TraceFile, TheTableOfThePageIsTheForm) {
  const Again read = again(kBegin + stored('H', kHead) + stored('R', kRows) + stored('E', ""), jsonl_trace);
  ASSERT_FALSE(read.mistake) << read.mistake->offset << read.mistake->text;
  EXPECT_EQ(read.text,
            "{\"signal\":\"u.a\",\"unit\":\"rpm\"}\n"
            "{\"time_ms\":0.123456,\"frame\":\"sbus\",\"id\":1034,\"extended\":false,\"remote\":false,\"data\":\"8006\"}\n"
            "{\"time_ms\":1,\"frame\":\"line\",\"data\":\"05\",\"text\":\"hi\"}\n"
            "{\"time_ms\":1,\"signal\":\"u.a\",\"value\":0.005}\n"
            "{\"time_ms\":2,\"event\":\"u: F28\",\"fault\":true}\n"
            "{\"time_ms\":3,\"signal\":\"u.a\",\"value\":0.003}\n"
            "{\"time_ms\":4,\"signal\":\"u.a\",\"value\":0.002}\n");
}

TEST(TraceFile, OfAKilledRunThereIsEachWholeBlock) {
  const std::string file = kBegin + stored('H', kHead) + stored('R', kRows);
  const std::string text = again(file + stored('E', ""), jsonl_trace).text;
  for (size_t size = 0; size < kBegin.size() + kHead.size() + 16; ++size) {
    const Again read = again(file.substr(0, size), jsonl_trace);
    ASSERT_TRUE(read.mistake) << size;
    EXPECT_LE(read.mistake->offset, size);
  }
  const size_t rows = kBegin.size() + kHead.size() + 16;
  for (size_t size = rows; size <= file.size(); ++size) {
    const Again read = again(file.substr(0, size), jsonl_trace);
    ASSERT_FALSE(read.mistake) << size << read.mistake->text;
    EXPECT_EQ(read.ends_early, size == file.size() ? size : rows);
    if (size == file.size()) {
      EXPECT_EQ(read.text, text);
    }
  }
}

// Each changed bit is told, at the block that has it; a length that leads behind the end is an early one.
TEST(TraceFile, DamageHasItsPlace) {
  const std::string good = packed(hand_made());
  for (size_t bit = 0; bit < 8 * good.size(); ++bit) {
    std::string bad = good;
    bad[bit / 8] = static_cast<char>(bad[bit / 8] ^ 1 << bit % 8);
    const Again read = again(bad, csv_trace);
    ASSERT_TRUE(read.mistake || read.ends_early) << bit;
    EXPECT_LE(read.mistake ? read.mistake->offset : *read.ends_early, bit / 8);
  }
}

TEST(TraceFile, WhatNoTraceHasIsRefused) {
  const auto mistake = [](const std::string& bytes) {
    const Again read = again(bytes, csv_trace);
    return read.mistake ? read.mistake->text : "none";
  };
  const auto rows = [&](const std::string& content) { return mistake(kBegin + stored('H', kHead) + stored('R', content)); };
  EXPECT_EQ(mistake("time_ms,u.speed\n"), "this is no .ipos-trace");
  EXPECT_EQ(mistake("\x89IPOStrc\r\n\x1a\n\x02\0\0\0"s), "the trace is of version 2, and this ipos reads version 1");
  EXPECT_EQ(mistake(kBegin + stored('R', kRows)), "the first block is not the head");
  EXPECT_EQ(mistake(kBegin + stored('H', "[]")), "the head is no JSON with signals and tracks");
  EXPECT_EQ(mistake(kBegin + stored('H', R"({"signals":[{"name":""}],"tracks":[]})")),
            "signal 1 of the head is not described as a signal is");
  EXPECT_EQ(mistake(kBegin + stored('H', R"({"signals":[],"tracks":[{}]})")), "track 1 of the head has no bus");
  EXPECT_EQ(mistake(kBegin + stored('H', kHead) + stored('H', kHead)), "there is a second head");
  EXPECT_EQ(mistake(kBegin + stored('H', kHead) + stored('X', "")), "the block is of the unknown kind 88");
  EXPECT_EQ(mistake(kBegin + stored('H', kHead) + stored('E', "") + "x"), "1 bytes stand behind the last block");
  EXPECT_EQ(mistake(kBegin + stored('H', kHead) + stored('E', "x")), "the last block has a content");
  EXPECT_EQ(mistake(kBegin + block('H', 0, kHead, 5)), "the two lengths of a block that is not packed differ");
  EXPECT_EQ(mistake(kBegin + block('H', 1, kHead, 5)), "what is packed in the block cannot be unpacked to the length that it says");
  EXPECT_EQ(mistake(kBegin + block('H', 2, kHead, 5)), "the block is packed in the unknown way 2");
  EXPECT_EQ(mistake(kBegin + block('H', 1, kHead, size_t{1} << 29U)), "the block says that it has 536870912 bytes, more than it may have");
  EXPECT_EQ(rows(""), "the block ends within a number or a text");
  EXPECT_EQ(rows(kRows + "x"), "the block goes on behind its frames");
  EXPECT_EQ(rows("\x01\x01\x00\x02\x00\x00\x00"s), "the times of the rows do not rise");
  EXPECT_EQ(rows("\x01\x01\x01\xFF\xFF\xFF\xFF\x7F"s), "the block has a number of rows that it cannot have");
  EXPECT_EQ(rows("\x01\x01\x01\x01\x05\x00\x01\x00\x02\x00\x00"s), "column 1 changes in rows that are not there");
  EXPECT_EQ(rows("\x01\x01\x01\x01\x03\x00\x00\x00\x00\x00"s), "column 1 has another length than it says");
  EXPECT_EQ(rows("\x00\x02\x00\x00\x01\x00\x02\x00\x00"s), "an event is neither a fault nor none");
  EXPECT_EQ(rows("\x00\x02\x00\x00\x00\x01\x00\x05\x00\x00\x00"s), "a frame is of a bus that is not there");
  EXPECT_EQ(rows("\x00\x02\x00\x00\x00\x01\x00\x00\x08\x00\x00"s), "a frame has an identifier or marks that no frame has");
}

// A picture has the name of its file as the title.
std::string with_title(std::string text, const std::string& title) {
  const std::string own = "run.ipos-trace";
  for (size_t at = text.find(own); at != std::string::npos; at = text.find(own, at + title.size())) text.replace(at, own.size(), title);
  return text;
}

// A tenth of JSON lines, and the texts of the run; frames and telegrams with them.
TEST(TraceVerb, ExportsAreWhatTheRunWrites) {
  const tests::TemporaryFolder folder;
  struct Row {
    const char *plant, *signals;
    bool moves;
  };
  for (const Row& row : {Row{"examples/scom/scom.toml", "unit1.speed,unit1.status,sbus.frames", false},
                         Row{"examples/movilink-rs485/rs485.toml", "*.status,line1.frames", false},
                         Row{"examples/isync/isync.toml", "", true}}) {
    for (const char* form : {"csv", "vcd", "jsonl", "ipos-trace"}) {
      std::vector<std::string> words{"run", tests::project(row.plant).string(), "--for", "3s", "--trace", "run."s + form};
      if (*row.signals != '\0') words.insert(words.end(), {"--signals", row.signals});
      ASSERT_LE(tests::run_ipos(words, folder.path()).exit_code, 1) << row.plant;  // not all expectations come in 3 s
    }
    const auto text = [&](const std::string& name) { return tests::read_text((folder.path() / name).string()); };
    for (const std::string form : {"csv", "vcd", "jsonl"}) {
      const tests::CommandResult made = tests::run_ipos({"trace", "export", "run.ipos-trace", "-o", "again." + form}, folder.path());
      EXPECT_EQ(made.exit_code, 0) << made.err;
      EXPECT_TRUE(text("again." + form) == text("run." + form)) << row.plant << " " << form;
      EXPECT_TRUE(tests::run_ipos({"trace", "export", "run.ipos-trace", "--form", form}, folder.path()).out == text("run." + form));
    }
    // The pictures are those of the run, too.
    for (const std::string form : {"svg", "html"}) {
      std::vector<std::string> words{"run", tests::project(row.plant).string(), "--for", "3s", "--plot", "plot." + form};
      if (*row.signals != '\0') words.insert(words.end(), {"--signals", row.signals});
      ASSERT_LE(tests::run_ipos(words, folder.path()).exit_code, 1) << row.plant;
      ASSERT_EQ(tests::run_ipos({"trace", "export", "run.ipos-trace", "-o", "again." + form}, folder.path()).exit_code, 0);
      EXPECT_TRUE(with_title(text("again." + form), tests::project(row.plant).filename().string()) == text("plot." + form)) << row.plant << " " << form;
    }
    EXPECT_LT((row.moves ? 10 : 3) * text("run.ipos-trace").size(), text("run.jsonl").size()) << row.plant;
  }
}

TEST(TraceVerb, AKilledRunLeavesAReadableTrace) {
  const tests::TemporaryFolder folder;
  const auto file = folder.path() / "run.ipos-trace";
  {
    tests::RunningIpos run({"run", tests::project("examples/scom/scom.toml").string(), "--for", "100000s", "--trace", file.string()});
    for (int n = 0; n < 600 && (!std::filesystem::exists(file) || std::filesystem::file_size(file) < 20'000); ++n)
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    run.signal(SIGKILL);
    run.wait();
  }
  const tests::CommandResult made = tests::run_ipos({"trace", "export", "run.ipos-trace"}, folder.path());
  EXPECT_EQ(made.exit_code, 0);
  EXPECT_TRUE(made.out.starts_with("time_ms,unit1.speed [rpm],")) << made.out.substr(0, 100);
  EXPECT_GT(made.out.size(), 10'000U);
  EXPECT_NE(made.err.find(": warning: the trace ends here, without its last block"), std::string::npos) << made.err;
}

TEST(TraceVerb, ADamagedFileWritesNothing) {
  const tests::TemporaryFolder folder;
  std::string bytes = packed(hand_made());
  bytes[bytes.size() - 20] = static_cast<char>(bytes[bytes.size() - 20] ^ 1);
  folder.write("bad.ipos-trace", bytes);
  folder.write("out.csv", "old");
  const tests::CommandResult result = tests::run_ipos({"trace", "export", "bad.ipos-trace", "-o", "out.csv"}, folder.path());
  EXPECT_EQ(result.exit_code, 65);
  EXPECT_NE(result.err.find("bad.ipos-trace: byte "), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("the block is damaged: its checksum differs"), std::string::npos) << result.err;
  EXPECT_EQ(tests::read_text((folder.path() / "out.csv").string()), "old");
}

}  // namespace
}  // namespace ipos::tools
