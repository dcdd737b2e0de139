// Octets for the PROFIBUS tests: written as text, and a frame put together by hand, so that no expectation
// comes from the encoder under test.
#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <span>
#include <string>
#include <vector>

#include "runtime/bus/profibus/fdl_frame.hpp"
#include "tests/harness/proves.hpp"

namespace ipos::tests {

using namespace ipos::profibus;  // NOLINT: a test header, everything here is about PROFIBUS

// "68 05 05"
inline Octets hex(const std::string& text) {
  Octets octets;
  for (size_t at = 0; at + 1 < text.size(); at += 3)
    octets.push_back(static_cast<uint8_t>(std::stoi(text.substr(at, 2), nullptr, 16)));
  return octets;
}

inline std::string text_of(std::span<const uint8_t> octets) {
  std::string text;
  char two[4];
  for (const uint8_t octet : octets) {
    std::snprintf(two, sizeof two, "%02X", octet);
    text += (text.empty() ? "" : " ") + std::string(two);
  }
  return text;
}

// SD2 around DA .. data, with lengths, check octet and end by the rules of the norm.
inline Octets sd2(const std::string& body_text) {
  const Octets body = hex(body_text);
  const auto length = static_cast<uint8_t>(body.size());
  Octets octets{0x68, length, length, 0x68};
  unsigned sum = 0;
  for (const uint8_t octet : body) {
    octets.push_back(octet);
    sum += octet;
  }
  octets.push_back(static_cast<uint8_t>(sum % 256));
  octets.push_back(0x16);
  return octets;
}

}  // namespace ipos::tests
