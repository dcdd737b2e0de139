// The sources of a plant as this process has compiled them.
#pragma once

#include "tools/input/sources.hpp"
#include "tools/serve/host/outside.hpp"

namespace ipos::tools::serve {

class CompiledSources final : public Sources {
 public:
  std::optional<std::string> text(const std::string& file) override { return source_text(file); }
  bool has_changed(const std::string& file) override { return source_has_changed(file); }
};

}  // namespace ipos::tools::serve
