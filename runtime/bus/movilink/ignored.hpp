// Why a telegram to a unit had no effect or no answer, as data.
#pragma once

#include <cstdint>
#include <string_view>

namespace ipos::runtime {

enum class Ignored : uint8_t {
#define IGNORED(name, outcome, text) name,
#include "runtime/bus/movilink/ignored.def"
};

// "had no effect: remote frame".
constexpr std::string_view ignored_text(Ignored reason) {
  constexpr std::string_view kTexts[] = {
#define IGNORED(name, outcome, text) outcome ": " text,
#include "runtime/bus/movilink/ignored.def"
  };
  return kTexts[static_cast<size_t>(reason)];
}

}  // namespace ipos::runtime
