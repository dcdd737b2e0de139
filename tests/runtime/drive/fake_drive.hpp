// A drive whose inhibit and output stage a test sets by hand, and a window over a few words.
#pragma once

#include <string_view>
#include <vector>

#include "runtime/drive/parameters.hpp"

namespace ipos::tests {

inline const stdlib::UnitType& unit(std::string_view name) { return *stdlib::find_unit(name); }

struct FakeDrive final : runtime::DriveLink {
  bool inhibited = true;
  bool stage_on = false;
  std::vector<uint16_t> written;

  std::optional<int32_t> live_value(uint16_t) const override { return std::nullopt; }
  bool controller_inhibited() const override { return inhibited; }
  bool output_stage_on() const override { return stage_on; }
  void on_parameter_written(uint16_t index, int32_t) override { written.push_back(index); }
};

struct FakeWindow final : runtime::IndexWindow {
  explicit FakeWindow(size_t count) : words(count) {}
  std::vector<int32_t> words;
  int stores = 0;

  runtime::ParameterReply read(uint16_t offset) override { return words.at(offset); }
  runtime::ParameterReply write(uint16_t offset, int32_t value, bool nonvolatile) override {
    words.at(offset) = value;
    stores += nonvolatile;
    return value;
  }
  bool stored(uint16_t offset) const override { return offset < 128; }
};

}  // namespace ipos::tests
