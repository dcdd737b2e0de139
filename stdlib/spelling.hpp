// "did you mean": the known name most like one that is misspelt. One measure for the words of the language,
// names of programs and files, and what people type at the tools.
#pragma once

#include <span>
#include <string_view>

namespace ipos::stdlib {

// The nearest of the candidates: by steps of typing (a letter more, less, other, or two that changed places;
// another case is none), or one that begins as the name does, or as the name begins. Empty when none is near.
// Of equal ones the first.
std::string_view nearest(std::string_view name, std::span<const std::string_view> candidates);

bool equal_but_for_case(std::string_view a, std::string_view b);

}  // namespace ipos::stdlib
