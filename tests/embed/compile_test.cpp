// The compiler as a library, and the C++ header: from source text to a value.
#include <gtest/gtest.h>

#include <ipos_compile.h>
#include <array>
#include <cstdlib>
#include <cstring>
#include <ipos.hpp>
#include <new>
#include <string>

namespace {

bool memory_is_out = false;

}  // namespace

// The library takes its memory from here, too.
void* operator new(size_t size) {
  void* const memory = memory_is_out ? nullptr : std::malloc(size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
void* operator new(size_t size, const std::nothrow_t&) noexcept {
  return memory_is_out ? nullptr : std::malloc(size);
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, size_t) noexcept { std::free(memory); }

namespace {

struct Job {
  alignas(8) std::array<std::byte, 4096> image{};
  std::array<char, 500> messages{};
  ipos_compile_job job{};

  explicit Job(const char* source) {
    job.name = "test.IPC";
    job.source = source;
    job.image = image.data();
    job.image_capacity = image.size();
    job.messages = messages.data();
    job.messages_capacity = messages.size();
  }
};

TEST(ApiCompile, SourceToValue) {
  Job made("long result;\nmain() { result = 6 * 7; }\n");
  ASSERT_EQ(ipos_compile(&made.job), IPOS_OK) << made.messages.data();
  ipos::Program program;
  ASSERT_EQ(program.load(std::span(made.image).first(made.job.image_size)), IPOS_OK);
  struct Host {
    int faults = 0;
    void fault(ipos_vm*, const ipos_fault&) { ++faults; }
  } host;
  ipos::Machine machine;
  ASSERT_EQ(machine.init(program, host), IPOS_OK);
  ASSERT_EQ(machine.start(), IPOS_OK);
  EXPECT_EQ(machine.run_ticks(10), IPOS_ENDED);
  int32_t value = 0;
  EXPECT_EQ(machine.read("result", value), IPOS_OK);
  EXPECT_EQ(value, 42);
  EXPECT_EQ(machine.variables().size(), 512U);
  EXPECT_EQ(host.faults, 0);
}

TEST(ApiCompile, ErrorsHaveTheirPlace) {
  Job made("main() {\n  oops = 1;\n}\n");
  EXPECT_EQ(ipos_compile(&made.job), IPOS_SOURCE_ERROR);
  EXPECT_EQ(made.job.image_size, 0U);
  EXPECT_NE(std::strstr(made.messages.data(), "test.IPC:2:3: error:"), nullptr) << made.messages.data();
  // Cut, but whole in its size.
  const size_t whole = made.job.messages_size;
  EXPECT_EQ(whole, std::strlen(made.messages.data()));
  made.job.messages_capacity = 10;
  EXPECT_EQ(ipos_compile(&made.job), IPOS_SOURCE_ERROR);
  EXPECT_EQ(std::strlen(made.messages.data()), 9U);
  EXPECT_EQ(made.job.messages_size, whole);
}

TEST(ApiCompile, SizesUnitsAndArguments) {
  Job made("main() { H0 = X; }");
  const char* defines[] = {"X=5"};
  made.job.defines = defines;
  made.job.define_count = 1;
  made.job.image_capacity = 3;
  EXPECT_EQ(ipos_compile(&made.job), IPOS_MEMORY_TOO_SMALL);
  EXPECT_GT(made.job.image_size, 3U);
  made.job.image_capacity = made.image.size();
  EXPECT_EQ(ipos_compile(&made.job), IPOS_OK);
  for (const char* unit : {"", "movitrac", "mc31"}) {
    made.job.unit = unit;
    EXPECT_EQ(ipos_compile(&made.job), IPOS_UNKNOWN_UNIT) << unit;
  }
  made.job.unit = "mc07";
  EXPECT_EQ(ipos_compile(&made.job), IPOS_OK);
  EXPECT_EQ(made.image[8], std::byte{3});
  EXPECT_EQ(ipos_compile(nullptr), IPOS_INVALID_ARGUMENT);
  defines[0] = nullptr;
  EXPECT_EQ(ipos_compile(&made.job), IPOS_INVALID_ARGUMENT);
  made.job.define_count = 0;
  made.job.source = nullptr;
  EXPECT_EQ(ipos_compile(&made.job), IPOS_INVALID_ARGUMENT);
}

TEST(ApiCompile, FilesComeFromTheCallback) {
  Job made("#include \"part.h\"\nmain() { H0 = PART; }");
  EXPECT_EQ(ipos_compile(&made.job), IPOS_SOURCE_ERROR);
  made.job.read_file = [](void*, const char* path, ipos_add_bytes add, void* sink) {
    if (std::string(path).find("part.h") == std::string::npos) return false;
    add(sink, "#define PA", 10);
    add(sink, "RT 9\n", 5);
    return true;
  };
  EXPECT_EQ(ipos_compile(&made.job), IPOS_OK) << made.messages.data();
}

TEST(ApiCompile, NoMemoryIsAStatus) {
  Job made("main() { H0 = 1; }");
  memory_is_out = true;
  const ipos_status status = ipos_compile(&made.job);
  memory_is_out = false;
  EXPECT_EQ(status, IPOS_OUT_OF_MEMORY);
}

}  // namespace
