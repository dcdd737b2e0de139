// Each reader at its largest allowed input and one beyond, and files made to need much memory or many messages: what is used
// is counted, and bounded by the size of the file.
#include <gtest/gtest.h>
#include <malloc.h>
#include <zlib.h>

#include <atomic>
#include <cstdlib>
#include <ctime>
#include <new>

#include "runtime/bus/log/bus_load.hpp"
#include "tests/tools/taken_log.hpp"
#include "tools/logs/log_findings.hpp"

namespace {

std::atomic<size_t> in_use{0}, most{0};

void* counted(size_t size) {
  void* made = std::malloc(size == 0 ? 1 : size);
  if (made == nullptr) return nullptr;
  const size_t now = in_use += malloc_usable_size(made);
  for (size_t before = most; now > before && !most.compare_exchange_weak(before, now);) continue;
  return made;
}
void given_back(void* made) noexcept {
  if (made != nullptr) in_use -= malloc_usable_size(made);
  std::free(made);
}

}  // namespace

void* operator new(size_t size) {
  if (void* made = counted(size)) return made;
  throw std::bad_alloc();
}
void* operator new[](size_t size) { return operator new(size); }
void operator delete(void* made) noexcept { given_back(made); }
void operator delete[](void* made) noexcept { given_back(made); }
void operator delete(void* made, size_t) noexcept { given_back(made); }
void operator delete[](void* made, size_t) noexcept { given_back(made); }

