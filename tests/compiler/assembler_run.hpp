// Assembles a text kept in memory, for the tests of the assembler.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compiler/asm/assembler.hpp"
#include "compiler/diag/render.hpp"

namespace ipos::compiler::test {

struct Assembled {
  SourceMap sources;
  Diagnostics diagnostics;
  std::optional<vm::Image> image;
};

inline std::unique_ptr<Assembled> assemble_text(const std::string& text) {
  auto out = std::make_unique<Assembled>();
  out->image = assemble(out->sources.add("test.ipa", "test.ipa", text), out->diagnostics);
  return out;
}

inline std::vector<uint32_t> code(const std::string& text) {
  const auto result = assemble_text(text);
  EXPECT_TRUE(result->image) << text << render_text(result->diagnostics.all(), result->sources, false);
  return result->image ? result->image->code : std::vector<uint32_t>{};
}

}  // namespace ipos::compiler::test
