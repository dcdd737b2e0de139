// Where a node of the tree stands in the source, and how it is written there, through macros.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "compiler/source/source.hpp"

namespace ipos::compiler::mutants {

// A node that is, or is within, one use of a macro.
struct MacroUse {
  std::string_view name;  // of the macro that stands in the source
  Location use;
  bool built_in = false;  // its text stands in a built-in header
};

class Texts {
 public:
  explicit Texts(const SourceMap& sources) : sources_(sources) {}

  std::optional<MacroUse> macro_of(Span span) const;
  // As written, in the text of the macro where it is within one; on one line and not too long.
  std::string written(Span span) const;
  // As it stands where the macro is used.
  std::string used(Span span) const { return text_between(sources_.use(span.begin), sources_.use(span.end)); }
  // Of a file of the user.
  bool is_own(Location at) const;
  Location use(Location at) const { return sources_.use(at); }
  Location spelling(Location at) const { return sources_.spelling(at); }

 private:
  std::string text_between(Location begin, Location end) const;

  const SourceMap& sources_;
};

}  // namespace ipos::compiler::mutants
