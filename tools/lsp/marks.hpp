// What an editor draws on a text by itself: folds, colours by meaning, hints, lenses.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "tools/lsp/features.hpp"

namespace ipos::tools::lsp {

// The legend of semantic tokens, by number.
enum class TokenType : uint32_t { Macro, Variable, Function, Type, Property, Number, Namespace };
inline constexpr std::string_view kTokenTypes[] = {"macro",    "variable", "function", "type",
                                                   "property", "number",   "namespace"};
enum TokenModifier : uint32_t { kDeclaration = 1, kDefaultLibrary = 2 };
inline constexpr std::string_view kTokenModifiers[] = {"declaration", "defaultLibrary"};

// Tokens in any order, each within a line, and none over another.
class TokenRow {
 public:
  void add(const Json& range, TokenType type, uint32_t modifiers = 0);
  Json json();

 private:
  using Token = std::array<uint32_t, 5>;  // line, character, length, type, modifiers
  std::vector<Token> tokens_;
};

Json folding_ranges(Workspace& workspace, const Json& params);
Json inlay_hints(Workspace& workspace, const Json& params);
Json semantic_tokens(Workspace& workspace, const Json& params);
Json code_lenses(Workspace& workspace, const Json& params);
Json code_actions(Workspace& workspace, const Json& params);

// Of plants and tests.
Json plant_folding_ranges(Workspace& workspace, const Json& params);
Json plant_semantic_tokens(Workspace& workspace, const Json& params);
Json plant_code_lenses(Workspace& workspace, const Json& params);
Json plant_code_actions(Workspace& workspace, const Json& params);

}  // namespace ipos::tools::lsp