namespace ipos::tests {
namespace {

using namespace ipos::tools;  // NOLINT: everything here is about logs
using runtime::kSecond;

constexpr size_t kMega = size_t{1} << 20U;

// The most memory that an action needs at once beside what was there.
template <typename Action>
size_t memory_of(Action action) {
  const size_t before = in_use;
  most = before;
  action();
  return most - before;
}

// What a reader needs by itself: nothing is kept of what it gives. Its time is that of the processor: a reader that looks
// at everything again for each line or object needs hours for these logs, one that does not a second.
size_t memory_to_read(std::string_view log) {
  const std::clock_t began = std::clock();
  const size_t used = memory_of([&] {
    const auto nothing = [](const auto&, LogPlace) {};
    read_log(log, {nothing, nothing, nothing, [](LogPlace, const std::string&) {}});
  });
  EXPECT_LT((std::clock() - began) / CLOCKS_PER_SEC, 60) << log.size() << " bytes";
  return used;
}

std::string deflated(const std::string& bytes, bool gzip = false) {
  z_stream stream{};
  EXPECT_EQ(deflateInit2(&stream, 9, Z_DEFLATED, MAX_WBITS + (gzip ? 16 : 0), 9, Z_DEFAULT_STRATEGY), Z_OK);
  std::string out(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

std::string container(const std::string& packed, size_t size) {
  std::string out =
      blf_object(10, number(2, 2) + std::string(6, '\0') + number(size, 4) + std::string(4, '\0') + packed);
  return out + std::string((4 - out.size() % 4) % 4, '\0');
}
std::string container(const std::string& content) { return container(deflated(content), content.size()); }

const std::string kBlfHead = ("LOGG" + number(144, 4)).append(136, '\0');

// An object of `size` bytes that is no message.
std::string big_object(size_t size) {
  return "LOBJ" + number(32, 2) + number(1, 2) + number(size, 4) + number(65, 4) +
         std::string(size - 16, '\0');
}

TEST(LogLimits, ObjectsOfBlf) {
  const Taken largest = taken(kBlfHead + container(big_object(kMega)));
  EXPECT_TRUE(largest.wrong.empty()) << largest.wrong[0].second;
  EXPECT_EQ(largest.left_out.text(), "1 record of another kind");
  EXPECT_EQ(first_mistake(kBlfHead + container(big_object(kMega + 1))),
            "x: byte 144: an object of 1048577 bytes in this container");
}

// 40 containers of zeros behind an object that claims 4 GB.
TEST(LogLimits, ABombOfContainers) {
  std::string file = kBlfHead + container(big_object(16 * kMega).replace(8, 4, number(0xFFFFFFF0, 4)));
  const std::string zeros = container(std::string(16 * kMega, '\0'));
  for (int n = 0; n < 40; ++n) file += zeros;
  EXPECT_LT(file.size(), 4 * kMega);
  EXPECT_LT(memory_to_read(file), 4 * kMega);
  EXPECT_EQ(first_mistake(file), "x: byte 144: an object of 4294967280 bytes in this container");
  // And zeros only.
  const std::string empty = kBlfHead + zeros + zeros;
  EXPECT_LT(memory_to_read(empty), 4 * kMega);
  EXPECT_EQ(first_mistake(empty), "x: byte 144: an object expected in this container");
  // Small objects in large containers.
  std::string small;
  while (small.size() < 16 * kMega) small += big_object(4096);
  EXPECT_LT(memory_to_read(kBlfHead + container(small)), 4 * kMega);
}

// Many small things where a few large ones are allowed: lines, blocks, objects, each as many as fit into 16 MiB.
TEST(LogLimits, ManySmallRecordsTakeTheirTimeOnly) {
  const auto many = [](const std::string& head, const std::string& one) {
    std::string log = head;
    log.reserve(16 * kMega + one.size());
    while (log.size() < 16 * kMega) log += one;
    return log;
  };
  const std::string block = number(0x99, 4) + number(12, 4) + number(12, 4);
  const std::string section = number(0x0A0D0D0A, 4) + number(28, 4) + number(0x1A2B3C4D, 4) + number(1, 4) +
                              number(UINT64_MAX, 8) + number(28, 4);
  const std::string interface = number(1, 4) + number(20, 4) + number(227, 4) + number(0, 4) + number(20, 4);
  for (const std::string& log :
       {many("", "(1.000000) can0 203#31\n"), many("", "\n"), many("date x\n", "0.1 1 203 Rx d 1 31\n"),
        many(";$FILEVERSION=1.1\n", "1) 1.0 Rx 0203 0\n"), many("", "  can0  203   [0]\n"),
        many(section, block), many("", section), kBlfHead + many("", big_object(32)),
        many(kBlfHead, container(big_object(32)))})
    EXPECT_LT(memory_to_read(log), 4 * kMega) << log.substr(0, 40);
  EXPECT_LT(memory_to_read(many(section, interface)), 256 * kMega) << "each interface has a name";
}

TEST(LogLimits, ContainersOfBlf) {
  std::string objects;
  while (objects.size() < 64 * kMega) objects += big_object(kMega);
  const Taken largest = taken(kBlfHead + container(objects));
  EXPECT_TRUE(largest.wrong.empty()) << largest.wrong[0].second;
  EXPECT_EQ(largest.left_out.text(), "64 records of other kinds");
  const std::string packed = deflated(objects);
  EXPECT_EQ(first_mistake(kBlfHead + container(packed, 64 * kMega + 1)),
            "x: byte 168: a container of 67108865 bytes");
  for (const size_t claimed : {64 * kMega - 1, size_t{0}})
    EXPECT_EQ(first_mistake(kBlfHead + container(packed, claimed)),
              "x: byte 176: a container that cannot be unpacked")
        << claimed;
  EXPECT_EQ(first_mistake(kBlfHead + container(packed.substr(0, packed.size() / 2), 64 * kMega)),
            "x: byte 176: a container that cannot be unpacked");
}

// One long name is no 50 000 copies of it.
TEST(LogLimits, ALongNameOfAnInterface) {
  const auto block = [](uint32_t type, std::string body) {
    body.resize((body.size() + 3) / 4 * 4);
    const std::string size = number(body.size() + 12, 4);
    return number(type, 4) + size + body + size;
  };
  const std::string name(65'532, 'n');
  std::string file = block(0x0A0D0D0A, number(0x1A2B3C4D, 4) + number(1, 4) + number(UINT64_MAX, 8)) +
                     block(1, number(227, 4) + number(0, 4) + number(2, 2) + number(name.size(), 2) + name);
  const std::string packet = block(6, number(0, 4) + number(0, 8) + number(16, 4) + number(16, 4) +
                                          number(0x03020000, 4) + number(8, 4) + std::string(8, '\0'));
  for (int n = 0; n < 50'000; ++n) file += packet;
  EXPECT_LT(memory_to_read(file), kMega);
  size_t frames = 0, longest = 0;
  const size_t kept = memory_of([&] {
    const Taken got = taken(file);
    frames = got.can.size();
    for (const LogEntry& entry : got.can) longest = std::max(longest, entry.bus.size());
  });
  EXPECT_EQ(frames, 50'000U);
  EXPECT_LE(longest, 70U);
  EXPECT_LT(kept, 8 * file.size());
}

TEST(LogLimits, PackedLogs) {
  std::string log;
  while (log.size() < kMega / 2 - 64) log += "(1711000000.000000) can0 203#3100207E00000000\n";
  const std::string packed = deflated(log, true);
  EXPECT_TRUE(unpacked_log(packed)->bytes == log);
  EXPECT_TRUE(unpacked_log(packed + packed)->bytes == log + log) << "joined files";
  // A small file may become 1 MiB, and a larger one 32 times as large.
  EXPECT_EQ(unpacked_log(deflated(std::string(kMega, ' '), true))->bytes.size(), kMega);
  EXPECT_FALSE(unpacked_log(deflated(std::string(kMega + 1, ' '), true)));
  const std::string bomb = deflated(std::string(128 * kMega, '\0'), true);
  EXPECT_LT(memory_of([&] { EXPECT_FALSE(unpacked_log(bomb)); }), 100 * bomb.size() + kMega);
  EXPECT_TRUE(unpacked_log(bomb).error().starts_with("unpacks to more than "));
  std::string damaged = packed;
  damaged[damaged.size() - 5] = static_cast<char>(~damaged[damaged.size() - 5]);
  EXPECT_EQ(unpacked_log(damaged).error(), "packed with gzip, and damaged") << "its checksum";
}

// As of a log that is not packed: what is there is read, and the rest is missed. Half a line is none.
TEST(LogLimits, PackedLogsThatWereCutOff) {
  std::string log;
  for (int n = 0; n < 5'000; ++n)
    log += "(17110" + std::to_string(10'000 + n) + ".000000) can0 203#31" + std::to_string(10 + n * 7919 % 90) + "207E\n";
  const std::string packed = deflated(log, true);
  for (const size_t size : {packed.size() - 1, packed.size() - 9, packed.size() / 2, packed.size() / 7}) {
    const Taken got = taken(packed.substr(0, size));
    ASSERT_EQ(got.wrong.size(), 1U) << size;
    EXPECT_EQ(place_text("x", got.wrong[0].first) + ": " + got.wrong[0].second,
              "x: byte " + std::to_string(size) + ": packed with gzip, and cut off: the rest of the log is missing");
    EXPECT_GT(got.can.size(), 5'000 * size / packed.size() / 2) << size;
    const Taken whole = taken(log);
    EXPECT_TRUE(std::equal(got.can.begin(), got.can.end(), whole.can.begin())) << size << ": as they were";
  }
  EXPECT_EQ(taken(packed.substr(0, packed.size() - 9)).can.size(), 5'000U) << "only its checksum is missing";
  for (const size_t size : {2U, 9U, 12U}) {
    const Taken got = taken(packed.substr(0, size));
    EXPECT_EQ(got.wrong.size(), 1U) << size;
    EXPECT_TRUE(got.can.empty());
  }
}

// Texts: a line of a million letters, a million lines, each bad.
TEST(LogLimits, LongLinesAndManyMistakes) {
  const std::string heads[] = {"(1.000000) can0 203#", "date x\n0.1 1 203 Rx d 8 ",
                               ";$FILEVERSION=1.1\n1) 1.0 Rx 0203 8 ", "0.000001 0.000002 l ",
                               "  can0  203   [8]  "};
  for (const std::string& head : heads) {
    EXPECT_LT(memory_to_read(head + std::string(4 * kMega, 'z')), kMega) << head;
    EXPECT_LT(memory_to_read(head + std::string(4 * kMega, '0')), kMega) << head;
    EXPECT_LT(memory_to_read(head + std::string(4 * kMega, ' ')), kMega) << head;
    EXPECT_LT(memory_to_read(head + std::string(4 * kMega, '\n')), kMega) << head;
  }
  LogFindings findings("a.log");
  const LogReader reader = findings.watch(
      {[](const auto&, LogPlace) {}, [](const auto&, LogPlace) {}, [](const auto&, LogPlace) {}, {}});
  testing::internal::CaptureStderr();
  std::string garbage;
  while (garbage.size() < 4 * kMega) garbage += "nonsense\n";
  EXPECT_LT(memory_of([&] { read_log(garbage, reader); }), kMega);
  EXPECT_FALSE(findings.finish());
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "a.log:1:1: error: '(' expected; none of 466034 lines is understood: this is no log in a form "
            "that ipos reads\n");
}

// A clock that jumps must not make a window for each second that it left out.
TEST(LogLimits, WindowsOfALoadWithJumps) {
  runtime::BusLoad load;
  constexpr size_t kFrames = 100'000;
  const size_t used = memory_of([&] {
    for (size_t n = 0; n < kFrames; ++n) load.add(static_cast<Time>(n) * 3'599 * kSecond, Frame(1, 0));
  });
  EXPECT_EQ(load.total().frames, kFrames);
  EXPECT_LT(used, 64 * kMega);
  EXPECT_EQ(load.span(), static_cast<Time>(kFrames - 1) * 3'599 * kSecond);
}

}  // namespace
}  // namespace ipos::tests
