// A program of the C API with its memory, made of source text by the compiler, and a host that writes down
// what it is asked.
#pragma once

#include <gtest/gtest.h>

#include <ipos.h>
#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "compiler/compile.hpp"
#include "vm/image/image.hpp"

namespace ipos::tests {

// The image of a source text; empty, with a failed test, when it does not compile.
inline std::vector<uint8_t> image_of(const std::string& source, const char* unit = "md60a") {
  compiler::CompileOptions options;
  options.unit = stdlib::find_unit(std::string_view(unit));
  const compiler::Compilation made = compiler::compile("test.IPC", "", source, options);
  EXPECT_TRUE(made.image.has_value()) << source;
  return made.image ? vm::write_image(*made.image) : std::vector<uint8_t>();
}

inline std::vector<uint8_t> image_of_words(std::vector<uint32_t> words, uint8_t unit = 1) {
  vm::Image image;
  image.unit = unit;
  image.code = std::move(words);
  return vm::write_image(image);
}

// Writes the checksum of changed bytes anew.
inline void seal(std::vector<uint8_t>& bytes) {
  const uint32_t checksum = vm::crc32(std::span(bytes).first(bytes.size() - 4));
  for (uint32_t n = 0; n < 4; ++n) bytes[bytes.size() - 4 + n] = static_cast<uint8_t>(checksum >> (8 * n));
}

class LoadedProgram {
 public:
  explicit LoadedProgram(std::vector<uint8_t> image) : image_(std::move(image)) {
    status =
        ipos_program_load(memory_.data(), sizeof memory_, image_.data(), image_.size(), &program, &trouble);
  }
  explicit LoadedProgram(const std::string& source, const char* unit = "md60a")
      : LoadedProgram(image_of(source, unit)) {}

  ipos_status status;
  ipos_trouble trouble{};
  ipos_program* program = nullptr;

 private:
  std::vector<uint8_t> image_;
  std::array<uint64_t, IPOS_PROGRAM_BYTES / 8> memory_{};
};

// Answers as its members say.
struct RecordingHost {
  std::vector<ipos_command> commands;
  ipos_reply reply{IPOS_ANSWER_DONE, 0, nullptr};
  std::vector<int> cancelled;
  std::vector<std::pair<uint64_t, ipos_frame>> frames;
  std::vector<uint32_t> tags;
  ipos_sending sending = IPOS_SENDING_DONE;
  uint64_t now = 0;
  std::vector<uint8_t> nv = std::vector<uint8_t>(IPOS_NV_BYTES, 0xFF);
  bool nv_works = true;
  std::vector<ipos_fault> faults;
  std::vector<ipos_step> steps;
  ipos_status nested = IPOS_OK;  // what a function not for callbacks answered in one

  ipos_host callbacks() {
    ipos_host host{};
    host.user = this;
    host.command = [](void* self, ipos_vm* vm, const ipos_command* command) {
      of(self).commands.push_back(*command);
      of(self).nested = ipos_run_ticks(vm, 1, nullptr);
      return of(self).reply;
    };
    host.cancel = [](void* self, ipos_vm* vm, uint8_t context) {
      of(self).cancelled.push_back(context);
      of(self).nested = ipos_run_ticks(vm, 1, nullptr);
    };
    host.send = [](void* self, ipos_vm* vm, const ipos_frame* frame, uint32_t tag) {
      of(self).frames.emplace_back(ipos_ticks(vm), *frame);
      of(self).tags.push_back(tag);
      return of(self).sending;
    };
    host.time_us = [](void* self) { return of(self).now; };
    host.nv_write = [](void* self, uint32_t offset, const void* bytes, uint32_t size) {
      if (of(self).nv_works) std::memcpy(of(self).nv.data() + offset, bytes, size);
      return of(self).nv_works;
    };
    host.nv_read = [](void* self, uint32_t offset, void* bytes, uint32_t size) {
      std::memcpy(bytes, of(self).nv.data() + offset, size);
      return of(self).nv_works;
    };
    host.fault = [](void* self, ipos_vm*, const ipos_fault* fault) { of(self).faults.push_back(*fault); };
    return host;
  }
  static void note_step(void* self, ipos_vm*, const ipos_step* step) { of(self).steps.push_back(*step); }

 private:
  static RecordingHost& of(void* self) { return *static_cast<RecordingHost*>(self); }
};

// A started machine.
class RunningMachine {
 public:
  explicit RunningMachine(const LoadedProgram& loaded, const ipos_host* host = nullptr) {
    EXPECT_EQ(loaded.status, IPOS_OK);
    EXPECT_EQ(ipos_init(memory_.data(), sizeof memory_, loaded.program, host, &vm), IPOS_OK);
    EXPECT_EQ(ipos_start(vm), IPOS_OK);
  }
  int32_t operator[](uint32_t variable) const {
    int32_t value = 0;
    EXPECT_EQ(ipos_read(vm, variable, &value), IPOS_OK);
    return value;
  }
  int32_t operator[](const char* name) const {
    int32_t value = 0;
    EXPECT_EQ(ipos_read_symbol(vm, name, &value), IPOS_OK) << name;
    return value;
  }

  ipos_vm* vm = nullptr;

 private:
  std::array<uint64_t, (IPOS_VM_BYTES + 7) / 8> memory_{};
};

}  // namespace ipos::tests
