// The forms of files that verbs write by the ending of their names: one table, and the same refusal for all.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace ipos::tools {

// An option with the endings that say a form. A name without one, as that of a device has, is of the first form where
// that is `plain`.
struct OutputForms {
  std::string_view option;
  std::span<const std::string_view> endings;
  bool plain;
};
std::span<const OutputForms> output_forms();

// The ending in small letters, or "" for a plain name, standard output and no output at all. One that the option does not
// know is a Failure with those that it knows.
std::string output_ending(std::string_view option, const std::string& path);

}  // namespace ipos::tools
