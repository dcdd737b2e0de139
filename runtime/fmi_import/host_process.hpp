// The process of one machine: a small program that is written beside the unpacked FMU into a folder of its own, and loads it. Who
// holds the line to it keeps it alive, copies of this process, too; when nobody does, it removes its folder and ends.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/fmi_import/host/protocol.h"
#include "runtime/plant_file/foreign_machine.hpp"

namespace ipos::fmi_import {

// What a host is begun with, as bytes of the protocol.
struct Beginning {
  std::string bytes;
  uint32_t outputs = 0;
};

class HostProcess final : public runtime::MachineRun {
 public:
  // Makes the content of the folder: the FMU's files. It runs when the machine starts.
  using Unpack = std::function<Done(const std::filesystem::path& folder)>;
  using Begin = std::function<Beginning(const std::filesystem::path& folder)>;
  HostProcess(Unpack unpack, Begin begin, int64_t limit);
  ~HostProcess() override;

  Done start(std::span<const double> in, std::span<double> out) override;
  Done step(int64_t at, int64_t length, std::span<const double> in, std::span<double> out) override;
  std::vector<runtime::MachineWord> take_words() override;
  std::optional<std::string> save() override;
  Done restore(const std::string& state) override;

 private:
  Done open();
  Done spawn();
  Done ask(ipos_fmu_order order, std::string_view bytes, std::string& values);
  Done give(std::string_view values, std::span<double> out);
  bool wait_for(int file, int64_t until);
  bool receive(void* data, size_t size, int64_t until);
  bool send(std::string_view bytes, int64_t until);
  void listen();  // to its standard output
  void hear(std::string_view words);
  Done gone();
  void close_line();

  Unpack unpack_;
  Begin begin_;
  int64_t limit_;  // ns of the clock
  std::filesystem::path folder_;
  int line_ = -1;
  int output_ = -1;
  int process_ = 0;
  bool shared_ = false;  // copies of this process may go on with it
  bool late_ = false;
  std::string unfinished_;  // a line of its output
  std::vector<runtime::MachineWord> words_;
};

}  // namespace ipos::fmi_import
